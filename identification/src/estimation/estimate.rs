//! Least-squares estimation from the R factors of the lines, section 4.2 of the paper.
//!
//! χ minimises ||Y - W χ|| (44). With the residual's standard deviation σ_ρ (46), the covariance of
//! χ is σ_ρ² (Wᵀ W)^-1 = σ_ρ² R^-1 R^-T (47). Weighted least squares divides the equations of each
//! line j by the standard deviation of that line's own residual (48). Lines in N and N m then
//! become comparable.
//!
//! Residuals, relative residuals and the condition number are those of the unweighted system.

use nalgebra::DMatrix;
use overact::Code;
use serde::Serialize;

use crate::{
    regression::{
        elimination::residual,
        factor::{DATA_RANK_TOLERANCE, Factor},
        system::{System, condition_number},
    },
    settings::{Normalisation, Settings},
};
use overact_logs::{Error, Problem};

/// A line whose residual is below this fraction of its norm is exact up to rounding.
const EXACT: f64 = 1e-9;

/// Least-squares estimate with its standard deviations and residuals.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Estimation {
    /// Estimates χ, in the order of the selected columns (SI units).
    pub values: Vec<f64>,
    /// Standard deviations σ of the estimates, (47) (SI units).
    pub standard_deviations: Vec<f64>,
    /// 100 σ/|χ|; infinite for an estimate of zero.
    pub relative_standard_deviations_percent: Vec<f64>,
    /// ||ρ|| = ||Y - W χ|| of the unweighted system (N or N m, mixed for mixed lines).
    pub residual_norm: f64,
    /// 100 ||ρ||/||Y|| of the unweighted system.
    pub relative_error_percent: f64,
    /// Condition number of W, neither weighted nor scaled.
    pub condition_number: f64,
    /// Number of equations, r_c.
    pub equations: usize,
    /// σ_ρ of the solved system: about 1 if it was weighted.
    pub residual_deviation: f64,
    /// Residual of each line of Γ.
    pub lines: Vec<LineError>,
    /// Weight of each line's equations.
    pub weights: Vec<f64>,
    /// R^-1 of the weighted system; σ_ρ times its row norms are the standard deviations.
    pub(crate) inverse: DMatrix<f64>,
}

impl Estimation {
    /// The largest relative standard deviation divided by the smallest.
    #[must_use]
    pub fn deviation_ratio(&self) -> f64 {
        let deviations = &self.relative_standard_deviations_percent;
        let largest = deviations.iter().copied().fold(0.0, f64::max);
        let smallest = deviations.iter().copied().fold(f64::INFINITY, f64::min);
        if largest == 0.0 {
            1.0
        } else {
            largest / smallest
        }
    }
}

/// Residual of one line of Γ, or of one torque.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LineError {
    /// Name of the coordinate or actuator.
    pub name: String,
    /// Unit of the residual, `N` or `N m`; empty if unknown.
    pub unit: &'static str,
    /// ||ρ_j|| (N or N m).
    pub residual_norm: f64,
    /// ||Y_j|| (N or N m).
    pub measured_norm: f64,
    /// 100 ||ρ_j||/||Y_j||.
    pub relative_error_percent: f64,
    /// Root mean square of the residual, ||ρ_j||/√N (N or N m).
    pub rms: f64,
    /// Fit 100 (1 - ||ρ_j||/||Y_j - mean||); `None` if the measurement is constant.
    pub nrmse_fit_percent: Option<f64>,
    /// Number of equations, N.
    pub equations: usize,
}

/// Norms of one line, all in its unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LineNorms {
    /// Norm of the residual, ||ρ_j||.
    pub residual: f64,
    /// Norm of the measurement, ||Y_j||.
    pub measured: f64,
    /// Norm of the measurement without its mean.
    pub variation: f64,
}

/// Part of a measurement's norm below which its variation is rounding.
const CONSTANT: f64 = 1e-7;

impl LineNorms {
    /// Norms from the sums of the squared residual, the squared measurement and the measurement.
    #[must_use]
    pub fn of_sums(residual: f64, measured: f64, sum: f64, equations: usize) -> Self {
        let of_mean = sum * sum / equations.max(1) as f64;
        Self {
            residual: residual.sqrt(),
            measured: measured.sqrt(),
            variation: (measured - of_mean).max(0.0).sqrt(),
        }
    }
}

