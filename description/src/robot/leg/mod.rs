//! The tables `[[place]]`: a shape evaluated with the values of a placement.

pub(crate) mod cable_robot;
pub(crate) mod chain;
pub(crate) mod coupled_motor;
pub(crate) mod dependent;
pub(crate) mod joint;

use crate::diagnostic::{Code, Diagnostic, did_you_mean};
use crate::robot::cable;
use crate::robot::geometry::placement;
use crate::robot::model::{End, Leg, Spanned};
use crate::robot::shape::Shape;
use crate::toml_text::reader::Table;
use crate::toml_text::scope::{Scope, is_word};

/// Reads all placements in order.
pub(crate) fn read(
    tables: &[Table<'_, '_>],
    shapes: &[Shape<'_, '_>],
    constants: &Scope,
) -> Vec<Leg> {
    let mut legs: Vec<Leg> = Vec::new();
    for table in tables {
        let Some(leg) = place(table, shapes, constants) else {
            continue;
        };
        if legs.iter().any(|other| other.name.value == leg.name.value) {
            let message = format!("there are two legs `{}`", leg.name.value);
            table.context.report(Diagnostic::new(
                Code::SAME_NAME,
                message,
                leg.name.span.clone(),
            ));
        }
        legs.push(leg);
    }
    legs
}

fn place(table: &Table<'_, '_>, shapes: &[Shape<'_, '_>], constants: &Scope) -> Option<Leg> {
    let name = table
        .require("name", "for instance name = \"leg1\"")
        .and_then(|item| item.string());
    if let Some(name) = &name {
        check_name(table, name);
    }
    let help = "shape = \"NAME\" of a table [leg.NAME]";
    let shape = table.require("shape", help).and_then(|item| item.string());
    let home = table.get("home");
    let Some((index, shape)) = shape.and_then(|text| find(table, &text, shapes)) else {
        // Without a shape the valid keys are unknown.
        return None;
    };
    let mut scope = constants.clone();
    for variable in &shape.variables {
        let help = format!(
            "the leg `{}` leaves this value to its placements",
            shape.name.value
        );
        let value = table
            .require(&variable.value, &help)
            .and_then(|item| item.evaluate(constants));
        scope.add(variable.value.clone(), value);
    }
    let home = home.filter(|item| shape.cable.is_none() || cable::refuse_home(item));
    let homes = home.and_then(|item| item.table("the `home` of a leg"));
    table.finish();
    let joints = joint::read(shape, &scope, homes.as_ref());
    let end = shape.end.as_ref().map(|end| {
        let placement = placement(end.at.as_ref(), end.rotation.as_ref(), &scope);
        let value = if end.rigid {
            End::Rigid(placement)
        } else {
            End::Point {
                at: placement.at,
                along: end.along,
            }
        };
        Spanned::new(value, end.span.clone())
    });
    Some(Leg {
        name: name?,
        shape: index,
        shape_name: shape.name.value.clone(),
        base: placement(shape.base_at.as_ref(), shape.base_rotation.as_ref(), &scope),
        joints,
        cable: shape.cable.as_ref().map(|cable| cable.evaluate(&scope)),
        end,
        // Names of bodies are resolved when the skeleton is known.
        base_body: None,
        end_body: None,
        span: table.span.clone(),
    })
}

fn check_name(table: &Table<'_, '_>, name: &Spanned<String>) {
    let starts_well = name.value.starts_with(|c: char| c.is_ascii_alphabetic());
    if !starts_well || !is_word(&name.value) {
        let message = format!("`{}` cannot be the name of a leg", name.value);
        let diagnostic = Diagnostic::new(Code::BAD_NAME, message, name.span.clone());
        table
            .context
            .report(diagnostic.help("use letters, digits and underscores, a letter first"));
    }
}

fn find<'s, 'c, 't>(
    table: &Table<'_, '_>,
    name: &Spanned<String>,
    shapes: &'s [Shape<'c, 't>],
) -> Option<(usize, &'s Shape<'c, 't>)> {
    let found = shapes
        .iter()
        .enumerate()
        .find(|(_, shape)| shape.name.value == name.value);
    if found.is_none() {
        let names = || shapes.iter().map(|shape| shape.name.value.as_str());
        let list = || format!("known: {}", names().collect::<Vec<_>>().join(", "));
        let help = did_you_mean(&name.value, names()).unwrap_or_else(list);
        let message = format!("there is no table [leg.{}]", name.value);
        table
            .context
            .report(Diagnostic::new(Code::UNKNOWN_NAME, message, name.span.clone()).help(help));
    }
    found
}
