//! The functions of a robot, their inputs, and their names.

use crate::cas::Arena;
use crate::derivation::forward::closed_form::closed_form;
use crate::derivation::function_form::FunctionForm;
use crate::derivation::motion_input::MotionInput;
use crate::derivation::selection::JointsBy;
use crate::mechanism::Mechanism;
use overact_core::{Condition, Function};

/// All functions of a robot, in all forms.
#[must_use]
pub fn inventory(mechanism: &Mechanism, joints: JointsBy) -> Vec<FunctionForm> {
    let tree = mechanism.is_tree();
    let payload = mechanism
        .platform
        .as_ref()
        .is_some_and(|p| p.payload.is_some());
    let closed = closed_form(&Arena::new(), mechanism).is_some();
    let has = |function: &Function| match function.condition() {
        Condition::Platform => !tree,
        Condition::Redundancy => mechanism.actuated().len() > mechanism.dof(),
        Condition::Payload => payload,
        Condition::ClosedForm => closed,
        Condition::NumericJoints => joints == JointsBy::Newton,
        Condition::Parasitic => mechanism.is_parasitic(),
        Condition::JointsByRule => !tree && joints == JointsBy::Rule,
        _ => true,
    };
    let with = |function| {
        sources(function, tree)
            .iter()
            .map(move |&from| FunctionForm { function, from })
    };
    Function::ALL
        .into_iter()
        .filter(has)
        .flat_map(with)
        .collect()
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

/// The name of the Rust function, unique in the robot.
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
    use super::{JointsBy, inventory};
    use crate::mechanism::check;
    use overact_core::{Condition, Function};
    use overact_description::diagnostic::Source;

    /// Whether a robot of the library has the functions of a condition: all or none.
    fn has(description: &str, condition: Condition) -> bool {
        let source = Source::new("robot.toml", description);
        let description = overact_description::parse(&source).expect("a right description");
        let mechanism = check(&description).expect("a right mechanism");
        let offered = inventory(&mechanism, JointsBy::Rule);
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
    fn functions_of_redundancy_are_those_of_redundant_robots() {
        let dualv = include_str!("../../../../robots/dualv.toml");
        assert!(has(dualv, Condition::Redundancy));
        // As many actuators as coordinates: a closure, and no internal torques.
        let five_bar = include_str!("../../../../robots/five_bar.toml");
        assert!(has(five_bar, Condition::Platform));
        assert!(!has(five_bar, Condition::Redundancy));
    }
}