impl LineError {
    /// Computes relative residual, root mean square and fit from the norms.
    #[must_use]
    pub fn new(name: &str, unit: &'static str, norms: &LineNorms, equations: usize) -> Self {
        let varies = norms.variation > CONSTANT * norms.measured;
        Self {
            name: name.to_owned(),
            unit,
            residual_norm: norms.residual,
            measured_norm: norms.measured,
            relative_error_percent: percent(norms.residual, norms.measured),
            rms: norms.residual / (equations.max(1) as f64).sqrt(),
            nrmse_fit_percent: varies.then(|| 100.0 * (1.0 - norms.residual / norms.variation)),
            equations,
        }
    }

    /// Largest relative residual of several lines, with its line.
    ///
    /// Unlike a norm over all lines, it does not mix N and N m.
    #[must_use]
    pub fn worst(lines: &[Self]) -> Option<&Self> {
        let known = lines
            .iter()
            .filter(|one| !one.relative_error_percent.is_nan());
        known.max_by(|a, b| {
            a.relative_error_percent
                .total_cmp(&b.relative_error_percent)
        })
    }
}

/// 100 part/whole; 0 if both are zero.
pub(crate) fn percent(part: f64, whole: f64) -> f64 {
    if part == 0.0 {
        0.0
    } else {
        100.0 * part / whole
    }
}

/// Residuals of given parameters for every line of a system.
#[must_use]
pub(crate) fn line_errors(system: &System, selected: &[usize], values: &[f64]) -> Vec<LineError> {
    system
        .lines
        .iter()
        .zip(system.line_names.iter().zip(&system.line_units))
        .enumerate()
        .map(|(number, (line, (name, unit)))| {
            let residual = line.residual_norm(selected, values);
            let norms = match system.totals.get(number) {
                Some(total) => LineNorms::of_sums(
                    residual * residual,
                    total.squares,
                    total.sum,
                    line.equations(),
                ),
                None => LineNorms {
                    residual,
                    measured: line.measured_norm(),
                    variation: line.measured_variation(),
                },
            };
            LineError::new(name, unit, &norms, line.equations())
        })
        .collect()
}

/// ||ρ|| and ||Y|| of all lines together.
pub(crate) fn overall(lines: &[LineError]) -> (f64, f64) {
    let norm = |of: fn(&LineError) -> f64| {
        lines
            .iter()
            .map(|line| of(line).powi(2))
            .sum::<f64>()
            .sqrt()
    };
    (
        norm(|line| line.residual_norm),
        norm(|line| line.measured_norm),
    )
}

/// Estimates the parameters of the columns `selected`.
///
/// # Errors
/// No column, fewer equations than unknowns, or columns that are dependent on the data.
pub fn estimate(
    system: &System,
    selected: &[usize],
    settings: &Settings,
) -> Result<Estimation, Error> {
    let mut estimation = fit(system, selected, settings)?;
    estimation.condition_number = condition(system, selected);
    Ok(estimation)
}

/// Condition number of the columns `selected`, neither weighted nor scaled.
pub(crate) fn condition(system: &System, selected: &[usize]) -> f64 {
    let ones = vec![1.0; system.lines.len()];
    let reduced = Factor::reduced_together(&system.lines, &ones, selected);
    condition_number(&reduced.triangle)
}

/// [`estimate`] without the condition number, which is NaN.
///
/// The condition number dominates the cost, and steps of an elimination do not need it.
pub(crate) fn fit(
    system: &System,
    selected: &[usize],
    settings: &Settings,
) -> Result<Estimation, Error> {
    fit_with(
        system,
        selected,
        settings.weighted,
        settings.normalisation,
        settings.decimation,
    )
}

