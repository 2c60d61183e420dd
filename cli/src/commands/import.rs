//! `overact import`: imports a description from a robot file in another format.

use crate::{
    failure::Failure,
    note::is_quiet,
    output::{self, check, emit, print},
};
use overact_codegen::diagnostic::visible;
use overact_interchange::{ClosureMisfit, Entry, Imported, Options};
use overact_robot::import;
use serde::Serialize;
use std::{
    io::{self, Write},
    path::{Path, PathBuf},
};

/// Arguments of the command.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// The robot: MJCF, URDF, SDFormat or .par
    #[arg(value_name = "FILE")]
    pub(super) file: PathBuf,
    /// The description to write instead of stdout
    #[arg(short, long, value_name = "TOML")]
    output: Option<PathBuf>,
    /// Name of the robot [default: that of the file]
    #[arg(long)]
    name: Option<String>,
    /// Also print notes on contents without effect on the dynamics, on stderr
    #[arg(long)]
    ignored: bool,
    /// Choices that the file does not determine
    #[command(flatten)]
    choices: Choices,
}

/// Choices on which the joints of the description depend, and with them the names of its parameters.
#[derive(Debug, clap::Args)]
pub(super) struct Choices {
    /// Fix a floating base at its position
    #[arg(long)]
    fix_base: bool,
    /// The model to import from an SDFormat world with several
    #[arg(long, value_name = "NAME")]
    model: Option<String>,
    /// The driven joints [default: those that the file names]
    #[arg(long, value_delimiter = ',', value_name = "JOINTS")]
    actuated: Option<Vec<String>>,
    /// Joints to use as independent coordinates [default: those with the cheapest chains]
    #[arg(long, value_delimiter = ',', value_name = "JOINTS")]
    coordinates: Option<Vec<String>>,
    /// Values of symbols of a .par file, lengths in m and angles in rad
    #[arg(long = "value", value_delimiter = ',', value_name = "SYMBOL=NUMBER", value_parser = position)]
    values: Vec<(String, f64)>,
    /// Joint positions at the start of the search for a closed configuration, rad or m
    #[arg(long, value_delimiter = ',', value_name = "JOINT=POSITION", value_parser = position)]
    home: Vec<(String, f64)>,
    /// Also read MJCF includes and meshes outside the folder of the file
    #[arg(long)]
    include_outside: bool,
    /// Largest misfit of a closure, in rad and as a fraction of the loops' size [default: 0.002]
    #[arg(long, value_name = "NUMBER", value_parser = tolerance)]
    closure_tolerance: Option<f64>,
}

impl Choices {
    /// Options of the importer.
    pub(super) fn options(&self) -> Options {
        Options {
            name: None,
            model: self.model.clone(),
            fix_base: self.fix_base,
            actuated: self.actuated.clone(),
            coordinates: self.coordinates.clone(),
            values: self.values.clone(),
            home: self.home.clone(),
            include_outside: self.include_outside,
            closure_tolerance: self.closure_tolerance,
        }
    }
}

fn tolerance(text: &str) -> Result<f64, String> {
    let value: f64 = text
        .trim()
        .parse()
        .map_err(|_| format!("`{text}` is not a number"))?;
    if (0.0..=0.1).contains(&value) {
        Ok(value)
    } else {
        Err("write a number between 0 and 0.1".to_owned())
    }
}

fn position(text: &str) -> Result<(String, f64), String> {
    let (name, value) = text.split_once('=').ok_or("write NAME=NUMBER")?;
    let value: f64 = value
        .trim()
        .parse()
        .map_err(|_| format!("`{value}` is not a number"))?;
    if value.is_finite() {
        Ok((name.trim().to_owned(), value))
    } else {
        Err(format!("`{value}` is not a finite number"))
    }
}

