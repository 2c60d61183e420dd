//! The runs of an identification.

use std::{collections::BTreeMap, fmt};

use overact::Model;

use super::{Log, Scales};

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
    /// The robot with other lengths, one by one: whether the torques speak of such a length is asked. Where
    /// loops close, their closure tells much more.
    pub variants: &'a [Variant<'a>],
    /// What the description says of sizes and limits, by which units are judged.
    pub scales: Option<&'a Scales>,
}

/// The robot with one length that is a little longer than described.
#[derive(Clone, Copy)]
pub struct Variant<'a> {
    /// Name of the length.
    pub length: &'a str,
    /// By how much it is longer, m; small beside it.
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
