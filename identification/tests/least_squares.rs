//! Weighted least squares, standard deviations and elimination against dense textbook formulas.

mod common;

use nalgebra::{DMatrix, DVector};
use overact::Model;
use overact_identification::{
    Factor, Normalisation, Projection, Settings, System, essential, estimate,
};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

/// Relative tolerance to the dense formulas, which square the condition number.
const TOLERANCE: f64 = 1e-10;

const LINES: [(usize, f64); 3] = [(400, 0.05), (300, 2.0), (350, 0.3)];
const TRUTH: [f64; 4] = [3.0, -2.0, 0.5, 0.004];

/// Dense [W Y] of each line, with its own noise level. Column 0 is missing in line 2.
fn dense() -> Vec<(DMatrix<f64>, DVector<f64>)> {
    let mut generator = Pcg64::seed_from_u64(7);
    LINES
        .iter()
        .enumerate()
        .map(|(line, &(rows, deviation))| {
            let w = DMatrix::from_fn(rows, TRUTH.len(), |_, column| {
                let value: f64 = generator.random_range(-1.0..1.0);
                if line == 2 && column == 0 { 0.0 } else { value }
            });
            let noise = DVector::from_fn(rows, |_, _| {
                // Uniform with the standard deviation of the line.
                generator.random_range(-1.0..1.0) * deviation * 3.0_f64.sqrt()
            });
            let y = &w * DVector::from_row_slice(&TRUTH) + noise;
            (w, y)
        })
        .collect()
}

/// The system of these lines, pushed in unequal pieces.
fn system(lines: &[(DMatrix<f64>, DVector<f64>)]) -> System {
    let factors = lines.iter().map(|(w, y)| {
        let mut rows = w.clone().insert_column(TRUTH.len(), 0.0);
        rows.set_column(TRUTH.len(), y);
        let mut factor = Factor::new(TRUTH.len());
        for first in (0..rows.nrows()).step_by(37) {
            let count = 37.min(rows.nrows() - first);
            factor.push(&rows.rows(first, count).clone_owned());
        }
        factor
    });
    let mut system = System::new(Projection::Platform, &common::PAIR.info(), TRUTH.len());
    system.line_names = ["x", "y", "phi"].map(String::from).to_vec();
    system.line_units = vec!["N", "N", "N m"];
    system.lines = factors.collect();
    system
}

fn settings(weighted: bool) -> Settings {
    let settings = Settings::for_sampling_frequency(1000.0, &common::PAIR.info());
    Settings {
        weighted,
        ..settings
    }
}

/// Stacks the lines, each divided by a standard deviation.
fn stack(
    lines: &[(DMatrix<f64>, DVector<f64>)],
    deviations: &[f64],
) -> (DMatrix<f64>, DVector<f64>) {
    let rows: usize = lines.iter().map(|(w, _)| w.nrows()).sum();
    let mut all = (DMatrix::zeros(rows, TRUTH.len()), DVector::zeros(rows));
    let mut first = 0;
    for ((w, y), deviation) in lines.iter().zip(deviations) {
        all.0
            .rows_mut(first, w.nrows())
            .copy_from(&(w / *deviation));
        all.1
            .rows_mut(first, w.nrows())
            .copy_from(&(y / *deviation));
        first += w.nrows();
    }
    all
}

/// χ = (WᵀW)^-1 WᵀY and its standard deviations by the normal equations.
fn textbook(w: &DMatrix<f64>, y: &DVector<f64>) -> (DVector<f64>, DVector<f64>, f64) {
    let inverse = (w.transpose() * w).try_inverse().expect("regular");
    let x = &inverse * w.transpose() * y;
    let square = (y - w * &x).norm_squared() / (w.nrows() - w.ncols()) as f64;
    let deviations = inverse.diagonal().map(|c| (c * square).sqrt());
    (x, deviations, square.sqrt())
}

fn assert_close(found: &[f64], expected: &DVector<f64>) {
    for (found, expected) in found.iter().zip(expected.iter()) {
        assert!(
            (found - expected).abs() <= TOLERANCE * expected.abs(),
            "{found} {expected}"
        );
    }
}

