//! Samples as readers hand them on.

/// Some successive samples of a run.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Samples {
    /// Positions, samples x n, row-major (m, rad).
    pub positions: Vec<f64>,
    /// Torques, samples x n, row-major (N, N m).
    pub torques: Vec<f64>,
    /// Measured velocities, samples x n, row-major (m/s, rad/s); empty where there are none.
    pub velocities: Vec<f64>,
}

impl Samples {
    /// Forgets all numbers.
    pub(super) fn clear(&mut self) {
        self.positions.clear();
        self.torques.clear();
        self.velocities.clear();
    }
}
