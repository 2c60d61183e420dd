//! A description from a file, read and compiled.

use crate::{
    InterpretedRobot,
    failure::{Failure, Problem},
};
use overact_codegen::{
    Effort, RobotModel,
    compile::{Wanted, compile_some},
    description::{self, Description},
    diagnostic::{Diagnostics, Source},
};
use std::{fs, path::Path};

/// A robot with its description.
#[derive(Debug)]
pub struct Robot {
    /// The path as the user gave it.
    pub file: String,
    /// What the file says.
    pub description: Description,
    /// The model.
    pub model: RobotModel,
}

/// Reads and compiles a description.
///
/// # Errors
/// A file that can't be read, or everything that is wrong with the description.
pub fn load(path: &Path) -> Result<Robot, Failure> {
    load_some(path, &|_, _, _| true)
}

/// [`load`] with the functions only that an [`InterpretedRobot`] serves.
///
/// # Errors
/// A file that can't be read, or everything that is wrong with the description.
pub fn load_to_serve(path: &Path) -> Result<Robot, Failure> {
    load_some(path, &InterpretedRobot::serves)
}

/// [`load`] with the wanted functions only.
///
/// # Errors
/// A file that can't be read, or everything that is wrong with the description.
pub fn load_some(path: &Path, wanted: Wanted<'_>) -> Result<Robot, Failure> {
    loaded(path, &Option::unwrap_or_default, wanted)
}

/// [`load`] with the effort that follows from the description's.
///
/// # Errors
/// A file that can't be read, or everything that is wrong with the description.
pub fn load_with(path: &Path, effort: &dyn Fn(Option<Effort>) -> Effort) -> Result<Robot, Failure> {
    loaded(path, effort, &|_, _, _| true)
}

fn loaded(
    path: &Path,
    effort: &dyn Fn(Option<Effort>) -> Effort,
    wanted: Wanted<'_>,
) -> Result<Robot, Failure> {
    let source = read(path)?;
    match compiled(&source, effort, wanted) {
        Ok((description, model)) => Ok(Robot {
            file: source.name,
            description,
            model,
        }),
        Err(diagnostics) => Err(Failure::Description {
            source,
            diagnostics,
        }),
    }
}

fn compiled(
    source: &Source,
    effort: &dyn Fn(Option<Effort>) -> Effort,
    wanted: Wanted<'_>,
) -> Result<(Description, RobotModel), Diagnostics> {
    let description = description::parse(source)?;
    let model = compile_some(source, Some(effort(description.effort)), wanted)?;
    Ok((description, model))
}

/// Reads a description's text.
///
/// # Errors
/// A file that can't be read or is not UTF-8.
pub fn read(path: &Path) -> Result<Source, Failure> {
    let name = path.display().to_string();
    match fs::read_to_string(path) {
        Ok(text) => Ok(Source::new(name, text)),
        Err(error) => {
            let missing = error.kind() == std::io::ErrorKind::NotFound;
            let problem = Problem::new(format!("the file can't be read: {error}")).file(name);
            Err(match missing {
                true => problem.help("`overact new planar-4rrr my.toml` writes a first one"),
                false => problem,
            }
            .into())
        }
    }
}
