//! Applies the user's choices to a model: driven joints and home positions.

use crate::{
    files::Files,
    format::Format,
    model::{Joint, JointType, Model},
    motors,
    options::Options,
};
use std::collections::BTreeSet;

/// Largest home position of an option, rad or m.
const LARGEST_HOME: f64 = 1e6;

/// Rejects options of other formats, which would have no effect; `None` after an error.
pub(crate) fn check(files: &Files, format: Format, options: &Options) -> Option<()> {
    let foreign = [
        (
            "--value",
            !options.values.is_empty(),
            Format::Par,
            ".par files",
        ),
        ("--model", options.model.is_some(), Format::Sdf, "SDFormat"),
    ];
    for (option, is_given, own, name) in foreign {
        if is_given && format != own {
            let message = format!("`{option}` is an option for {name} only");
            files.refuse(message, "leave it out");
        }
    }
    let homes = options.home.iter().map(|(joint, _)| joint);
    refuse_repeated(files, "--home", homes);
    refuse_repeated(files, "--actuated", options.actuated.iter().flatten());
    refuse_repeated(files, "--coordinates", options.coordinates.iter().flatten());
    files.is_clean().then_some(())
}

fn refuse_repeated<'a>(files: &Files, option: &str, joints: impl Iterator<Item = &'a String>) {
    let mut seen = BTreeSet::new();
    for joint in joints.filter(|&joint| !seen.insert(joint)) {
        let message = format!("`{option}` names the joint `{joint}` twice");
        files.refuse(message, "name each joint once");
    }
}

/// Applies the user's choice of actuated joints and home positions.
pub(crate) fn apply(files: &Files, model: &mut Model, options: &Options) -> Option<()> {
    if let Some(names) = &options.actuated {
        model
            .joints
            .iter_mut()
            .for_each(|joint| joint.actuated = false);
        for name in names {
            let at = find(files, model, name)?;
            model.joints[at].actuated = true;
        }
    } else if !model.says_motors {
        if !model.closures.is_empty() {
            let help = "name them: `--actuated JOINT,JOINT`";
            files.refuse(
                "the file does not say which joints of its loops are driven",
                help,
            );
            return None;
        }
        model
            .joints
            .iter_mut()
            .for_each(|joint| joint.actuated = joint.follow.is_none());
        model
            .notes
            .push("The file has no motors: every joint has one here.".to_owned());
    }
    motors::lead_by_driven_joints(model);
    motors::resolve(files, model, options.actuated.is_some());
    if model.closures.is_empty() {
        let passive = |joint: &&mut Joint| !joint.actuated && joint.follow.is_none();
        let mut names = Vec::new();
        for joint in model.joints.iter_mut().filter(passive) {
            joint.actuated = true;
            names.push(format!("`{}`", joint.name));
        }
        if !names.is_empty() {
            model.notes.push(format!(
                "No motor drives {}: without loops every joint needs a torque column; theirs is zero.",
                names.join(", ")
            ));
        }
    }
    set_homes(files, model, &options.home)?;
    if model.closures.is_empty() {
        off_limits(model, options);
    }
    if model.joints.is_empty() {
        files.refuse(
            "the robot has no joint that moves",
            "add a joint that moves",
        );
        return None;
    }
    Some(())
}

/// Joint with a name; reports an error if there is none.
fn find(files: &Files, model: &Model, name: &str) -> Option<usize> {
    let found = model.joint_named(name);
    if found.is_none() {
        let names = model.joints.iter().map(|joint| joint.name.as_str());
        let help = files.joint_help(name, names);
        files.refuse(format!("there is no joint `{name}`"), help);
    }
    found
}

/// Sets the positions from which the search for a closed home configuration starts.
fn set_homes(files: &Files, model: &mut Model, homes: &[(String, f64)]) -> Option<()> {
    for (name, position) in homes {
        let at = find(files, model, name)?;
        let joint = &model.joints[at];
        if joint.kind == JointType::Ball {
            let message =
                format!("`--home` sets the ball joint `{name}`, whose rotation is not one number");
            files.refuse(
                message,
                "leave it out: the search for a closed configuration rotates it",
            );
        } else if let Some(follow) = joint.follow {
            let leader = &model.joints[follow.joint].name;
            let message = format!("`--home` sets `{name}`, which is coupled to `{leader}`");
            files.refuse(message, format!("set `{leader}` instead"));
        } else if position.abs() > LARGEST_HOME {
            let message =
                format!("the home position {position:?} of `{name}` is beyond {LARGEST_HOME:e}");
            files.refuse(message, "give it in rad or m");
        }
        model.joints[at].home = *position;
    }
    Some(())
}

/// For serial robots: moves joints whose home is at a limit to the middle of their range.
///
/// Otherwise there would be no room for motions about the home configuration.
fn off_limits(model: &mut Model, options: &Options) {
    let mut names = Vec::new();
    for joint in model
        .joints
        .iter_mut()
        .filter(|joint| joint.follow.is_none())
    {
        let is_chosen = options.home.iter().any(|(name, _)| *name == joint.name);
        let Some([low, high]) = joint.range.filter(|_| !is_chosen) else {
            continue;
        };
        let room = 0.05 * (high - low);
        if joint.home < low + room || joint.home > high - room {
            joint.home = 0.5 * (low + high);
            names.push(format!("`{}`", joint.name));
        }
    }
    if !names.is_empty() {
        let list = names.join(", ");
        let note = format!(
            "The file's zero is on or near a limit of {list}: home is in the middle of the range."
        );
        model.notes.push(note);
    }
}
