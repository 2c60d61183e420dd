//! Standard deviations against repetitions of synthetic experiments.

use super::super::estimate::{Estimation, estimate};
use super::{Noise, line_residual};
use crate::{
    regression::{
        factor::Factor,
        projection::Projection,
        system::{Stretch, System},
    },
    settings::{Normalisation, Settings},
};
use nalgebra::DMatrix;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

const SAMPLES: usize = 600;
const TRUTH: [f64; 3] = [2.0, -1.0, 0.5];

/// Two lines with slow columns, a constant and a fast one.
///
/// The residuals are x_k = a x_(k-1) + white noise, partly common to the lines.
fn system(a: f64, seed: u64) -> System {
    let mut generator = Pcg64::seed_from_u64(seed);
    let mut white = || {
        (0..12)
            .map(|_| generator.random_range(-0.5..0.5))
            .sum::<f64>()
    };
    let mut state = [0.0; 2];
    let mut lines = vec![DMatrix::zeros(SAMPLES, 4); 2];
    for k in 0..SAMPLES {
        let common = white();
        for (line, rows) in lines.iter_mut().enumerate() {
            state[line] = a * state[line] + 0.6 * common + 0.8 * white();
            let t = k as f64 * 0.05;
            let row = [(t + line as f64).sin(), 1.0, (11.0 * t).cos()];
            let y: f64 = row.iter().zip(TRUTH).map(|(w, x)| w * x).sum();
            for (column, value) in row.into_iter().enumerate() {
                rows[(k, column)] = value;
            }
            rows[(k, 3)] = y + (1 + line) as f64 * state[line];
        }
    }
    let factor = |rows: &DMatrix<f64>| {
        let mut factor = Factor::new(3);
        factor.push(rows);
        factor
    };
    System {
        projection: Projection::Platform,
        line_names: vec![String::from("x"), String::from("y")],
        sessions: Vec::new(),
        line_units: vec!["N"; 2],
        lines: lines.iter().map(factor).collect(),
        parts: Vec::new(),
        phase_sums: Vec::new(),
        totals: Vec::new(),
        stretches: vec![Stretch {
            run: 0,
            lines,
            instruments: Vec::new(),
        }],
        partition: None,
        instruments: Vec::new(),
    }
}

pub(crate) fn settings() -> Settings {
    Settings {
        filter_order: 4,
        filter_cutoff_hz: 10.0,
        decimation: 1,
        gear_friction: Vec::new(),
        stribeck_velocities: std::collections::BTreeMap::new(),
        skip_start: 0,
        skip_end: 0,
        difference_order: 4,
        velocity_dead_band: 0.0,
        standstill_velocity: Vec::new(),
        filter_torques: false,
        filter_equations: false,
        validation_samples: None,
        averaged_reversals: false,
        r_sigma: 10.0,
        keep_significant: false,
        normalisation: Normalisation::Unbiased,
        asymmetric_friction: false,
        weighted: true,
        instruments: crate::settings::Instruments::None,
        checks: crate::settings::CheckScope::All,
        period_s: None,
        prior: Default::default(),
        known: Default::default(),
        kept_actuators: Vec::new(),
        seed: 1,
        online: None,
    }
}

fn estimated(a: f64, seed: u64) -> (Estimation, Vec<f64>) {
    let system = system(a, seed);
    let found = estimate(&system, &[0, 1, 2], &settings()).expect("an estimate");
    let noise = Noise::new(&system, &[0, 1, 2], &found).expect("equations");
    let deviations = noise.deviations(&[0, 1, 2], &found);
    (found, deviations)
}

