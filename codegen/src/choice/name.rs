//! Meaning of function names.

use super::group::Group;
use crate::derivation::{FunctionForm, MotionInput, function_name, sources};
use overact_core::{Condition, FrameQuantity, Function};
use overact_description::diagnostic::did_you_mean;
use std::fmt;

/// Name of forward kinematics, which is not in the function table because it iterates.
const FORWARD: &str = "pose_from_actuators";

/// Meaning of a name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Meant {
    Group(Group),
    Forward,
    /// The function of exactly this name.
    Form(FunctionForm),
    /// A function of the function table in all its forms.
    Forms(Function),
    /// A function of a frame, if the robot has a frame of this name.
    OfFrame,
}

/// A name that no function of any robot has.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnknownFunction {
    /// Index in the given list.
    pub index: usize,
    /// The name.
    pub name: String,
    /// A remedy.
    pub help: String,
}

impl fmt::Display for UnknownFunction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "no robot has a function `{}`", self.name)
    }
}

/// The meaning of a name, for a robot with or without a platform.
pub(super) fn meant(name: &str, tree: bool) -> Option<Meant> {
    if let Some(group) = Group::ALL.into_iter().find(|group| group.name() == name) {
        return Some(Meant::Group(group));
    }
    if name == FORWARD {
        return Some(Meant::Forward);
    }
    for function in Function::ALL {
        for &from in sources(function, tree) {
            if function_name(function, from, tree) == name {
                return Some(Meant::Form(FunctionForm { function, from }));
            }
        }
    }
    // Forms of both columns have one name; those with standard columns come first.
    let found = Function::ALL.into_iter().find(|f| f.name() == name);
    let of_frame = || FrameQuantity::in_name(name).map(|_| Meant::OfFrame);
    found.map(Meant::Forms).or_else(of_frame)
}

/// A similar name, or all groups and where the names are listed.
pub(super) fn help(name: &str) -> String {
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

/// Why a robot does not have a function.
pub(super) fn reason(meant: Meant, tree: bool) -> &'static str {
    let (Meant::Form(FunctionForm { function, .. }) | Meant::Forms(function)) = meant else {
        return "";
    };
    if tree && matches!(meant, Meant::Form(form) if form.from == MotionInput::Joints) {
        return ": its joints are its pose, so use the function without `_from_joints`";
    }
    match function.condition() {
        Condition::Platform if tree => ": only robots with a platform have it",
        Condition::Redundancy => {
            ": only robots with more actuators than degrees of freedom have it"
        }
        Condition::Payload => ": only robots with a `[platform.payload]` have it",
        Condition::ClosedForm => ": its pose has no closed form in the actuators",
        Condition::NumericJoints => ": its joints are found without closure errors",
        Condition::Parasitic => {
            ": only robots whose platform has `independent` coordinates have it"
        }
        Condition::DependentJoints => ": only robots with `dependent` joints have it",
        Condition::Masses => ": none of its parameters is a mass",
        Condition::JointsByRule => {
            ": only robots with loops and closed-form joint positions have it"
        }
        _ if function.columns().is_some() => {
            ": with known parameters there are no identification models"
        }
        _ => "",
    }
}
