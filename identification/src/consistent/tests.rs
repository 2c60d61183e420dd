//! Problems with known solutions.

use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

use super::{
    pseudo_inertia::{Inertia, definiteness, divergence},
    solve::solve,
    unknowns::{UnknownGroup, UnknownKind, Unknowns},
};

/// A box of 0.5 kg and 0.2 m × 0.1 m × 0.4 m with one corner at the origin.
fn body() -> Inertia {
    let (mass, edge) = (0.5, [0.2, 0.1, 0.4]);
    let [x, y, z] = edge;
    let square = |a: f64, b: f64| mass * (a * a + b * b) / 3.0;
    let product = |a: f64, b: f64| -mass * a * b / 4.0;
    Inertia::from([
        square(y, z),
        product(x, y),
        product(x, z),
        square(x, z),
        product(y, z),
        square(x, y),
        mass * x / 2.0,
        mass * y / 2.0,
        mass * z / 2.0,
        mass,
    ])
}

/// A body, a positive coefficient and a free one.
fn unknowns(prior: Inertia, bounds: Vec<(usize, [f64; 2])>) -> Unknowns {
    let group = |first, kind, bounds| UnknownGroup {
        first,
        kind,
        bounds,
    };
    Unknowns {
        groups: vec![
            group(0, UnknownKind::Body { prior }, bounds),
            group(10, UnknownKind::Positive { prior: 2.0 }, Vec::new()),
            group(11, UnknownKind::Free { scale: 1.0 }, Vec::new()),
        ],
        of_column: (0..12).collect(),
        names: (0..12).map(|k| k.to_string()).collect(),
    }
}

/// Independent random rows of magnitude 1/noise.
fn rows(count: usize, noise: f64) -> DMatrix<f64> {
    let mut random = Pcg64::seed_from_u64(5);
    DMatrix::from_fn(count, 12, |_, _| random.random_range(-1.0..1.0) / noise)
}

#[test]
fn without_data_the_prior_is_returned() -> Result<(), &'static str> {
    let all = unknowns(body(), Vec::new());
    let found = solve(&all, &DMatrix::zeros(0, 12), &DVector::zeros(0)).ok_or("no solution")?;
    assert!((found.values.rows(0, 10) - body()).norm() < 1e-9);
    assert!((found.values[10] - 2.0).abs() < 1e-9 && found.values[11].abs() < 1e-9);
    assert!(found.determined.iter().all(|part| *part == 0.0));
    Ok(())
}

#[test]
fn a_fully_determined_body_is_recovered() -> Result<(), &'static str> {
    let mut prior = body() * 3.0;
    prior[9] *= 1.2;
    let all = unknowns(prior, Vec::new());
    let mut truth = DVector::zeros(12);
    truth.rows_mut(0, 10).copy_from(&body());
    (truth[10], truth[11]) = (0.7, -0.3);
    let a = rows(12, 1e-6);
    let found = solve(&all, &a, &(&a * &truth)).ok_or("no solution")?;
    assert!((&found.values - &truth).norm() < 1e-8, "{}", found.values);
    assert!(found.determined.iter().all(|part| *part > 0.999));
    Ok(())
}

#[test]
fn impossible_parameters_are_replaced_by_the_nearest_possible() -> Result<(), &'static str> {
    let all = unknowns(body(), Vec::new());
    // Impossible moments (xx + yy < zz), and a negative coefficient.
    let mut wanted = DVector::zeros(12);
    wanted.rows_mut(0, 10).copy_from(&body());
    wanted[5] = wanted[0] + wanted[3] + 0.02;
    (wanted[10], wanted[11]) = (-1.0, 0.4);
    let a = rows(12, 1e-3);
    let b = &a * &wanted;
    let found = solve(&all, &a, &b).ok_or("no solution")?;
    let own = Inertia::from_iterator(found.values.rows(0, 10).iter().copied());
    assert!(definiteness(&own) > 0.0 && definiteness(&own) < 1e-3);
    assert!(found.values[10] > 0.0 && found.values[10] < 1e-3);
    // The objective increases in every feasible direction, by its gradient.
    let objective = |values: &DVector<f64>| {
        let own = Inertia::from_iterator(values.rows(0, 10).iter().copied());
        let ratio = values[10] / 2.0;
        let distance =
            divergence(&own, &body())? + ratio - ratio.ln() - 1.0 + 0.5 * values[11].powi(2);
        Some(0.5 * (&a * values - &b).norm_squared() + 1e-3 * distance)
    };
    let least = objective(&found.values).ok_or("outside")?;
    let mut random = Pcg64::seed_from_u64(6);
    let mut inside = 0;
    for _ in 0..2000 {
        let step = found
            .values
            .map(|value| value * 1e-3 * random.random_range(-1.0..1.0));
        if let Some(other) = objective(&(&found.values + step)) {
            inside += 1;
            assert!(other >= least * (1.0 - 1e-12), "{other} < {least}");
        }
    }
    assert!(inside > 20, "{inside}");
    Ok(())
}

#[test]
fn bounds_are_respected() -> Result<(), &'static str> {
    let bounds = vec![(9, [1.0, 1.5])];
    let all = unknowns(body(), bounds);
    let mut wanted = DVector::zeros(12);
    wanted.rows_mut(0, 10).copy_from(&(body() * 4.0));
    let a = rows(12, 1e-3);
    let found = solve(&all, &a, &(&a * &wanted)).ok_or("no solution")?;
    assert!(
        found.values[9] < 1.5 && found.values[9] > 1.49,
        "{}",
        found.values[9]
    );
    Ok(())
}

#[test]
fn nan_data_end_the_search() {
    let all = unknowns(body(), Vec::new());
    let a = rows(12, 1e-3);
    assert_eq!(solve(&all, &a, &DVector::repeat(12, f64::NAN)), None);
}
