//! A path that is no string.

use overact::redundant_robot;

#[redundant_robot(five_bar)]
struct FiveBar;

fn main() {}
