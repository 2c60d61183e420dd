//! Which functions of a robot are wanted, by name or by what they are for, and what those need.
//!
//! A controller takes a few functions of dozens. Names are those of the generated functions, those of the
//! table of functions (which may stand for several forms), or of a [`Group`]. What a function calls comes
//! along: forward kinematics with what it iterates on, Newton's method with the closure of the legs.

use crate::derivation::{JointsBy, MotionInput, function_name, sources};
use crate::diagnostic::did_you_mean;
use crate::mechanism::Mechanism;
use overact_core::{Columns, Condition, Function};
use std::collections::BTreeSet;
use std::fmt;

/// The name of forward kinematics, which is no function of the table: it iterates.
const FORWARD: &str = "pose_from_actuators";

/// Functions for one purpose.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Group {
    /// Pose from actuators, twist, inverse dynamics with internal torques, mass matrix and bias.
    Control,
    /// What `overact::Model` is asked for, and all forms of the identification models from the pose.
    Identification,
    /// Positions, rates and Jacobians, in all forms.
    Kinematics,
}

impl Group {
    /// All.
    pub const ALL: [Self; 3] = [Self::Control, Self::Identification, Self::Kinematics];

    /// The name in attributes and on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Control => "control",
            Self::Identification => "identification",
            Self::Kinematics => "kinematics",
        }
    }

    fn has(self, mechanism: &Mechanism, function: Function, from: MotionInput) -> bool {
        let is_plain = from == plain(mechanism);
        match self {
            Self::Control => is_plain && is_for_control(function),
            Self::Identification => {
                let is_model =
                    function.columns().is_some() || function == Function::ProjectActuators;
                serves_model(mechanism, function, from) || (is_plain && is_model)
            }
            Self::Kinematics => is_kinematic(function),
        }
    }
}

const fn is_for_control(function: Function) -> bool {
    matches!(
        function,
        Function::ActuatorPositions
            | Function::InverseJacobian
            | Function::TwistFromActuators
            | Function::InverseDynamics(Columns::Standard)
            | Function::InverseDynamicsPreloaded
            | Function::MassMatrix(Columns::Standard)
            | Function::Bias(Columns::Standard)
            | Function::ProjectTorques
            | Function::NullSpace
    )
}

const fn is_kinematic(function: Function) -> bool {
    matches!(
        function,
        Function::PoseInClosedForm
            | Function::Joints
            | Function::ActuatorPositions
            | Function::InverseJacobian
            | Function::Jacobian
            | Function::LegsJacobian
            | Function::LegsPlatformJacobian
            | Function::ClosurePlatformJacobian
            | Function::ClosureActuatorJacobian
            | Function::ClosureError
            | Function::PlatformJacobian
            | Function::BlockedError
            | Function::BlockedJacobian
            | Function::JointVelocities
            | Function::JointAccelerations
            | Function::TwistFromActuators
            | Function::AccelerationFromActuators
    )
}

/// From what functions are evaluated that are given plain states.
fn plain(mechanism: &Mechanism) -> MotionInput {
    match mechanism.is_tree() {
        false => MotionInput::Pose,
        true => MotionInput::Joints,
    }
}

/// Whether identification and simulation ask a model for a function, or it serves to find pose and joints.
#[must_use]
pub fn serves_model(mechanism: &Mechanism, function: Function, from: MotionInput) -> bool {
    match function {
        Function::PoseInClosedForm => true,
        Function::ClosureError | Function::LegsJacobian | Function::ClosureActuatorJacobian => {
            from == MotionInput::Joints
        }
        Function::Jacobian
        | Function::LegsPlatformJacobian
        | Function::ClosurePlatformJacobian
        | Function::IdmRedPlatform(Columns::Base)
        | Function::IdmRedActuators(_)
        | Function::IdmRedPayloadActuators
        | Function::ProjectActuators
        | Function::InverseDynamics(Columns::Base)
        | Function::MassMatrix(Columns::Base)
        | Function::Bias(_)
        | Function::ForwardDynamics(Columns::Base)
        | Function::InverseDynamicsPreloaded => false,
        _ => from == plain(mechanism),
    }
}

/// What a name stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Meant {
    Group(Group),
    Forward,
    /// The function of exactly this name.
    Form(Function, MotionInput),
    /// A function of the table in all its forms.
    Forms(Function),
}

