//! Table of the YAML file that accompanies a URDF: its keys.

use super::table::{Rule, Table, Treatment};
use Treatment::Honoured;

pub(crate) const TABLE: Table = Table {
    rules: &[Rule {
        within: "",
        elements: "yaml",
        treatment: Honoured,
        attributes: &[("closed_loop type name_mot joint_name joint_type", Honoured)],
    }],
    repeatable: "",
    texts: "",
};
