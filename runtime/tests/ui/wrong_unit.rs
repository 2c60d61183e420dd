//! A mass where a length belongs.

use overact::redundant_robot;

#[redundant_robot("descriptions/wrong_unit.toml")]
struct FiveBar;

fn main() {}
