//! Known values of a robot's parameters.

use super::base::BaseParameter;
use crate::derivation::{BodyParameter, Selection};
use crate::mechanism::Mechanism;
use std::collections::BTreeMap;

/// Parameter values for the functions: base parameters with all that is regrouped into them, and
/// the payload.
///
/// All others are zero, since torques determine regrouped parameters only. Missing values are zero.
pub(crate) fn regrouped(
    mechanism: &Mechanism,
    selection: &Selection,
    base: &[BaseParameter],
    given: &BTreeMap<String, f64>,
) -> Vec<(BodyParameter, f64)> {
    let value = |parameter: BodyParameter| {
        let value = given.get(&parameter.name(mechanism));
        value.copied().unwrap_or_default()
    };
    let of_base = base.iter().map(|one| {
        let others = one.regrouped.iter();
        let others = others.map(|&(other, coefficient)| coefficient * value(other));
        (one.parameter, value(one.parameter) + others.sum::<f64>())
    });
    let of_payload = selection.payload.iter().map(|&one| (one, value(one)));
    of_base.chain(of_payload).collect()
}
