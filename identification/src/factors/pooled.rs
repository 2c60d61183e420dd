//! Estimate of a pool of factors, and comparison of two estimates.
//!
//! It is the weighted least-squares estimate (44), (48) of all columns that are independent on the
//! data, in their order. Factors contain base parameters, so it equals the base estimate from the
//! logs. If a robot with payload has only unloaded runs in the pool, the columns of loaded runs are
//! found to be dependent, and are listed.
//!
//! Estimates from different runs are independent. The difference d of q parameters has the
//! covariance V = V_1 + V_2. dᵀ V^-1 d/q is compared with Fisher's distribution with q and ν
//! degrees of freedom. ν is the smallest value of Welch's rule (*Biometrika* 34, 1947) for single
//! parameters.

use nalgebra::{DMatrix, DVector};
use serde::Serialize;

use super::pool::{Pool, PoolGroup};
use crate::{
    estimation::{
        estimate::{Estimation, fit_with},
        intervals::{Intervals, distributions::fisher_tail},
    },
    regression::{
        elimination::eliminate,
        factor::{DATA_RANK_TOLERANCE, Factor},
        projection::Projection,
        system::{RunPart, System},
    },
    settings::Normalisation,
};
use overact_logs::Error;

/// Estimate of a pool of factors.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
#[non_exhaustive]
pub struct Pooled {
    /// Why there is no estimate; empty otherwise.
    pub problem: String,
    /// Number of runs.
    pub runs: u64,
    /// Number of equations of all lines.
    pub equations: u64,
    /// Number of independent groups for the standard deviations.
    pub groups: u64,
    /// Number of duplicate records, which count once.
    pub twice: u64,
    /// Number of records that were damaged or not finite.
    pub damaged: u64,
    /// Number of runs with another description or settings, or beyond the largest number of kinds.
    pub unlike: u64,
    /// 100 ||ρ||/||Y||.
    pub relative_error_percent: f64,
    /// Parameters.
    pub parameters: Vec<PooledParameter>,
    /// Columns that are zero, or dependent on others, on these data.
    pub not_determined: Vec<String>,
    /// Covariance of the parameters: upper triangle, row by row.
    pub covariance: Vec<f64>,
}

/// A parameter estimated from a pool.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
#[non_exhaustive]
pub struct PooledParameter {
    /// Name.
    pub name: String,
    /// Estimate (SI units).
    pub value: f64,
    /// Standard deviation, for any residual within a part of a run.
    pub deviation: f64,
    /// Degrees of freedom of the standard deviation.
    pub freedom: f64,
    /// Standard deviation for white residuals, (47).
    pub white_deviation: f64,
}

/// Test whether parameters of two estimates differ.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Comparison {
    /// dᵀ V^-1 d/q.
    pub ratio: f64,
    /// q.
    pub parameters: u64,
    /// ν.
    pub freedom: f64,
    /// p-value: probability of this or a larger ratio for equal parameters.
    pub probability: f64,
}

impl Pool {
    /// Estimate from the kind with the most runs.
    #[must_use]
    pub fn estimate(&self) -> Pooled {
        let mut estimate_of_all = Pooled {
            twice: self.twice,
            damaged: self.damaged,
            unlike: self.others,
            ..Pooled::default()
        };
        // The first of equally frequent kinds; the order is that of a hash and thus reproducible.
        let most = self.kinds.values().map(PoolGroup::runs).max();
        let Some(kind) = self.kinds.values().find(|kind| Some(kind.runs()) == most) else {
            estimate_of_all.problem = "no run is left".to_owned();
            return estimate_of_all;
        };
        let others = self.kinds.values().filter(|other| *other != kind);
        let mixed = others
            .clone()
            .any(|other| other.settings_hash == kind.settings_hash);
        estimate_of_all.unlike += others.map(|other| other.runs() as u64).sum::<u64>();
        if mixed {
            estimate_of_all.problem =
                "runs of several models, or with and without payload: group by `model`, `loaded` and `payload`"
                    .to_owned();
            return estimate_of_all;
        }
        if let Err(error) = kind.estimate(&mut estimate_of_all) {
            let messages = error.problems.into_iter().map(|one| one.message);
            estimate_of_all.problem = messages.collect::<Vec<_>>().join("; ");
        }
        estimate_of_all
    }

    /// Number of runs of all kinds.
    #[must_use]
    pub fn runs(&self) -> u64 {
        self.kinds.values().map(|kind| kind.runs() as u64).sum()
    }
}

impl PoolGroup {
    /// The equations as a system; a line that a group lacks is empty.
    fn system(&self) -> System {
        let size = self.parameters();
        let empty = Factor::new(size);
        let names = &self.line_names;
        let parts: Vec<RunPart> = { self.groups.values() }
            .map(|lines| RunPart {
                run: 0,
                lines: { names.keys() }
                    .map(|line| lines.get(line).unwrap_or(&empty).clone())
                    .collect(),
            })
            .collect();
        let mut lines = vec![empty.clone(); names.len()];
        for part in &parts {
            for (all, own) in lines.iter_mut().zip(&part.lines) {
                all.add(own);
            }
        }
        System {
            projection: Projection::Joints,
            line_names: names.values().cloned().collect(),
            sessions: Vec::new(),
            line_units: vec![""; lines.len()],
            lines,
            parts,
            stretches: Vec::new(),
            phase_sums: Vec::new(),
            partition: None,
            instruments: Vec::new(),
            totals: Vec::new(),
        }
    }