/// A name that no function of any robot has.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnknownFunction {
    /// Its place in the list that was given.
    pub index: usize,
    /// The name.
    pub name: String,
    /// A way out.
    pub help: String,
}

impl fmt::Display for UnknownFunction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "no robot has a function `{}`", self.name)
    }
}

/// Functions that are wanted.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Choice {
    names: Vec<String>,
}

impl Choice {
    /// Functions by their names, and groups.
    ///
    /// # Errors
    /// All names that no robot's function has; an empty list, which would leave nothing, as one of an empty
    /// name.
    pub fn new<'a>(names: impl IntoIterator<Item = &'a str>) -> Result<Self, Vec<UnknownFunction>> {
        let names: Vec<String> = names
            .into_iter()
            .map(|name| name.trim().to_owned())
            .collect();
        let mut unknown = Vec::new();
        for (index, name) in names.iter().enumerate() {
            if meant(name, true).is_none() && meant(name, false).is_none() {
                unknown.push(UnknownFunction {
                    index,
                    name: name.clone(),
                    help: help(name),
                });
            }
        }
        if names.is_empty() {
            unknown.push(UnknownFunction {
                index: 0,
                name: String::new(),
                help: help(""),
            });
        }
        match unknown.is_empty() {
            true => Ok(Self { names }),
            false => Err(unknown),
        }
    }

    /// The names as they were given.
    #[must_use]
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// The functions of a robot with this inventory that are wanted, and what they need.
    ///
    /// # Errors
    /// A sentence for each name that this robot has no function for.
    pub(crate) fn of_robot(
        &self,
        mechanism: &Mechanism,
        joints: JointsBy,
        inventory: &[(Function, MotionInput)],
    ) -> Result<Chosen, Vec<String>> {
        let tree = mechanism.is_tree();
        let mut chosen = Chosen::default();
        let mut missing = Vec::new();
        for name in &self.names {
            let found = meant(name, tree);
            chosen.forward |= matches!(found, Some(Meant::Group(_) | Meant::Forward));
            let is_wanted = |&&(function, from): &&(Function, MotionInput)| match found {
                Some(Meant::Group(group)) => group.has(mechanism, function, from),
                Some(Meant::Form(f, source)) => f == function && from == source,
                Some(Meant::Forms(f)) => f == function,
                Some(Meant::Forward) | None => false,
            };
            let mut wanted = inventory.iter().filter(is_wanted).peekable();
            let is_several = matches!(found, Some(Meant::Group(_) | Meant::Forward));
            if wanted.peek().is_none() && !is_several {
                let reason = found
                    .or_else(|| meant(name, !tree))
                    .map_or("", |m| reason(m, tree));
                missing.push(format!("has no function `{name}`{reason}"));
            }
            chosen.functions.extend(wanted);
        }
        if !missing.is_empty() {
            return Err(missing);
        }
        chosen.complete(mechanism, joints, inventory);
        Ok(chosen)
    }
}

/// The functions of a robot that are generated.
#[derive(Debug, Clone, Default)]
pub(crate) struct Chosen {
    /// The functions.
    pub(crate) functions: BTreeSet<(Function, MotionInput)>,
    /// Whether forward kinematics is among them.
    pub(crate) forward: bool,
    /// Whether all are among them that `overact::Model` is asked for.
    pub(crate) is_model: bool,
}

impl Chosen {
    /// All of an inventory.
    pub(crate) fn all(inventory: &[(Function, MotionInput)]) -> Self {
        Self {
            functions: inventory.iter().copied().collect(),
            forward: true,
            is_model: true,
        }
    }

    /// Adds what the functions call.
    fn complete(
        &mut self,
        mechanism: &Mechanism,
        joints: JointsBy,
        inventory: &[(Function, MotionInput)],
    ) {
        let is_found = |(function, from): &(Function, MotionInput)| {
            *from == MotionInput::Actuators && *function != Function::PoseInClosedForm
        };
        self.forward |= self.functions.iter().any(is_found);
        let mut needed = Vec::new();
        if self.forward && !mechanism.is_tree() {
            needed.extend([
                (Function::ActuatorPositions, MotionInput::Pose),
                (Function::InverseJacobian, MotionInput::Pose),
                (Function::PoseInClosedForm, MotionInput::Actuators),
                (Function::BlockedError, MotionInput::Pose),
                (Function::BlockedJacobian, MotionInput::Pose),
            ]);
        }
        let from_pose = |one: &(Function, MotionInput)| one.1 != MotionInput::Joints;
        let iterates = self.forward || self.functions.iter().any(from_pose);
        if joints == JointsBy::Newton && iterates {
            needed.extend([
                (Function::Joints, MotionInput::Pose),
                (Function::ClosureError, MotionInput::Joints),
                (Function::LegsJacobian, MotionInput::Joints),
            ]);
        }
        let has = |one: &(Function, MotionInput)| inventory.contains(one);
        self.functions.extend(needed.into_iter().filter(has));
        let mut served = inventory.iter();
        self.is_model = self.forward
            && served.all(|&(function, from)| {
                let one = (function, from);
                !serves_model(mechanism, function, from) || self.functions.contains(&one)
            });
    }
}

