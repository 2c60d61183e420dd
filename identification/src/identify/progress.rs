//! What a long identification tells while it works.

/// What an identification is doing.
#[derive(Debug, Clone, Copy, PartialEq)]
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
        /// `platform`, `actuators` or `joints`.
        model: &'static str,
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
