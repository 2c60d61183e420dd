//! An attribute on an enum.

use overact::redundant_robot;

#[redundant_robot("descriptions/five_bar.toml")]
enum FiveBar {}

fn main() {}
