//! Conversion of joints with several axes to joints with one axis.

use crate::robot::joint_shape::JointShape;
use crate::robot::joint_shape::compound_kind::{Axis, CompoundJointKind};
use crate::robot::model::{JointKind, Spanned};
use overact_core::StandardParameter;

/// Splits a joint into its axes.
///
/// `first` is its table, with the parameters of the last body; `at` is the index of the first axis
/// in the leg.
pub(crate) fn split<'c, 't>(
    word: CompoundJointKind,
    first: JointShape<'c, 't>,
    at: usize,
) -> Vec<JointShape<'c, 't>> {
    let axes = word.axes();
    if axes.is_empty() {
        return vec![first];
    }
    let (name, span) = (first.name.clone(), first.span.clone());
    let (parameters, kind) = (first.parameters.clone(), first.kind.clone());
    let own = |axis: &Axis| match axis.0 {
        "" => name.clone(),
        ending => Spanned::new(format!("{}_{ending}", name.value), name.span.clone()),
    };
    // Intermediate axes have friction, but no mass.
    let between = |axis: &Axis| -> Vec<StandardParameter> {
        let of_joint = parameters.iter().copied().filter(|p| !p.is_inertial());
        match axis.1 {
            JointKind::Fixed => Vec::new(),
            _ if word == CompoundJointKind::Helical => Vec::new(),
            _ => of_joint.collect(),
        }
    };
    let mut joints = vec![first];
    for (place, axis) in axes.iter().enumerate().skip(1) {
        joints.push(JointShape {
            name: own(axis),
            kind: Spanned::new(axis.1, kind.span.clone()),
            antecedent: (at + place).checked_sub(1),
            steps: [const { None }; 6],
            turned: axis.2,
            actuated: false,
            dependent: None,
            parameters: Vec::new(),
            spring: None,
            known: None,
            stribeck: None,
            load: None,
            pitch: None,
            word,
            called: name.value.clone(),
            span: span.clone(),
        });
    }
    let last = joints.len() - 1;
    for (place, (joint, axis)) in joints.iter_mut().zip(axes).enumerate() {
        joint.name = own(axis);
        joint.parameters = if place == last {
            parameters.clone()
        } else {
            between(axis)
        };
    }
    if let (CompoundJointKind::Helical, [slide, turn]) = (word, joints.as_mut_slice()) {
        turned(slide, turn);
    }
    joints
}

/// Moves the keys about the motion of a helical joint to its rotation; the slide keeps the
/// geometry.
fn turned<'c, 't>(slide: &mut JointShape<'c, 't>, turn: &mut JointShape<'c, 't>) {
    turn.steps[4] = slide.steps[4].take();
    turn.actuated = std::mem::take(&mut slide.actuated);
    turn.dependent = slide.dependent.take();
    turn.spring = slide.spring.take();
    turn.known = slide.known.take();
    turn.stribeck = slide.stribeck.take();
    turn.load = slide.load.take();
}
