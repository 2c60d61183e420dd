//! Section on the identified Stribeck velocities.

use crate::page::{
    Contents,
    elements::{
        markup::{Section, note},
        table::{Cell, Table},
    },
};
use overact_identification::StribeckVelocity;

/// Section; empty if no velocity was identified.
pub(crate) fn section(contents: &Contents<'_>) -> Section {
    let joints = &contents.identification.stribeck_velocities;
    let row = |joint: &StribeckVelocity| {
        let own = joint.estimate;
        vec![
            Cell::text(&joint.parameter),
            Cell::digits(Some(joint.described), 3),
            Cell::digits(own.map(|own| own.value), 3),
            Cell::digits(own.map(|own| own.interval_95[0]), 3),
            Cell::digits(own.map(|own| own.interval_95[1]), 3),
            Cell::text(joint.unit),
        ]
    };
    let right = |title: &str| Cell::text(title).class("n");
    let table = Table {
        caption: String::from("Velocity at which the additional friction of standstill is a half"),
        header: vec![vec![
            Cell::text("friction"),
            right("described"),
            right("velocity"),
            right("95 % from"),
            right("to"),
            Cell::text("unit"),
        ]],
        rows: joints.iter().map(row).collect(),
    };
    let body = if joints.is_empty() {
        String::new()
    } else {
        table.html()
            + &note(
                "The parameters on this page are those for these velocities, and their intervals include the uncertainty of the velocities. A velocity without number is not determined, and that of the description counts.",
            )
    };
    Section {
        id: "stribeck",
        title: "Stribeck velocities",
        body,
    }
}
