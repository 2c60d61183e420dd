//! The errors of a robot as an `enum`: one for each leg, input and condition, so that a number
//! identifies the error. Their texts begin like those of the Rust functions.

use super::lines::string;
use super::naming::Naming;
use crate::lowering::Condition;
use crate::model::RobotModel;
use overact_core::ActuatorGroup;
use std::collections::BTreeSet;

/// An error: enumerator without prefix, and its text.
struct ErrorEntry {
    name: String,
    text: String,
}

/// Inputs of functions, in the order of their error numbers.
const INPUTS: [&str; 15] = [
    "pose",
    "joints",
    "twist",
    "acceleration",
    "joint_velocities",
    "joint_accelerations",
    "actuators",
    "actuator_velocities",
    "actuator_accelerations",
    "torques",
    "parameters",
    "preload",
    "start",
    "inverse_jacobian",
    "base_parameters",
];

/// All errors of a robot's functions.
///
/// The numbers depend on the robot only, not on which functions are generated.
fn kinds(model: &RobotModel) -> Vec<ErrorEntry> {
    let kind = |name: &str, text: &str| ErrorEntry {
        name: name.to_owned(),
        text: text.to_owned(),
    };
    let determine = "do not determine the platform's motion here";
    let mut kinds = vec![
        kind("OK", "no error"),
        kind("SINGULAR_ACTUATORS", &format!("the actuators {determine}")),
        kind(
            "SINGULAR_KEPT_ACTUATORS",
            &format!("the kept actuators {determine}"),
        ),
        kind(
            "SINGULAR_PARTITION",
            &format!("the given kept actuators {determine}"),
        ),
        kind("NO_ACTUATOR", "there is no actuator of this number"),
        kind("NO_CONVERGENCE", "the forward kinematics did not converge"),
        kind("MASS_MATRIX", "the mass matrix is not positive definite"),
    ];
    for input in ["pose", "start"] {
        kinds.push(ErrorEntry {
            name: format!("ZERO_QUATERNION_{}", input.to_uppercase()),
            text: format!("the quaternion of `{input}` is zero, which is no rotation"),
        });
    }
    kinds.extend(INPUTS.iter().map(|input| ErrorEntry {
        name: not_finite(input),
        text: format!("`{input}` has a number that is not finite"),
    }));
    let legs = model.mechanism.legs.iter();
    for (leg, name) in legs.clone().zip(leg_constants(model)) {
        kinds.push(ErrorEntry {
            name: format!("OUT_OF_REACH_{name}"),
            text: format!("the pose is out of reach of leg `{}`", leg.name),
        });
        kinds.push(ErrorEntry {
            name: format!("SINGULAR_LEG_{name}"),
            text: format!("leg `{}` is singular here", leg.name),
        });
    }
    if model.mechanism.has_dependent_coordinates() {
        kinds.push(kind(
            "SINGULAR_COORDINATES",
            "the independent coordinates do not determine the others here",
        ));
        kinds.extend(
            legs.zip(leg_constants(model))
                .map(|(leg, name)| ErrorEntry {
                    name: format!("NOT_CLOSED_{name}"),
                    text: format!("leg `{}` does not allow the pose", leg.name),
                }),
        );
    }
    if model.mechanism.has_cables() {
        kinds.push(kind(
            "TENSIONS",
            "no tensions above the minima of the cables produce this motion",
        ));
    }
    kinds.push(kind("OVERFLOW", "a value is too large for a number"));
    kinds.extend(INPUTS.iter().map(|input| ErrorEntry {
        name: out_of_range(input),
        text: format!(
            "`{input}` has a number that is too large: values computed from it might overflow"
        ),
    }));
    kinds.push(ErrorEntry {
        name: not_finite("inputs"),
        text: "`inputs` has a number that is not finite".to_owned(),
    });
    if !model.mechanism.frames.is_empty() {
        kinds.push(kind(
            &not_finite("wrench"),
            "`wrench` has a number that is not finite",
        ));
        kinds.push(kind(
            &out_of_range("wrench"),
            "`wrench` has a number that is too large: values computed from it might overflow",
        ));
    }
    kinds
}

