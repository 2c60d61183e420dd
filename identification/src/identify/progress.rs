//! What a long identification tells while it works.

use crate::regression::projection::ModelKind;

/// What an identification is doing.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Progress<'a> {
    /// Finds the base parameters.
    Base,
    /// Goes through a run: motion, columns, decimation.
    Run {
        /// Name of the run.
        run: &'a str,
        /// Samples done.
        done: usize,
        /// Samples of the run.
        samples: usize,
    },
    /// Estimates and eliminates parameters.
    Estimation {
        /// Which inputs the model explains.
        model: ModelKind,
    },
    /// Compares predictions with a run that was not identified from.
    Validation {
        /// Name of the run.
        run: &'a str,
        /// Samples done.
        done: usize,
        /// Samples of the run.
        samples: usize,
    },
}
