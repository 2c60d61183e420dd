//! A description that does not exist.

use overact::redundant_robot;

#[redundant_robot("descriptions/missing_file.toml")]
struct FiveBar;

fn main() {}
