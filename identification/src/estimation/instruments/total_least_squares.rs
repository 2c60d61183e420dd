//! Total least squares, for comparison with instrumental variables.
//!
//! Let the errors of the columns have the covariance Ω_w and those of Y the variance Ω_y in each
//! equation, independently. The parameters with the smallest errors are those of the vector v =
//! [χ, -1] with the largest vᵀ Ω v/vᵀ [W Y]ᵀ [W Y] v (S. Van Huffel, J. Vandewalle, *The Total
//! Least Squares Problem*, 1991, generalised form). With the R factor of [W Y], this is the largest
//! eigenvalue of R^-T Ω R^-1, even if some columns have no errors.
//!
//! Ω_w is the part of the columns that the instruments do not explain. Ω_y is the part of the
//! residual that the columns' errors do not explain. Independence of both is an assumption that
//! instrumental variables do not need.

use nalgebra::{DMatrix, SymmetricEigen};

use super::Instrumental;
use crate::regression::{factor::Factor, system::System};

/// Smallest fraction of the residual assigned to Y; below it Ω would be singular.
const LEAST_OF_OUTPUT: f64 = 0.01;

/// Estimates the columns `selected`; `None` if they are undetermined.
pub(crate) fn total_least_squares(
    system: &System,
    selected: &[usize],
    instrumental: &Instrumental,
) -> Option<Vec<f64>> {
    let p = selected.len();
    let estimation = &instrumental.estimation;
    let reduced = Factor::reduced_together(&system.lines, &estimation.weights, selected);
    let mut r = DMatrix::zeros(p + 1, p + 1);
    r.view_mut((0, 0), (p, p)).copy_from(&reduced.triangle);
    r.view_mut((0, p), (p, 1)).copy_from(&reduced.rhs);
    r[(p, p)] = reduced.residual_norm;
    let errors = instrumental.unexplained();
    let values = nalgebra::DVector::from_column_slice(&estimation.values);
    let equations = estimation.equations as f64;
    let whole = estimation.residual_deviation.powi(2) * equations;
    let explained = (errors * values).norm_squared();
    let mut omega = DMatrix::zeros(p + 1, p + 1);
    omega
        .view_mut((0, 0), (p, p))
        .copy_from(&errors.tr_mul(errors));
    omega[(p, p)] = (whole - explained).max(LEAST_OF_OUTPUT * whole);
    // R^-T Ω R^-1, by two solutions with Rᵀ.
    let half = r.tr_solve_upper_triangular(&omega)?;
    let matrix = r.tr_solve_upper_triangular(&half.transpose())?;
    let system = SymmetricEigen::new(0.5 * (&matrix + matrix.transpose()));
    let vector = system.eigenvectors.column(system.eigenvalues.imax());
    let vector = r.solve_upper_triangular(&vector.clone_owned())?;
    let values: Vec<f64> = vector.rows(0, p).iter().map(|v| -v / vector[p]).collect();
    values
        .iter()
        .all(|value| value.is_finite())
        .then_some(values)
}
