//! Filters compared with reference vectors of MATLAB and scipy.

mod common;

use overact_identification::filters::{
    Decimator, ZeroPhase, butterworth, chebyshev1, decimate, filtfilt,
};
use serde_json::Value;

/// A list of numbers of the reference.
fn numbers(value: &Value) -> Vec<f64> {
    value
        .as_array()
        .expect("a list")
        .iter()
        .map(|x| x.as_f64().expect("a number"))
        .collect()
}

/// Fails if two vectors differ by more than `tolerance`.
fn assert_close(found: &[f64], expected: &[f64], tolerance: f64, what: &str) {
    assert_eq!(found.len(), expected.len(), "{what}: length");
    let worst = found
        .iter()
        .zip(expected)
        .map(|(f, e)| (f - e).abs())
        .fold(0.0, f64::max);
    println!("{what}: largest difference {worst:.1e}, allowed {tolerance:.0e}");
    assert!(worst <= tolerance, "{what}: {worst:.2e} > {tolerance:.0e}");
}

#[test]
fn filters_agree_with_the_reference() {
    let Some(path) = common::shared("data/filters/filters_reference.json") else {
        return;
    };
    let text = std::fs::read_to_string(path).expect("readable");
    let reference: Value = serde_json::from_str(&text).expect("JSON");
    let x = numbers(&reference["x"]);

    let cheby = chebyshev1(8, 0.05, 0.8 / 10.0).expect("a design");
    for (section, expected) in cheby
        .sections()
        .iter()
        .zip(reference["sos"].as_array().expect("sections"))
    {
        let found = [section.b, section.a].concat();
        assert_close(&found, &numbers(expected), 1e-12, "section");
    }
    let (b, a) = cheby.polynomials();
    assert_close(&b, &numbers(&reference["cheby1_b"]), 1e-12, "Chebyshev b");
    assert_close(&a, &numbers(&reference["cheby1_a"]), 1e-9, "Chebyshev a");
    let filtered = filtfilt(&cheby, &x).expect("long enough");
    assert_close(
        &filtered,
        &numbers(&reference["sosfiltfilt_padlen24"]),
        1e-9,
        "sections, filtfilt",
    );
    assert_close(
        &filtered,
        &numbers(&reference["filtfilt_matlab_padlen24"]),
        1e-7,
        "polynomials, filtfilt",
    );
    let decimated = decimate(&x, 10).expect("long enough");
    assert_close(
        &decimated,
        &numbers(&reference["decimate_matlab"]),
        1e-7,
        "decimate",
    );
    // Sections compared with sections: the last of 203 samples is kept, so the first is number 2.
    let kept: Vec<f64> = numbers(&reference["sosfiltfilt_padlen24"])
        .into_iter()
        .skip(2)
        .step_by(10)
        .collect();
    assert_close(&decimated, &kept, 1e-9, "decimate in sections");
}

#[test]
fn butterworth_agrees_with_the_reference() {
    let Some(path) = common::shared("data/filters/filters_reference.json") else {
        return;
    };
    let text = std::fs::read_to_string(path).expect("readable");
    let reference: Value = serde_json::from_str(&text).expect("JSON");
    // 100 Hz at 1 kHz, as for EMPS.
    let butter = butterworth(4, 0.2).expect("a design");
    let (b, a) = butter.polynomials();
    assert_close(
        &b,
        &numbers(&reference["butter4_b"]),
        1e-12,
        "Butterworth b",
    );
    assert_close(
        &a,
        &numbers(&reference["butter4_a"]),
        1e-12,
        "Butterworth a",
    );
    let filtered = filtfilt(&butter, &numbers(&reference["x"])).expect("long enough");
    assert_close(
        &filtered,
        &numbers(&reference["butter4_filtfilt_matlab"]),
        1e-9,
        "Butterworth, filtfilt",
    );
}

#[test]
fn filter_responses_match_the_definitions() {
    // |H|² of cascaded sections at a fraction of the Nyquist frequency.
    let magnitude = |filter: &overact_identification::filters::LowPass, fraction: f64| -> f64 {
        let w = std::f64::consts::PI * fraction;
        let norm = |p: [f64; 3]| {
            let re = p[0] + p[1] * w.cos() + p[2] * (2.0 * w).cos();
            let im = p[1] * w.sin() + p[2] * (2.0 * w).sin();
            re * re + im * im
        };
        filter
            .sections()
            .iter()
            .map(|s| norm(s.b) / norm(s.a))
            .product()
    };
    for order in 1..=9 {
        for cutoff in [0.002, 0.3, 0.9] {
            let butter = butterworth(order, cutoff).expect("a design");
            assert!(
                (magnitude(&butter, cutoff) - 0.5).abs() < 1e-8,
                "half power at the cutoff"
            );
            assert!((magnitude(&butter, 0.0) - 1.0).abs() < 1e-6, "one at rest");
            let cheby = chebyshev1(order, 0.05, cutoff).expect("a design");
            let bottom = 10.0_f64.powf(-0.005);
            assert!(
                (magnitude(&cheby, cutoff) - bottom).abs() < 1e-6,
                "the ripple at the edge"
            );
        }
    }
}

