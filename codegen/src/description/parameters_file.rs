//! Standard parameters in a file of their own, as an identification writes them.

use super::document::Description;
use super::experiment::{TrueParameter, parameters};
use super::inventory::Inventory;
use super::reader::{Context, Table};
use super::robot::syntax;
use super::scope::Scope;
use crate::diagnostic::{Diagnostics, Source};
use toml::de::DeTable;

/// Reads a file with a table `[parameters]` of a robot's standard parameters, as an identification writes it.
///
/// # Errors
/// Everything that is wrong with it, and parameters of the robot (not those of its payload) that are missing.
pub fn parse_parameters(
    source: &Source,
    description: &Description,
) -> Result<Vec<TrueParameter>, Diagnostics> {
    let (document, syntax_errors) = DeTable::parse_recoverable(&source.text);
    if !syntax_errors.is_empty() {
        return Err(syntax(&syntax_errors));
    }
    let context = Context::new(source);
    let table = Table::new(&context, document.get_ref(), 0..0, "the file");
    let scope = Scope::default();
    let robot = Inventory {
        platform: description.platform.as_ref(),
        legs: &description.legs,
        scope: &scope,
        payloads: &description.payloads,
    };
    let item = table.require(
        "parameters",
        "a table `[parameters]` with a value for each parameter",
    );
    let found = item.map(|item| parameters(&item, &robot));
    table.finish();
    context.into_errors().into_result(found.unwrap_or_default())
}
