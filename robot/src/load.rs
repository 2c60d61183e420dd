//! A description from a file, read and compiled.

use crate::{
    error::{Error, Problem},
    interpreted::InterpretedRobot,
};
use overact_codegen::{
    Effort, Request, RobotModel, compile_with, description::Description, diagnostic::Source,
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
pub fn load(path: &Path) -> Result<Robot, Error> {
    load_with(path, &Request::default())
}

/// The same with the functions only that an [`InterpretedRobot`] serves. The few operations that a
/// search would spare take less time than the search.
///
/// # Errors
/// A file that can't be read, or everything that is wrong with the description.
pub fn load_to_serve(path: &Path) -> Result<Robot, Error> {
    let request = Request {
        wanted: &InterpretedRobot::serves,
        ..Request::with_effort(Effort::None)
    };
    load_with(path, &request)
}

/// The same with what is asked for.
///
/// # Errors
/// A file that can't be read, or everything that is wrong with the description.
pub fn load_with(path: &Path, request: &Request<'_>) -> Result<Robot, Error> {
    let source = read(path)?;
    match compile_with(&source, request) {
        Ok(compiled) => Ok(Robot {
            file: source.name,
            description: compiled.description,
            model: compiled.model,
        }),
        Err(diagnostics) => Err(Error::Description {
            source,
            diagnostics,
        }),
    }
}

/// What a description says that may not be meant: a motor marked by mistake looks like redundancy, so
/// redundancy that the description does not speak of is worth a word.
#[must_use]
pub fn note(robot: &Robot) -> Option<String> {
    let mechanism = &robot.model.mechanism;
    let (n, r) = (mechanism.actuated().len(), mechanism.dof());
    let said = (robot.description.platform.as_ref()).is_some_and(|p| p.redundancy.is_some());
    if n <= r || said {
        return None;
    }
    Some(format!(
        "{n} actuators ({}) drive {}. If that is meant, write redundancy = {} in [platform]; else \
         take `actuated = true` from a joint",
        mechanism.actuator_names().join(", "),
        match r {
            1 => "1 degree of freedom".to_owned(),
            _ => format!("{r} degrees of freedom"),
        },
        n - r,
    ))
}

/// Reads a description's text.
///
/// # Errors
/// A file that can't be read or is not UTF-8.
pub fn read(path: &Path) -> Result<Source, Error> {
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
