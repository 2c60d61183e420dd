//! Section on the identified gravity direction.

use crate::{
    page::{
        Contents,
        elements::{
            markup::{Section, note, paragraph},
            table::{Cell, Table},
        },
    },
    terminal::gravity::{angle, described},
};

/// Section; empty if the direction was not identified.
pub(crate) fn section(contents: &Contents<'_>) -> Section {
    let direction = contents.identification.gravity.as_ref();
    let body = direction.map_or_else(String::new, |own| {
        let rows = ["x", "y", "z"].into_iter().enumerate().map(|(axis, name)| {
            vec![
                Cell::text(name),
                Cell::digits(Some(own.described[axis]), 6),
                Cell::digits(Some(own.estimated[axis]), 6),
                Cell::digits(Some(own.deviations[axis]), 2),
                Cell::text("m/s^2").class("unit"),
            ]
        });
        let right = |title: &str| Cell::text(title).class("n");
        let table = Table {
            caption: String::from("Acceleration of gravity in the base\u{2019}s frame"),
            header: vec![vec![
                Cell::text("axis"),
                right("described"),
                right("identified"),
                right("deviation"),
                Cell::text("unit"),
            ]],
            rows: rows.collect(),
        };
        let held = own.undetermined_about.map_or_else(String::new, |axis| {
            let [x, y, z] = axis.map(|one| overact_identification::significant(one, 3));
            note(&format!("A rotation about [{x}, {y}, {z}] is not determined and fixed at zero."))
        });
        paragraph(&format!("The direction of gravity was identified together with the parameters: {}.", angle(own)))
            + &table.html()
            + &held
            + &note(&format!(
                "For the description: {}. Standard deviations and intervals of parameters include the uncertainty of the direction.",
                described(own)
            ))
    });
    Section {
        id: "gravity",
        title: "Direction of gravity",
        body,
    }
}
