//! Level of the selection, and parameters that must not be removed.

use super::{grows, refuted};
use crate::estimation::intervals::Intervals;
use nalgebra::DMatrix;

/// Estimates of unit standard deviation.
fn intervals(values: &[f64], freedom: f64) -> Intervals {
    let count = values.len();
    let columns = (0..count).collect();
    Intervals::known(columns, values, DMatrix::identity(count, count), freedom)
}

#[test]
fn parameters_far_from_zero_are_not_cancelled() {
    let known = intervals(&[0.3, -1.1, 6.0], 60.0);
    assert_eq!(refuted(&known, &[0]), None);
    assert_eq!(refuted(&known, &[0, 1]), None);
    assert!(refuted(&known, &[0, 1, 2]).is_some_and(|why| why.contains("F = ")));
}

#[test]
fn many_small_parameters_are_jointly_significant() {
    // Each alone is within its interval.
    let known = intervals(&[1.9; 12], 200.0);
    assert_eq!(refuted(&known, &[0]), None);
    let all: Vec<usize> = (0..12).collect();
    assert!(refuted(&known, &all).is_some());
}

#[test]
fn few_degrees_of_freedom_cannot_test_many_parameters() {
    let known = intervals(&[0.0; 12], 20.0);
    let all: Vec<usize> = (0..12).collect();
    assert!(refuted(&known, &all).is_some_and(|why| why.contains("these data cannot test 12")));
    assert_eq!(refuted(&known, &all[..10]), None);
}

#[test]
fn held_out_errors_grow_only_if_all_folds_agree() {
    assert!(grows(&[1.0, 2.0, 1.5, 1.0], &[1.2, 2.2, 1.8, 1.3]));
    assert!(!grows(&[1.0, 2.0, 1.5, 1.0], &[1.2, 1.8, 1.6, 0.9]));
    // The spread of two folds has no meaning.
    assert!(!grows(&[1.0, 2.0], &[1.5, 2.5]));
}
