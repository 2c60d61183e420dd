//! `overact check`: every error of a description at once.

use crate::{
    failure::Failure,
    note::tell_note,
    output::{counted, json, print},
};
use overact_codegen::{Effort, Request};
use overact_robot::CompiledFile;
use serde::Serialize;
use std::path::PathBuf;

/// Arguments of the command.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Descriptions
    #[arg(required = true, value_name = "TOML")]
    files: Vec<PathBuf>,
}

/// A description without errors.
#[derive(Debug, Serialize)]
struct Checked {
    file: String,
    robot: String,
    legs: usize,
    joints: usize,
    actuators: usize,
    dof: usize,
    /// What may not be meant.
    note: Option<String>,
}

/// Runs the command.
///
/// # Errors
/// All errors of all descriptions.
pub(super) fn run(arguments: &Arguments, as_json: bool) -> Result<(), Failure> {
    let (mut good, mut bad) = (Vec::new(), Vec::new());
    for file in &arguments.files {
        // Whether there is a model does not depend on how few operations it takes.
        match CompiledFile::read(file, &Request::with_effort(Effort::None)) {
            Ok(robot) => {
                tell_note(&robot, as_json);
                good.push(Checked::new(robot));
            }
            Err(failure) => bad.push(failure),
        }
    }
    if as_json {
        // Without an error: a document with errors goes to stderr.
        if bad.is_empty() {
            print(&json(&serde_json::json!({ "robots": good }))?)?;
        }
    } else {
        let lines: Vec<String> = good.iter().map(Checked::line).collect();
        print(&lines.join("\n"))?;
    }
    match bad.len() {
        0 => Ok(()),
        _ => Err(bad.into()),
    }
}

impl Checked {
    fn new(robot: CompiledFile) -> Self {
        let note = robot.note();
        let mechanism = &robot.model.mechanism;
        Self {
            note,
            robot: mechanism.name.clone(),
            legs: mechanism.legs.len(),
            joints: mechanism.joints().len(),
            actuators: mechanism.actuated().len(),
            dof: mechanism.dof(),
            file: robot.file,
        }
    }

    fn line(&self) -> String {
        format!(
            "{}: {}, {}, {}, {}, {}, ok",
            self.file,
            self.robot,
            counted(self.legs, "leg", "legs"),
            counted(self.joints, "joint", "joints"),
            counted(self.actuators, "actuator", "actuators"),
            counted(self.dof, "degree of freedom", "degrees of freedom"),
        )
    }
}
