//! Tests whether physically consistent bodies explain the data.

use super::negative_parameters::is_positive;
use crate::{
    assessment::{
        check::{About, Check, CheckKind, Grade},
        checks::Context,
    },
    result::{Estimate, Stage},
};
use overact_logs::{Error, significant};

/// Checks the base parameters of models without a physically consistent solution.
///
/// Friction remains usable; masses, first moments and inertias do not.
pub(crate) fn check(context: &Context<'_>) -> Result<Vec<Check>, Error> {
    let estimates = context.estimates_of(Stage::Base);
    let without = estimates.filter(|one| context.inconsistent.contains(&one.model));
    let of_model = |estimate: &Estimate| {
        let inertial = estimate.parameters.iter();
        let inertial = inertial.filter(|one| one.unit.starts_with("kg"));
        Check::new(
            CheckKind::Consistency,
            About::Model,
            words(context, estimate),
        )
        .of_model(estimate.model)
        .with_grade(Grade::UseListed)
        .with_unusable_parameters(inertial.map(|one| one.name.clone()).collect())
    };
    Ok(without.map(of_model).collect())
}

/// Describes the negative parameters and a remedy.
fn words(context: &Context<'_>, estimate: &Estimate) -> String {
    let negative = estimate
        .parameters
        .iter()
        .filter(|one| one.value < 0.0 && is_positive(context, one.column));
    let values: Vec<String> = negative
        .map(|one| {
            format!(
                "`{}` = {} {}",
                one.name,
                significant(one.value, 3),
                one.unit
            )
        })
        .collect();
    let fails = if values.is_empty() {
        String::from(
            "no single mass or moment of inertia is negative, but no bodies have these combinations",
        )
    } else {
        format!("below zero: {}", values.join(", "))
    };
    let advice = if context.settings.prior.bounds.is_empty() {
        "check signs and units of the log and whether the runs excite these parameters; values of bodies in the table `prior` help the search"
    } else {
        "check the bounds in the table `prior`, then signs and units of the log"
    };
    format!("no physically consistent parameters: the search did not converge; {fails}; {advice}")
}
