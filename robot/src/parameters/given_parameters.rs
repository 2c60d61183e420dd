//! Reads standard parameters from a file written by `overact identify --parameters`.

use crate::{
    compiled_file::{CompiledFile, read, read_or},
    error::Error,
    parameters::physical::physical_warnings,
};
use overact::{Info, Parameter};
use overact_codegen::diagnostic::Code;
use overact_codegen::{
    Request, RobotModel,
    derivation::BodyParameter,
    description::{self, Description, parse_parameters},
    diagnostic::{Diagnostic, Diagnostics, Source},
};
use std::{collections::BTreeMap, path::Path};

/// Table of the file.
const TABLE: &str = "[parameters]";

/// Standard parameters from a file.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct GivenParameters {
    /// Values by name (SI units).
    pub values: BTreeMap<String, f64>,
    /// Sentences on values that no body or joint can have, with file and line.
    pub warnings: Vec<String>,
}

/// Reads a robot's standard parameters from the `[parameters]` table of a TOML file.
///
/// Values are in SI units or have units. The file must contain all parameters of the robot, and all
/// or none of the payload's.
///
/// # Errors
/// A file that cannot be read, unknown names, or missing parameters.
pub fn read_parameters(
    path: &Path,
    description: &Description,
    info: &Info<'_>,
) -> Result<GivenParameters, Error> {
    let (source, given) = given(path, description)?;
    let names = |all: &[Parameter]| all.iter().map(|one| one.name.to_owned()).collect();
    let (own, payload) = (names(info.parameters), names(info.payload_parameters));
    complete(source, &given.values, own, payload)?;
    Ok(given)
}

impl CompiledFile {
    /// Reads a description and its standard parameters, and compiles with these as constants.
    ///
    /// See [`read_parameters`].
    ///
    /// # Errors
    /// A file that cannot be read, or all errors of either file.
    pub fn with_parameters(
        path: &Path,
        parameters: &Path,
        request: &Request<'_>,
    ) -> Result<Self, Error> {
        let source = read(path)?;
        let description = match description::parse(&source) {
            Ok(description) => description,
            Err(diagnostics) => {
                return Err(Error::Description {
                    source,
                    diagnostics,
                });
            }
        };
        let (file, given) = given(parameters, &description)?;
        // Compile the columns only: they determine the parameters and are much cheaper than the
        // functions.
        let columns = Request {
            wanted: &|_, _, _| false,
            ..*request
        };
        let RobotModel {
            mechanism,
            selection,
            ..
        } = Self::new(source.clone(), &columns)?.model;
        let names = |all: &[BodyParameter]| {
            let names = all.iter().map(|&one| one.name(&mechanism));
            names.collect()
        };
        let (own, payload) = (names(&selection.standard), names(&selection.payload));
        complete(file, &given.values, own, payload)?;
        let request = Request {
            parameters: Some(&given.values),
            ..*request
        };
        let mut robot = Self::new(source, &request)?;
        robot.warnings = given.warnings;
        Ok(robot)
    }
}

/// Standard parameters in a file, by name (SI units).
fn given(path: &Path, description: &Description) -> Result<(Source, GivenParameters), Error> {
    let origin = "`overact identify my.toml --parameters parameters.toml` writes one";
    let source = read_or(path, origin)?;
    match parse_parameters(&source, description) {
        Ok(values) => {
            let warnings = physical_warnings(&source, &values);
            let pairs = values.into_iter().map(|one| (one.name.value, one.value));
            let values = pairs.collect();
            Ok((source, GivenParameters { values, warnings }))
        }
        Err(diagnostics) => Err(Error::Description {
            source,
            diagnostics,
        }),
    }
}

/// Rejects files without all of the robot's parameters, or with only some of the payload's.
fn complete(
    source: Source,
    values: &BTreeMap<String, f64>,
    own: Vec<String>,
    payload: Vec<String>,
) -> Result<(), Error> {
    let lacking = |mut names: Vec<String>| {
        // Several payloads have parameters of their own.
        let of_loads = |name: &String| {
            let mut given = values.keys();
            name.ends_with("_payload") && given.any(|own| own.starts_with(&format!("{name}_")))
        };
        names.retain(|name| !values.contains_key(name) && !of_loads(name));
        names
    };
    let count = payload.len();
    let (mut missing, load) = (lacking(own), lacking(payload));
    if load.len() < count {
        missing.extend(load);
    }
    if missing.is_empty() {
        return Ok(());
    }
    let message = format!("missing parameters: {}", missing.join(", "));
    let help =
        "`overact identify --parameters FILE` writes all of them; write 0 for one that is absent";
    let at = source.text.find(TABLE).unwrap_or_default();
    let error = Diagnostic::new(Code::PARAMETERS_FILE, message, at..at + TABLE.len()).help(help);
    Err(Error::Description {
        source,
        diagnostics: Diagnostics::from(error),
    })
}
