//! The runs of an identification.

use std::collections::BTreeMap;

use super::Log;

/// The data of an identification.
#[derive(Debug, Clone, Copy)]
pub struct Dataset<'a> {
    /// Runs to identify from.
    pub runs: &'a [Log],
    /// Runs to cross-validate on.
    pub validation: &'a [Log],
    /// Values of the standard parameters by name, where they are known (virtual runs, weighed
    /// payloads). Names that the robot does not have are ignored.
    pub true_values: Option<&'a BTreeMap<String, f64>>,
}
