//! A leg that is stretched at home.

use overact::redundant_robot;

#[redundant_robot("descriptions/stretched_leg.toml")]
struct FiveBar;

fn main() {}
