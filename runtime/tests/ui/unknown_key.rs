//! A key that is near no other.

use overact::redundant_robot;

#[redundant_robot("descriptions/unknown_key.toml")]
struct FiveBar;

fn main() {}
