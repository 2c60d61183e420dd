//! `overact export --serial`: writes the skeleton as a serial robot with lumped inertia.

use super::{Arguments, SerialFormat};
use crate::{
    failure::Failure,
    input,
    output::{self, check, json, print},
};
use overact::Model;
use overact_interchange::{Format, Options};
use overact_report::layout::{columns, paragraph};
use overact_robot::{
    RangeOrigin, RelativeError, Robot, SerialModel, SerialSettings, read_parameters,
};
use serde_json::json;
use std::io::{self, Write};
use std::path::Path;

/// Relative error of the inertia matrix or of gravity above which a warning is printed.
const INACCURATE: f64 = 0.1;

/// Runs the command for a description.
///
/// # Errors
/// Errors of the description or the parameters, or an output that cannot be written.
pub(super) fn run(
    arguments: &Arguments,
    file: &Path,
    format: SerialFormat,
    as_json: bool,
) -> Result<(), Failure> {
    let output = output::file(arguments.output.as_ref());
    if as_json && output.is_none() {
        return Err(Failure::Usage(
            "the report is JSON: write the robot to a file, `-o FILE`".to_owned(),
        ));
    }
    if arguments.choices.options() != Options::default() {
        return Err(Failure::Usage(
            "`--serial` exports a description: leave out the options of the import".to_owned(),
        ));
    }
    let states = arguments.states.as_deref();
    let outputs: Vec<&Path> = output.into_iter().chain(states).collect();
    let inputs: Vec<&Path> = std::iter::once(file)
        .chain(arguments.parameters.as_deref())
        .collect();
    check(&inputs, &outputs)?;
    let compiled = input::compiled(file, &Robot::serial_request(), as_json)?;
    let robot = Robot::new(compiled);
    let mut settings = SerialSettings::new(match format {
        SerialFormat::Mjcf => Format::Mjcf,
        SerialFormat::Urdf => Format::Urdf,
    });
    let mut warnings = Vec::new();
    if let Some(parameters) = &arguments.parameters {
        let info = robot.model().info();
        let given = read_parameters(parameters, robot.description(), &info)?;
        warnings = given.warnings;
        settings.parameters = Some(given.values);
    }
    let model = robot.serial(&settings)?;
    warnings.extend(inaccurate(&model));
    let mut files = Vec::new();
    if let Some(states) = states {
        files.push((states.to_owned(), table(&model).into_bytes()));
    }
    if let Some(output) = output {
        files.push((output.to_owned(), model.text.clone().into_bytes()));
    }
    output::write(files)?;
    if as_json {
        let mut document = serde_json::to_value(&model).unwrap_or_default();
        document["file"] = json!(output);
        document["warnings"] = json!(warnings);
        return print(&json(&document)?);
    }
    let mut report = report(&model);
    for warning in &warnings {
        paragraph(&mut report, "", &format!("warning: {warning}"));
    }
    if output.is_some() {
        return print(&report);
    }
    // A closed stderr is ignored.
    let _ = write!(io::stderr(), "{report}");
    print(&model.text)
}

/// Warning about errors that lumped inertia leaves.
fn inaccurate(model: &SerialModel) -> Option<String> {
    let errors = [Some(model.inertia_matrix), model.gravity];
    let largest = errors.iter().flatten().map(|error| error.rms);
    let largest = largest.fold(0.0, f64::max);
    (largest > INACCURATE).then(|| {
        format!(
            "the serial model differs by up to {:.0} % rms, since lumped inertia cannot follow loops that change their shape: use the closed model where this matters",
            100.0 * largest
        )
    })
}

/// The report as text.
fn report(model: &SerialModel) -> String {
    let percent = |value: f64| {
        let value = 100.0 * value;
        if value >= 1e-3 {
            format!("{value:.3}")
        } else {
            format!("{value:.1e}")
        }
    };
    let row = |name: &str, error: Option<RelativeError>| {
        let cells = error.map_or_else(
            || ["-".to_owned(), "-".to_owned()],
            |error| [percent(error.rms), percent(error.largest)],
        );
        let [rms, largest] = cells;
        vec![name.to_owned(), rms, largest]
    };
    let header = ["error, % of the rms", "rms", "largest"];
    let rows = [
        header.map(str::to_owned).to_vec(),
        row("inertia matrix", Some(model.inertia_matrix)),
        row("torque of gravity", model.gravity),
        row("centrifugal and Coriolis torques", model.velocity_torques),
    ];
    let mut text = columns(&rows, &[true]);
    let ranges = model.coordinates.iter().zip(&model.half_ranges);
    let ranges: Vec<String> = ranges
        .map(|(name, range)| {
            format!(
                "{name} ± {}",
                overact_identification::significant(*range, 3)
            )
        })
        .collect();
    let origin = match model.origin {
        RangeOrigin::Limits => "of [excitation]",
        RangeOrigin::Runs => "of the runs",
        RangeOrigin::Assumed => "assumed",
    };
    paragraph(
        &mut text,
        "",
        &format!(
            "{} states around home, {} (rad, m; {origin})",
            model.state_count,
            ranges.join(", ")
        ),
    );
    if model.rejected_states > 0 {
        let message = format!(
            "note: {} other states of these ranges are outside the workspace",
            model.rejected_states
        );
        paragraph(&mut text, "", &message);
    }
    if model.ambiguous_states > 0 {
        let message = format!(
            "warning: a singularity of the motors separates {} states from home: equal motor positions have several poses there",
            model.ambiguous_states
        );
        paragraph(&mut text, "", &message);
    }
    for note in &model.notes {
        paragraph(&mut text, "", &format!("note: {note}"));
    }
    text
}

/// The states as a table that `overact evaluate --states` reads.
fn table(model: &SerialModel) -> String {
    let r = model.home.len();
    let names = |of: &str| (0..r).map(|at| format!("{of}[{at}]")).collect::<Vec<_>>();
    let mut text = [names("pose"), names("twist")].concat().join(",");
    text.push('\n');
    for (pose, twist) in &model.states {
        let numbers: Vec<String> = pose.iter().chain(twist).map(|x| format!("{x:?}")).collect();
        text += &numbers.join(",");
        text.push('\n');
    }
    text
}
