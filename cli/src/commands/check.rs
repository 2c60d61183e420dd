//! `overact check`: reports every error of a description at once.

use crate::{
    failure::Failure,
    note::print_note,
    output::{self, counted, json, print},
};
use overact_robot::{CheckedFile, check};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Arguments of the command.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Descriptions
    #[arg(required = true, value_name = "TOML")]
    pub(super) files: Vec<PathBuf>,
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
    /// Contents that may be unintended.
    note: Option<String>,
}

/// Runs the command.
///
/// # Errors
/// All errors of all descriptions.
pub(super) fn run(arguments: &Arguments, as_json: bool) -> Result<(), Failure> {
    let files: Vec<&Path> = arguments.files.iter().map(PathBuf::as_path).collect();
    output::check_distinct(&files, &[])?;
    let (mut good, mut bad) = (Vec::new(), Vec::new());
    for file in &arguments.files {
        match check(file) {
            Ok(found) => {
                print_note(&found.file, found.note.as_deref(), as_json);
                good.push(Checked::new(found));
            }
            Err(failure) => bad.push(failure),
        }
    }
    if as_json {
        // Only without errors: a document with errors goes to stderr.
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
    fn new(found: CheckedFile) -> Self {
        let mechanism = &found.mechanism;
        Self {
            note: found.note,
            robot: mechanism.name.clone(),
            legs: mechanism.legs.len(),
            joints: mechanism.joints().len(),
            actuators: mechanism.actuator_count(),
            dof: mechanism.dof(),
            file: found.file,
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
