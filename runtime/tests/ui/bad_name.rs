//! A name that is no identifier.

use overact::redundant_robot;

#[redundant_robot("descriptions/bad_name.toml")]
struct FiveBar;

fn main() {}
