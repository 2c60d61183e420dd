//! Legs that are too short for the home pose.

use overact::redundant_robot;

#[redundant_robot("descriptions/does_not_close.toml")]
struct FiveBar;

fn main() {}
