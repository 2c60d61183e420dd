//! Synthetic systems with and without errors of the columns.

use super::{Instrumental, hausman::Hausman, strength::strengths};
use crate::{
    estimation::{
        correlation::tests::settings,
        estimate::{Estimation, estimate},
        instruments::total_least_squares::total_least_squares,
    },
    regression::{
        factor::Factor,
        projection::Projection,
        system::{Stretch, System},
    },
};
use nalgebra::DMatrix;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

const TRUTH: [f64; 3] = [2.0, -1.0, 0.5];

const SELECTED: [usize; 3] = [0, 1, 2];

/// One line of periodic columns; the first has errors and the last is constant.
///
/// The instruments have independent errors of the same size. The residual of Y is autocorrelated.
fn system(errors: f64, seed: u64) -> System {
    const SAMPLES: usize = 500;
    let mut generator = Pcg64::seed_from_u64(seed);
    let mut white = || {
        (0..12)
            .map(|_| generator.random_range(-0.5..0.5))
            .sum::<f64>()
    };
    let mut rows = DMatrix::zeros(SAMPLES, 4);
    let mut instruments = DMatrix::zeros(SAMPLES, 3);
    let mut noise = 0.0;
    for k in 0..SAMPLES {
        let angle = std::f64::consts::TAU * k as f64 / 100.0;
        let wave = |harmonic: f64| (harmonic * angle + harmonic * harmonic).sin();
        let exact = [wave(1.0) + wave(7.0), wave(2.0) - 0.6 * wave(7.0), 1.0];
        let y: f64 = exact.iter().zip(TRUTH).map(|(w, x)| w * x).sum();
        noise = 0.6 * noise + 0.2 * white();
        for (column, value) in exact.into_iter().enumerate() {
            rows[(k, column)] = value;
            instruments[(k, column)] = value;
        }
        // A small error even if none is requested, so that instruments differ from the columns.
        rows[(k, 0)] += errors * white();
        instruments[(k, 0)] += errors.max(0.02) * white();
        rows[(k, 3)] = y + noise;
    }
    let mut line = Factor::new(3);
    line.push(&rows);
    let mut wide = DMatrix::zeros(SAMPLES, 7);
    wide.columns_mut(0, 3).copy_from(&rows.columns(0, 3));
    wide.columns_mut(3, 3).copy_from(&instruments);
    wide.set_column(6, &rows.column(3));
    let mut both = Factor::new(6);
    both.push(&wide);
    System {
        projection: Projection::Joints,
        line_names: vec![String::from("1")],
        sessions: Vec::new(),
        line_units: vec!["N"],
        lines: vec![line],
        parts: Vec::new(),
        phase_sums: Vec::new(),
        totals: Vec::new(),
        stretches: vec![Stretch {
            run: 0,
            lines: vec![rows],
            instruments: vec![instruments],
        }],
        partition: None,
        instruments: vec![both],
    }
}

/// Both estimates of one draw.
fn both(system: &System) -> (Estimation, Instrumental) {
    let start = estimate(system, &SELECTED, &settings()).expect("an estimate");
    let found = Instrumental::new(system, &SELECTED, &start).expect("instruments");
    (start, found)
}

#[test]
fn instruments_and_total_least_squares_are_unbiased() {
    const DRAWS: u64 = 60;
    let (mut least, mut instrumental, mut total) = (0.0, 0.0, 0.0);
    let (mut covering, mut rejected) = (0, 0);
    for seed in 0..DRAWS {
        let system = system(0.4, seed);
        let (start, found) = both(&system);
        least += start.values[0] / DRAWS as f64;
        instrumental += found.estimation.values[0] / DRAWS as f64;
        let compared = total_least_squares(&system, &SELECTED, &found).expect("a solution");
        total += compared[0] / DRAWS as f64;
        let intervals = found.intervals.as_ref().expect("successive equations");
        for (column, truth) in TRUTH.into_iter().enumerate() {
            let [low, high] = intervals.of(column, SELECTED.len()).expect("an interval");
            covering += usize::from((low..=high).contains(&truth));
        }
        let test = Hausman::new(&system, &SELECTED, &start, &found).expect("a test");
        rejected += usize::from(test.rejects());
        assert!(strengths(&found).iter().all(|strength| strength.f > 100.0));
        // Expected bias: 0.4² by 1 - 0.36/1.36 of the column's own part.
    }
    let covering = f64::from(covering as u32) / (3 * DRAWS) as f64;
    println!(
        "{least:.3} {instrumental:.3} {total:.3}; covering {covering:.3}; {rejected} rejected"
    );
    assert!(least < 1.75, "{least}");
    assert!((instrumental - 2.0).abs() < 0.03, "{instrumental}");
    assert!((total - 2.0).abs() < 0.05, "{total}");
    assert!((0.90..0.995).contains(&covering), "{covering}");
    assert_eq!(rejected, DRAWS as usize);
}

#[test]
fn the_hausman_test_has_its_nominal_size() {
    const DRAWS: u64 = 400;
    let rejected = |errors: f64| -> f64 {
        let rejects = (0..DRAWS).filter(|seed| {
            let system = system(errors, 1000 + seed);
            let (start, found) = both(&system);
            let test = Hausman::new(&system, &SELECTED, &start, &found).expect("a test");
            test.rejects()
        });
        rejects.count() as f64 / DRAWS as f64
    };
    let (size, power) = (rejected(0.0), rejected(0.15));
    println!("size {size:.3}, power {power:.3}");
    // Level 1/12 %: three or more of 400 draws are rejected in one of 200 such trials.
    assert!(size < 0.0075, "{size}");
    assert!(power > 0.8, "{power}");
}

#[test]
fn weak_instruments_are_reported() {
    let mut system = system(0.2, 3);
    let mut generator = Pcg64::seed_from_u64(5);
    let rows = &system.stretches[0].lines[0];
    let mut wide = DMatrix::zeros(rows.nrows(), 7);
    wide.columns_mut(0, 3).copy_from(&rows.columns(0, 3));
    wide.columns_mut(3, 3).copy_from(&rows.columns(0, 3));
    wide.column_mut(3)
        .iter_mut()
        .for_each(|value| *value = generator.random_range(-1.0..1.0));
    wide.set_column(6, &rows.column(3));
    let mut both_columns = Factor::new(6);
    both_columns.push(&wide);
    system.instruments = vec![both_columns];
    let (_, found) = both(&system);
    let strengths = strengths(&found);
    assert!(strengths[0].f < super::strength::WEAK, "{strengths:?}");
}
