//! Sums of scores over batches of successive samples.
//!
//! Their scatter estimates the covariance of the total, whatever the correlation within batches.

use nalgebra::{DMatrix, DVector};

use super::system::Stretch;

/// Fewest batches.
pub(crate) const FEWEST_BATCHES: usize = 30;

/// Sums over batches in all stretches; `scores` has one row for each sample of a stretch.
///
/// A batch has about the cube root of all samples. That is longer than the noise's correlation
/// after decimation.
pub(crate) fn batch_sums(
    stretches: &[Stretch],
    scores: impl Fn(&Stretch) -> DMatrix<f64>,
) -> Vec<DVector<f64>> {
    let kept = samples(stretches);
    let root = (kept as f64).cbrt().ceil() as usize;
    let batch = root.min(kept / FEWEST_BATCHES).max(1);
    let mut sums = Vec::new();
    for stretch in stretches {
        let scores = scores(stretch);
        let mut first = 0;
        while first < scores.nrows() {
            let count = batch.min(scores.nrows() - first);
            sums.push(scores.rows(first, count).row_sum().transpose());
            first += count;
        }
    }
    sums
}

/// Number of samples in all stretches.
pub(crate) fn samples(stretches: &[Stretch]) -> usize {
    let of_one = |stretch: &Stretch| stretch.lines.first().map_or(0, DMatrix::nrows);
    stretches.iter().map(of_one).sum()
}
