//! Section on drive parameters on the motor side.

use crate::page::{
    Contents,
    elements::{
        markup::{Section, note},
        table::{Cell, Table},
    },
};

/// Section; empty if no motors are described.
pub(crate) fn section(contents: &Contents<'_>) -> Section {
    let motors = &contents.identification.motors;
    let rows = motors.iter().map(|one| {
        vec![
            Cell::text(&one.motor),
            Cell::digits(Some(one.ratio), 6),
            Cell::text(&one.name),
            Cell::digits(Some(one.value), 5),
            Cell::digits(Some(one.deviation), 2),
            Cell::text(&one.unit).class("unit"),
        ]
    });
    let right = |title: &str| Cell::text(title).class("n");
    let table = Table {
        caption: String::from("Base parameters of drives, motor side"),
        header: vec![vec![
            Cell::text("motor"),
            right("ratio"),
            Cell::text("parameter"),
            right("motor side"),
            right("deviation"),
            Cell::text("unit"),
        ]],
        rows: rows.collect(),
    };
    let body = if motors.is_empty() {
        String::new()
    } else {
        table.html()
            + &note(
                "Inertia and viscous friction are smaller by the square of the ratio, dry friction by its magnitude, an offset by the ratio. Regrouped parameters are not those of the motor alone.",
            )
    };
    Section {
        id: "motors",
        title: "Motors",
        body,
    }
}
