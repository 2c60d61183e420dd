//! Lists with one value per actuator or coordinate.

use crate::diagnostic::Code;
use crate::expressions::dimension::Dimension;
use crate::robot::model::JointKind;
use crate::toml_text::reader::Item;
use crate::toml_text::scope::Scope;
use overact_core::StandardParameter;

/// Dimension of an actuator's torque or force.
pub(crate) fn effort(kind: JointKind) -> Dimension {
    Dimension::of_parameter(StandardParameter::Fs, kind == JointKind::Prismatic)
}

/// One value for all actuators, or a list with one per actuator.
pub(crate) fn per_actuator(
    item: &Item<'_, '_>,
    kinds: &[JointKind],
    dimension: fn(JointKind) -> Dimension,
    scope: &Scope,
) -> Option<Vec<f64>> {
    let dimensions: Vec<Dimension> = kinds.iter().map(|kind| dimension(*kind)).collect();
    one_or_each(item, &dimensions, "actuator", scope)
}

/// One value for all, or a list with one for each.
pub(crate) fn one_or_each(
    item: &Item<'_, '_>,
    dimensions: &[Dimension],
    what: &str,
    scope: &Scope,
) -> Option<Vec<f64>> {
    let items = if item.value.is_array() {
        item.list()?
    } else {
        vec![item.clone(); dimensions.len()]
    };
    if items.len() != dimensions.len() {
        let message = format!(
            "`{}`: expected one value or {}, one for each {what}, found {}",
            item.key.value,
            dimensions.len(),
            items.len()
        );
        item.context.report(item.error(Code::WRONG_COUNT, message));
        return None;
    }
    let pairs = items.iter().zip(dimensions);
    let values: Vec<_> = pairs
        .map(|(item, dimension)| item.not_negative(*dimension, scope))
        .collect();
    values.into_iter().collect()
}
