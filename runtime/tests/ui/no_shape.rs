//! A leg of a shape that is not described.

use overact::redundant_robot;

#[redundant_robot("descriptions/no_shape.toml")]
struct FiveBar;

fn main() {}
