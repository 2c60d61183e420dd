//! Ranks of a model's regressor over random states, by the evaluation backend.

use super::backend::evaluate;
use super::{Failure, Sample};
use crate::reference::linear::normalized_singular_values;
use nalgebra::DMatrix;
use overact::{Columns, Function};
use overact_codegen::RobotModel;
use overact_codegen::derivation::MotionInput;
use std::fmt;

/// Singular values below this fraction of the largest one count as zero.
const TOLERANCE: f64 = 1e-9;

/// A rank and the singular values at its edge, columns scaled to unit length.
#[derive(Clone, Copy, Debug)]
pub struct Rank {
    /// The rank.
    pub rank: usize,
    /// Number of columns.
    pub columns: usize,
    /// Largest singular value.
    pub largest: f64,
    /// Smallest singular value that counts.
    pub last: f64,
    /// Next singular value, which is rounding; zero if all count.
    pub next: f64,
}

impl Rank {
    /// Rank of a matrix.
    #[must_use]
    pub fn of(matrix: &DMatrix<f64>) -> Self {
        let values = normalized_singular_values(matrix);
        let largest = values.iter().copied().fold(0.0, f64::max);
        let rank = values.iter().filter(|&&v| v > TOLERANCE * largest).count();
        let at = |index: usize| values.get(index).copied().unwrap_or(0.0);
        Self {
            rank,
            columns: matrix.ncols(),
            largest,
            last: at(rank.saturating_sub(1)),
            next: at(rank),
        }
    }

    /// Whether the gap is at least four decades.
    #[must_use]
    pub fn is_clear(&self) -> bool {
        self.last > 1e4 * self.next
    }
}

impl fmt::Display for Rank {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "rank {} of {} columns, singular values {:.2} ... {:.1e} | {:.1e}",
            self.rank, self.columns, self.largest, self.last, self.next
        )
    }
}

/// Standard regressor of the platform projection from joints, over samples.
///
/// # Errors
///
/// If the model has no value at a sample.
pub fn regressor(model: &RobotModel, samples: &[Sample]) -> Result<DMatrix<f64>, Failure> {
    let function = Function::IdmRedPlatform(Columns::Standard);
    let function = model.function(function, MotionInput::Joints);
    let program = &function.ok_or("no regressor from joints")?.program;
    let (rows, columns) = (model.mechanism.dof(), model.selection.standard.len());
    let mut all = DMatrix::zeros(rows * samples.len(), columns);
    for (at, sample) in samples.iter().enumerate() {
        let values = evaluate(program, &|name| sample.input(name).ok())?;
        let block = DMatrix::from_row_slice(rows, columns, &values);
        all.rows_mut(rows * at, rows).copy_from(&block);
    }
    Ok(all)
}
