//! An attribute on a struct with fields.

use overact::redundant_robot;

#[redundant_robot("descriptions/five_bar.toml")]
struct FiveBar {
    length: f64,
}

fn main() {}
