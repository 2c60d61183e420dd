//! Forms that do not exist, or that do not go together.

use overact::redundant_robot;

#[redundant_robot("descriptions/capitals.toml", from = ["joint", "sky"])]
pub struct Sources;

#[redundant_robot("descriptions/capitals.toml", columns = "bases")]
pub struct Columns;

#[redundant_robot("descriptions/capitals.toml", crate = "a b")]
pub struct Path;

#[redundant_robot("descriptions/capitals.toml", function = ["joints"])]
pub struct Key;

#[redundant_robot("descriptions/capitals.toml", from = [])]
pub struct Nothing;

#[redundant_robot("descriptions/capitals.toml", effort = "full")]
pub struct Effort;

#[redundant_robot(
    "descriptions/five_bar.toml",
    functions = ["mass_matrix", "idm_red_platform_from_actuators", "bias"],
    from = ["joints"]
)]
pub struct Forms;

fn main() {}
