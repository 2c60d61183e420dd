//! Standard parameters from a file, as `overact identify --parameters` writes it.

use crate::{
    compiled_file::read,
    error::{Error, Problem},
};
use overact::{Info, Parameter};
use overact_codegen::description::{Description, parse_parameters};
use std::{collections::BTreeMap, path::Path};

/// Reads the standard parameters of a robot from the table `[parameters]` of a TOML file (SI units, or
/// quantities with units): all of the robot's, and all or none of the payload's.
///
/// # Errors
/// A file that can't be read, names that the robot does not have, parameters that are missing.
pub fn read_parameters(
    path: &Path,
    description: &Description,
    info: &Info<'_>,
) -> Result<BTreeMap<String, f64>, Error> {
    let source = read(path)?;
    let values = match parse_parameters(&source, description) {
        Ok(values) => values,
        Err(diagnostics) => {
            return Err(Error::Description {
                source,
                diagnostics,
            });
        }
    };
    let pairs = values.into_iter().map(|one| (one.name.value, one.value));
    let values: BTreeMap<String, f64> = pairs.collect();
    let lacking = |all: &[Parameter]| -> Vec<&'static str> {
        let names = all.iter().map(|parameter| parameter.name);
        names.filter(|name| !values.contains_key(*name)).collect()
    };
    let mut missing = lacking(info.parameters);
    let load = lacking(info.payload_parameters);
    if load.len() < info.payload_parameters.len() {
        missing.extend(load);
    }
    if missing.is_empty() {
        return Ok(values);
    }
    let message = format!("missing parameters: {}", missing.join(", "));
    let help =
        "`overact identify --parameters FILE` writes all of them; write 0 for one that is absent";
    Err(Problem::new(message).file(source.name).help(help).into())
}
