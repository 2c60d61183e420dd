//! Fewer actuators than degrees of freedom.

use overact::redundant_robot;

#[redundant_robot("descriptions/few_actuators.toml")]
struct FiveBar;

fn main() {}
