//! Progress of a long identification.

use crate::regression::projection::ModelKind;

/// Current activity of an identification.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Progress<'a> {
    /// Finding the base parameters.
    Base,
    /// Reading a run: motion, columns, decimation.
    Run {
        /// Name of the run.
        run: &'a str,
        /// Number of finished samples.
        done: usize,
        /// Number of all samples.
        samples: usize,
    },
    /// Estimation and elimination of parameters.
    Estimation {
        /// Model.
        model: ModelKind,
    },
    /// Another stage begins.
    Stage {
        /// Name of the stage.
        name: &'static str,
    },
    /// A check begins.
    Check {
        /// What it examines.
        name: &'static str,
    },
    /// Comparing predictions with a validation run.
    Validation {
        /// Name of the run.
        run: &'a str,
        /// Number of finished samples.
        done: usize,
        /// Number of all samples.
        samples: usize,
    },
}
