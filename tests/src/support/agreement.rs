//! Differences between two computations of the same matrix over many states.
//!
//! There are two measures:
//!
//! - `matrix`: the largest difference relative to the largest entry, state by state;
//! - `entry`: the largest difference of one entry over all states, relative to the largest
//!   magnitude of that entry over all states. A small column cannot hide behind a large one.

use crate::reference::linear::relative_difference;
use nalgebra::DMatrix;
use std::fmt;

/// Largest entry of a matrix that counts as zero; inputs near one in SI units give no results as
/// small.
const ZERO: f64 = 1e-12;

/// Worst differences so far.
#[derive(Clone, Debug, Default)]
pub struct Agreement {
    matrix: f64,
    differences: Option<DMatrix<f64>>,
    magnitudes: Option<DMatrix<f64>>,
    states: usize,
}

impl Agreement {
    /// No comparisons yet.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Whether there were no comparisons.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.states == 0
    }

    /// Compares a result with the expected one.
    pub fn compare(&mut self, found: &DMatrix<f64>, expected: &DMatrix<f64>) {
        self.states += 1;
        if found.shape() != expected.shape() || found.iter().any(|x| !x.is_finite()) {
            self.matrix = f64::INFINITY;
            return;
        }
        if found.amax().max(expected.amax()) > ZERO {
            self.matrix = self.matrix.max(relative_difference(found, expected));
        }
        larger(&mut self.differences, (found - expected).abs());
        larger(&mut self.magnitudes, expected.abs());
    }

    /// Worst relative difference of a whole matrix.
    #[must_use]
    pub const fn matrix(&self) -> f64 {
        self.matrix
    }

    /// Worst relative difference of an entry.
    ///
    /// An entry that is always zero in one computation must be zero in the other, up to rounding of
    /// the largest entry.
    #[must_use]
    pub fn entry(&self) -> f64 {
        let (Some(differences), Some(magnitudes)) = (&self.differences, &self.magnitudes) else {
            return self.matrix;
        };
        let rounding = (1e-12 * magnitudes.amax()).max(ZERO);
        let relative = |difference: &f64, magnitude: &f64| {
            if *magnitude > rounding {
                difference / magnitude
            } else if *difference > rounding {
                f64::INFINITY
            } else {
                0.0
            }
        };
        let all = differences.iter().zip(magnitudes.iter());
        all.map(|(d, m)| relative(d, m)).fold(0.0, f64::max)
    }

    /// Whether both measures are within a tolerance, after at least one comparison.
    #[must_use]
    pub fn within(&self, tolerance: f64) -> bool {
        self.states > 0 && self.matrix < tolerance && self.entry() < tolerance
    }
}

impl fmt::Display for Agreement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{:.1e} of the matrix, {:.1e} of an entry, over {} states",
            self.matrix,
            self.entry(),
            self.states
        )
    }
}

/// The angle shifted by full turns to be nearest to another.
#[must_use]
pub fn unwound(angle: f64, near: f64) -> f64 {
    let turn = std::f64::consts::TAU;
    angle - turn * ((angle - near) / turn).round()
}

fn larger(kept: &mut Option<DMatrix<f64>>, new: DMatrix<f64>) {
    *kept = Some(match kept.take() {
        Some(old) => old.zip_map(&new, f64::max),
        None => new,
    });
}
