//! Gains and unknown parameters from the equations W χ - V g + w = 0 with noise in V only.
//!
//! The residual of line i is ρ_i = V_i g - W_i χ - w_i. Let the noise of drive j's signal have the
//! variance σ_j², independent of other drives. Then the variance of ρ_i is s_i² = gᵀ Ω_i g with
//! Ω_i = diag(σ_j² m_ji), where m_ji is the mean of J_ji². Least squares would reduce V g to reduce
//! its noise. The estimate instead minimises
//!
//! ```text
//! Σ_i ||ρ_i||² / (gᵀ Ω_i g).
//! ```
//!
//! This is total least squares with exact columns W and w (S. Van Huffel, J. Vandewalle, *The Total
//! Least Squares Problem*, 1991, chapter 3 and the generalised form of chapter 10). For a serial
//! robot with normal noise, it is the maximum likelihood estimate. The derivatives vanish for
//!
//! ```text
//! [W V]ᵀ S^-1 ([W V] [-χ; g] - w) = [0; Λ g],    Λ = Σ_i ||ρ_i||²/s_i⁴ Ω_i,
//! ```
//!
//! with the line variances S. With the R factor of [W V | w] and its block R_11 of W, the gains
//! follow iteratively from (R_22ᵀ R_22 - Λ) g = R_22ᵀ c_2.

use nalgebra::{DMatrix, DVector};
use overact::Code;

use super::{
    noise::Noise,
    observation::Equations,
    selection::{Selection, size},
};
use crate::regression::factor::Factor;
use overact_logs::{Error, Problem};

/// Largest number of iterations for a given noise of the drives.
const INNER: usize = 200;

/// Largest number of updates of the noise.
const OUTER: usize = 30;

/// Relative change of the gains at which the iteration ends.
const TOLERANCE: f64 = 1e-9;

/// Relative change above which it has not converged.
const CONVERGED: f64 = 1e-5;

/// Gains and parameters, with data for their standard deviations.
#[derive(Debug, Clone)]
pub(super) struct Solution {
    /// [-χ; g] in the order of the selection.
    pub(super) values: Vec<f64>,
    /// R of the weighted [W V].
    pub(super) triangle: DMatrix<f64>,
    /// Variance s_i² of each line.
    pub(super) variances: Vec<f64>,
    /// Diagonal of Ω_i for each line.
    pub(super) omegas: Vec<DVector<f64>>,
    /// Diagonal of Λ.
    pub(super) lambda: DVector<f64>,
}

impl Solution {
    /// Gains.
    pub(super) fn gains(&self) -> &[f64] {
        let (_, gains) = self.values.split_at(self.values.len() - self.lambda.len());
        gains
    }
}

/// Solves the equations.
///
/// # Errors
/// Gains that the data do not determine.
pub(super) fn solve(equations: &Equations, selection: &Selection) -> Result<Solution, Error> {
    let lines = &equations.system.lines;
    let drives = selection.drives;
    let variances: Vec<f64> = lines.iter().map(|line| size(line).powi(2)).collect();
    let none = DVector::zeros(drives);
    let mut solution = weighted(lines, selection, &variances, &none)?;
    for _ in 0..OUTER {
        let before = solution.gains().to_vec();
        let noise = Noise::new(equations, selection, &solution.values);
        solution = with_noise(lines, selection, &noise, solution)?;
        let change = change(&before, solution.gains());
        if change < TOLERANCE {
            return Ok(solution);
        }
        if !change.is_finite() {
            break;
        }
    }
    // Accept a small change between two noise updates.
    let noise = Noise::new(equations, selection, &solution.values);
    let next = with_noise(lines, selection, &noise, solution.clone())?;
    if change(solution.gains(), next.gains()) < CONVERGED {
        Ok(next)
    } else {
        Err(not_converged())
    }
}

fn not_converged() -> Error {
    Problem::new(
        Code::GAINS,
        "gains are not determined: their effect is below the noise",
    )
    .help("record longer runs with larger accelerations, and carry a heavier payload")
    .into()
}

