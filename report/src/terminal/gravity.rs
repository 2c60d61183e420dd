//! Gravity direction as text.

use overact_identification::{GravityDirection, significant};

use crate::layout::table;

/// Decimals of a component, m/s²; digits of standard deviations.
const DECIMALS: usize = 6;

/// Line for the description.
pub(crate) fn described(direction: &GravityDirection) -> String {
    let [x, y, z] = direction.estimated.map(|one| format!("{one:.DECIMALS$}"));
    format!("gravity = [{x}, {y}, {z}]")
}

/// Angle between the described and the identified direction.
pub(crate) fn angle(direction: &GravityDirection) -> String {
    let [tilt, deviation] =
        [direction.tilt, direction.tilt_deviation].map(|one| significant(one.to_degrees(), 3));
    let own = format!("{tilt} deg from the described one, standard deviation {deviation} deg");
    if direction.significant {
        format!("{own}; the results below include it")
    } else {
        format!("{own}: not significant, so the results below use the described direction")
    }
}

/// Table of the components; empty if the direction was not identified.
pub(crate) fn gravity(direction: Option<&GravityDirection>) -> String {
    let Some(own) = direction else {
        return String::new();
    };
    let rows = ["x", "y", "z"].into_iter().enumerate().map(|(axis, name)| {
        vec![
            name.to_owned(),
            format!("{:.DECIMALS$}", own.described[axis]),
            format!("{:.DECIMALS$}", own.estimated[axis]),
            significant(own.deviations[axis], 2),
        ]
    });
    let header = ["m/s^2", "described", "identified", "deviation"];
    let held = own.undetermined_about.map_or_else(String::new, |axis| {
        let [x, y, z] = axis.map(|one| significant(one, 3));
        format!("A rotation about [{x}, {y}, {z}] is not determined and fixed at zero.\n")
    });
    format!(
        "\nDirection of gravity in the base's frame: {}\n{}{held}For the description: {}\n",
        angle(own),
        table(&header, rows.collect()),
        described(own)
    )
}
