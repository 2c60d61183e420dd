//! Samples as returned by readers.

/// Some successive samples of a run.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Samples {
    /// Positions, samples × n, row-major (m, rad).
    pub positions: Vec<f64>,
    /// Torques, samples × n, row-major (N, N m).
    pub torques: Vec<f64>,
    /// Measured velocities, samples × n, row-major (m/s, rad/s); empty if not measured.
    pub velocities: Vec<f64>,
}

impl Samples {
    /// Removes all samples.
    pub(crate) fn clear(&mut self) {
        self.positions.clear();
        self.torques.clear();
        self.velocities.clear();
    }
}
