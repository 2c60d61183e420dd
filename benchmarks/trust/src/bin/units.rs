//! `units ROBOTS…`: results of identifications of logs with time, positions or torques in another
//! unit.

use clap::Parser;
use overact_identification::Grade;
use overact_trust::{
    Failure, Subject,
    units::{Cell, Slip, Verdict, cells},
};
use std::{collections::BTreeMap, fmt::Write as _, fs, path::PathBuf, process::ExitCode};

/// Makes the matrix of robots and slips.
#[derive(Debug, Parser)]
struct Arguments {
    /// Descriptions with virtual experiments
    #[arg(value_name = "TOML", required = true)]
    robots: Vec<PathBuf>,
    /// Only units that contain this
    #[arg(long, default_value = "")]
    only: String,
    /// Shorten all runs to this part of their duration
    #[arg(long, default_value_t = 0.25)]
    part: f64,
    /// Write the cells as JSON, too
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

/// Counts of a table row.
#[derive(Default)]
struct Row {
    cells: usize,
    used: usize,
    partly: usize,
    refused: usize,
    errors: usize,
    named: usize,
}

impl Row {
    fn take(&mut self, cell: &Cell) {
        self.cells += 1;
        match cell.verdict {
            Verdict::Error => self.errors += 1,
            Verdict::Graded(Grade::Use) => self.used += 1,
            Verdict::Graded(Grade::UseListed) => self.partly += 1,
            Verdict::Graded(Grade::DoNotUse) => self.refused += 1,
        }
        self.named += usize::from(cell.named);
    }
}

/// Row that a cell belongs to.
fn title(slip: Option<&Slip>) -> String {
    slip.map_or_else(
        || String::from("none"),
        |slip| {
            let signal = slip.signal.name();
            format!("{signal} in {}, {:?}", slip.unit, slip.drives).to_lowercase()
        },
    )
}

/// One row for each unit error.
fn table(cells: &[Cell]) -> String {
    let mut rows: BTreeMap<String, Row> = BTreeMap::new();
    for cell in cells {
        rows.entry(title(cell.slip.as_ref()))
            .or_default()
            .take(cell);
    }
    let mut text = String::from(
        "| slip | cells | use it | in part | do not use it | error | named |\n|---|---:|---:|---:|---:|---:|---:|\n",
    );
    for (title, row) in &rows {
        let _ = writeln!(
            text,
            "| {title} | {} | {} | {} | {} | {} | {} |",
            row.cells, row.used, row.partly, row.refused, row.errors, row.named
        );
    }
    text
}

fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut all = Vec::new();
    for path in &arguments.robots {
        let mut subject = Subject::load(path)?;
        subject.shorten(arguments.part);
        all.extend(cells(&subject, &arguments.only)?);
    }
    println!("{}", table(&all));
    if let Some(path) = &arguments.json {
        fs::write(path, serde_json::to_string_pretty(&all)?)?;
    }
    Ok(())
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}
