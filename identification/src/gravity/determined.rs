//! In which directions gravity can be turned so that the torques tell, whatever the data.
//!
//! A turn is told if what it does to the torques is more than other parameters could do. It is tried close to
//! the described direction, but beside it, since columns that vanish in this direction alone take in a part of
//! what a turn does as soon as there is one.

use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

use super::{columns::Extended, frame::Frame};
use crate::regression::elimination::eliminate;

/// How far beside the described direction turns are tried, rad.
const BESIDE: f64 = 1e-6;

/// Part of what gravity does that a turn has to do beyond all parameters, larger than what [`BESIDE`] makes of
/// effects of second order.
const PART: f64 = 1e-4;

/// A column whose part outside the others is below this part of its norm is dependent.
const TOLERANCE: f64 = 1e-9;

/// The turns that torques can tell, as orthogonal combinations of those of a frame: all of them, some or none.
pub(super) fn free_turns(extended: &Extended, frame: &Frame, seed: u64) -> Vec<DVector<f64>> {
    let angles = DVector::from_vec(vec![0.6 * BESIDE, 0.8 * BESIDE]);
    let frame = frame.turned(&angles);
    let columns = &extended.random * extended.at(&frame.gravity());
    let all: Vec<usize> = (0..extended.names.len()).collect();
    let kept = eliminate(&columns, &all, TOLERANCE).kept;
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
    let effects = frame.turns.iter().map(effect).collect::<Vec<_>>();
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
    let told = |at: &usize| parts.eigenvalues[*at] > PART * PART;
    let told: Vec<usize> = (0..parts.eigenvalues.len()).filter(told).collect();
    if told.len() == frame.turns.len() {
        // All of them are told: those of the frame are as good as any.
        let unit =
            |at: usize| DVector::from_fn(told.len(), |row, _| f64::from(u8::from(row == at)));
        return (0..told.len()).map(unit).collect();
    }
    // What is as small as effects of second order are is none.
    let vector = |at: usize| {
        let own = parts.eigenvectors.column(at);
        let own = own.map(|part| if part.abs() < PART { 0.0 } else { part });
        own.normalize()
    };
    told.into_iter().map(vector).collect()
}
