//! Checks of plausible magnitude and robot size, made before anything is computed.

use crate::{
    account::Use,
    files::{Files, Place},
    model::{Body, ClosureKind, Joint, Model, Pose},
    xml::Element,
};
use nalgebra::Matrix3;

/// Upper bound on numbers in SI units; squares of larger ones could soon overflow.
const LARGEST: f64 = 1e15;
/// Largest number of moving joints, as in a description.
const MOST_JOINTS: usize = 200;

/// Largest number of joint elements, fixed joints included.
const MOST_JOINT_ELEMENTS: usize = 2_000;
/// Largest number of body elements.
const MOST_BODY_ELEMENTS: usize = 10_000;
/// Largest number of frame elements.
const MOST_FRAME_ELEMENTS: usize = 5_000;
/// Largest number of loop closures, because the search for chains solves all of them together.
const MOST_CLOSURES: usize = 200;
/// Largest number of elements that close loops, inactive ones included.
const MOST_CLOSURE_ELEMENTS: usize = 2_000;

/// Elements that close loops, of all formats.
const CLOSURES: &[&str] = &[
    "connect",
    "weld",
    "loop",
    "constraint",
    "loop_joint",
    "ball_constraint",
];

/// Rejects files with too many joints, bodies, frames or loop closures; `None` after an error.
///
/// This runs before the elements are compared with each other.
pub(crate) fn check_elements(files: &Files, root: &Element) -> Option<()> {
    let limits: [(&str, &[&str], usize); 4] = [
        (
            "elements of joints",
            &["joint", "freejoint"],
            MOST_JOINT_ELEMENTS,
        ),
        ("bodies", &["body", "link"], MOST_BODY_ELEMENTS),
        ("frames", &["frame"], MOST_FRAME_ELEMENTS),
        ("loop closures", CLOSURES, MOST_CLOSURE_ELEMENTS),
    ];
    for (what, names, most) in limits {
        let count = count(root, names);
        if count > most {
            let message = format!("the file has {count} {what}, more than {most}");
            files.report(&root.place, message, "import the robot in parts");
            return None;
        }
    }
    Some(())
}

/// Number of elements with one of these names.
fn count(element: &Element, names: &[&str]) -> usize {
    let inside = element.children.iter().map(|child| count(child, names));
    inside.sum::<usize>() + usize::from(names.contains(&element.name.as_str()))
}

/// Rejects models out of bounds; `None` after an error.
pub(crate) fn check(files: &Files, model: &Model) -> Option<()> {
    if model.joints.len() > MOST_JOINTS {
        let message = format!(
            "the robot has {} joints that move, more than {MOST_JOINTS}",
            model.joints.len()
        );
        files.refuse(
            message,
            "fix joints that need not move, or import it in parts",
        );
    }
    if let Some(first) = model.closures.get(MOST_CLOSURES) {
        let count = model.closures.len();
        let message = format!("the robot has {count} loop closures, more than {MOST_CLOSURES}");
        let help = "remove redundant ones, or import the robot in parts";
        files.report(&first.place, message, help);
    }
    for body in &model.bodies {
        let joint = body.joint.map(|joint| &model.joints[joint].place);
        if !body_numbers(body).into_iter().all(is_in_bounds) {
            let message = format!("`{}` has a number beyond {LARGEST:e}", body.name);
            report(files, body.place.as_ref().or(joint), message);
        } else if let (Some(inertia), Some(place)) = (&body.inertia, body.place.as_ref().or(joint))
            && let Some(problem) = impossibility(&inertia.tensor)
        {
            let reason = format!("`{}`: {problem}; kept in the model", body.name);
            files.record(Use::Reported, place, "inertia", None, &reason);
        }
    }
    for joint in &model.joints {
        if !joint_numbers(joint).into_iter().all(is_in_bounds) {
            let message = format!("the joint `{}` has a number beyond {LARGEST:e}", joint.name);
            report(files, Some(&joint.place), message);
        }
        let negative = [
            ("rotor inertia", joint.armature),
            ("damping", joint.damping),
            ("friction", joint.friction),
            (
                "stiffness",
                joint.spring.map_or(0.0, |(stiffness, _)| stiffness),
            ),
        ];
        for (what, _) in negative.into_iter().filter(|(_, value)| *value < 0.0) {
            let reason = format!(
                "`{}`: its {what} is negative; kept in the model",
                joint.name
            );
            files.record(Use::Reported, &joint.place, "joint", None, &reason);
        }
        if joint.follow.is_some_and(|follow| follow.factor == 0.0) {
            let message = format!(
                "the joint `{}` is coupled to another with the factor 0: it does not move",
                joint.name
            );
            let help = "write it as a fixed joint, or give another factor";
            files.report(&joint.place, message, help);
        }
    }
    for closure in &model.closures {
        let numbers: Vec<f64> = match &closure.kind {
            ClosureKind::Point { at, .. } => at.iter().flat_map(|at| at.coords.data.0[0]).collect(),
            ClosureKind::Weld { at, .. } | ClosureKind::Pin { at, .. } => {
                at.iter().flat_map(pose_numbers).collect()
            }
        };
        if !numbers.into_iter().all(is_in_bounds) {
            let message = format!("`{}` has a number beyond {LARGEST:e}", closure.name);
            report(files, Some(&closure.place), message);
        }
    }
    for spring in &model.springs {
        let own = [spring.stiffness, spring.damping, spring.rest].into_iter();
        let points = spring.at.iter().flat_map(|at| at.coords.data.0[0]);
        if !own.chain(points).all(is_in_bounds) {
            let message = format!(
                "the tendon `{}` has a number beyond {LARGEST:e}",
                spring.name
            );
            report(files, Some(&spring.place), message);
        }
    }
    if !model.gravity.into_iter().all(is_in_bounds) {
        report(
            files,
            None,
            format!("gravity has a number beyond {LARGEST:e}"),
        );
    }
    files.is_clean().then_some(())
}

