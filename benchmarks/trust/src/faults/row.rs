//! One row of the fault table: sums over the draws of one fault.

use crate::traps::KnownFault;
use overact_identification::{Detectable, Estimator, Grade, Identification, Stage};
use serde::Serialize;
use std::{collections::BTreeMap, fmt};

/// Half width of a 95 % interval in standard deviations.
const HALF_WIDTH: f64 = 1.96;

/// Errors beyond this number of standard deviations are counted.
const LARGE: f64 = 3.5;

/// Error of a usable parameter.
#[derive(Debug, Clone)]
struct UsableError {
    /// Name of the parameter.
    name: String,
    /// Its error, with its sign, in standard deviations.
    error: f64,
    /// Whether the report states that this fault may be hidden, and that it shifts the parameter.
    is_named: bool,
}

/// Identification of one draw.
#[derive(Debug, Clone)]
pub(super) struct Draw {
    /// Grade; `None` if the data are refused with an error.
    grade: Option<Grade>,
    /// Errors of the usable parameters.
    errors: Vec<UsableError>,
    /// Names of the failed checks.
    checks: Vec<&'static str>,
}

impl Draw {
    /// Data that are refused with an error.
    pub(super) const fn refused() -> Self {
        Self {
            grade: None,
            errors: Vec::new(),
            checks: Vec::new(),
        }
    }

    /// The identification of data with these faults, for a robot with these actuators: parameters of
    /// the first verdict's stage.
    pub(super) fn new(result: &Identification, known: &[KnownFault], actuators: &[&str]) -> Self {
        let checks = result.checks.iter().filter(|check| !check.passed);
        let checks = checks.map(|check| check.kind.name()).collect();
        let Some(verdict) = result.verdicts.first() else {
            return Self {
                grade: Some(Grade::DoNotUse),
                errors: Vec::new(),
                checks,
            };
        };
        let usable = |name: &String| match verdict.grade {
            Grade::Use => true,
            Grade::UseListed => verdict.listed.contains(name),
            Grade::DoNotUse => false,
        };
        let stages = result.estimates.iter().filter(|one| {
            one.model == verdict.model
                && one.estimator == Estimator::LeastSquares
                && matches!(one.stage, Stage::Base | Stage::Recommended)
        });
        let parameters = stages.flat_map(|one| &one.parameters);
        let stated = known.iter();
        let stated = stated.filter_map(|one| one.stated_in(result, actuators));
        let stated: Vec<&str> = stated.flat_map(Detectable::parameters).collect();
        let errors = parameters
            .filter(|one| usable(&one.name))
            .filter_map(|one| {
                let half = 0.5 * (one.interval_95[1] - one.interval_95[0]);
                Some(UsableError {
                    name: one.name.clone(),
                    error: (one.value - one.true_value?) * HALF_WIDTH / half,
                    is_named: stated.contains(&one.name.as_str()),
                })
            });
        Self {
            grade: Some(verdict.grade),
            errors: errors.collect(),
            checks,
        }
    }
}

/// Results of one fault over all draws.
#[derive(Debug, Clone, Serialize)]
pub struct FaultRow {
    /// Robot.
    pub robot: String,
    /// Fault.
    pub fault: String,
    /// Draws refused with an error, and draws of each grade from worst to best.
    pub refused: usize,
    /// Draws with the grade "do not use it".
    pub unusable: usize,
    /// Draws with the grade "use it for what is listed".
    pub listed: usize,
    /// Draws with the grade "use it".
    pub used: usize,
    /// Mean number of usable parameters in these draws, both stages together.
    pub parameters: f64,
    /// Largest error of a usable parameter in one draw, in standard deviations, and its name.
    pub largest: Option<(f64, String)>,
    /// Largest mean of the error of a parameter over the draws in which it is usable.
    ///
    /// These are at least half of the draws with usable parameters: noise decides whether a small
    /// parameter is recommended, so that its mean over few draws is that of a selection.
    pub mean: Option<(f64, String)>,
    /// The same of parameters that the report does not name next to the detection limit of this fault,
    /// or whose detection limit is smaller than the fault.
    pub unnamed_mean: Option<(f64, String)>,
    /// Fraction of the values of usable parameters beyond 3.5 standard deviations, in percent.
    pub beyond_percent: f64,
    /// Failed checks, with the number of draws.
    pub checks: BTreeMap<&'static str, usize>,
}

