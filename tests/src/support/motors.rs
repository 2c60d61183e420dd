//! Descriptions of robots with loops whose actuated joints are replaced by coupled motors.

use super::Failure;
use super::random::Dice;
use overact_codegen::Source;
use overact_codegen::description::{Description, JointKind, parse};
use std::fmt::Write as _;

/// Beginnings of the sections about experiments, whose actuators have other names.
const EXPERIMENTS: [&str; 6] = [
    "data",
    "experiment",
    "identification",
    "excitation",
    "prior",
    "controller",
];

/// Parameters of drawn motors.
const PARAMETERS: [&str; 4] = [
    "",
    "parameters = [\"ia\", \"fv\", \"fs\", \"off\"]\n",
    "parameters = [\"ia\", \"friction by direction\"]\n",
    "stribeck = \"0.1 rad/s\"\n",
];

/// A description without the sections about experiments.
#[must_use]
pub fn mechanism_only(text: &str) -> String {
    let mut kept = String::new();
    let mut is_kept = true;
    for line in text.lines() {
        if line.starts_with('[') {
            let name = line.trim_start_matches('[');
            let word = name.find(|c: char| !c.is_ascii_alphanumeric() && c != '_');
            let word = &name[..word.unwrap_or(name.len())];
            is_kept = !EXPERIMENTS.contains(&word);
        }
        if is_kept {
            kept.push_str(line);
            kept.push('\n');
        }
    }
    kept
}

/// The description with coupled motors in place of its actuated joints.
///
/// # Errors
///
/// Text that does not occur in the description.
pub fn with_motors(text: &str, motors: &str) -> Result<String, Failure> {
    let text = mechanism_only(text);
    if !text.contains("actuated = true") {
        return Err("no joint is actuated".into());
    }
    Ok(text.replace("actuated = true", "actuated = false") + "\n" + motors)
}

/// A joint that motors may turn.
struct Turned {
    /// Its variable, `left.q1`.
    variable: String,
    is_revolute: bool,
    is_actuated: bool,
}

/// All joints of a description that move.
fn moving_joints(robot: &Description) -> Vec<Turned> {
    let legs = robot.legs.iter();
    let joints = legs.flat_map(|leg| leg.joints.iter().map(move |joint| (leg, joint)));
    let moving = joints.filter(|(_, joint)| joint.kind.value != JointKind::Fixed);
    let one = |(leg, joint): (
        &overact_codegen::description::Leg,
        &overact_codegen::description::Joint,
    )| {
        let name = &joint.name.value;
        let line = if name.starts_with(|c: char| c.is_ascii_digit()) {
            ""
        } else {
            "_"
        };
        Turned {
            variable: format!("{}.q{line}{name}", leg.name.value),
            is_revolute: joint.kind.value == JointKind::Revolute,
            is_actuated: joint.actuated,
        }
    };
    moving.map(one).collect()
}

/// The description with a random motor for each actuated joint, which turns two more joints of any
/// legs, drawn by seed.
///
/// # Errors
///
/// An invalid description, or a robot without loops.
pub fn with_random_motors(text: &str, seed: u64) -> Result<String, Failure> {
    let source = Source::new("motors.toml", text);
    let robot = parse(&source).map_err(|errors| errors.render_plain(&source))?;
    if robot.platform.is_none() && robot.legs.iter().all(|leg| leg.end.is_none()) {
        return Err("the robot has no loop".into());
    }
    let joints = moving_joints(&robot);
    let mut dice = Dice::new(seed ^ 0x3070_12f5);
    let mut motors = String::new();
    let actuated: Vec<&Turned> = joints.iter().filter(|joint| joint.is_actuated).collect();
    for (number, own) in actuated.into_iter().enumerate() {
        let mut turns = String::new();
        let first = [1.0, 1.5, -2.0][dice.below(3)];
        write!(turns, "{first:?} * {}", own.variable)?;
        for _ in 0..2 {
            let other = &joints[dice.below(joints.len())];
            let factor = dice.angle(0.4);
            let unit = match (own.is_revolute, other.is_revolute) {
                (true, false) => " rad/m",
                (false, true) => " m/rad",
                _ => "",
            };
            write!(turns, " + ({factor:?}{unit}) * {}", other.variable)?;
        }
        let parameters = PARAMETERS[dice.below(PARAMETERS.len())];
        let parameters = if own.is_revolute {
            parameters.to_owned()
        } else {
            parameters.replace("rad/s", "m/s")
        };
        write!(
            motors,
            "[motor.drive{number}]\nturns = \"{turns}\"\n{parameters}"
        )?;
    }
    with_motors(text, &motors)
}
