//! Formats runs as TOML tables, and replaces the training runs of a description.

use super::fourier_run::FourierRun;
use crate::error::{Error, Problem};
use crate::robot::Robot;
use overact_codegen::diagnostic::Code;
use overact_identification::carried_payloads;
use overact_simulation::{Term, Trajectory};
use std::fmt::Write;
use toml_edit::{ArrayOfTables, DocumentMut, Item, Table, Value};

/// Comment above the runs.
const COMMENT: &str = "\n# Computed by `overact excite`: they determine the base parameters best within the limits.\n";

/// Formats runs as `[[experiment.run]]` tables.
///
/// For each coordinate, `coordinates` has its names in the model and in the description, and
/// whether it is a length.
pub(super) fn tables(
    runs: &[(FourierRun, Trajectory)],
    coordinates: &[(&str, String, bool)],
) -> String {
    let mut text = COMMENT.to_owned();
    for (run, trajectory) in runs {
        let mut table = format!(
            "\n[[experiment.run]]\nname = {}\n",
            Value::from(run.name.as_str())
        );
        match &run.payload_name {
            Some(label) => {
                let names = carried_payloads(label).map(|name| format!("\"{name}\""));
                let names: Vec<String> = names.collect();
                let _ = match names.as_slice() {
                    [name] => writeln!(table, "payload = {name}"),
                    names => writeln!(table, "payload = [{}]", names.join(", ")),
                };
            }
            None if run.payload => table += "payload = true\n",
            None => {}
        }
        if let Some(duration) = run.own_duration {
            let _ = writeln!(table, "duration = \"{duration} s\"");
        }
        let _ = writeln!(table, "fundamental = \"{} Hz\"\nterms = [", run.fundamental);
        if let Trajectory::Periodic { terms, .. } = trajectory {
            terms
                .iter()
                .for_each(|own| table += &term(own, coordinates));
        }
        text = text + &table + "]\n";
    }
    text
}

/// Formats one term as a line of `terms`.
fn term(term: &Term, coordinates: &[(&str, String, bool)]) -> String {
    let known = coordinates
        .iter()
        .find(|(name, ..)| *name == term.coordinate);
    let (name, is_length) = known.map_or((term.coordinate.as_str(), false), |(_, name, length)| {
        (name, *length)
    });
    let amplitude = if is_length {
        format!("{:.3} mm", term.amplitude * 1e3)
    } else {
        format!("{:.4} deg", term.amplitude.to_degrees())
    };
    format!(
        "    {{ coordinate = \"{name}\", harmonic = {}, amplitude = \"{amplitude}\", phase = \"{:.2} deg\" }},\n",
        term.harmonic,
        term.phase_rad.to_degrees()
    )
}

/// Replaces the training runs of a description by `tables`; validation runs stay.
///
/// # Errors
/// Runs of the description that are not `[[experiment.run]]` tables.
pub(super) fn description(robot: &Robot, tables: &str) -> Result<String, Error> {
    let source = robot.source();
    let problem = |message: String| {
        let help = "write each run of the description as a table [[experiment.run]]";
        Error::from(
            Problem::new(Code::EXCITATION, message)
                .file(source.name.as_str())
                .help(help),
        )
    };
    let read = |text: &str| {
        let document = text.parse::<DocumentMut>();
        document.map_err(|error| problem(format!("the runs can't be written: {}", error.message())))
    };
    let (mut document, found) = (read(&source.text)?, read(tables)?);
    let not_separate = || problem("the runs of the description are not separate tables".to_owned());
    let mut implied = Table::new();
    implied.set_implicit(true);
    let experiment = document.entry("experiment").or_insert(Item::Table(implied));
    let experiment = experiment.as_table_mut().ok_or_else(not_separate)?;
    let own = experiment
        .entry("run")
        .or_insert(Item::ArrayOfTables(ArrayOfTables::new()));
    let own = own.as_array_of_tables_mut().ok_or_else(not_separate)?;
    let first = own.iter().next().and_then(Table::position);
    let found = found
        .get("experiment")
        .and_then(|table| table.get("run")?.as_array_of_tables());
    let mut all = ArrayOfTables::new();
    for table in found.into_iter().flatten() {
        let mut table = table.clone();
        table.set_position(first);
        all.push(table);
    }
    let is_held_out =
        |table: &&Table| table.get("validation").and_then(Item::as_bool) == Some(true);
    own.iter()
        .filter(is_held_out)
        .for_each(|table| all.push(table.clone()));
    *own = all;
    Ok(document.to_string())
}
