//! Differentiation of uniformly sampled signals.

use std::ops::Range;

/// Central differences per sample of rows of `n` values, one-sided at both ends of the run: those of
/// the samples `range`, row by row. `values` hold the rows from sample `start` on; number `last` is
/// the run's last one. A central difference has no phase, so velocities and accelerations stay aligned
/// with torques.
pub(crate) fn central_differences(
    values: &[f64],
    start: usize,
    range: Range<usize>,
    (n, last): (usize, usize),
) -> impl Iterator<Item = f64> {
    range.flat_map(move |sample| {
        let (before, after) = (sample.saturating_sub(1), (sample + 1).min(last));
        let step = (after - before).max(1) as f64;
        let row = move |sample: usize| &values[(sample - start) * n..(sample - start + 1) * n];
        let pair = row(after).iter().zip(row(before));
        pair.map(move |(after, before)| (after - before) / step)
    })
}

#[cfg(test)]
mod tests {
    use super::central_differences;

    #[test]
    fn a_parabola_is_exact_inside() {
        let signal: Vec<f64> = (0..6).map(|k| f64::from(k * k)).collect();
        let whole: Vec<f64> = central_differences(&signal, 0, 0..6, (1, 5)).collect();
        assert_eq!(whole, [1.0, 2.0, 4.0, 6.0, 8.0, 9.0]);
        let part: Vec<f64> = central_differences(&signal[2..], 2, 3..5, (1, 5)).collect();
        assert_eq!(part, [6.0, 8.0]);
        assert_eq!(
            central_differences(&[3.0], 0, 0..1, (1, 0)).next(),
            Some(0.0)
        );
    }
}
