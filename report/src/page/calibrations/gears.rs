//! Section on the identified friction of gears.

use crate::page::{
    Contents,
    elements::{
        markup::{Section, note},
        table::{Cell, Table},
    },
};
use overact_identification::DriveGearFriction;

/// Section; empty if no friction of gears was identified.
pub(crate) fn section(contents: &Contents<'_>) -> Section {
    let drives = &contents.identification.gear_friction;
    let row = |drive: &DriveGearFriction| {
        let own = drive.coefficient;
        vec![
            Cell::text(&drive.actuator),
            Cell::digits(own.map(|own| own.value), 3),
            Cell::digits(own.map(|own| own.deviation), 2),
            Cell::digits(own.map(|own| own.interval_95[0]), 3),
            Cell::digits(own.map(|own| own.interval_95[1]), 3),
        ]
    };
    let right = |title: &str| Cell::text(title).class("n");
    let table = Table {
        caption: String::from("Friction as a part of the transmitted torque"),
        header: vec![vec![
            Cell::text("gear of"),
            right("coefficient"),
            right("deviation"),
            right("95 % from"),
            right("to"),
        ]],
        rows: drives.iter().map(row).collect(),
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
