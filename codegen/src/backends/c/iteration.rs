//! Iterative functions: forward kinematics by Gauss-Newton, inverse kinematics by Newton's method,
//! and partitions of the actuator projection.
//!
//! They correspond to `overact::forward`, `overact::inverse` and `overact::partition`, operation by
//! operation. The Rust is in `codegen/src/emission/model_impl.rs` and `inverse.rs`. In the C texts,
//! `rob_` and `ROB_` are placeholders of the robot's prefix.

use super::errors;
use super::function::{has_quaternion, in_range, signature};
use super::lines::documentation;
use super::naming::Naming;
use crate::derivation::{JointsBy, MotionInput};
use crate::lowering::Array;
use crate::model::RobotModel;
use overact_core::Function;

const DISPLACE: &str = include_str!("text/displace.c");
const DISPLACE_FREELY: &str = include_str!("text/displace_freely.c");
const DISPLACE_PARASITIC: &str = include_str!("text/displace_parasitic.c");
const DISPLACE_JOINTS: &str = include_str!("text/displace_joints.c");
/// Solution of a square system, for both displacements of poses with dependent coordinates.
///
/// The placeholder `ROB_COUNT` is replaced by the macro of its size.
const ELIMINATE: &str = include_str!("text/eliminate.c");
const DISPLACE_QUATERNION: &str = include_str!("text/displace_quaternion.c");
/// Function called by both displacements of poses with a quaternion.
const TURN: &str = include_str!("text/turn.c");
const GAUSS_NEWTON: &str = include_str!("text/gauss_newton.c");
/// The loop around the steps that `rob_FIND` computes.
const STEPS: &str = include_str!("text/steps.c");
const FIT_POSE: &str = include_str!("text/fit_pose.c");
const FORWARD_OF_A_TREE: &str = "    for (int i = 0; i < ROB_POSE; i++) {
        output[i] = actuators[i];
    }
    return ROB_OK;
}
";

const FORWARD_START: &str = "    double pose[ROB_POSE];
    for (int i = 0; i < ROB_POSE; i++) {
        pose[i] = start[i];
    }
";

const FORWARD_START_QUATERNION: &str = "    double pose[ROB_POSE];
    if (!(rob_unit_quaternion(start, pose))) {
        return ROB_ZERO_QUATERNION_START;
    }
";

const FORWARD_START_PARASITIC: &str = "    const double still[ROB_DOF] = { 0.0 };
    double pose[ROB_POSE];
    if (!(rob_unit_quaternion(start, pose))) {
        return ROB_ZERO_QUATERNION_START;
    }
    rob_displace(pose, still);
";

const FORWARD_START_JOINTS: &str = "    const double still[ROB_DOF] = { 0.0 };
    double pose[ROB_POSE];
    for (int i = 0; i < ROB_POSE; i++) {
        pose[i] = start[i];
    }
    rob_displace(pose, still);
";

const FORWARD_BY_RULE: &str = "    rob_error error = rob_pose_in_closed_form(actuators, pose);
    if (error != ROB_OK) {
        error = rob_FIT(actuators, pose);
    }
";

const FORWARD_FROM_RULE: &str = "    double other[ROB_POSE];
    const int is_closed = (rob_pose_in_closed_form(actuators, other) == ROB_OK) ? 1 : 0;
    int is_near = is_closed;
    for (int i = 0; (i < ROB_POSE) && (is_near != 0); i++) {
        is_near = (fabs(other[i] - pose[i]) <= 0.01) ? 1 : 0;
    }
    for (int i = 0; (i < ROB_POSE) && (is_near != 0); i++) {
        const double closed = other[i];
        other[i] = pose[i];
        pose[i] = closed;
    }
    rob_error error = rob_FIT(actuators, pose);
    if ((error != ROB_OK) && (is_closed != 0)) {
        for (int i = 0; i < ROB_POSE; i++) {
            pose[i] = other[i];
        }
        error = rob_FIT(actuators, pose);
    }
";

const FORWARD: &str = "    const rob_error error = rob_FIT(actuators, pose);
";

const FORWARD_END: &str = "    if (error != ROB_OK) {
        return error;
    }
    for (int i = 0; i < ROB_POSE; i++) {
        output[i] = pose[i];
    }
    return ROB_OK;
}
";

const NEWTON: &str = include_str!("text/newton.c");
/// The placeholder `ROB_WAY` is replaced by the normalisation of the quaternion of an intermediate
/// pose.
const JOINTS: &str = include_str!("text/joints.c");
/// Normalises the quaternion of an intermediate pose.
const WAY_OF_A_QUATERNION: &str = "            {
                double *const q = &way[ROB_POSE - 4];
                const double norm = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
                for (int i = 0; i < 4; i++) {
                    q[i] /= norm;
                }
            }
