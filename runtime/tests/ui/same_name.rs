//! Two legs of one name.

use overact::redundant_robot;

#[redundant_robot("descriptions/same_name.toml")]
struct FiveBar;

fn main() {}
