//! State-variable filters against their transfer function.

use overact::online::{Error, StateVariableFilter};
use std::f64::consts::TAU;

/// Amplitude and phase of H(s) = ωᴺ / Π (s - p) of a Butterworth filter at a frequency ratio.
fn response(order: usize, ratio: f64) -> (f64, f64) {
    let (mut amplitude, mut phase) = (1.0, 0.0);
    for k in 0..order {
        let angle = std::f64::consts::PI * (2 * k + order + 1) as f64 / (2 * order) as f64;
        let (re, im) = (-angle.cos(), ratio - angle.sin());
        amplitude /= re.hypot(im);
        phase -= im.atan2(re);
    }
    (amplitude, phase)
}

fn check_response<const N: usize>() {
    let (cutoff, sampling) = (30.0, 20_000.0);
    for frequency in [5.0, 30.0, 60.0] {
        let mut filter = StateVariableFilter::<N>::new(cutoff, sampling).unwrap();
        let (amplitude, phase) = response(N, frequency / cutoff);
        let rate = TAU * frequency;
        for step in 0..20_000 {
            let t = f64::from(step) / sampling;
            let signal = filter.update((rate * t).sin()).unwrap();
            if step > 15_000 {
                let (s, c) = (rate * t + phase).sin_cos();
                assert!((signal.value - amplitude * s).abs() < 1e-4);
                assert!((signal.velocity / rate - amplitude * c).abs() < 1e-4);
                assert!((signal.acceleration / rate / rate + amplitude * s).abs() < 1e-4);
            }
        }
    }
}

#[test]
fn frequency_response_matches_a_butterworth_filter() {
    check_response::<3>();
    check_response::<4>();
    check_response::<6>();
}

#[test]
fn linear_signals_are_exact_for_any_sampling() {
    // Between samples the signal is linear, so the discretisation has no error: after the
    // transient the output lags by the delay exactly.
    for sampling in [100.0, 1000.0, 100_000.0] {
        let mut filter = StateVariableFilter::<3>::new(40.0, sampling).unwrap();
        let delay = filter.delay();
        let count = (sampling * 0.5) as u32;
        for step in 0..count {
            let t = f64::from(step) / sampling;
            let signal = filter.update(3.0 * t).unwrap();
            if step + 10 > count {
                assert!((signal.value - 3.0 * (t - delay)).abs() < 1e-9);
                assert!((signal.velocity - 3.0).abs() < 1e-8);
                assert!(signal.acceleration.abs() < 1e-5);
            }
        }
    }
}

#[test]
fn derivatives_are_consistent_in_single_precision() {
    let mut single = StateVariableFilter::<3, f32>::new(20.0, 1000.0).unwrap();
    let mut double = StateVariableFilter::<3>::new(20.0, 1000.0).unwrap();
    for step in 0..3000 {
        let sample = (f64::from(step) * 0.005).sin();
        let (a, b) = (
            single.update(sample as f32).unwrap(),
            double.update(sample).unwrap(),
        );
        assert!((f64::from(a.value) - b.value).abs() < 1e-5);
        assert!((f64::from(a.acceleration) - b.acceleration).abs() < 0.1);
    }
}

#[test]
fn invalid_samples_leave_the_state_unchanged() {
    let mut filter = StateVariableFilter::<3>::new(20.0, 1000.0).unwrap();
    filter.update(1.0).unwrap();
    let before = filter;
    let error = Err(Error::NotFinite { input: "sample" });
    assert_eq!(filter.update(f64::NAN), error);
    assert_eq!(filter.update(f64::INFINITY), error);
    assert_eq!(filter, before);
    for sample in [f64::MAX, -f64::MAX, f64::MAX] {
        let before = filter;
        if filter.update(sample).is_err() {
            assert_eq!(filter, before);
        }
    }
    assert!(filter.update(1.0).unwrap().value.is_finite());
}

#[test]
fn cutoffs_out_of_range_are_errors() {
    for (cutoff, sampling) in [
        (0.0, 1e3),
        (500.0, 1e3),
        (f64::NAN, 1e3),
        (1.0, f64::INFINITY),
        (1.0, -1.0),
    ] {
        let error = StateVariableFilter::<3>::new(cutoff, sampling).unwrap_err();
        assert!(matches!(error, Error::Setting { .. }));
    }
}