";

const JOINTS_CHECKS_QUATERNION: &str = "    double unit_pose[ROB_POSE];
    if (!(rob_unit_quaternion(pose, unit_pose))) {
        return ROB_ZERO_QUATERNION_POSE;
    }
";

const PARTITION_TYPE: &str = include_str!("text/partition.h");
const PARTITION: &str = include_str!("text/partition.c");
/// Whether partitions of the actuator projection are written: for redundant robots with all
/// functions needed.
fn has_partitions(model: &RobotModel) -> bool {
    let is_redundant = model.mechanism.actuator_count() > model.mechanism.dof();
    let jacobian = model.function(Function::InverseJacobian, MotionInput::Pose);
    let regressor = model.function(
        Function::IdmRedPlatform(overact_core::Columns::Standard),
        MotionInput::Pose,
    );
    is_redundant && jacobian.is_some() && regressor.is_some()
}

/// The arguments of `pose_from_actuators`.
#[must_use]
pub fn forward_arguments(model: &RobotModel) -> [Array; 2] {
    let array = |name: &str, length: usize| Array {
        name: name.to_owned(),
        shape: vec![length],
    };
    let mechanism = &model.mechanism;
    [
        array("actuators", mechanism.actuator_count()),
        array("start", mechanism.pose_len()),
    ]
}

/// Declarations for the header.
#[must_use]
pub fn declarations(model: &RobotModel, naming: &Naming) -> String {
    let mut out = String::new();
    if model.forward_kinematics {
        let way = match closed_form(model) {
            ClosedForm::None => " It keeps the assembly mode of `start`.",
            ClosedForm::Alone => " It equals pose_in_closed_form if that succeeds.",
            ClosedForm::Start => {
                " The iteration starts from pose_in_closed_form if that is within 0.01 (m, rad) of `start`, otherwise from `start`, whose assembly mode it keeps. If that fails, the result is in the assembly mode of the home configuration."
            }
        };
        let lines = [
            format!("Forward kinematics: the pose that fits all actuators best by least squares, iterated from the pose `start`.{way}"),
            String::new(),
            format!("@param actuators q, positions of the {} (m, rad) (ROB_ACTUATORS)", model.mechanism.kind_of_actuators()),
            "@param start a pose near the wanted one, in its assembly mode (m, rad) (ROB_POSE)".to_owned(),
            "@param[out] output [ROB_POSE]".to_owned(),
            "@return 0, or an error: an input that is infinite, NaN or too large, no convergence, or a singular or unreachable configuration on the way.".to_owned(),
        ];
        out += &naming.apply(&documentation(&lines));
        let signature = signature("pose_from_actuators", &forward_arguments(model), naming);
        out += &format!("{signature};\n\n");
    }
    if has_partitions(model) {
        out += &naming.apply(PARTITION_TYPE);
    }
    out
}

/// Use of a closed form by forward kinematics.
#[derive(Clone, Copy, PartialEq, Eq)]
enum ClosedForm {
    /// No closed form.
    None,
    /// The pose itself, since there is no redundant actuator.
    Alone,
    /// The start, or restart, of the iteration.
    Start,
}

fn closed_form(model: &RobotModel) -> ClosedForm {
    let is_redundant = model.mechanism.actuator_count() > model.mechanism.dof();
    match model.function(Function::PoseInClosedForm, MotionInput::Actuators) {
        Some(_) if is_redundant => ClosedForm::Start,
        Some(_) => ClosedForm::Alone,
        None => ClosedForm::None,
    }
}

/// Definitions for the source file.
#[must_use]
pub fn definitions(model: &RobotModel, naming: &Naming) -> String {
    let mut parts = Vec::new();
    if model.selection.joints == JointsBy::Newton && has_joints(model) {
        parts.push(joints(model, naming));
    }
    if model.forward_kinematics {
        parts.push(forward(model, naming));
    }
    if has_partitions(model) {
        parts.push(naming.apply(PARTITION));
    }
    parts.join("\n")
}

fn has_joints(model: &RobotModel) -> bool {
    model
        .function(Function::Joints, MotionInput::Pose)
        .is_some()
}

