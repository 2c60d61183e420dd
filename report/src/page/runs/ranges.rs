//! Section on the range of motion of each joint, with its limits.

use crate::{
    page::{
        Contents,
        elements::{
            markup::{Section, figure, paragraph},
            table::{Cell, Table},
        },
    },
    plot::{Axis, Bar, Forest, Look},
    text::escape,
};
use overact_identification::{ActuatorRange, significant};

/// Section.
pub(crate) fn section(contents: &Contents<'_>) -> Section {
    let ranges = &contents.identification.figures.ranges;
    let mut body = String::new();
    if !ranges.is_empty() {
        body.push_str(&paragraph(
            "Range of each actuated joint in the training runs. A joint that moves little determines its parameters poorly. Limits are those of the table `excitation` of the description.",
        ));
        let plots: Vec<String> = ["rad", "m"]
            .into_iter()
            .flat_map(|unit| plots(ranges, unit))
            .collect();
        body.push_str(&figure(
            "figure-ranges",
            &plots,
            "",
            &escape("The bars are the used ranges; crosses are described limits."),
        ));
        body.push_str(&table(ranges));
    }
    Section {
        id: "ranges",
        title: "Range of motion",
        body,
    }
}

/// Interval of a bar, and the limit that it shows.
type BarOf<'a> = dyn Fn(&ActuatorRange) -> ([f64; 2], Option<f64>) + 'a;

/// Plots of position, velocity and acceleration of the joints with this unit.
fn plots(ranges: &[ActuatorRange], unit: &str) -> Vec<String> {
    let own: Vec<&ActuatorRange> = ranges.iter().filter(|one| one.unit == unit).collect();
    if own.is_empty() {
        return Vec::new();
    }
    let symmetric = |largest: f64| [-largest, largest];
    let plot = |what: &str, unit: String, bar: &BarOf<'_>| {
        let row = |one: &&ActuatorRange| {
            let (interval, limit) = bar(one);
            let bar = Bar {
                look: Look::First,
                value: 0.5 * (interval[0] + interval[1]),
                interval,
                other: limit,
                label: format!("{}: {what}", one.actuator),
            };
            (one.actuator.clone(), vec![bar])
        };
        Forest {
            title: format!("{what} ({unit})"),
            description: format!("range of the {what} of each joint"),
            x: Axis::linear(unit),
            rows: own.iter().map(row).collect(),
        }
        .svg()
    };
    vec![
        plot("position", unit.to_owned(), &|one| {
            // The nearer limit, since a bar has one mark.
            let limit = one.position_limits.map(|[low, high]| {
                let is_low = one.position[0] - low < high - one.position[1];
                if is_low { low } else { high }
            });
            (one.position, limit)
        }),
        plot("velocity", format!("{unit}/s"), &|one| {
            (symmetric(one.velocity), one.velocity_limit)
        }),
        plot("acceleration", format!("{unit}/s²"), &|one| {
            (symmetric(one.acceleration), one.acceleration_limit)
        }),
    ]
}

/// Table with the numbers and the limits.
fn table(ranges: &[ActuatorRange]) -> String {
    let span = |[low, high]: [f64; 2]| {
        format!("{} … {}", significant(low, 3), significant(high, 3)).replace('-', "−")
    };
    let row = |one: &ActuatorRange| {
        let limits = one.position_limits;
        vec![
            Cell::text(&one.actuator),
            Cell::text(one.unit).class("unit"),
            Cell::text(&span(one.position)).class("n"),
            limits.map_or_else(Cell::nothing, |own| Cell::text(&span(own)).class("n")),
            Cell::digits(Some(one.velocity), 3),
            Cell::digits(one.velocity_limit, 3),
            Cell::digits(Some(one.acceleration), 3),
            Cell::digits(one.acceleration_limit, 3),
        ]
    };
    let titles = [
        ("joint", ""),
        ("unit", ""),
        ("position", "n"),
        ("limits", "n"),
        ("largest velocity (per s)", "n"),
        ("limit", "n"),
        ("largest acceleration (per s²)", "n"),
        ("limit", "n"),
    ];
    Table {
        caption: String::from("Range of motion in the training runs"),
        header: vec![
            titles
                .iter()
                .map(|(title, class)| Cell::text(title).class(class))
                .collect(),
        ],
        rows: ranges.iter().map(row).collect(),
    }
    .html()
}
