//! Section on tracking errors of several controllers on the same runs (Table 4).

use crate::page::{
    Contents,
    elements::{
        markup::{Section, note, paragraph},
        table::{Cell, Table},
    },
};

/// Tracking errors of one controller on one run.
struct Entry<'a> {
    run: &'a str,
    controller: &'a str,
    largest: &'a [f64],
    published: bool,
}

/// Section.
pub(crate) fn section(contents: &Contents<'_>) -> Section {
    let tracking = &contents.identification.tracking;
    let mut body = String::new();
    if let Some(first) = tracking.first() {
        body.push_str(&paragraph(
            "The largest difference between desired and measured position of each actuator, in simulation. Computed torques with the recommended parameters should reduce it clearly compared with the plain controller; the percentages give the remainder.",
        ));
        body.push_str(&table(contents, &first.actuators));
    }
    Section {
        id: "tracking",
        title: "Tracking errors",
        body,
    }
}

/// Table 4.
fn table(contents: &Contents<'_>, actuators: &[String]) -> String {
    let own = contents.identification.tracking.iter().map(|one| Entry {
        run: &one.run,
        controller: &one.controller,
        largest: &one.largest,
        published: false,
    });
    let published = contents.published.filter(|all| all.actuators == actuators);
    let others = published.iter().flat_map(|all| &all.tracking);
    let others = others.map(|one| Entry {
        run: &one.run,
        controller: &one.controller,
        largest: &one.largest,
        published: true,
    });
    let entries: Vec<Entry<'_>> = own.chain(others).collect();
    let mut rows = Vec::new();
    for entry in &entries {
        rows.push(row(entry));
        // The others are compared with the first controller of a run.
        let first = entries
            .iter()
            .find(|one| one.run == entry.run && one.published == entry.published);
        if let Some(first) = first.filter(|first| first.controller != entry.controller) {
            rows.push(reduction(entry, first));
        }
    }
    let mut header = vec![Cell::text("run"), Cell::text("controller")];
    header.extend(actuators.iter().map(|name| {
        let unit = contents.units.position(name);
        let unit = if unit.is_empty() {
            "10⁻³".to_owned()
        } else {
            format!("m{unit}")
        };
        // Tracking errors in thousandths: millimetres.
        Cell::text(&format!("{name} ({unit})")).class("n")
    }));
    let mut html = Table {
        caption: String::from("Largest tracking errors"),
        header: vec![header],
        rows,
    }
    .html();
    if let Some(all) = published.filter(|all| !all.tracking.is_empty()) {
        html.push_str(&note(&format!(
            "Published: {}.",
            all.source.trim_end_matches('.')
        )));
    }
    html
}

fn row(entry: &Entry<'_>) -> Vec<Cell> {
    let run = if entry.published {
        format!("{} (published)", entry.run)
    } else {
        entry.run.to_owned()
    };
    let mut cells = vec![Cell::text(&run), Cell::text(entry.controller)];
    let thousandths = entry.largest.iter().map(|value| Some(1e3 * value));
    cells.extend(thousandths.map(|value| Cell::digits(value, 3)));
    cells
}

/// Reduction of the error relative to the first controller.
fn reduction(entry: &Entry<'_>, first: &Entry<'_>) -> Vec<Cell> {
    let mut cells = vec![
        Cell::text(""),
        Cell::text(&format!("less than {} (%)", first.controller)).class("note"),
    ];
    let pairs = entry.largest.iter().zip(first.largest);
    cells.extend(pairs.map(|(now, before)| {
        let percent = 100.0 * (1.0 - now / before);
        if percent.is_finite() {
            Cell::number(format!("{percent:.1}")).class("n note")
        } else {
            Cell::nothing()
        }
    }));
    cells
}