fn forward(model: &RobotModel, naming: &Naming) -> String {
    let head = signature("pose_from_actuators", &forward_arguments(model), naming);
    let text = |parts: &[&str]| naming.apply(&parts.concat());
    let checks = [("actuators", "ACTUATORS"), ("start", "POSE")]
        .map(|(input, size)| in_range(input, &naming.constant(size), naming))
        .concat();
    let checks = format!("\n{{\n{checks}");
    if model.is_tree() {
        return format!("{head}{checks}{}", text(&[FORWARD_OF_A_TREE]));
    }
    let independent = model.mechanism.independent_coordinates();
    let eliminate = |count: &str| ELIMINATE.replace("ROB_COUNT", count);
    let (displace, start) = match (has_quaternion(model), &independent) {
        (true, Some(_)) => (
            [
                DISPLACE_FREELY,
                &eliminate("ROB_BLOCKED"),
                DISPLACE_PARASITIC,
            ]
            .concat(),
            FORWARD_START_PARASITIC,
        ),
        (false, Some(_)) => (
            [&eliminate("ROB_DEPENDENT"), DISPLACE_JOINTS].concat(),
            FORWARD_START_JOINTS,
        ),
        (true, None) => (DISPLACE_QUATERNION.to_owned(), FORWARD_START_QUATERNION),
        (false, None) => (DISPLACE.to_owned(), FORWARD_START),
    };
    let found = match closed_form(model) {
        ClosedForm::None => FORWARD,
        ClosedForm::Alone => FORWARD_BY_RULE,
        ClosedForm::Start => FORWARD_FROM_RULE,
    };
    let count = model.mechanism.velocity_len();
    let tables = independent.map_or_else(String::new, |own| coordinates(count, &own));
    let (fit, steps) = fitting(model);
    let turn = if has_quaternion(model) {
        [TURN, "\n"].concat()
    } else {
        String::new()
    };
    let displace = [tables.as_str(), &turn, &displace].concat();
    let helpers = text(&[&displace, "\n", GAUSS_NEWTON, "\n", &steps, "\n"]);
    let found = found.replace("rob_FIT", fit);
    let body = text(&[start, &found, FORWARD_END]);
    format!("{helpers}{head}{checks}{body}")
}

/// The function that fits a pose, and its text.
fn fitting(model: &RobotModel) -> (&'static str, String) {
    let steps = |name: &str, step: &str| STEPS.replace("LOOP", name).replace("FIND", step);
    let normal = steps("gauss_newton", "normal_step");
    match model.function(Function::PoseStep, MotionInput::Pose) {
        None => ("rob_gauss_newton", normal),
        Some(_) => {
            let at_once = steps("steps_at_once", "pose_step");
            ("rob_fit_pose", format!("{normal}\n{at_once}\n{FIT_POSE}"))
        }
    }
}

/// Tables of the independent and dependent ones of the `count` coordinates of a pose.
fn coordinates(count: usize, independent: &[usize]) -> String {
    let table = |name: &str, of: Vec<usize>| {
        let elements: Vec<String> = of.iter().map(ToString::to_string).collect();
        let (count, elements) = (elements.len(), elements.join(", "));
        format!("static const int rob_{name}[{count}] = {{ {elements} }};\n")
    };
    let others = (0..count).filter(|at| !independent.contains(at)).collect();
    table("independent", independent.to_vec()) + &table("dependent", others) + "\n"
}

/// Inverse kinematics by Newton's method, with its tables of the legs.
fn joints(model: &RobotModel, naming: &Naming) -> String {
    let mechanism = &model.mechanism;
    let mut first = vec!["0".to_owned()];
    let starts = (0..mechanism.legs.len()).map(|leg| mechanism.leg_range(leg).end.to_string());
    first.extend(starts);
    let legs = errors::leg_constants(model);
    let of_legs = |kind: &str| {
        let names = legs
            .iter()
            .map(|leg| naming.constant(&format!("{kind}_{leg}")));
        names.collect::<Vec<_>>().join(", ")
    };
    let count = legs.len();
    let table = |kind: &str, name: &str, count: usize, elements: &str| {
        let head = naming.apply(&format!("static const {kind} rob_{name}[{count}]"));
        format!("{head} = {{ {elements} }};\n")
    };
    let mut out = table("int", "first_joints", count + 1, &first.join(", "));
    out += &table(
        "rob_error",
        "legs_out_of_reach",
        count,
        &of_legs("OUT_OF_REACH"),
    );
    out += &table(
        "rob_error",
        "singular_legs",
        count,
        &of_legs("SINGULAR_LEG"),
    );
    let pose = Array {
        name: "pose".to_owned(),
        shape: vec![mechanism.pose_len()],
    };
    let head = signature("joints", &[pose], naming);
    let (scaled, goal, way) = if has_quaternion(model) {
        (JOINTS_CHECKS_QUATERNION, "unit_pose", WAY_OF_A_QUATERNION)
    } else {
        ("", "pose", "")
    };
    let body = JOINTS.replace("ROB_GOAL", goal).replace("ROB_WAY", way);
    let text = |parts: &[&str]| naming.apply(&parts.concat());
    out += &text(&["\n", NEWTON, "\n"]);
    let checks = in_range("pose", &naming.constant("POSE"), naming);
    out + &head + &format!("\n{{\n{checks}") + &text(&[scaled, &body])
}
