//! An attribute on a generic struct.

use overact::redundant_robot;

#[redundant_robot("descriptions/five_bar.toml")]
struct FiveBar<T>;

fn main() {}