impl FaultRow {
    /// Sums over draws.
    pub(super) fn new(robot: &str, fault: &str, draws: &[Draw]) -> Self {
        let count = |grade| draws.iter().filter(|one| one.grade == grade).count();
        let errors = by_name(draws, |_| true);
        let unnamed = by_name(draws, |one| !one.is_named);
        let mut checks: BTreeMap<&'static str, usize> = BTreeMap::new();
        for one in draws {
            let mut own = one.checks.clone();
            own.sort_unstable();
            own.dedup();
            own.into_iter()
                .for_each(|name| *checks.entry(name).or_default() += 1);
        }
        let values: Vec<f64> = errors.values().flatten().copied().collect();
        let beyond = values.iter().filter(|error| error.abs() > LARGE).count();
        let [listed, used] = [Grade::UseListed, Grade::Use].map(|grade| count(Some(grade)));
        // Each parameter has a value in both stages.
        let least = listed + used;
        let mean = |own: &[f64]| own.iter().sum::<f64>().abs() / own.len() as f64;
        let largest = |own: &[f64]| own.iter().fold(0.0, |most: f64, one| most.max(one.abs()));
        Self {
            robot: robot.to_owned(),
            fault: fault.to_owned(),
            refused: count(None),
            unusable: count(Some(Grade::DoNotUse)),
            listed,
            used,
            parameters: values.len() as f64 / (listed + used).max(1) as f64,
            largest: worst(&errors, 1, &largest),
            mean: worst(&errors, least, &mean),
            unnamed_mean: worst(&unnamed, least, &mean),
            beyond_percent: 100.0 * beyond as f64 / values.len().max(1) as f64,
            checks,
        }
    }
}

/// Errors of some usable parameters in all draws, by name.
fn by_name(draws: &[Draw], is_wanted: impl Fn(&UsableError) -> bool) -> BTreeMap<&str, Vec<f64>> {
    let mut errors: BTreeMap<&str, Vec<f64>> = BTreeMap::new();
    for one in draws.iter().flat_map(|one| &one.errors) {
        if is_wanted(one) {
            errors.entry(&one.name).or_default().push(one.error);
        }
    }
    errors
}

/// Largest value of a parameter with at least so many errors, and its name.
fn worst(
    errors: &BTreeMap<&str, Vec<f64>>,
    least: usize,
    of: &dyn Fn(&[f64]) -> f64,
) -> Option<(f64, String)> {
    let all = errors.iter().filter(|(_, own)| own.len() >= least);
    let all = all.map(|(name, own)| (of(own), (*name).to_owned()));
    all.max_by(|a, b| a.0.total_cmp(&b.0))
}

/// Header of the table.
#[must_use]
pub fn header() -> &'static str {
    "| robot | fault | refused | do not use | listed | use | usable values | largest error, σ | largest mean error, σ | of those not named by a limit, σ | beyond 3.5 σ, % | failed checks |\n|---|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---|"
}

impl fmt::Display for FaultRow {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let error = |one: &Option<(f64, String)>| {
            one.as_ref().map_or_else(
                || String::from("-"),
                |(size, name)| format!("{size:.1} `{name}`"),
            )
        };
        let checks: Vec<String> = { &self.checks }
            .iter()
            .map(|(name, count)| format!("{name} {count}"))
            .collect();
        write!(
            f,
            "| {} | {} | {} | {} | {} | {} | {:.0} | {} | {} | {} | {:.1} | {} |",
            self.robot,
            self.fault,
            self.refused,
            self.unusable,
            self.listed,
            self.used,
            self.parameters,
            error(&self.largest),
            error(&self.mean),
            error(&self.unnamed_mean),
            self.beyond_percent,
            checks.join(", ")
        )
    }
}
