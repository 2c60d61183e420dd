//! Instrumental variables: estimates that errors of the regressor do not bias.
//!
//! Least squares minimises ||Y - W χ|| as if W were exact. Its columns come from measured
//! positions. Errors of W that are independent over time bias the estimate towards zero, for runs
//! of any length. Instruments Z are columns that are correlated with those of W but not with the
//! errors of W. Then Zᵀ(Y - W χ) has zero mean for the true χ, and
//!
//! ```text
//! χ = (Zᵀ Λ² W)^-1 Zᵀ Λ² Y
//! ```
//!
//! is consistent (A. Janot, P.-O. Vandanjon, M. Gautier, *A generic instrumental variable approach
//! for industrial robot identification*, IEEE Trans. Control Systems Technology 22, 2014). Z is the
//! regressor of another motion: that of the simulated robot, or that of the other periods of a
//! periodic motion. Λ are the weights of least squares. With the R factor of Λ[Z W Y],
//!
//! ```text
//!     | R_zz R_zw R_zy |
//! R = |      R_ww R_wy | ,   χ = R_zw^-1 R_zy.
//!     |           R_yy |
//! ```
//!
//! This forms no product of regressors, so the condition number is not squared.
//!
//! - `hausman`: whether both estimates agree;
//! - `strength`: correlation of the instruments with the columns;
//! - `total_least_squares`: the estimate that allows for white errors of the columns;
//! - `regressor`: the reported result.

pub(crate) mod hausman;
pub(crate) mod regressor;
pub(crate) mod strength;
pub(crate) mod total_least_squares;

use nalgebra::{DMatrix, DVector};
use overact::Code;

use super::{
    estimate::{Estimation, line_errors, overall, percent},
    intervals::{Intervals, scores::Context},
};
use crate::regression::{factor::Factor, system::System};
use overact_logs::{Error, Problem};

/// Instrumental-variable estimate with its factors.
#[derive(Debug, Clone)]
pub(crate) struct Instrumental {
    /// The estimate; its R^-1 is that of least squares.
    pub(crate) estimation: Estimation,
    /// Intervals; `None` without successive equations.
    pub(crate) intervals: Option<Intervals>,
    /// R_zz and R_zw.
    triangle: DMatrix<f64>,
    crossed: DMatrix<f64>,
    /// R_ww and R_wy.
    errors: DMatrix<f64>,
}

impl Instrumental {
    /// Estimates the columns `selected`; `start` is their least-squares estimate.
    ///
    /// # Errors
    /// A system without instruments, or instruments that do not determine the parameters.
    pub(crate) fn new(
        system: &System,
        selected: &[usize],
        start: &Estimation,
    ) -> Result<Self, Error> {
        let p = selected.len();
        let total = system.lines.first().map_or(0, Factor::parameters);
        let instruments = selected.iter().map(|column| total + column);
        let places: Vec<usize> = instruments.chain(selected.iter().copied()).collect();
        let reduced = Factor::reduced_together(&system.instruments, &start.weights, &places);
        if system.instruments.is_empty() || reduced.triangle.nrows() < 2 * p {
            return Err(Problem::new(Code::INSTRUMENTS, "the system has no instruments").into());
        }
        let block = |row: usize, column: usize| -> DMatrix<f64> {
            reduced.triangle.view((row, column), (p, p)).clone_owned()
        };
        let (triangle, crossed) = (block(0, 0), block(0, p));
        let wanted = reduced.rhs.rows(0, p).clone_owned();
        let (values, inverse) = solve(&crossed, &wanted).ok_or_else(|| {
            Problem::new(
                Code::INSTRUMENTS,
                "the instruments do not determine the parameters",
            )
            .help("record several periods of a motion that excites all of them")
        })?;
        let estimation = with_values(system, selected, start, values, &inverse);
        let mut found = Self {
            intervals: None,
            errors: block(p, p),
            estimation,
            triangle,
            crossed,
        };
        if let Some(influence) = found.influence() {
            let context = Context::new(selected, &found.estimation);
            let context = context.with_influence(influence);
            found.intervals = Intervals::of_context(system, &context);
        }
        Ok(found)
    }

    /// Influence [0, (Zᵀ Λ² W)^-1] of weighted columns and instruments on the estimate.
    fn influence(&self) -> Option<DMatrix<f64>> {
        let p = self.crossed.ncols();
        // R_zw^-1 R_zz^-T, the transpose of R_zz^-1 R_zw^-T.
        let inverse = self.crossed.clone().try_inverse()?;
        let part = self.triangle.solve_upper_triangular(&inverse.transpose())?;
        let mut influence = DMatrix::zeros(p, 2 * p);
        influence.columns_mut(p, p).tr_copy_from(&part);
        influence
            .iter()
            .all(|value| value.is_finite())
            .then_some(influence)
    }

    /// R_ww: the part of the columns that the instruments do not explain.
    pub(crate) const fn unexplained(&self) -> &DMatrix<f64> {
        &self.errors
    }
}

/// Solves R_zw χ = R_zy and inverts R_zw, with columns scaled to be independent of units.
fn solve(crossed: &DMatrix<f64>, wanted: &DVector<f64>) -> Option<(Vec<f64>, DMatrix<f64>)> {
    let scales: Vec<f64> = crossed
        .column_iter()
        .map(|column| 1.0 / column.norm())
        .collect();
    let mut scaled = crossed.clone();
    for (mut column, scale) in scaled.column_iter_mut().zip(&scales) {
        column *= *scale;
    }
    let mut inverse = scaled.try_inverse()?;
    for (mut row, scale) in inverse.row_iter_mut().zip(&scales) {
        row *= *scale;
    }
    let values: Vec<f64> = (&inverse * wanted).iter().copied().collect();
    let finite = values.iter().chain(inverse.iter()).all(|v| v.is_finite());
    finite.then_some((values, inverse))
}

/// An estimation with other values.
///
/// Its standard deviations for white residuals are σ_ρ times the row norms of R_zw^-1.
fn with_values(
    system: &System,
    selected: &[usize],
    start: &Estimation,
    values: Vec<f64>,
    inverse: &DMatrix<f64>,
) -> Estimation {
    let lines = line_errors(system, selected, &values);
    let (residual_norm, measured_norm) = overall(&lines);
    let weighted: f64 = lines
        .iter()
        .zip(&start.weights)
        .map(|(line, weight)| (weight * line.residual_norm).powi(2))
        .sum();
    let freedom = start.equations.saturating_sub(selected.len()).max(1);
    let deviation = (weighted / freedom as f64).sqrt();
    let standard_deviations: Vec<f64> = inverse
        .row_iter()
        .map(|row| deviation * row.norm())
        .collect();
    let relative = values.iter().zip(&standard_deviations);
    Estimation {
        relative_standard_deviations_percent: relative
            .map(|(value, deviation)| percent(*deviation, value.abs()))
            .collect(),
        standard_deviations,
        residual_norm,
        relative_error_percent: percent(residual_norm, measured_norm),
        residual_deviation: deviation,
        lines,
        values,
        ..start.clone()
    }
}

#[cfg(test)]
mod tests;
