//! Differentiation of uniformly sampled signals.

/// Derivative of `signal` at `frequency` (Hz) by central differences, one-sided at both ends. A
/// central difference has no phase, so velocities and accelerations stay aligned with torques.
#[must_use]
pub fn central_differences(signal: &[f64], frequency: f64) -> Vec<f64> {
    let last = signal.len().saturating_sub(1);
    (0..signal.len())
        .map(|k| {
            let (before, after) = (k.saturating_sub(1), (k + 1).min(last));
            let step = (after - before).max(1) as f64;
            (signal[after] - signal[before]) / step * frequency
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::central_differences;

    #[test]
    fn a_parabola_is_exact_inside() {
        let signal: Vec<f64> = (0..6).map(|k| f64::from(k * k)).collect();
        assert_eq!(
            central_differences(&signal, 1.0),
            [1.0, 2.0, 4.0, 6.0, 8.0, 9.0]
        );
        assert_eq!(central_differences(&[3.0], 10.0), [0.0]);
        assert!(central_differences(&[], 10.0).is_empty());
    }
}
