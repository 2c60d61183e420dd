//! Tests whether the runs excite every base parameter.
//!
//! It reports parameters that only position noise separates, and parameters whose columns are
//! linearly dependent on these runs.

use crate::{
    assessment::{
        check::{About, Check, CheckKind, Grade},
        checks::Context,
        hypotheses::is_quasi_static,
    },
    estimation::column_noise::Directions,
    regression::{
        elimination::eliminate,
        factor::{DATA_RANK_TOLERANCE, Factor},
        system::System,
    },
    result::{Estimate, ParameterEstimate, Stage},
};
use overact::StandardParameter;
use overact_logs::{Error, significant};

/// Directions of the columns with a larger noise fraction have too little motion.
const LARGEST_NOISE: f64 = 0.1;

/// Fraction of a parameter's variance along such directions that makes it undetermined.
const LARGEST_SHARE: f64 = 1e-3;

/// Largest bias from position noise, in standard deviations.
const LARGEST_BIAS: f64 = 2.0;

/// A coordinate hardly moves if its range is below this fraction of the largest range.
const HARDLY: f64 = 0.02;

/// Checks the base parameters of all models.
pub(crate) fn check(context: &Context<'_>) -> Result<Vec<Check>, Error> {
    let base = context.estimates.iter();
    let base = base.filter(|(_, one)| one.stage == Stage::Base);
    Ok(base
        .map(|(projection, estimate)| of_model(context, *projection, estimate))
        .collect())
}

fn of_model(context: &Context<'_>, projection: usize, estimate: &Estimate) -> Check {
    let new = |words: String| {
        Check::new(CheckKind::Excitation, About::Data, words).of_model(estimate.model)
    };
    let Some(Ok(system)) = context.systems.get(projection) else {
        return new(String::from("there are no equations"));
    };
    let mut spoiled = dependent(system, estimate);
    let inertias = unaccelerated(context, estimate);
    let others = inertias.iter().filter(|name| !spoiled.contains(name));
    let others: Vec<String> = others.cloned().collect();
    spoiled.extend(others);
    let noise = context.column_noise.get(projection);
    let columns = estimate.columns();
    let values: Vec<f64> = estimate.parameters.iter().map(|one| one.value).collect();
    let directions = noise
        .and_then(Option::as_ref)
        .and_then(|noise| noise.directions(system, &estimate.weights, &columns, &values));
    let Some(directions) = directions else {
        let words = "whether the runs move every coordinate is not tested: the regressor cannot be evaluated with noise in the positions";
        return new(String::from(words)).found();
    };
    let largest = directions.noise.iter().copied().fold(0.0, f64::max);
    for (place, own) in estimate.parameters.iter().enumerate() {
        let is_lost = directions.is_undetermined(place) || directions.is_biased(place, own);
        if is_lost && !spoiled.contains(&own.name) {
            spoiled.push(own.name.clone());
        }
    }
    let check = |words: String| {
        new(words).measured(100.0 * largest, "% noise").against(
            100.0 * LARGEST_NOISE,
            "a tenth of the information on a direction would be lost",
        )
    };
    if spoiled.is_empty() {
        return check(format!(
            "the runs separate all columns: position noise is at most {} % of their smallest difference",
            significant(100.0 * largest, 2)
        ));
    }
    refused(
        estimate,
        check(description(context, &spoiled, &inertias)),
        spoiled,
        &inertias,
    )
}

/// A check that fails for these parameters; `inertias` are those that a quasi-static run loses.
fn refused(estimate: &Estimate, check: Check, spoiled: Vec<String>, inertias: &[String]) -> Check {
    let grade = if spoiled == inertias {
        // Nothing else is lost, and such runs are a way to determine weights and friction.
        Grade::UseListed
    } else if 2 * spoiled.len() > estimate.parameters.len() {
        Grade::DoNotUse
    } else {
        Grade::UseListed
    };
    check.with_grade(grade).with_unusable_parameters(spoiled)
}

