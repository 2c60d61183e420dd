//! Finds motions that the loops allow only infinitesimally.
//!
//! A loop that closes with rods at their full reach has a closure Jacobian of a lower rank there, as
//! if it could move. A displacement along such a motion vanishes when the loops are closed again.

use super::motion::{Motion, State};
use nalgebra::{DMatrix, DVector};

/// Fraction of a displacement that the closures may change without suspicion.
const CHANGED: f64 = 0.5;
/// Displacements that are tried along each motion, rad or m.
const SIZES: [f64; 3] = [0.05, -0.05, 0.01];
/// Fraction of a displacement that remains along a finite motion.
const REMAINS: f64 = 0.3;
/// Rates below this fraction of the largest are rounding errors.
const STILL: f64 = 1e-3;

/// Whether closing the loops has changed most of a displacement `free` · `weights` from home.
pub(super) fn is_suspicious(
    motion: &Motion<'_>,
    home: &State,
    free: &DMatrix<f64>,
    weights: &DVector<f64>,
    closed: &State,
) -> bool {
    let left = free.transpose() * motion.step_between(home, closed);
    (weights - left).norm() > CHANGED * weights.norm()
}

/// Joints that move only infinitesimally, if `mobility` finite motions are not left.
///
/// The columns of `free` are orthonormal.
pub(super) fn joints(
    motion: &Motion<'_>,
    home: &State,
    free: &DMatrix<f64>,
    mobility: usize,
) -> Vec<usize> {
    let count = free.ncols();
    let mut left = DMatrix::identity(count, count);
    for at in 0..count {
        if let Some(column) = remaining(motion, home, free, at) {
            left.set_column(at, &column);
        }
    }
    let Some(svd) = left.try_svd(false, true, 1e-15, 10_000) else {
        return Vec::new();
    };
    let lost: Vec<usize> = (0..count)
        .filter(|&at| svd.singular_values[at] < REMAINS)
        .collect();
    let Some(directions) = svd.v_t.filter(|_| count - lost.len() < mobility) else {
        return Vec::new();
    };
    let rates = DMatrix::from_fn(count, lost.len(), |i, j| directions[(lost[j], i)]);
    let rates = free * rates;
    let largest = rates.amax();
    let mut joints: Vec<usize> = (0..motion.coordinates.len())
        .filter(|&at| rates.row(at).amax() > STILL * largest)
        .map(|at| motion.coordinates[at].joint)
        .filter(|&joint| !motion.model.joints[joint].is_virtual)
        .collect();
    joints.dedup();
    joints
}

/// What remains of a unit displacement along one motion after closing the loops; `None` if they
/// don't close.
fn remaining(
    motion: &Motion<'_>,
    home: &State,
    free: &DMatrix<f64>,
    at: usize,
) -> Option<DVector<f64>> {
    SIZES.into_iter().find_map(|size| {
        let moved = motion.moved_by(home, &(free.column(at) * size));
        let closed = motion.closed(&moved).ok()?;
        Some(free.transpose() * motion.step_between(home, &closed) / size)
    })
}