#[test]
fn impossible_filters_are_errors() {
    let text = butterworth(0, 1.5).expect_err("two problems").to_string();
    assert_eq!(
        text,
        "a filter of order 0 is not possible\n  help: choose an order from 1 to 50; 4 is usual\n\
         a cutoff frequency of 1.5 times the Nyquist frequency is not possible\n  \
         help: choose a cutoff between 0 and half the sampling frequency"
    );
    let text = decimate(&[1.0; 24], 10).expect_err("too short").to_string();
    assert_eq!(
        text,
        "a filter of order 8 run forwards and backwards needs at least 25 samples; there are 24\n  \
         help: record a longer run, or lower `skip_start`, `skip_end` or `decimation` of [identification]"
    );
    assert!(decimate(&[1.0; 30], 0).is_err());
    assert_eq!(decimate(&[1.0, 2.0], 1).expect("unfiltered"), [1.0, 2.0]);
}

/// A signal with slow and fast parts and a jump.
fn signal(samples: usize, shift: f64) -> Vec<f64> {
    let mut noise = 0x2545_f491_u64;
    (0..samples)
        .map(|k| {
            noise = noise
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            let white = (noise >> 11) as f64 / (1_u64 << 53) as f64 - 0.5;
            let t = k as f64 * 1e-3 + shift;
            (2.0 * t).sin()
                + 0.3 * (40.0 * t).cos()
                + white
                + if k > samples / 3 { 2.0 } else { 0.0 }
        })
        .collect()
}

/// Pushes rows in blocks; also returns the output length before the last block.
fn pushed(
    rows: &[f64],
    block: usize,
    mut push: impl FnMut(&[f64], &mut Vec<f64>),
) -> (Vec<f64>, usize) {
    let (mut found, mut early) = (Vec::new(), 0);
    for rows in rows.chunks(block) {
        early = found.len();
        push(rows, &mut found);
    }
    (found, early)
}

#[test]
fn filtering_in_blocks_equals_filtering_the_whole_signal() {
    const SAMPLES: usize = 61_234;
    let signals = [signal(SAMPLES, 0.0), signal(SAMPLES, 5.0)];
    let rows: Vec<f64> = (0..SAMPLES)
        .flat_map(|k| signals.iter().map(move |signal| signal[k]))
        .collect();
    let column =
        |rows: &[f64], index| -> Vec<f64> { rows.iter().skip(index).step_by(2).copied().collect() };
    for (name, filter) in [
        ("even order", butterworth(4, 0.04)),
        ("odd order", butterworth(5, 0.1)),
    ] {
        let filter = filter.expect("a design");
        let whole = signals
            .each_ref()
            .map(|signal| filtfilt(&filter, signal).expect("long enough"));
        // Blocks of all sizes, down to single samples.
        for block in [1, 7, 5_000, SAMPLES] {
            let mut stream = ZeroPhase::new(&filter, 2, SAMPLES).expect("long enough");
            let (found, early) = pushed(&rows, 2 * block, |rows, found| stream.push(rows, found));
            assert!(block == SAMPLES || early > 0, "{name}: all came at the end");
            for (index, whole) in whole.iter().enumerate() {
                assert_close(&column(&found, index), whole, 1e-12, name);
            }
        }
    }
    for factor in [1, 2, 5, 20, 50] {
        let decimator = Decimator::new(factor).expect("a factor");
        // Sample by sample, with the same sections.
        let first = (SAMPLES - 1) % factor;
        let whole = signals.each_ref().map(|signal| {
            if factor == 1 {
                return signal.clone();
            }
            let filter = chebyshev1(8, 0.05, 0.8 / factor as f64).expect("a design");
            let filtered = filtfilt(&filter, signal).expect("long enough");
            filtered.into_iter().skip(first).step_by(factor).collect()
        });
        for block in [1, 7, 5_000, SAMPLES] {
            let mut stream = decimator.stream(2, SAMPLES).expect("long enough");
            let (found, early) = pushed(&rows, 2 * block, |rows, found| stream.push(rows, found));
            assert!(
                block == SAMPLES || factor == 50 || early > 0,
                "{factor}: all came at the end"
            );
            for (index, whole) in whole.iter().enumerate() {
                assert_close(
                    &column(&found, index),
                    whole,
                    1e-11,
                    &format!("decimation by {factor}"),
                );
            }
        }
    }
    // The shortest possible signals.
    for samples in 25..40 {
        let signal = signal(samples, 1.0);
        let filter = chebyshev1(8, 0.05, 0.8 / 10.0).expect("a design");
        let whole: Vec<f64> = filtfilt(&filter, &signal).expect("long enough");
        let kept: Vec<f64> = whole
            .into_iter()
            .skip((samples - 1) % 10)
            .step_by(10)
            .collect();
        assert_close(
            &decimate(&signal, 10).expect("long enough"),
            &kept,
            1e-11,
            "short",
        );
    }
}

#[test]
fn decimation_after_a_low_pass_equals_consecutive_filters() {
    let wave = |k: usize| (0.01 * k as f64).sin() + 0.3 * ((k * k) as f64).sin();
    let signal: Vec<f64> = (0..3000).map(wave).collect();
    let filter = butterworth(6, 0.05).expect("a design");
    let filtered = filtfilt(&filter, &signal).expect("long enough");
    for factor in [1, 10] {
        let whole = Decimator::new(factor).expect("a factor");
        let expected = whole.apply(&filtered).expect("long enough");
        let behind = whole.behind(filter.clone());
        let mut stream = behind.stream(1, signal.len()).expect("long enough");
        let mut found = Vec::new();
        for block in signal.chunks(77) {
            stream.push(block, &mut found);
        }
        assert_close(
            &found,
            &expected,
            1e-12,
            &format!("behind a low-pass, {factor}"),
        );
        assert!(behind.stream(1, 18).is_err(), "shorter than the reflection");
    }
}
