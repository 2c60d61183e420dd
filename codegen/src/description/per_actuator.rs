//! Lists with a value for each actuator.

use super::dimension::Dimension;
use super::model::JointKind;
use super::parameter::dimension;
use super::reader::Item;
use super::scope::Scope;
use overact_core::StandardParameter;

/// Torque or force of an actuator.
pub(super) fn effort(kind: JointKind) -> Dimension {
    dimension(StandardParameter::Fs, kind)
}

/// One value for all actuators, or a list with one for each.
pub(super) fn per_actuator(
    item: &Item<'_, '_>,
    kinds: &[JointKind],
    dimension: fn(JointKind) -> Dimension,
    scope: &Scope,
) -> Option<Vec<f64>> {
    let items = if item.value.is_array() {
        item.list()?
    } else {
        vec![item.clone(); kinds.len()]
    };
    if items.len() != kinds.len() {
        let message = format!(
            "`{}`: expected one value or {}, one for each actuator, found {}",
            item.key.value,
            kinds.len(),
            items.len()
        );
        item.context.report(item.error(message));
        return None;
    }
    let pairs = items.iter().zip(kinds);
    let values: Vec<_> = pairs
        .map(|(item, kind)| item.not_negative(dimension(*kind), scope))
        .collect();
    values.into_iter().collect()
}
