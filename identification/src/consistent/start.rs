//! Starting point of the search for a consistent estimate.

use nalgebra::DVector;

use super::unknowns::{UnknownKind, Unknowns};

/// Smallest distance of a bounded unknown from its bounds, by their distance.
const INSIDE: f64 = 0.1;

/// Prior values, with bounded ones moved inside their bounds.
pub(super) fn start(unknowns: &Unknowns) -> DVector<f64> {
    let mut values = DVector::zeros(unknowns.len());
    for group in &unknowns.groups {
        let mut own = values.rows_mut(group.first, group.len());
        match &group.kind {
            UnknownKind::Body { prior } => own.copy_from(prior),
            UnknownKind::Positive { prior } => own[0] = *prior,
            UnknownKind::Free { .. } => {}
        }
        for (k, [low, high]) in &group.bounds {
            let is_free = matches!(group.kind, UnknownKind::Free { .. });
            let low = if is_free { *low } else { low.max(0.0) };
            let inside = moved_inside(own[*k], low, *high);
            match &group.kind {
                // A body of the same shape with another mass.
                UnknownKind::Body { .. } => own *= inside / own[*k],
                _ => own[*k] = inside,
            }
        }
    }
    values
}

/// The nearest value with the required distance from the bounds.
fn moved_inside(value: f64, low: f64, high: f64) -> f64 {
    match (low.is_finite(), high.is_finite()) {
        (true, true) => {
            let margin = INSIDE * (high - low);
            value.max(low + margin).min(high - margin)
        }
        (true, false) => value.max(low + INSIDE * low.abs()),
        (false, true) => value.min(high - INSIDE * high.abs()),
        (false, false) => value,
    }
}
