//! Runs and other data of an identification.

use std::{collections::BTreeMap, fmt};

use overact::Model;

use crate::{mapping::scales::Scales, run::log::Log};

/// Data of an identification.
#[derive(Debug, Clone, Copy)]
pub struct Dataset<'a> {
    /// Training runs.
    pub runs: &'a [Log],
    /// Validation runs.
    pub validation: &'a [Log],
    /// Known values of standard parameters by name (virtual runs, weighed payloads).
    ///
    /// Names that the robot does not have are ignored.
    pub true_values: Option<&'a BTreeMap<String, f64>>,
    /// The robot with each length changed, to test the length with the torques.
    ///
    /// In closed loops, the closure determines lengths far better.
    pub variants: &'a [Variant<'a>],
    /// Described sizes and limits, for the check of units.
    pub scales: Option<&'a Scales>,
}

/// The robot with one length slightly longer than described.
#[derive(Clone, Copy)]
pub struct Variant<'a> {
    /// Name of the length.
    pub length: &'a str,
    /// Increase of the length, m; small compared with it.
    pub step: f64,
    /// The robot, with the same parameters in the same order.
    pub model: &'a dyn Model,
}

impl fmt::Debug for Variant<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Variant")
            .field("length", &self.length)
            .field("step", &self.step)
            .finish_non_exhaustive()
    }
}
