//! Tests whether the known values agree with each other.
//!
//! One known parameter fixes the common factor of gains and parameters. A further one is redundant:
//! it is estimated from the others by adding its column to the unknown ones. The difference from its
//! known value, by its standard deviation, is standard normal if all known values are true.

use overact::Code;
use overact_logs::{Error, Problem, significant};

use super::{
    deviations::deviations, known::Split, observation::Equations, selection::Selection,
    solve::solve,
};
use crate::{
    estimation::intervals::distributions::student_quantile,
    regression::{
        elimination::eliminate,
        factor::{DATA_RANK_TOLERANCE, Factor},
    },
};

/// Fraction of true values that are called a contradiction in place of undetermined gains.
const LEVEL: f64 = 1e-6;

/// What to do about known values that contradict each other.
pub(crate) const REMEDY: &str = "Weigh the bodies again, check which runs carry which payload, or leave out the value that is in doubt";

/// A known value that the others determine, too.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct RedundantValue {
    /// Name of the parameter.
    pub(crate) name: String,
    /// Its SI unit.
    pub(crate) unit: String,
    /// Known value.
    pub(crate) known: f64,
    /// Estimate from the other known values.
    pub(crate) estimated: f64,
    /// Standard deviation of the estimate.
    pub(crate) deviation: f64,
    /// Degrees of freedom of the standard deviation.
    pub(crate) freedom: f64,
}

impl RedundantValue {
    /// Difference from the known value, in standard deviations.
    pub(crate) fn miss(&self) -> f64 {
        (self.estimated - self.known).abs() / self.deviation
    }

    /// Difference in standard deviations that a true value exceeds with this probability.
    pub(crate) fn limit(&self, probability: f64) -> f64 {
        student_quantile(probability, self.freedom)
    }

    /// The known value and the estimate.
    pub(crate) fn words(&self) -> String {
        let Self { name, unit, .. } = self;
        let [known, estimated, deviation] =
            [self.known, self.estimated, self.deviation].map(|value| significant(value, 3));
        format!(
            "`{name}` is known to be {known} {unit}, and the other known values give {estimated} {unit} (standard deviation {deviation} {unit})"
        )
    }
}

/// Values that contradict the others at a level, the largest difference first.
pub(crate) fn contradictions(values: &[RedundantValue], level: f64) -> Vec<&RedundantValue> {
    let mut all: Vec<&RedundantValue> = values.iter().collect();
    all.retain(|one| one.miss() > one.limit(level));
    all.sort_by(|a, b| b.miss().total_cmp(&a.miss()));
    all
}

/// Why known values contradict each other.
pub(crate) fn words(contradictions: &[&RedundantValue]) -> String {
    let each: Vec<String> = contradictions.iter().map(|one| one.words()).collect();
    format!(
        "the known values contradict each other: {}",
        each.join("; ")
    )
}

/// The error of contradicting values that no gains can explain; `None` if they agree.
pub(super) fn contradiction(values: &[RedundantValue]) -> Option<Error> {
    let found = contradictions(values, LEVEL);
    let message = || format!("gains are not determined: {}", words(&found));
    let problem = || Problem::new(Code::GAINS, message()).help(format!("{REMEDY}."));
    (!found.is_empty()).then(|| problem().into())
}

/// Each known value that the others determine, with its estimate from them.
pub(super) fn redundant_values(
    equations: &Equations,
    selection: &Selection,
    split: &Split,
) -> Vec<RedundantValue> {
    let numbers = 0..equations.known;
    let one = |number: usize| redundant_value(equations, selection, split, number);
    numbers.filter_map(one).collect()
}

/// The known value with this number; `None` if the others do not determine it.
fn redundant_value(
    equations: &Equations,
    selection: &Selection,
    split: &Split,
    number: usize,
) -> Option<RedundantValue> {
    let known = split.known.get(number)?;
    let freed = selection.with_column(split.base.columns.len() + selection.drives + number);
    let weights = Selection::weights(&equations.system.lines);
    let merged = Factor::merged(&equations.system.lines, &weights);
    let kept = eliminate(merged.matrix(), &freed.columns, DATA_RANK_TOLERANCE).kept;
    if kept.len() < freed.columns.len() {
        return None;
    }
    let solution = solve(equations, &freed).ok()?;
    let deviation = deviations(equations, &freed, &solution)?;
    let place = selection.parameters();
    let column = split.columns.as_slice().get(known.column)?;
    Some(RedundantValue {
        name: column.name.clone(),
        unit: column.unit.to_owned(),
        known: known.value,
        estimated: known.value - solution.values[place],
        deviation: deviation.all[place],
        freedom: (equations.count() as f64 - freed.columns.len() as f64).max(1.0),
    })
}