    fn estimate(&self, estimate_of_all: &mut Pooled) -> Result<(), Error> {
        let system = self.system();
        estimate_of_all.runs = self.runs() as u64;
        estimate_of_all.groups = system.parts.len() as u64;
        estimate_of_all.equations = system
            .lines
            .iter()
            .map(|line| line.equations() as u64)
            .sum();
        let names: Vec<&str> = self.columns.split(',').collect();
        let name = |place: usize| names.get(place).map_or("", |name| *name).to_owned();
        let all = Factor::merged(&system.lines, &vec![1.0; system.lines.len()]);
        let places: Vec<usize> = (0..self.parameters()).collect();
        let found = eliminate(all.matrix(), &places, DATA_RANK_TOLERANCE);
        let dependent = found.dependent.iter().map(|(place, _)| *place);
        let missing = found.zero.iter().copied().chain(dependent);
        estimate_of_all.not_determined = missing.map(name).collect();
        let estimation = fit_with(&system, &found.kept, true, Normalisation::Unbiased, 1)?;
        let intervals = Intervals::new(&system, &found.kept, &estimation);
        estimate_of_all.relative_error_percent = estimation.relative_error_percent;
        estimate_of_all.parameters = parameters(
            &estimation,
            &intervals,
            found.kept.iter().map(|at| name(*at)),
        );
        let matrix = intervals.covariance();
        let size = matrix.nrows();
        let places = (0..size).flat_map(|row| (row..size).map(move |column| (row, column)));
        estimate_of_all.covariance = places.map(|place| matrix[place]).collect();
        Ok(())
    }
}

fn parameters(
    estimation: &Estimation,
    intervals: &Intervals,
    names: impl Iterator<Item = String>,
) -> Vec<PooledParameter> {
    let deviations = intervals.deviations();
    let of = |(place, name): (usize, String)| PooledParameter {
        name,
        value: estimation.values[place],
        deviation: deviations[place],
        freedom: intervals.freedoms()[place],
        white_deviation: estimation.standard_deviations[place],
    };
    names.enumerate().map(of).collect()
}

impl Pooled {
    /// Values, covariance and degrees of freedom of parameters; `None` if one is not estimated.
    fn of(&self, names: &[&str]) -> Option<(DVector<f64>, DMatrix<f64>, Vec<f64>)> {
        let place = |name: &&str| self.parameters.iter().position(|own| own.name == **name);
        let places: Vec<usize> = names.iter().map(place).collect::<Option<_>>()?;
        let count = self.parameters.len();
        let entry = |a: usize, b: usize| {
            let (row, column) = (a.min(b), a.max(b));
            let before = row * count - row * row.saturating_sub(1) / 2;
            self.covariance.get(before + column - row).copied()
        };
        let size = places.len();
        let mut covariance = DMatrix::zeros(size, size);
        for (i, j) in (0..size).flat_map(|i| (0..size).map(move |j| (i, j))) {
            covariance[(i, j)] = entry(places[i], places[j])?;
        }
        let own = || places.iter().map(|place| &self.parameters[*place]);
        let values = DVector::from_iterator(size, own().map(|one| one.value));
        Some((values, covariance, own().map(|one| one.freedom).collect()))
    }
}

/// Compares parameters of two estimates from different runs.
///
/// `None` if an estimate lacks a parameter, or the covariance is singular.
#[must_use]
pub fn compare(a: &Pooled, b: &Pooled, names: &[&str]) -> Option<Comparison> {
    let (first, of_first, freedoms) = a.of(names)?;
    let (second, of_second, others) = b.of(names)?;
    let covariance = &of_first + &of_second;
    let scales = covariance.diagonal().map(|variance| 1.0 / variance.sqrt());
    let scaled = DMatrix::from_fn(names.len(), names.len(), |i, j| {
        covariance[(i, j)] * scales[i] * scales[j]
    });
    let difference = (first - second).component_mul(&scales);
    let solved = scaled.cholesky()?.solve(&difference);
    let ratio = difference.dot(&solved) / names.len() as f64;
    let welch = (0..names.len()).map(|i| {
        let (a, b) = (of_first[(i, i)], of_second[(i, i)]);
        (a + b).powi(2) / (a * a / freedoms[i] + b * b / others[i])
    });
    let freedom = welch.fold(f64::INFINITY, f64::min);
    ratio.is_finite().then(|| Comparison {
        ratio,
        parameters: names.len() as u64,
        freedom,
        probability: fisher_tail(ratio, names.len() as f64, freedom),
    })
}
