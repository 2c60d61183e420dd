//! The functions of a robot, their inputs, and their names.

use crate::cas::Arena;
use crate::derivation::forward::closed_form::closed_form;
use crate::derivation::function_form::FunctionForm;
use crate::derivation::motion_input::MotionInput;
use crate::derivation::selection::{JointsBy, Selection};
use crate::mechanism::{Mechanism, StandardParameter};
use overact_core::{Condition, FrameFunction, FrameQuantity, Function};

/// All functions of a robot, in all forms.
#[must_use]
pub fn inventory(mechanism: &Mechanism, selection: &Selection) -> Vec<FunctionForm> {
    let joints = selection.joints;
    let tree = mechanism.is_tree();
    let payload = mechanism
        .platform
        .as_ref()
        .is_some_and(|p| p.payload.is_some());
    let payload = payload || !mechanism.payloads.is_empty();
    let closed = closed_form(&Arena::new(), mechanism).is_some();
    let has = |function: &Function| match function.condition() {
        Condition::Platform => !tree,
        Condition::Redundancy => mechanism.actuator_count() > mechanism.dof(),
        Condition::Payload => payload,
        Condition::ClosedForm => closed,
        Condition::NumericJoints => joints == JointsBy::Newton,
        Condition::Parasitic => mechanism.is_parasitic(),
        Condition::DependentJoints => mechanism.has_dependent_joints(),
        Condition::JointsByRule => !tree && joints == JointsBy::Rule,
        Condition::Masses => has_masses(selection),
        _ => true,
    };
    let with = |function| {
        sources(function, tree)
            .iter()
            .map(move |&from| FunctionForm { function, from })
    };
    let frames = 0..mechanism.frames.len();
    let of_frames = frames.flat_map(|frame| {
        let all = FrameQuantity::ALL.into_iter();
        all.map(move |quantity| Function::of_frame(frame, quantity))
    });
    let all = Function::ALL.into_iter().filter(has);
    all.chain(of_frames).flat_map(with).collect()
}

/// Whether a mass is among the parameters.
fn has_masses(selection: &Selection) -> bool {
    let mut all = selection.standard.iter().chain(&selection.payload);
    all.any(|parameter| parameter.symbol() == StandardParameter::M)
}

/// The motions from which a function is evaluated.
///
/// Functions that run at every sample of a log use all inputs that a log may contain; matrices of
/// the closure use joints.
#[must_use]
pub(crate) const fn sources(function: Function, tree: bool) -> &'static [MotionInput] {
    match function {
        Function::PoseInClosedForm => &[MotionInput::Actuators],
        _ if tree => &[MotionInput::Joints],
        Function::InverseJacobian => &[MotionInput::Pose, MotionInput::Joints],
        Function::LegsJacobian
        | Function::LegsPlatformJacobian
        | Function::ClosurePlatformJacobian
        | Function::ClosureActuatorJacobian
        | Function::ClosureError => &[MotionInput::Joints],
        Function::IdmRedPlatform(_)
        | Function::IdmRedActuators(_)
        | Function::IdmRedPayload
        | Function::InverseDynamics(_) => &[
            MotionInput::Pose,
            MotionInput::Joints,
            MotionInput::Actuators,
        ],
        _ => &[MotionInput::Pose],
    }
}

/// The name of a robot's Rust function, unique in the robot.
#[must_use]
pub fn name_in_robot(mechanism: &Mechanism, form: FunctionForm) -> String {
    let FunctionForm { function, from } = form;
    match function {
        Function::Frame(FrameFunction { frame, quantity }) => {
            let frame = mechanism.frames.get(frame).map_or("frame", |own| &own.name);
            format!("{frame}_{}", quantity.name())
        }
        _ => function_name(function, from, mechanism.is_tree()),
    }
}

/// The name of a Rust function of the table of functions.
#[must_use]
pub fn function_name(function: Function, from: MotionInput, tree: bool) -> String {
    let name = function.name();
    let base = if function.is_of_base_parameters() {
        "_base"
    } else {
        ""
    };
    let from = match from {
        MotionInput::Joints if !tree => "_from_joints",
        MotionInput::Actuators if function != Function::PoseInClosedForm => "_from_actuators",
        _ => "",
    };
    format!("{name}{base}{from}")
}

#[cfg(test)]
mod tests {
    use super::{Selection, inventory};
    use crate::mechanism::check;
    use overact_core::{Condition, Function};
    use overact_description::diagnostic::Source;

    /// Whether a robot of the library has the functions of a condition: all or none.
    fn has(description: &str, condition: Condition) -> bool {
        let source = Source::new("robot.toml", description);
        let description = overact_description::parse(&source).expect("a right description");
        let mechanism = check(&description).expect("a right mechanism");
        let offered = inventory(&mechanism, &Selection::default());
        let wanted = Function::ALL
            .into_iter()
            .filter(|f| f.condition() == condition);
        let found: Vec<bool> = wanted
            .map(|wanted| offered.iter().any(|form| form.function == wanted))
            .collect();
        assert!(!found.is_empty() && found.iter().all(|one| *one == found[0]));
        found[0]
    }

    #[test]
    fn redundancy_functions_are_offered_for_redundant_robots_only() {
        let dualv = include_str!("../../../../robots/dualv.toml");
        assert!(has(dualv, Condition::Redundancy));
        // As many actuators as coordinates: a closure, and no internal torques.
        let five_bar = include_str!("../../../../robots/five_bar.toml");
        assert!(has(five_bar, Condition::Platform));
        assert!(!has(five_bar, Condition::Redundancy));
    }
}
