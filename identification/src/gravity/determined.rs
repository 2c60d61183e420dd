//! Directions in which torques determine a rotation of gravity, for any data.
//!
//! A rotation is determined if its effect on the torques exceeds what other parameters can explain.
//! It is tested near the described direction, but not exactly there. Columns that vanish only in
//! that direction absorb part of the effect of any finite rotation.

use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

use super::{columns::Extended, direction::GravityFrame};
use crate::{estimation::base::RANK_TOLERANCE, regression::elimination::eliminate};

/// Angle between the tested and the described direction, rad.
const SMALL_ANGLE: f64 = 1e-6;

/// Smallest independent effect of a rotation, relative to gravity.
///
/// It is larger than second-order effects of [`SMALL_ANGLE`].
const PART: f64 = 1e-4;

/// Rotations that torques determine, as orthogonal combinations of the frame's: all, some or none.
pub(super) fn free_turns(
    extended: &Extended,
    frame: &GravityFrame,
    seed: u64,
) -> Vec<DVector<f64>> {
    let angles = DVector::from_vec(vec![0.6 * SMALL_ANGLE, 0.8 * SMALL_ANGLE]);
    let frame = frame.rotated(&angles);
    let columns = &extended.random * extended.at(&frame.gravity());
    let all: Vec<usize> = (0..extended.names.len()).collect();
    let kept = eliminate(&columns, &all, RANK_TOLERANCE).kept;
    let mut own = columns.select_columns(&kept);
    for mut column in own.column_iter_mut() {
        let norm = column.norm();
        column /= norm;
    }
    let mut generator = Pcg64::seed_from_u64(seed);
    let values = DVector::from_fn(all.len(), |_, _| generator.random_range(0.5..1.5));
    let effect = |field: &nalgebra::Vector3<f64>| {
        &extended.random * (extended.in_field(&(field * frame.size)) * &values)
    };
    let effects = frame.tilts.iter().map(effect).collect::<Vec<_>>();
    let axes = (0..3).map(|axis| effect(&nalgebra::Vector3::ith(axis, 1.0)).norm());
    let scale = axes.fold(0.0, f64::max);
    if scale == 0.0 {
        return Vec::new();
    }
    let mut free = DMatrix::from_columns(&effects);
    let q = own.qr().q();
    for _ in 0..2 {
        let inside = q.tr_mul(&free);
        free -= &q * inside;
    }
    let normal = free.tr_mul(&free) / (scale * scale);
    let parts = normal.symmetric_eigen();
    let determined = |at: &usize| parts.eigenvalues[*at] > PART * PART;
    let determined: Vec<usize> = (0..parts.eigenvalues.len()).filter(determined).collect();
    if determined.len() == frame.tilts.len() {
        // All are determined, so the frame's own directions suffice.
        let unit =
            |at: usize| DVector::from_fn(determined.len(), |row, _| f64::from(u8::from(row == at)));
        return (0..determined.len()).map(unit).collect();
    }
    // Components of the size of second-order effects are set to zero.
    let vector = |at: usize| {
        let own = parts.eigenvectors.column(at);
        let own = own.map(|part| if part.abs() < PART { 0.0 } else { part });
        own.normalize()
    };
    determined.into_iter().map(vector).collect()
}
