//! Standard parameters from a file, as `overact identify --parameters` writes it.

use crate::{
    compiled_file::{CompiledFile, read, read_or},
    error::Error,
    physical::doubts,
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

/// The table that a file has.
const TABLE: &str = "[parameters]";

/// Standard parameters that a file gives.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct GivenParameters {
    /// Values by name (SI units).
    pub values: BTreeMap<String, f64>,
    /// Values that no body or joint has, a sentence with file and line for each.
    pub doubts: Vec<String>,
}

/// Reads the standard parameters of a robot from the table `[parameters]` of a TOML file (SI units, or
/// quantities with units): all of the robot's, and all or none of the payload's.
///
/// # Errors
/// A file that can't be read, names that the robot does not have, parameters that are missing.
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
    /// Reads a description and a file of its standard parameters (see
    /// [`read_parameters`]), and compiles what is asked for with these as constants.
    ///
    /// # Errors
    /// A file that can't be read, or everything that is wrong with one of them.
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
        // Which parameters the robot has is known when its columns are, long before its functions.
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
        robot.doubts = given.doubts;
        Ok(robot)
    }
}

/// What a file says of a robot's standard parameters, by name (SI units).
fn given(path: &Path, description: &Description) -> Result<(Source, GivenParameters), Error> {
    let origin = "`overact identify my.toml --parameters parameters.toml` writes one";
    let source = read_or(path, origin)?;
    match parse_parameters(&source, description) {
        Ok(values) => {
            let doubts = doubts(&source, &values);
            let pairs = values.into_iter().map(|one| (one.name.value, one.value));
            let values = pairs.collect();
            Ok((source, GivenParameters { values, doubts }))
        }
        Err(diagnostics) => Err(Error::Description {
            source,
            diagnostics,
        }),
    }
}

/// Refuses values of a file without all of the robot's parameters, or with some of the payload's.
fn complete(
    source: Source,
    values: &BTreeMap<String, f64>,
    own: Vec<String>,
    payload: Vec<String>,
) -> Result<(), Error> {
    let lacking = |mut names: Vec<String>| {
        // Of several payloads each has its own.
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