/// Reports position limits that leave no range.
pub(crate) fn record_empty_range(files: &Files, limits: &Element) {
    let reason = "the lower limit is not below the upper one: the joint has no limits here";
    files.record(Use::Reported, &limits.place, &limits.name, None, reason);
}

/// Largest angle of a pose, rad; larger ones have lost digits within the turn.
const LARGEST_ANGLE: f64 = 1e6;

/// Reports angles of a pose that are too large to mean a rotation.
pub(crate) fn check_angles(files: &Files, place: &Place, angles: &[f64]) {
    if angles.iter().any(|angle| angle.abs() > LARGEST_ANGLE) {
        let message = format!("an angle of the pose is beyond {LARGEST_ANGLE:e} rad");
        files.report(place, message, "give angles within one turn");
    }
}

/// Relative size of rounding errors in the inertias of files.
const ROUNDING: f64 = 0.05;

/// Reason why no body has a central inertia; `None` if a body may have it.
///
/// Principal moments of a body are not negative, and none exceeds the sum of the others.
fn impossibility(tensor: &Matrix3<f64>) -> Option<String> {
    let mut moments = tensor.symmetric_eigenvalues();
    moments.as_mut_slice().sort_by(f64::total_cmp);
    let [small, middle, large] = [moments[0], moments[1], moments[2]];
    let size = large.abs().max(small.abs());
    let list = format!(
        "principal moments about the centre of mass {small:.3e}, {middle:.3e} and {large:.3e} kg m^2"
    );
    if small < -ROUNDING * size {
        return Some(format!("{list}: one is negative"));
    }
    let is_too_large = large > (1.0 + ROUNDING) * (small + middle);
    is_too_large.then(|| format!("{list}: one exceeds the sum of the others"))
}

fn report(files: &Files, place: Option<&Place>, message: String) {
    let help = "give lengths in m, angles in rad, masses in kg and inertias in kg m^2";
    match place {
        Some(place) => files.report(place, message, help),
        None => files.refuse(message, help),
    }
}

/// Whether a number is finite and plausible.
fn is_in_bounds(number: f64) -> bool {
    number.abs() < LARGEST
}

fn body_numbers(body: &Body) -> Vec<f64> {
    let mut numbers = pose_numbers(&body.placement);
    if let Some(own) = &body.inertia {
        numbers.push(own.mass);
        numbers.extend(own.centre.coords.iter().chain(own.tensor.iter()));
    }
    numbers
}

fn joint_numbers(joint: &Joint) -> Vec<f64> {
    let mut numbers = vec![
        joint.reference,
        joint.home,
        joint.damping,
        joint.friction,
        joint.armature,
    ];
    numbers.extend(joint.axis.iter().chain(joint.at.coords.iter()));
    numbers.extend(
        joint
            .spring
            .iter()
            .flat_map(|(stiffness, rest)| [*stiffness, *rest]),
    );
    numbers.extend(joint.follow.iter().flat_map(|own| [own.factor, own.offset]));
    numbers
}

fn pose_numbers(pose: &Pose) -> Vec<f64> {
    let rotation = pose.rotation.matrix().iter();
    let numbers = rotation.chain(pose.translation.vector.iter());
    numbers.copied().collect()
}
