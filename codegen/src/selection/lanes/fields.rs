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

/// What the numbers are called, in the same order.
pub(super) fn names_of_numbers(leg: &Leg) -> Vec<String> {
    let axes = |of: &str| ["x", "y", "z"].map(|axis| format!("{axis} of {of}"));
    let of_joint = |name: &str| ["b", "d", "r"].map(|own| format!("{own} of `{name}`"));
    let ends = leg.end.iter().flat_map(|_| axes("the end"));
    let joints = leg.joints.iter().flat_map(|joint| of_joint(&joint.name));
    axes("the base")
        .into_iter()
        .chain(ends)
        .chain(joints)
        .collect()
}

/// What the angles are called, in the same order.
pub(super) fn names_of_angles(leg: &Leg) -> Vec<String> {
    let axes = |of: &str| ["x", "y", "z"].map(|axis| format!("turn of {of} about {axis}"));
    let of_joint = |name: &str| ["gamma", "alpha", "theta"].map(|own| format!("{own} of `{name}`"));
    let end = leg.end.iter().filter(|end| matches!(end, End::Rigid(_)));
    let ends = end.flat_map(|_| axes("the end"));
    let joints = leg.joints.iter().flat_map(|joint| of_joint(&joint.name));
    axes("the base")
        .into_iter()
        .chain(ends)
        .chain(joints)
        .collect()
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