/// All names that a function has in a robot with or without platform.
fn meant(name: &str, tree: bool) -> Option<Meant> {
    if let Some(group) = Group::ALL.into_iter().find(|group| group.name() == name) {
        return Some(Meant::Group(group));
    }
    if name == FORWARD {
        return Some(Meant::Forward);
    }
    for function in Function::ALL {
        for &from in sources(function, tree) {
            if function_name(function, from, tree) == name {
                return Some(Meant::Form(function, from));
            }
        }
    }
    // Forms of both columns have one name; those of standard ones come first.
    let found = Function::ALL.into_iter().find(|f| f.name() == name)?;
    Some(Meant::Forms(found))
}

/// A name that is near, or all groups and where the names are.
fn help(name: &str) -> String {
    let groups = Group::ALL.map(Group::name);
    let functions = Function::ALL.into_iter().flat_map(|function| {
        let names = sources(function, false).iter();
        names.map(move |&from| function_name(function, from, false))
    });
    let functions: Vec<String> = functions.collect();
    let table = Function::ALL.map(Function::name);
    let known = groups.into_iter().chain([FORWARD]);
    let known = known
        .chain(functions.iter().map(String::as_str))
        .chain(table);
    did_you_mean(name, known).unwrap_or_else(|| {
        format!(
            "name functions as `overact inspect` lists them, or a group: {}",
            groups.map(|group| format!("`{group}`")).join(", ")
        )
    })
}

/// Why a robot has not got a function.
fn reason(meant: Meant, tree: bool) -> &'static str {
    let (Meant::Form(function, _) | Meant::Forms(function)) = meant else {
        return "";
    };
    match function.condition() {
        Condition::Platform if tree => ": that is one of robots with a platform",
        Condition::Redundancy => {
            ": that is one of robots with more actuators than degrees of freedom"
        }
        Condition::Payload => ": that is one of robots with a `[platform.payload]`",
        Condition::ClosedForm => ": no rule gives its pose from the actuators",
        Condition::NumericJoints => ": its joints are found without closure errors",
        Condition::Parasitic => {
            ": that is one of robots whose platform has `independent` coordinates"
        }
        _ if function.columns().is_some() => {
            ": where the parameters are known there are no identification models"
        }
        _ => "",
    }
}

#[cfg(test)]
mod tests {
    use super::{Choice, Group, Meant, meant};
    use overact_core::Function;

    #[test]
    fn names_of_functions_and_groups_are_known() {
        let names = [
            "control",
            "inverse_dynamics",
            "idm_red_platform_base_from_joints",
            "legs_jacobian",
            "pose_from_actuators",
        ];
        assert_eq!(Choice::new(names).expect("known").names(), names);
        assert_eq!(
            meant("kinematics", true),
            Some(Meant::Group(Group::Kinematics))
        );
        assert!(matches!(
            meant("joints", false),
            Some(Meant::Form(Function::Joints, _))
        ));
    }

    #[test]
    fn all_unknown_names_are_told_with_what_was_meant() {
        let unknown = Choice::new(["inverse_dynamic", "joints", "nonsense", ""]).expect_err("two");
        let told: Vec<(usize, &str)> = unknown.iter().map(|u| (u.index, u.help.as_str())).collect();
        assert_eq!(told.len(), 3);
        assert_eq!(told[0], (0, "did you mean `inverse_dynamics`?"));
        assert_eq!(told[1].0, 2);
        assert!(told[1].1.contains("`control`"), "{}", told[1].1);
        assert_eq!(Choice::new([]).expect_err("nothing").len(), 1);
    }
}
