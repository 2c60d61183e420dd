//! Tests whether parameters that cannot be negative are estimated negative.

use overact::StandardParameter;

use crate::{
    assessment::{
        check::{About, Check, CheckKind, Grade},
        checks::Context,
    },
    result::{Estimate, ParameterEstimate, Stage},
};
use overact_logs::{Error, significant};

/// Standard deviations below zero from which an estimate is clearly negative.
const CLEARLY_NEGATIVE: f64 = 5.0;

/// Checks the base parameters of all models.
pub(crate) fn check(context: &Context<'_>) -> Result<Vec<Check>, Error> {
    let of_model = |estimate: &Estimate| {
        let positive = estimate
            .parameters
            .iter()
            .filter(|one| is_positive(context, one.column));
        // The half width of a 95 % interval is 1.96 σ, or more with few degrees of freedom.
        let below = |one: &ParameterEstimate| -1.96 * one.value / (one.interval_95[1] - one.value);
        let worst = positive
            .clone()
            .map(below)
            .fold(f64::NEG_INFINITY, f64::max);
        let negative: Vec<&ParameterEstimate> = positive
            .filter(|one| below(one) > CLEARLY_NEGATIVE)
            .collect();
        let (words, grade) = if negative.is_empty() {
            let words = "no mass, inertia or friction is clearly below zero";
            (String::from(words), Grade::Use)
        } else {
            (description(&negative), Grade::DoNotUse)
        };
        Check::new(CheckKind::NegativeParameter, About::Model, words)
            .of_model(estimate.model)
            .measured(worst, "standard deviations below zero")
            .against(CLEARLY_NEGATIVE, "chance is below 3e-7 for each parameter")
            .with_grade(grade)
            .with_unusable_parameters(negative.iter().map(|one| one.name.clone()).collect())
    };
    Ok(context.estimates_of(Stage::Base).map(of_model).collect())
}

/// Describes negative parameters.
fn description(negative: &[&ParameterEstimate]) -> String {
    let values: Vec<String> = negative
        .iter()
        .map(|one| {
            format!(
                "`{}` = {} {}",
                one.name,
                significant(one.value, 3),
                one.unit
            )
        })
        .collect();
    let (is, it) = if negative.len() == 1 {
        ("is", "it")
    } else {
        ("are", "them")
    };
    format!(
        "{} can't be negative, but {is} estimated so: check the signs of positions and torques, and whether the runs excite {it}",
        values.join(", "),
    )
}

/// Whether a base parameter is a positive combination of nonnegative parameters.
pub(crate) fn is_positive(context: &Context<'_>, place: usize) -> bool {
    let columns = context.columns.as_slice();
    let positive = |column: usize| {
        let symbol = columns.get(column).map(|column| column.symbol);
        symbol.is_some_and(StandardParameter::is_nonnegative)
    };
    let base = context.base;
    base.columns.get(place).is_some_and(|&kept| positive(kept))
        && base.regroupings.get(place).is_some_and(|terms| {
            terms
                .iter()
                .all(|&(column, coefficient)| positive(column) && coefficient > 0.0)
        })
}
