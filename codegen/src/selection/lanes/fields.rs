//! The numbers of a leg in which a leg of the same kind may differ, in an order of their own.

use crate::cas::{Angle, Number};
use crate::mechanism::{End, Leg};

/// Lengths.
pub(super) fn numbers(leg: &mut Leg) -> Vec<&mut Number> {
    let mut numbers: Vec<&mut Number> = leg.base.at.iter_mut().collect();
    match &mut leg.end {
        Some(End::Rigid(placement)) => numbers.extend(&mut placement.at),
        Some(End::Point { at, .. }) => numbers.extend(at),
        None => {}
    }
    for joint in &mut leg.joints {
        numbers.extend([&mut joint.b, &mut joint.d, &mut joint.r]);
    }
    numbers
}

/// Angles.
pub(super) fn angles(leg: &mut Leg) -> Vec<&mut Angle> {
    let mut angles: Vec<&mut Angle> = leg.base.rotation.iter_mut().collect();
    if let Some(End::Rigid(placement)) = &mut leg.end {
        angles.extend(&mut placement.rotation);
    }
    for joint in &mut leg.joints {
        angles.extend([&mut joint.gamma, &mut joint.alpha, &mut joint.theta]);
    }
    angles
}
