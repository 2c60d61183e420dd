//! The numbers by which legs of one kind may differ, in a fixed order.

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

/// Names of the numbers, in the same order.
pub(super) fn names_of_numbers(leg: &Leg) -> Vec<String> {
    let along = |axis: &str, of: &str| format!("{axis} of {of}");
    names(leg, leg.end.is_some(), along, ["b", "d", "r"])
}

/// Names of the angles, in the same order.
pub(super) fn names_of_angles(leg: &Leg) -> Vec<String> {
    let about = |axis: &str, of: &str| format!("turn of {of} about {axis}");
    let is_rigid = matches!(leg.end, Some(End::Rigid(_)));
    names(leg, is_rigid, about, ["gamma", "alpha", "theta"])
}

/// Three names for the base, for the end if it has them, and for each joint.
fn names(
    leg: &Leg,
    has_end: bool,
    of_axis: impl Fn(&str, &str) -> String,
    of_joint: [&str; 3],
) -> Vec<String> {
    let ends = ["the base", "the end"]
        .into_iter()
        .take(1 + usize::from(has_end));
    let ends = ends.flat_map(|of| ["x", "y", "z"].map(|axis| of_axis(axis, of)));
    let joints = leg.joints.iter().map(|joint| &joint.name);
    let joints = joints.flat_map(|name| of_joint.map(|own| format!("{own} of `{name}`")));
    ends.chain(joints).collect()
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

#[cfg(test)]
mod tests {
    use super::{angles, names_of_angles, names_of_numbers, numbers};
    use crate::mechanism::check;
    use overact_description::diagnostic::Source;

    #[test]
    fn every_number_and_angle_has_a_unique_name() {
        for text in [
            include_str!("../../../../robots/dualv.toml"),
            include_str!("../../../../robots/hexapod.toml"),
        ] {
            let description = overact_description::parse(&Source::new("a.toml", text));
            let mut leg = check(&description.expect("right")).expect("right").legs[0].clone();
            let names = [names_of_numbers(&leg), names_of_angles(&leg)];
            assert_eq!(names[0].len(), numbers(&mut leg).len());
            assert_eq!(names[1].len(), angles(&mut leg).len());
            let mut all = names.concat();
            all.sort();
            all.dedup();
            assert_eq!(all.len(), numbers(&mut leg).len() + angles(&mut leg).len());
        }
    }
}