/// [`fit`] with explicit weighting and rule for σ_ρ.
///
/// `decimation` is the number of samples of an equation; it only serves the error message.
pub(crate) fn fit_with(
    system: &System,
    selected: &[usize],
    weighted: bool,
    normalisation: Normalisation,
    decimation: usize,
) -> Result<Estimation, Error> {
    let unknowns = selected.len();
    let equations: usize = system.lines.iter().map(Factor::equations).sum();
    if unknowns == 0 || equations <= unknowns {
        return Err(Problem::new(
            Code::NOTHING_DETERMINED,
            format!(
                "{equations} equations do not determine {unknowns} parameters{}",
                match decimation {
                    0 | 1 => String::new(),
                    kept => format!(": `decimation` keeps one equation per {kept} samples"),
                }
            ),
        )
        .help(
            "record longer runs, lower `decimation` of [identification] or list fewer `parameters`",
        )
        .into());
    }
    let weights = if weighted {
        weights(system, selected)
    } else {
        vec![1.0; system.lines.len()]
    };
    let Solution {
        values,
        inverse,
        residual_norm,
    } = solve(&system.lines, &weights, selected)?;
    let sums = system.lines.iter().zip(&weights);
    let sum = sums.map(|(line, weight)| weight * line.residual_sum(selected, &values));
    let deviation =
        residual_deviation(equations, unknowns, residual_norm, sum.sum(), normalisation);
    let standard_deviations: Vec<f64> = inverse
        .row_iter()
        .map(|row| deviation * row.norm())
        .collect();
    let relative = values
        .iter()
        .zip(&standard_deviations)
        .map(|(value, deviation)| percent(*deviation, value.abs()))
        .collect();
    let lines = line_errors(system, selected, &values);
    let (residual_norm, measured_norm) = overall(&lines);
    Ok(Estimation {
        relative_standard_deviations_percent: relative,
        standard_deviations,
        residual_norm,
        relative_error_percent: percent(residual_norm, measured_norm),
        condition_number: f64::NAN,
        equations,
        residual_deviation: deviation,
        lines,
        values,
        weights,
        inverse,
    })
}

/// A least-squares solution.
struct Solution {
    values: Vec<f64>,
    /// R_1^-1; σ_ρ times its row norms are the standard deviations (47).
    inverse: DMatrix<f64>,
    residual_norm: f64,
}

/// Solves R_1 χ = Q_1ᵀ Y (44) of weighted lines.
fn solve(lines: &[Factor], weights: &[f64], selected: &[usize]) -> Result<Solution, Error> {
    let reduced = Factor::reduced_together(lines, weights, selected);
    let identity = DMatrix::identity(selected.len(), selected.len());
    let values = reduced.triangle.solve_upper_triangular(&reduced.rhs);
    let inverse = reduced.triangle.solve_upper_triangular(&identity);
    match (values, inverse) {
        (Some(values), Some(inverse)) if values.iter().all(|value| value.is_finite()) => {
            Ok(Solution {
                values: values.iter().copied().collect(),
                inverse,
                residual_norm: reduced.residual_norm,
            })
        }
        _ => Err(Problem::new(
            Code::NOTHING_DETERMINED,
            "the parameters are not independent on these data",
        )
        .help("excite the robot more (`overact excite`), or list fewer `parameters`")
        .into()),
    }
}

/// σ_ρ from the norm and the sum of the residual.
///
/// Either (46), or the sample variance.
fn residual_deviation(
    equations: usize,
    unknowns: usize,
    norm: f64,
    sum: f64,
    normalisation: Normalisation,
) -> f64 {
    let count = equations as f64;
    let square = match normalisation {
        Normalisation::Unbiased => norm * norm / (count - unknowns as f64),
        Normalisation::SampleVariance => (norm * norm - sum * sum / count).max(0.0) / (count - 1.0),
    };
    square.sqrt()
}

/// Weight of each line: the inverse standard deviation of the line's own residual (48).
///
/// Only the independent columns of a line count, since a line need not determine all parameters.
fn weights(system: &System, selected: &[usize]) -> Vec<f64> {
    let deviation = |line: &Factor, norm: f64| norm / (line.equations().max(1) as f64).sqrt();
    // A common floor for exact lines, so that rounding does not choose between them.
    let floor = system
        .lines
        .iter()
        .map(|line| EXACT * deviation(line, line.measured_norm()))
        .fold(0.0, f64::max);
    let weights: Vec<f64> = system
        .lines
        .iter()
        .map(|line| {
            let (own, norm) = residual(line.matrix(), selected, DATA_RANK_TOLERANCE);
            let freedom = line.equations().saturating_sub(own).max(1) as f64;
            let deviation = norm / freedom.sqrt();
            1.0 / deviation.max(floor)
        })
        .collect();
    // Without any torque there is no standard deviation.
    if weights.iter().all(|weight| weight.is_finite()) {
        weights
    } else {
        vec![1.0; system.lines.len()]
    }
}