/// Runs the command.
///
/// # Errors
/// Errors of the file, contents that a description cannot express, or an output that cannot be
/// written.
pub(super) fn run(arguments: &Arguments, as_json: bool) -> Result<(), Failure> {
    let options = Options {
        name: arguments.name.clone(),
        ..arguments.choices.options()
    };
    let written = output::file(arguments.output.as_ref());
    let output: Vec<&Path> = written.into_iter().collect();
    check(&[&arguments.file], &output)?;
    let imported = import(&arguments.file, &options)?;
    let inputs: Vec<&Path> = imported.inputs.iter().map(PathBuf::as_path).collect();
    check(&inputs, &output)?;
    if !as_json {
        print_notes("reported", &imported.account.reported);
        if arguments.ignored {
            print_notes("ignored", &imported.account.ignored);
        }
        print_misfits(&imported.misfits);
        return emit(&imported.text, written);
    }
    let document = output::json(&Document::new(&imported))?;
    if written.is_some() {
        emit(&imported.text, written)?;
    }
    print(&document)
}

/// Prints unused contents of the files with their treatment, on stderr.
fn print_notes(treatment: &str, entries: &[Entry]) {
    for entry in entries.iter().filter(|_| !is_quiet()) {
        let (subject, reason) = (entry.subject(), entry.counted_reason());
        let text = format!("{subject}: {treatment}: {reason}");
        let note = format!(
            "{}:{}: {}",
            visible(&entry.file),
            entry.line,
            visible(&text)
        );
        // A closed stderr is ignored.
        let _ = writeln!(io::stderr(), "note: {note}");
    }
}

/// Prints changes that close the loops, on stderr.
fn print_misfits(misfits: &[ClosureMisfit]) {
    for own in misfits.iter().filter(|_| !is_quiet()) {
        let text = own.to_string();
        let (file, text) = (visible(&own.file), visible(&text));
        // A closed stderr is ignored.
        let _ = writeln!(io::stderr(), "note: {file}:{}: {text}", own.line);
    }
}

/// JSON document of an import.
#[derive(Debug, Serialize)]
struct Document<'d> {
    robot: &'d str,
    /// TOML text.
    description: &'d str,
    honoured: Vec<Item<'d>>,
    ignored: Vec<Item<'d>>,
    reported: Vec<Item<'d>>,
    /// Changes of closures and axes that close the loops.
    misfits: Vec<MisfitItem<'d>>,
    /// Rods whose rotation about their own line is held.
    spins: &'d [String],
}

/// Change of a closure or axis.
#[derive(Debug, Serialize)]
struct MisfitItem<'d> {
    file: &'d str,
    line: usize,
    name: &'d str,
    /// Displacement, m.
    length: f64,
    /// Rotation, rad.
    angle: f64,
}

impl<'d> MisfitItem<'d> {
    fn new(own: &'d ClosureMisfit) -> Self {
        Self {
            file: &own.file,
            line: own.line,
            name: &own.name,
            length: own.length,
            angle: own.angle,
        }
    }
}

/// Equal elements or attributes of a file.
#[derive(Debug, Serialize)]
struct Item<'d> {
    file: &'d str,
    line: usize,
    element: &'d str,
    attribute: Option<&'d str>,
    reason: &'d str,
    count: usize,
}

impl<'d> Document<'d> {
    fn new(imported: &'d Imported) -> Self {
        let items = |entries: &'d [Entry]| entries.iter().map(Item::new).collect();
        let account = &imported.account;
        Self {
            robot: &imported.name,
            description: &imported.text,
            honoured: items(&account.honoured),
            ignored: items(&account.ignored),
            reported: items(&account.reported),
            misfits: imported.misfits.iter().map(MisfitItem::new).collect(),
            spins: &imported.spins,
        }
    }
}

impl<'d> Item<'d> {
    fn new(entry: &'d Entry) -> Self {
        Self {
            file: &entry.file,
            line: entry.line,
            element: &entry.element,
            attribute: entry.attribute.as_deref(),
            reason: &entry.reason,
            count: entry.count,
        }
    }
}
