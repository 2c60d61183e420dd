//! Standard parameters in a separate file, as written by an identification.

use crate::diagnostic::{Code, Diagnostic, Diagnostics, Source};
use crate::document::Description;
use crate::experiments::experiment::{TrueParameter, parameters};
use crate::robot::inventory::Inventory;
use crate::root::syntax;
use crate::toml_text::reader::{Context, Item, Table};
use crate::toml_text::scope::Scope;
use toml::de::DeTable;

/// Reads a file with a table `[parameters]` of a robot's standard parameters, as written by an
/// identification.
///
/// # Errors
/// All errors, and missing parameters of the robot (except for those of its payload).
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
        motors: &description.motors,
        springs: &description.springs,
        scope: &scope,
        payloads: &description.payloads,
        payload_bodies: &description.payload_bodies,
    };
    let item = table.require(
        "parameters",
        "a table `[parameters]` with a value for each parameter",
    );
    let of_other = table
        .get("robot")
        .and_then(|item| of_other(&item, description));
    // All parameters would be wrong.
    if let Some(of_other) = of_other {
        return Err(of_other.into());
    }
    let found = item.map(|item| parameters(&item, &robot));
    table.finish();
    context.into_errors().into_result(found.unwrap_or_default())
}

/// The error for parameters of a robot other than the described one.
fn of_other(item: &Item<'_, '_>, description: &Description) -> Option<Diagnostic> {
    let name = item.string()?;
    let own = [description.name.value.clone(), description.type_name()];
    if own.contains(&name.value) {
        return None;
    }
    let message = format!(
        "these are the parameters of `{}`, and the robot is `{}`",
        name.value, own[0]
    );
    let error = Diagnostic::new(Code::PARAMETERS_FILE, message, name.span);
    let help = "give the file of this robot; if another name means the same robot, leave the key `robot` out";
    Some(error.help(help))
}
