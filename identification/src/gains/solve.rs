//! Gains and unknown parameters from the equations W χ - V g + w = 0, of which V alone has noise.
//!
//! The residual of line i is ρ_i = V_i g - W_i χ - w_i. With noise of variance σ_j² in the signal of drive
//! j, independent of the others, its variance is s_i² = gᵀ Ω_i g with Ω_i = diag(σ_j² m_ji), m_ji the mean of
//! J_ji². Least squares would make V g small to have little noise in it; the estimate minimises
//!
//! ```text
//! Σ_i ||ρ_i||² / (gᵀ Ω_i g),
//! ```
//!
//! total least squares of which the columns W and w are exact (S. Van Huffel, J. Vandewalle, *The Total
//! Least Squares Problem*, 1991, chapter 3 and the generalised form of chapter 10), and the most likely one
//! of a serial robot under normal noise. The derivatives vanish where
//!
//! ```text
//! [W V]ᵀ S^-1 ([W V] [-χ; g] - w) = [0; Λ g],    Λ = Σ_i ||ρ_i||²/s_i⁴ Ω_i,
//! ```
//!
//! S having the variances of the lines. With the R factor of [W V | w], R_11 being that of W, the gains
//! follow from (R_22ᵀ R_22 - Λ) g = R_22ᵀ c_2 by repetition.

use nalgebra::{DMatrix, DVector};
use overact::Code;

use super::{
    noise::Noise,
    observation::Equations,
    selection::{Selection, size},
};
use crate::{
    error::{Error, Problem},
    regression::factor::Factor,
};

/// Most repetitions for a given noise of the drives.
const INNER: usize = 200;

/// Most repetitions with the noise found anew.
const OUTER: usize = 30;

/// Relative change of the gains at which the repetition ends.
const TOLERANCE: f64 = 1e-9;

/// Relative change above which it has not converged.
const CONVERGED: f64 = 1e-5;

/// Gains and parameters, and what their deviations need.
#[derive(Debug, Clone)]
pub(super) struct Solution {
    /// [-χ; g] in the order of the selection.
    pub(super) values: Vec<f64>,
    /// R of the weighted [W V].
    pub(super) triangle: DMatrix<f64>,
    /// Variance s_i² of each line.
    pub(super) variances: Vec<f64>,
    /// The diagonal of Ω_i for each line.
    pub(super) omegas: Vec<DVector<f64>>,
    /// The diagonal of Λ.
    pub(super) lambda: DVector<f64>,
}

impl Solution {
    /// The gains.
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
    // What changes no more than this from one noise to the next is told to as many digits.
    let noise = Noise::new(equations, selection, &solution.values);
    let next = with_noise(lines, selection, &noise, solution.clone())?;
    match change(solution.gains(), next.gains()) < CONVERGED {
        true => Ok(next),
        false => Err(not_converged()),
    }
}

fn not_converged() -> Error {
    Problem::new(
        Code::GAINS,
        "gains are not determined: noise outweighs what the data tell of them",
    )
    .help("record longer runs with larger accelerations, and carry a heavier payload")
    .into()
}

/// Solves the equations for a given noise of the drives, from a solution for another one on.
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

/// The largest relative change of gains.
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

/// The solution for given variances of the lines and Λ.
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
    // Scaled to a diagonal of ones, so that units play no part in its digits.
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

/// The gains by plain total least squares, for comparison: the vector of the smallest singular value of the
/// weighted [W V w], all of whose columns are taken for equally wrong. None where it has no part in w.
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
