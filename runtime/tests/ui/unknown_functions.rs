//! Functions that are not there, or said twice.

use overact::redundant_robot;

#[redundant_robot("descriptions/capitals.toml", functions = ["inverse_dynamic", "joints", "nonsense"])]
pub struct Misspelled;

#[redundant_robot("descriptions/capitals.toml", functions = ["idm_red_payload"])]
pub struct NotOffered;

#[redundant_robot("descriptions/capitals.toml", functions = [])]
pub struct Nothing;

#[redundant_robot("descriptions/capitals.toml", functions = ["joints"], functions = ["bias"])]
pub struct Twice;

#[redundant_robot("descriptions/capitals.toml", functions = [joints])]
pub struct Unquoted;

fn main() {}