#[test]
fn standard_deviations_agree_with_monte_carlo() {
    const RUNS: u64 = 200;
    for a in [0.0, 0.9] {
        let mut errors = [0.0; 3];
        let (mut white, mut correlated) = ([0.0; 3], [0.0; 3]);
        for seed in 0..RUNS {
            let (found, deviations) = estimated(a, seed);
            for i in 0..3 {
                errors[i] += (found.values[i] - TRUTH[i]).powi(2);
                white[i] += found.standard_deviations[i].powi(2);
                correlated[i] += deviations[i].powi(2);
            }
        }
        let ratio = |of: [f64; 3]| [0, 1, 2].map(|i| (of[i] / errors[i]).sqrt());
        let (white, correlated) = (ratio(white), ratio(correlated));
        println!("a = {a}: white {white:.2?}, correlated {correlated:.2?} of the true deviations");
        for ratio in correlated {
            // The constant has the largest error: both lines share the lowest frequency.
            assert!((0.7..1.35).contains(&ratio), "{a}: {ratio}");
        }
        if a > 0.0 {
            // Slow residuals affect the constant and the slow column.
            assert!(white[0] < 0.5 && white[1] < 0.5);
        }
    }
}

#[test]
fn periodic_residuals_do_not_average_out() {
    // A missing harmonic with the trajectory's period: more periods add no information.
    let with_periods = |periods: usize| {
        let samples = 100 * periods;
        let mut rows = DMatrix::zeros(samples, 3);
        for k in 0..samples {
            let t = 2.0 * std::f64::consts::PI * k as f64 / 100.0;
            rows[(k, 0)] = t.sin() + 0.2 * (3.0 * t).sin();
            rows[(k, 1)] = t.cos();
            rows[(k, 2)] = rows[(k, 0)] + rows[(k, 1)] + 0.3 * (3.0 * t + 1.0).sin();
        }
        let mut factor = Factor::new(2);
        factor.push(&rows);
        let system = System {
            projection: Projection::Joints,
            line_names: vec![String::from("1")],
            sessions: Vec::new(),
            line_units: vec!["N"],
            lines: vec![factor],
            parts: Vec::new(),
            phase_sums: Vec::new(),
            totals: Vec::new(),
            stretches: vec![Stretch {
                run: 0,
                lines: vec![rows],
                instruments: Vec::new(),
            }],
            partition: None,
            instruments: Vec::new(),
        };
        let found = estimate(&system, &[0, 1], &settings()).expect("an estimate");
        let noise = Noise::new(&system, &[0, 1], &found).expect("equations");
        (
            found.standard_deviations[0],
            noise.deviations(&[0, 1], &found)[0],
        )
    };
    let (few, many) = (with_periods(10), with_periods(40));
    assert!(
        (many.0 / few.0 * 2.0 - 1.0).abs() < 0.05,
        "white {few:?} {many:?}"
    );
    assert!(
        (many.1 / few.1 - 1.0).abs() < 0.25,
        "correlated {few:?} {many:?}"
    );
}

#[test]
fn autocorrelation_and_spectrum_match_the_ar_process() {
    let system = system(0.9, 3);
    let found = line_residual(&system, 0, &[0, 1, 2], &TRUTH, 0.01);
    assert_eq!(found.autocorrelation[0], 1.0);
    for (lag, expected) in [(1, 0.9), (2, 0.81)] {
        assert!((found.autocorrelation[lag] - expected).abs() < 0.1);
    }
    assert!(found.within_bound < 0.9);
    // The density integrates to the variance, and low frequencies dominate.
    let step = found.frequency_hz[1];
    let inner: f64 = found.power.iter().sum::<f64>()
        - 0.5 * (found.power[0] + found.power[found.power.len() - 1]);
    let rows = &system.stretches[0].lines[0];
    let variance = super::residual(&rows.rows(0, SAMPLES), &[0, 1, 2], &TRUTH)
        .iter()
        .map(|x| x * x)
        .sum::<f64>()
        / SAMPLES as f64;
    assert!(
        (inner * step / variance - 1.0).abs() < 1e-9,
        "{} {variance}",
        inner * step
    );
    assert!(found.power[1] > 20.0 * found.power[found.power.len() - 1]);
}
