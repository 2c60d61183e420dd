//! Samples as readers hand them on.

/// Some successive samples of a run.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Samples {
    /// Positions, samples x n, row-major (m, rad).
    pub positions: Vec<f64>,
    /// Torques, samples x n, row-major (N, N m).
    pub torques: Vec<f64>,
}
