//! A misspelled key is answered with the right one.

use overact::redundant_robot;

#[redundant_robot("descriptions/misspelled_key.toml")]
struct FiveBar;

fn main() {}
