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
//! robot with normal noise, it is the maximum likelihood estimate. It is found by the method of
//! Levenberg and Marquardt on ρ_i/s_i with the derivatives [W V]/s_i - [0 ρ_i (Ω_i g)ᵀ]/s_i³. The
//! σ_j follow from the residuals, and both steps are repeated. At the solution,
//!
//! ```text
//! [W V]ᵀ S^-1 ([W V] [-χ; g] - w) = [0; Λ g],    Λ = Σ_i ||ρ_i||²/s_i⁴ Ω_i,
//! ```
//!
//! with the line variances S.

use nalgebra::{DMatrix, DVector};
use overact::Code;

use super::{
    noise::{Noise, residual},
    observation::Equations,
    selection::{Selection, size},
};
use crate::regression::factor::Factor;
use overact_logs::{Error, Problem};

/// Largest number of steps for a given noise of the drives.
const INNER: usize = 100;

/// First and largest damping of a step, by the squared norms of the columns.
const FIRST_DAMPING: f64 = 1e-3;
const LARGEST_DAMPING: f64 = 1e12;

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

/// Solves the equations, from the least-squares solution or from gains of 1.
///
/// # Errors
/// Gains that the data do not determine.
pub(super) fn solve(equations: &Equations, selection: &Selection) -> Result<Solution, Error> {
    let lines = &equations.system.lines;
    let variances: Vec<f64> = lines.iter().map(|line| size(line).powi(2)).collect();
    let [biased, ones] = starts(lines, selection, &variances)?;
    iterated(equations, selection, biased).or_else(|_| iterated(equations, selection, ones))
}

/// Alternates between the noise of the drives and the values [-χ; g].
fn iterated(
    equations: &Equations,
    selection: &Selection,
    mut values: Vec<f64>,
) -> Result<Solution, Error> {
    let lines = &equations.system.lines;
    let parameters = selection.parameters();
    let mut last = f64::INFINITY;
    for _ in 0..OUTER {
        let noise = Noise::new(equations, selection, &values);
        let omegas = noise.omegas(&values[parameters..]);
        let criterion = Criterion {
            lines,
            selection,
            least: Noise::least(lines),
            omegas,
        };
        let next = criterion.minimum(values.clone())?;
        last = change(&values[parameters..], &next[parameters..]);
        values = next;
        if last < TOLERANCE || !last.is_finite() {
            break;
        }
    }
    // A small change between two updates of the noise is accepted.
    if last.is_nan() || last >= CONVERGED {
        return Err(not_converged());
    }
    let noise = Noise::new(equations, selection, &values);
    let criterion = Criterion {
        lines,
        selection,
        least: Noise::least(lines),
        omegas: noise.omegas(&values[parameters..]),
    };
    Ok(criterion.solution(values))
}

fn not_converged() -> Error {
    Problem::new(
        Code::GAINS,
        "gains are not determined: their effect is below the noise",
    )
    .help("record longer runs with larger accelerations, and carry a heavier payload")
    .into()
}

/// Σ_i ||ρ_i||²/s_i² for a given noise of the drives.
struct Criterion<'a> {
    lines: &'a [Factor],
    selection: &'a Selection,
    /// Smallest variance of each line.
    least: Vec<f64>,
    /// Diagonals of Ω_i.
    omegas: Vec<DVector<f64>>,
}