/// The enumerator of an input that is too large, without prefix.
#[must_use]
pub fn out_of_range(input: &str) -> String {
    format!("OUT_OF_RANGE_{}", input.to_uppercase())
}

/// The enumerator of an input that is not finite, without prefix.
#[must_use]
pub fn not_finite(input: &str) -> String {
    format!("NOT_FINITE_{}", input.to_uppercase())
}

/// Names of the legs in capitals; legs whose names differ in case only get numbers.
#[must_use]
pub fn leg_constants(model: &RobotModel) -> Vec<String> {
    let mut taken = BTreeSet::new();
    let legs = model.mechanism.legs.iter();
    let name = |leg: &crate::mechanism::Leg| {
        let plain = leg.name.to_uppercase();
        let mut name = plain.clone();
        let mut count = 1;
        while !taken.insert(name.clone()) {
            count += 1;
            name = format!("{plain}_{count}");
        }
        name
    };
    legs.map(name).collect()
}

/// Name of a leg in capitals.
fn leg_constant(model: &RobotModel, leg: &str) -> String {
    let at = model.mechanism.legs.iter().position(|l| l.name == leg);
    let name = at.and_then(|at| leg_constants(model).into_iter().nth(at));
    name.unwrap_or_default()
}

/// The enumerator of a singular leg, without prefix.
#[must_use]
pub fn singular_leg(model: &RobotModel, leg: &str) -> String {
    format!("SINGULAR_LEG_{}", leg_constant(model, leg))
}

/// The enumerator of a violated condition, without prefix.
#[must_use]
pub fn of_condition(model: &RobotModel, condition: &Condition) -> String {
    let leg = |leg: &str| leg_constant(model, leg);
    match condition {
        Condition::Reach { leg: name, .. } => format!("OUT_OF_REACH_{}", leg(name)),
        Condition::Leg { leg: name, .. } => singular_leg(model, name),
        Condition::Closed { leg: name, .. } => format!("NOT_CLOSED_{}", leg(name)),
        Condition::Coordinates { .. } => "SINGULAR_COORDINATES".to_owned(),
        Condition::Mass => "MASS_MATRIX".to_owned(),
        Condition::Size { .. } => "OVERFLOW".to_owned(),
        Condition::Platform { actuators, .. } => match actuators {
            ActuatorGroup::All => "SINGULAR_ACTUATORS".to_owned(),
            ActuatorGroup::Kept => "SINGULAR_KEPT_ACTUATORS".to_owned(),
        },
    }
}

/// The `enum`, and the declaration of the function that returns the texts.
#[must_use]
pub fn declaration(model: &RobotModel, naming: &Naming) -> String {
    let kinds = kinds(model);
    let lines = kinds.iter().enumerate().map(|(at, kind)| {
        let comma = if at + 1 < kinds.len() { "," } else { "" };
        let name = naming.constant(&kind.name);
        format!("    {name} = {at}{comma} /**< {} */\n", kind.text)
    });
    let lines: String = lines.collect();
    let head = naming.apply(
        "/** Why a function has no value; 0 if it has one. If several legs fail, it names the first. */\n\
         typedef enum rob_error {\n",
    );
    let end = naming.apply(
        "} rob_error;\n\n\
         /** What an error means, in a sentence. */\n\
         const char *rob_error_text(rob_error error);\n\n",
    );
    format!("{head}{lines}{end}")
}

/// The function that returns the texts.
#[must_use]
pub fn definition(model: &RobotModel, naming: &Naming) -> String {
    let kinds = kinds(model);
    let texts = kinds.iter().enumerate().map(|(at, kind)| {
        let comma = if at + 1 < kinds.len() { "," } else { "" };
        format!("        {}{comma}\n", string(&kind.text))
    });
    let (texts, count): (String, usize) = (texts.collect(), kinds.len());
    let head = naming.apply("const char *rob_error_text(rob_error error)");
    format!(
        "{head}\n{{\n\
         \x20   static const char *const texts[{count}] = {{\n{texts}    }};\n\
         \x20   const int number = (int)error;\n\
         \x20   return ((number >= 0) && (number < {count})) ? texts[number] : \"no error of this robot\";\n\
         }}\n\n"
    )
}
