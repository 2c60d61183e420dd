//! Messages of the unit check.

use super::Finding;
use crate::{
    assessment::check::{About, Check, CheckKind},
    units::{Quantity, UnitError},
};
use overact_logs::significant;

/// Largest number of quantities named in a message.
const NAMED: usize = 3;

/// A finding as a check.
pub(super) fn check(found: &Finding) -> Check {
    let check = Check::new(CheckKind::Unit, About::Data, sentence(found));
    let Some(worst) = found.contradictions.first() else {
        return check;
    };
    let bound = if worst.value > worst.possible.high {
        worst.possible.high
    } else {
        worst.possible.low
    };
    let check = check
        .measured(worst.value, worst.unit)
        .against(bound, "physical scales of robots and of the description");
    match found.unit_error {
        Some(unit_error) => check.in_unit(unit_error.signal.name(), unit_error.factor),
        None => check,
    }
}

/// A finding as a hint below an error.
pub(super) fn hint(found: &Finding) -> String {
    let text = sentence(found);
    match &found.actuator {
        Some(actuator) => format!("{}: {text}", overact_logs::titled(actuator)),
        None => text,
    }
}

/// States the contradiction, the unit error and the remedy.
fn sentence(found: &Finding) -> String {
    let told: Vec<String> = found
        .contradictions
        .iter()
        .take(NAMED)
        .map(quantity)
        .collect();
    let advice = found.unit_error.map_or_else(
        || String::from("check the units of time, positions and torques: they must be SI units"),
        UnitError::advice,
    );
    format!("implausible: {}; {advice}", told.join(", "))
}

/// A quantity with its bound.
fn quantity(one: &Quantity) -> String {
    let with_unit = |value: f64| {
        let value = significant(value, 3);
        if one.unit.is_empty() {
            value
        } else {
            format!("{value} {}", one.unit)
        }
    };
    let bound = if one.value > one.possible.high {
        format!("at most {}", with_unit(one.possible.high))
    } else {
        format!("at least {}", with_unit(one.possible.low))
    };
    format!(
        "{} of {} ({bound})",
        one.name.trim_start_matches("the "),
        with_unit(one.value)
    )
}