impl Directions {
    /// Whether badly excited directions contribute to the variance of parameter `place`.
    fn is_undetermined(&self, place: usize) -> bool {
        let steps = self.steps.row(place);
        let lost: f64 = { steps.iter().zip(&self.noise) }
            .filter(|(_, noise)| **noise > LARGEST_NOISE)
            .map(|(step, _)| step * step)
            .sum();
        lost > LARGEST_SHARE * steps.norm_squared()
    }

    /// Whether position noise biases a parameter along the other directions.
    fn is_biased(&self, place: usize, parameter: &ParameterEstimate) -> bool {
        let steps = self.steps.row(place);
        let all = steps.iter().zip(&self.noise).zip(self.sizes.iter());
        let bias: f64 = all
            .filter(|((_, noise), _)| **noise <= LARGEST_NOISE)
            .map(|((step, noise), size)| step * size * noise / (1.0 - noise))
            .sum();
        bias.abs() > LARGEST_BIAS * parameter.correlated_standard_deviation
    }
}

/// Parameters that other columns depend on linearly in these runs.
fn dependent(system: &System, estimate: &Estimate) -> Vec<String> {
    let ones = vec![1.0; system.lines.len()];
    let all = Factor::merged(&system.lines, &ones);
    let places: Vec<usize> = (0..all.parameters()).collect();
    let found = eliminate(all.matrix(), &places, DATA_RANK_TOLERANCE);
    let depends = |column: usize| {
        let mut terms = found.dependent.iter().flat_map(|(_, terms)| terms);
        terms.any(|(kept, _)| *kept == column)
    };
    let own = estimate.parameters.iter();
    own.filter(|one| depends(one.column))
        .map(|one| one.name.clone())
        .collect()
}

/// Parameters that act by accelerations alone, in quasi-static runs: second moments and rotor
/// inertias.
fn unaccelerated(context: &Context<'_>, estimate: &Estimate) -> Vec<String> {
    let is_slow = context
        .scores
        .is_some_and(|scores| is_quasi_static(&context.paces(scores)));
    if !is_slow {
        return Vec::new();
    }
    let symbol = |column: usize| {
        let column = *context.base.columns.get(column)?;
        Some(context.columns.as_slice().get(column)?.symbol)
    };
    let own = estimate.parameters.iter();
    own.filter(|one| symbol(one.column).is_some_and(is_of_acceleration))
        .map(|one| one.name.clone())
        .collect()
}

/// Whether a parameter's column has no other factors than accelerations and squares of velocities.
const fn is_of_acceleration(symbol: StandardParameter) -> bool {
    use StandardParameter as P;
    matches!(
        symbol,
        P::Xx | P::Xy | P::Xz | P::Yy | P::Yz | P::Zz | P::Ia
    )
}

/// Describes parameters that the runs do not separate.
fn description(context: &Context<'_>, spoiled: &[String], inertias: &[String]) -> String {
    let listed = |names: &[String]| {
        let names: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
        names.join(", ")
    };
    if spoiled == inertias {
        return format!(
            "the motion is quasi-static, so inertia forces are negligible and {} not identifiable; weights and friction are. Record faster runs, or hold values from CAD by `held` of [prior]",
            if inertias.len() == 1 {
                format!("{} is", listed(inertias))
            } else {
                format!("{} are", listed(inertias))
            }
        );
    }
    let names = listed(spoiled);
    let still: Vec<String> = still(context)
        .iter()
        .map(|name| format!("`{name}`"))
        .collect();
    let moves = match &still[..] {
        [] => String::from(
            "record runs that move all coordinates independently, with larger velocities and accelerations: `overact excite` computes some",
        ),
        [one] => format!("{one} hardly moves: record runs in which it does"),
        _ => format!(
            "{} hardly move: record runs in which they do",
            still.join(", ")
        ),
    };
    format!(
        "the runs do not determine {names}, whose columns differ by little more than position noise; {moves}"
    )
}

/// Coordinates that hardly move in the training data: of the platform, or joints.
fn still(context: &Context<'_>) -> Vec<String> {
    let ranges = context.ranges;
    let largest = ranges.iter().map(|(_, range)| *range).fold(0.0, f64::max);
    let hardly = ranges.iter().filter(|(_, range)| *range < HARDLY * largest);
    hardly.map(|(name, _)| name.clone()).collect()
}
