//! Table of the YAML file that accompanies a URDF: its keys.

use super::table::{Table, Treatment, rule};
use Treatment::Honoured;

pub(crate) const TABLE: Table = Table {
    rules: &[rule(
        "",
        "yaml",
        Honoured,
        &[("closed_loop type name_mot joint_name joint_type", Honoured)],
    )],
    repeatable: "",
    texts: "",
};
