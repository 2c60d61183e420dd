//! An attribute without a path.

use overact::redundant_robot;

#[redundant_robot]
struct FiveBar;

fn main() {}