/// Solves the equations for a given noise, starting from another solution.
fn with_noise(
    lines: &[Factor],
    selection: &Selection,
    noise: &Noise,
    mut solution: Solution,
) -> Result<Solution, Error> {
    for _ in 0..INNER {
        let omegas = noise.omegas(solution.gains());
        let variances = noise.variances(lines);
        let mut lambda = DVector::zeros(selection.drives);
        for ((line, variance), omega) in lines.iter().zip(&variances).zip(&omegas) {
            let residual = line.residual_norm(&selection.columns, &solution.values);
            lambda += omega * (residual / variance).powi(2);
        }
        let mut next = weighted(lines, selection, &variances, &lambda)?;
        next.omegas = omegas;
        let change = change(solution.gains(), next.gains());
        solution = next;
        if change < TOLERANCE || !change.is_finite() {
            break;
        }
    }
    Ok(solution)
}

/// Largest relative change of gains; NaN if any is NaN.
fn change(before: &[f64], after: &[f64]) -> f64 {
    let each = before.iter().zip(after);
    each.map(|(a, b)| ((b - a) / b).abs())
        .fold(0.0, |largest, one| {
            if one > largest || one.is_nan() {
                one
            } else {
                largest
            }
        })
}

/// Solution for given variances of the lines and Λ.
fn weighted(
    lines: &[Factor],
    selection: &Selection,
    variances: &[f64],
    lambda: &DVector<f64>,
) -> Result<Solution, Error> {
    let weights: Vec<f64> = variances.iter().map(|own| 1.0 / own.sqrt()).collect();
    let reduced = Factor::reduced_together(lines, &weights, &selection.columns);
    let (p, n) = (selection.parameters(), selection.drives);
    let triangle = reduced.triangle;
    let corner = triangle.view((p, p), (n, n));
    let rest = reduced.rhs.rows(p, n).clone_owned();
    let normal = corner.tr_mul(&corner) - DMatrix::from_diagonal(lambda);
    // Scaled to a unit diagonal, to be independent of units.
    let scales = DVector::from_fn(n, |j, _| 1.0 / normal[(j, j)].abs().sqrt());
    let scaled = DMatrix::from_fn(n, n, |i, j| normal[(i, j)] * scales[i] * scales[j]);
    let right = corner.tr_mul(&rest).component_mul(&scales);
    let cholesky = scaled.cholesky().ok_or_else(not_converged)?;
    let gains = cholesky.solve(&right).component_mul(&scales);
    let across = triangle.view((0, p), (p, n)) * &gains;
    let right = reduced.rhs.rows(0, p) - across;
    let parameters = triangle
        .view((0, 0), (p, p))
        .solve_upper_triangular(&right)
        .ok_or_else(not_converged)?;
    let values: Vec<f64> = parameters.iter().chain(gains.iter()).copied().collect();
    if values.iter().any(|value| !value.is_finite()) {
        return Err(not_converged());
    }
    Ok(Solution {
        values,
        variances: variances.to_vec(),
        omegas: vec![DVector::zeros(n); lines.len()],
        lambda: lambda.clone(),
        triangle,
    })
}

/// Gains by ordinary total least squares, for comparison.
///
/// They follow from the smallest singular vector of the weighted [W V w], with equal errors in all
/// columns. `None` if that vector has no component of w.
pub(super) fn total_least_squares(
    equations: &Equations,
    selection: &Selection,
    solution: &Solution,
) -> Option<Vec<f64>> {
    let lines = &equations.system.lines;
    let weights: Vec<f64> = solution.variances.iter().map(|s| 1.0 / s.sqrt()).collect();
    let reduced = Factor::reduced_together(lines, &weights, &selection.columns);
    let size = selection.columns.len();
    let mut all = DMatrix::zeros(size + 1, size + 1);
    all.view_mut((0, 0), (size, size))
        .copy_from(&reduced.triangle);
    all.view_mut((0, size), (size, 1)).copy_from(&reduced.rhs);
    all[(size, size)] = reduced.residual_norm;
    let decomposition = all.svd(false, true);
    let smallest = decomposition.singular_values.imin();
    let vectors = decomposition.v_t?;
    let vector = vectors.row(smallest);
    let scale = -1.0 / vector[size];
    let gains: Vec<f64> = (selection.parameters()..size)
        .map(|j| vector[j] * scale)
        .collect();
    gains.iter().all(|gain| gain.is_finite()).then_some(gains)
}
