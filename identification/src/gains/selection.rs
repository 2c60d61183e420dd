//! Choice of independent columns, and errors for drives without one.

use super::observation::Equations;
use crate::regression::{
    elimination::eliminate,
    factor::{DATA_RANK_TOLERANCE, Factor},
};
use overact::Code;
use overact_logs::{Error, Problem};

/// Smallest independent part of a drive's column, by its norm.
const RANK_TOLERANCE: f64 = 1e-7;

/// Columns of the equations that are solved for.
#[derive(Debug, Clone)]
pub(super) struct Selection {
    /// Columns that are independent on the data: those of parameters, then those of all drives.
    pub(super) columns: Vec<usize>,
    /// Number of the drives.
    pub(super) drives: usize,
}

impl Selection {
    /// Selects the columns that are independent on the data, without those of known parameters;
    /// `actuators` names the drives.
    ///
    /// # Errors
    /// Drives whose columns depend on others.
    pub(super) fn new(equations: &Equations, actuators: &[&str]) -> Result<Self, Error> {
        let lines = &equations.system.lines;
        let factor = Factor::merged(lines, &Self::weights(lines));
        let drives = actuators.len();
        let unknown = factor.parameters() - drives - equations.known;
        let order: Vec<usize> = (0..unknown).collect();
        let found = eliminate(factor.matrix(), &order, DATA_RANK_TOLERANCE);
        let all: Vec<usize> = (unknown..unknown + drives).collect();
        let columns = [found.kept, all.clone()].concat();
        let kept = eliminate(factor.matrix(), &columns, RANK_TOLERANCE).kept;
        let missing = all.iter().filter(|column| !kept.contains(column));
        let missing: Vec<String> = missing
            .map(|column| format!("`{}`", actuators[column - unknown]))
            .collect();
        if missing.is_empty() {
            Ok(Self { columns, drives })
        } else {
            Err(undetermined(
                &missing,
                ", whose torques are combinations of what the parameters and the other drives explain",
            ))
        }
    }

    /// Weights that scale lines before their noise is known.
    pub(super) fn weights(lines: &[Factor]) -> Vec<f64> {
        lines.iter().map(|line| 1.0 / size(line)).collect()
    }

    /// The same with one more parameter, the last before the gains.
    pub(super) fn with_column(&self, column: usize) -> Self {
        let mut columns = self.columns.clone();
        columns.insert(self.parameters(), column);
        Self { columns, ..*self }
    }

    /// Number of parameters, without the gains.
    pub(super) fn parameters(&self) -> usize {
        self.columns.len() - self.drives
    }
}

/// Root mean square of a line's rows, to scale lines before their noise is known; 1 if zero.
pub(super) fn size(line: &Factor) -> f64 {
    let norm = line.matrix().norm() / (line.equations().max(1) as f64).sqrt();
    if norm > 0.0 { norm } else { 1.0 }
}

/// The problem of gains that the data do not determine, and why.
pub(super) fn undetermined(actuators: &[String], why: &str) -> Error {
    let message = format!(
        "gains are not determined: the data do not determine {} of {}{why}",
        if actuators.len() == 1 {
            "that"
        } else {
            "those"
        },
        actuators.join(", ")
    );
    Problem::new(Code::GAINS, message)
        .help("let all drives accelerate the known bodies, with and without the payload, or give more known values, such as the first moments of the payload")
        .into()
}