#[test]
fn ordinary_least_squares_match_the_textbook() {
    let lines = dense();
    let (w, y) = stack(&lines, &[1.0; 3]);
    let (x, deviations, sigma) = textbook(&w, &y);
    let found = estimate(&system(&lines), &[0, 1, 2, 3], &settings(false)).expect("an estimate");
    assert_close(&found.values, &x);
    assert_close(&found.standard_deviations, &deviations);
    assert!((found.residual_deviation - sigma).abs() < TOLERANCE * sigma);
    let residual = (&y - &w * &x).norm();
    assert!((found.residual_norm - residual).abs() < TOLERANCE * residual);
    assert!((found.relative_error_percent - 100.0 * residual / y.norm()).abs() < 1e-8);
    let singular = w.singular_values();
    let condition = singular.max() / singular.min();
    assert!((found.condition_number - condition).abs() < TOLERANCE * condition);
    assert_eq!(found.equations, 1050);
    assert_eq!(found.lines[1].equations, 300);
    // The sample variance subtracts the mean and divides by N - 1.
    let sample = Settings {
        normalisation: Normalisation::SampleVariance,
        ..settings(false)
    };
    let found = estimate(&system(&lines), &[0, 1, 2, 3], &sample).expect("an estimate");
    let deviation = ((&y - &w * &x).variance() * 1050.0 / 1049.0).sqrt();
    assert!((found.residual_deviation - deviation).abs() < TOLERANCE * deviation);
}

#[test]
fn weighted_least_squares_match_the_textbook() {
    let lines = dense();
    // Each line separately; the third one has no column 0, so three parameters only.
    let own: Vec<f64> = lines
        .iter()
        .enumerate()
        .map(|(line, (w, y))| {
            let w = if line == 2 {
                w.clone().remove_column(0)
            } else {
                w.clone()
            };
            textbook(&w, y).2
        })
        .collect();
    for (found, (_, deviation)) in own.iter().zip(LINES) {
        assert!(
            (found / deviation - 1.0).abs() < 0.1,
            "the noise is found again: {found}"
        );
    }
    let (w, y) = stack(&lines, &own);
    let (x, deviations, sigma) = textbook(&w, &y);
    let found = estimate(&system(&lines), &[0, 1, 2, 3], &settings(true)).expect("an estimate");
    assert_close(&found.values, &x);
    assert_close(&found.standard_deviations, &deviations);
    assert!((found.residual_deviation - sigma).abs() < TOLERANCE * sigma);
    // Reported residuals stay in physical units.
    let (w, y) = stack(&lines, &[1.0; 3]);
    let residual = (&y - &w * &x).norm();
    assert!((found.residual_norm - residual).abs() < TOLERANCE * residual);
}

#[test]
fn elimination_removes_and_reports_the_worst_parameters() {
    let lines = dense();
    let system = system(&lines);
    let names: Vec<String> = ["a", "b", "c", "d"].map(String::from).to_vec();
    let start = estimate(&system, &[0, 1, 2, 3], &settings(true)).expect("an estimate");
    let found = essential(&system, &[0, 1, 2, 3], &names, &start, &settings(true)).expect("a set");
    // 0.004 is hidden in a noise of 0.05.
    assert_eq!(found.removals[0].name, "d");
    assert!(!found.removals[0].significant);
    assert_eq!(found.selected, [0, 1, 2]);
    assert!(found.estimation.deviation_ratio() < 10.0);
    let before = found.removals[0].relative_error_before_percent;
    assert!((before - start.relative_error_percent).abs() < 1e-12);
    // A stricter ratio continues and removes a well-determined parameter ...
    let strict = Settings {
        r_sigma: 1.5,
        ..settings(true)
    };
    let found = essential(&system, &[0, 1, 2, 3], &names, &start, &strict).expect("a set");
    assert!(found.removals.iter().any(|removal| removal.significant));
    // ... unless the significance test counts.
    let careful = Settings {
        keep_significant: true,
        ..strict
    };
    let found = essential(&system, &[0, 1, 2, 3], &names, &start, &careful).expect("a set");
    assert_eq!(found.selected, [0, 1, 2]);
}

#[test]
fn too_few_equations_are_an_error() {
    let lines: Vec<_> = dense()
        .into_iter()
        .map(|(w, y)| (w.rows(0, 1).clone_owned(), y.rows(0, 1).clone_owned()))
        .collect();
    let error = estimate(&system(&lines), &[0, 1, 2, 3], &settings(true)).expect_err("too few");
    let text = error.to_string();
    assert!(
        text.starts_with("3 equations do not determine 4 parameters"),
        "{text}"
    );
    assert!(text.contains("\n  help: "), "{text}");
}
