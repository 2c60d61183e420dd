//! A placement without its variable.

use overact::redundant_robot;

#[redundant_robot("descriptions/missing_variable.toml")]
struct FiveBar;

fn main() {}
