//! A description that is no TOML.

use overact::redundant_robot;

#[redundant_robot("descriptions/broken_toml.toml")]
struct FiveBar;

fn main() {}
