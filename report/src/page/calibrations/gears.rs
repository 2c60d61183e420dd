//! Section on the identified friction of gears.

use crate::page::{
    Contents,
    elements::{
        markup::{Section, note},
        table::{Cell, Table},
    },
};
use overact_identification::GearCoefficient;

/// Section; empty if no friction of gears was identified.
pub(crate) fn section(contents: &Contents<'_>) -> Section {
    let drives = &contents.identification.gear_friction;
    let row = |drive: &str, motion: &str, coefficient: Option<GearCoefficient>| {
        vec![
            Cell::text(drive),
            Cell::text(motion),
            Cell::digits(coefficient.map(|own| own.value), 3),
            Cell::digits(coefficient.map(|own| own.deviation), 2),
            Cell::digits(coefficient.map(|own| own.interval_95[0]), 3),
            Cell::digits(coefficient.map(|own| own.interval_95[1]), 3),
        ]
    };
    let rows = drives.iter().flat_map(|one| {
        [
            row(&one.actuator, "driving", one.driving),
            row(&one.actuator, "back-driving", one.back_driving),
        ]
    });
    let right = |title: &str| Cell::text(title).class("n");
    let table = Table {
        caption: String::from("Friction as a part of the transmitted torque"),
        header: vec![vec![
            Cell::text("gear of"),
            Cell::text("motion"),
            right("coefficient"),
            right("deviation"),
            right("95 % from"),
            right("to"),
        ]],
        rows: rows.collect(),
    };
    let body = if drives.is_empty() {
        String::new()
    } else {
        table.html()
            + &note(
                "All torques on this page are those that the gears transmit. All intervals include the uncertainty of these coefficients. A coefficient without number is not determined and counts as zero.",
            )
    };
    Section {
        id: "gears",
        title: "Friction of the gears",
        body,
    }
}