impl Criterion<'_> {
    /// Variances s_i² of the lines.
    fn variances(&self, gains: &DVector<f64>) -> Vec<f64> {
        let of = |(omega, least): (&DVector<f64>, &f64)| {
            let variance = omega.component_mul(gains).dot(gains).max(*least);
            if variance > 0.0 { variance } else { 1.0 }
        };
        self.omegas.iter().zip(&self.least).map(of).collect()
    }

    fn gains(&self, values: &[f64]) -> DVector<f64> {
        DVector::from_column_slice(&values[self.selection.parameters()..])
    }

    fn value(&self, values: &[f64]) -> f64 {
        let variances = self.variances(&self.gains(values));
        let lines = self.lines.iter().zip(variances);
        let part = |(line, variance): (&Factor, f64)| {
            line.residual_norm(&self.selection.columns, values).powi(2) / variance
        };
        lines.map(part).sum()
    }

    /// Scaled residuals ρ_i/s_i of all lines, and their derivatives.
    fn residuals(&self, values: &[f64]) -> (DVector<f64>, DMatrix<f64>) {
        let columns = &self.selection.columns;
        let gains = self.gains(values);
        let rows = self.lines.first().map_or(0, |line| line.matrix().nrows());
        let mut residuals = DVector::zeros(rows * self.lines.len());
        let mut derivatives = DMatrix::zeros(rows * self.lines.len(), columns.len());
        let variances = self.variances(&gains);
        for (place, (line, variance)) in self.lines.iter().zip(&variances).enumerate() {
            let own = residual(line.matrix(), columns, values);
            let deviation = variance.sqrt();
            residuals
                .rows_mut(place * rows, rows)
                .axpy(1.0 / deviation, &own, 0.0);
            for (to, column) in columns.iter().enumerate() {
                let mut target = derivatives.column_mut(to);
                let mut target = target.rows_mut(place * rows, rows);
                target.axpy(1.0 / deviation, &line.matrix().column(*column), 0.0);
                if let Some(drive) = to.checked_sub(self.selection.parameters()) {
                    let slope = self.omegas[place][drive] * gains[drive];
                    target.axpy(-slope / (deviation * variance), &own, 1.0);
                }
            }
        }
        (residuals, derivatives)
    }

    /// The values of the minimum next to `values`.
    fn minimum(&self, mut values: Vec<f64>) -> Result<Vec<f64>, Error> {
        let count = values.len();
        let (mut damping, mut least) = (FIRST_DAMPING, self.value(&values));
        for _ in 0..INNER {
            let (residuals, derivatives) = self.residuals(&values);
            let scales: Vec<f64> = derivatives.column_iter().map(|one| one.norm()).collect();
            let rows = residuals.len();
            let mut right = DVector::zeros(rows + count);
            right.rows_mut(0, rows).copy_from(&-residuals);
            let step = loop {
                let mut stacked = DMatrix::zeros(rows + count, count);
                stacked
                    .view_mut((0, 0), (rows, count))
                    .copy_from(&derivatives);
                for (place, scale) in scales.iter().enumerate() {
                    stacked[(rows + place, place)] = damping.sqrt() * scale;
                }
                let qr = stacked.qr();
                let target = qr.q().tr_mul(&right);
                let step = qr
                    .r()
                    .solve_upper_triangular(&target)
                    .ok_or_else(not_converged)?;
                let next: Vec<f64> = values.iter().zip(step.iter()).map(|(a, b)| a + b).collect();
                let value = self.value(&next);
                let sound = self.gains(&next).iter().all(|gain| *gain > 0.0);
                if sound && value <= least {
                    damping = (damping / 5.0).max(f64::EPSILON);
                    least = value;
                    break Some(next);
                }
                damping *= 4.0;
                if damping >= LARGEST_DAMPING {
                    break None;
                }
            };
            let Some(next) = step else { break };
            let own = self.selection.parameters();
            let change = change(&values[own..], &next[own..]);
            values = next;
            if change < TOLERANCE {
                break;
            }
        }
        Ok(values)
    }

    /// The solution, with data for its standard deviations.
    fn solution(self, values: Vec<f64>) -> Solution {
        let variances = self.variances(&self.gains(&values));
        let mut lambda = DVector::zeros(self.selection.drives);
        for ((line, variance), omega) in self.lines.iter().zip(&variances).zip(&self.omegas) {
            let residual = line.residual_norm(&self.selection.columns, &values);
            lambda += omega * (residual / variance).powi(2);
        }
        let weights: Vec<f64> = variances.iter().map(|own| 1.0 / own.sqrt()).collect();
        let reduced = Factor::reduced_together(self.lines, &weights, &self.selection.columns);
        Solution {
            values,
            triangle: reduced.triangle,
            variances,
            omegas: self.omegas,
            lambda,
        }
    }
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

/// Two starts [-χ; g]: least squares, whose gains are too small, and the best χ for gains of 1.
fn starts(
    lines: &[Factor],
    selection: &Selection,
    variances: &[f64],
) -> Result<[Vec<f64>; 2], Error> {
    let weights: Vec<f64> = variances.iter().map(|own| 1.0 / own.sqrt()).collect();
    let reduced = Factor::reduced_together(lines, &weights, &selection.columns);
    let (p, n) = (selection.parameters(), selection.drives);
    let triangle = reduced.triangle;
    let corner = triangle.view((p, p), (n, n));
    let least_squares = corner.solve_upper_triangular(&reduced.rhs.rows(p, n).clone_owned());
    let with_gains = |gains: DVector<f64>| -> Option<Vec<f64>> {
        let across = triangle.view((0, p), (p, n)) * &gains;
        let right = reduced.rhs.rows(0, p) - across;
        let parameters = triangle
            .view((0, 0), (p, p))
            .solve_upper_triangular(&right)?;
        let values: Vec<f64> = parameters.iter().chain(gains.iter()).copied().collect();
        values
            .iter()
            .all(|value| value.is_finite())
            .then_some(values)
    };
    let ones = DVector::from_element(n, 1.0);
    // Least squares may even change a sign.
    let biased =
        least_squares.map_or_else(|| ones.clone(), |gains| gains.map(|g| g.abs().max(1e-3)));
    let both = with_gains(biased).zip(with_gains(ones));
    both.map(|(a, b)| [a, b]).ok_or_else(not_converged)
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
