//! Revolute axes of a leg that meet in one point: the centre of a shoulder, wrist or universal
//! joint.
//!
//! For such an axis o, the partial velocity of a body's origin O is o × (O - S), with S the centre.
//! The generalised force of a wrench (f, m) is o · (m + (O - S) × f): the moment about the centre,
//! which all axes through it share. For three axes this takes fewer operations than three partial
//! velocities along the leg. For two axes it depends on the robot.

use super::rates::{Rates, parallel};
use crate::cas::Number;
use crate::mechanism::{JointKind, Leg};

/// A point in which revolute axes meet in every configuration.
#[derive(Debug, Clone, PartialEq)]
pub struct Centre {
    /// The joints of these axes, at least two, antecedents first.
    pub joints: Vec<usize>,
    /// Position of the centre on the first axis, from that joint's origin, m.
    pub offset: Number,
}

/// The centres of a leg. Each axis belongs to one centre at most: the one with most axes, the first
/// of equals.
#[must_use]
pub fn centres(leg: &Leg, rates: &Rates) -> Vec<Centre> {
    let mut candidates: Vec<Centre> = (0..leg.joints.len())
        .filter_map(|first| from_axis(leg, rates, first))
        .collect();
    // A stable sort keeps the first of equals first.
    candidates.sort_by_key(|c| std::cmp::Reverse(c.joints.len()));
    let mut centres: Vec<Centre> = Vec::new();
    for candidate in candidates {
        let taken = |j: &usize| centres.iter().any(|c| c.joints.contains(j));
        if !candidate.joints.iter().any(taken) {
            centres.push(candidate);
        }
    }
    centres
}

/// The axes after `first` that pass through the point where the next axis meets it.
fn from_axis(leg: &Leg, rates: &Rates, first: usize) -> Option<Centre> {
    let turns_alone = |j: usize| leg.joints[j].kind == JointKind::Revolute && rates.is_alone(j);
    if !turns_alone(first) {
        return None;
    }
    let mut centre: Option<Centre> = None;
    // Position of each joint's origin on its axis, from the centre.
    let mut along: Vec<Option<Number>> = vec![None; leg.joints.len()];
    for (index, joint) in leg.joints.iter().enumerate().skip(first + 1) {
        let Some(antecedent) = joint.antecedent else {
            continue;
        };
        let meets = turns_alone(index) && joint.d.is_zero() && parallel(joint.alpha).is_none();
        let offset = match &centre {
            None if antecedent == first => joint.b,
            None => continue,
            Some(centre) => centre.offset,
        };
        let origin = if antecedent == first {
            Some(-offset)
        } else {
            along[antecedent]
        };
        let passes = origin.is_some_and(|origin| (origin + joint.b).is_zero());
        if meets && passes {
            let centre = centre.get_or_insert_with(|| Centre {
                joints: vec![first],
                offset,
            });
            centre.joints.push(index);
            along[index] = Some(joint.r);
        }
    }
    centre
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Source, mechanism};

    fn of(robot: &str) -> Vec<Vec<usize>> {
        let path = format!("{}/../robots/{robot}.toml", env!("CARGO_MANIFEST_DIR"));
        let text = std::fs::read_to_string(path).unwrap();
        let description = overact_description::parse(&Source::new(robot, text)).unwrap();
        let mechanism = mechanism::check(&description).unwrap();
        let leg = &mechanism.legs[0];
        let rates = Rates::new(leg, mechanism.platform.is_some());
        centres(leg, &rates).into_iter().map(|c| c.joints).collect()
    }

    #[test]
    fn shoulder_and_wrist_centres_of_a_seven_axis_arm_are_found() {
        assert_eq!(of("kuka_lwr"), [[0, 1, 2], [4, 5, 6]]);
    }

    #[test]
    fn parallel_and_skew_axes_have_no_common_centre() {
        assert_eq!(of("dualv"), Vec::<Vec<usize>>::new());
        assert_eq!(of("rx90"), [vec![3, 4, 5], vec![0, 1]]);
    }
}
