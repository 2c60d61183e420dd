//! Independent columns of an identification model, and the others as combinations of them.
//!
//! The model is evaluated at random states: poses around home, joints that close every leg, random
//! twists and accelerations. Columns are taken in the symmetric order (43): the platform first,
//! then each parameter of all legs together. They are orthogonalised one after the other. A column
//! without remainder is a constant combination of earlier ones. The coefficients are constants of
//! the robot's geometry; the proof of a combination makes them exact.

use crate::cas::Ratio;
use crate::derivation::BodyParameter;
use crate::mechanism::Mechanism;
use nalgebra::{DMatrix, DVector};

/// A base parameter: an independent column and the parameters regrouped into it.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct BaseParameter {
    /// The parameter whose column is kept.
    pub parameter: BodyParameter,
    /// Parameters whose columns contain a multiple of this column, with their coefficients.
    pub regrouped: Vec<(BodyParameter, f64)>,
}

/// Remainder of a column, relative to its length, below which it is dependent.
const DEPENDENT: f64 = 1e-8;
/// Length of a column, relative to the longest, below which it is zero.
///
/// Such a column is rounding of a joint that the closures block, as the second axis of a universal
/// joint in a plane.
const NOTHING: f64 = 1e-12;
/// Coefficients below this are zero.
const NEGLIGIBLE: f64 = 1e-9;

/// The symmetric order (43) as indices of `parameters`.
#[must_use]
pub(super) fn symmetric_order(mechanism: &Mechanism, parameters: &[BodyParameter]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..parameters.len()).collect();
    order.sort_by_key(|&i| match parameters[i] {
        BodyParameter::Platform(symbol) => (0, 0, 0, symbol, 0),
        BodyParameter::Leg { leg, joint, symbol } => {
            (1, mechanism.legs[leg].shape, joint, symbol, leg)
        }
        BodyParameter::Spring(index) => (1, usize::MAX, 0, parameters[i].symbol(), index),
        BodyParameter::Motor { motor, symbol } => (1, usize::MAX, 1, symbol, motor),
        BodyParameter::Payload(symbol) => (2, 0, 0, symbol, 0),
        BodyParameter::Load { payload, symbol } => (2, payload + 1, 0, symbol, 0),
    });
    order
}

/// Independent columns of `matrix` (rows of many states) in the given order.
#[must_use]
pub(super) fn select(
    matrix: &DMatrix<f64>,
    order: &[usize],
    parameters: &[BodyParameter],
) -> Vec<BaseParameter> {
    let longest = matrix
        .column_iter()
        .map(|column| column.norm())
        .fold(0.0, f64::max);
    let least = NOTHING * longest;
    let mut basis: Vec<DVector<f64>> = Vec::new();
    let mut kept: Vec<usize> = Vec::new();
    let mut dependent: Vec<usize> = Vec::new();
    for &column in order {
        let original = matrix.column(column).into_owned();
        let size = original.norm();
        let mut rest = original;
        // A second pass removes the rounding errors of the first.
        for _ in 0..2 {
            for known in &basis {
                let along = known.dot(&rest);
                rest.axpy(-along, known, 1.0);
            }
        }
        if size > least && rest.norm() > DEPENDENT * size {
            basis.push(rest.normalize());
            kept.push(column);
        } else if size > least {
            dependent.push(column);
        }
    }
    let mut result: Vec<BaseParameter> = kept
        .iter()
        .map(|&c| BaseParameter {
            parameter: parameters[c],
            regrouped: Vec::new(),
        })
        .collect();
    let coefficients = combinations(matrix, &kept, &dependent);
    for (k, &column) in dependent.iter().enumerate() {
        for (row, base) in result.iter_mut().enumerate() {
            let coefficient = coefficients[(row, k)];
            if coefficient.abs() > NEGLIGIBLE {
                base.regrouped.push((parameters[column], coefficient));
            }
        }
    }
    result
}

/// Number of corrections of the coefficients by the remainder.
const REFINEMENTS: usize = 2;

/// Coefficients of the dependent columns on the kept ones, by least squares with scaled columns.
///
/// The dependence is exact, so the remainder of a solution is its own error, which is solved for
/// again.
fn combinations(matrix: &DMatrix<f64>, kept: &[usize], dependent: &[usize]) -> DMatrix<f64> {
    if kept.is_empty() || dependent.is_empty() {
        return DMatrix::zeros(kept.len(), dependent.len());
    }
    let mut left = matrix.select_columns(kept);
    let scales: Vec<f64> = left.column_iter().map(|c| c.norm()).collect();
    for (mut column, scale) in left.column_iter_mut().zip(&scales) {
        column /= *scale;
    }
    let right = matrix.select_columns(dependent);
    let qr = left.clone().qr();
    let (q, r) = (qr.q(), qr.r());
    let mut solved = DMatrix::zeros(kept.len(), dependent.len());
    for _ in 0..=REFINEMENTS {
        let mut correction = q.tr_mul(&(&right - &left * &solved));
        if !r.solve_upper_triangular_mut(&mut correction) {
            return DMatrix::zeros(kept.len(), dependent.len());
        }
        solved += correction;
    }
    for (mut row, scale) in solved.row_iter_mut().zip(&scales) {
        row /= *scale;
    }
    solved
}

/// A simple fraction near a number, by its continued fraction. `precision` is relative.
///
/// It is a guess: nearly every number has a fraction of six digits within 1e-10.
#[must_use]
pub(super) fn nearby_ratio(value: f64, precision: f64) -> Option<Ratio> {
    let (mut h0, mut h1, mut k0, mut k1) = (0_i128, 1_i128, 1_i128, 0_i128);
    let mut rest = value;
    for _ in 0..20 {
        let whole = rest.floor();
        if whole.abs() > 1e9 {
            return None;
        }
        let whole_part = whole as i128;
        (h0, h1) = (h1, whole_part * h1 + h0);
        (k0, k1) = (k1, whole_part * k1 + k0);
        if k1 > 1_000_000 {
            return None;
        }
        if (h1 as f64 / k1 as f64 - value).abs() <= precision * value.abs() {
            return Ratio::new(h1, k1);
        }
        if rest == whole {
            return None;
        }
        rest = 1.0 / (rest - whole);
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn simple_ratios_are_recognised() {
        let ratio = nearby_ratio(0.11 * 0.11 / 0.28, 1e-10).unwrap();
        assert_eq!((ratio.numerator(), ratio.denominator()), (121, 2800));
        assert_eq!(nearby_ratio(-0.28, 1e-10).unwrap().to_string(), "-7/25");
        let third = nearby_ratio(0.333_333_2, 1e-6).unwrap();
        assert_eq!((third.numerator(), third.denominator()), (1, 3));
    }
}
