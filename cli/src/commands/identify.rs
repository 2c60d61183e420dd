//! `overact identify`: parameters from measured motion and torque, or from the virtual experiment.
//!
//! Measured or virtual, the identification sees positions and torques of the actuators only. The true
//! values of a virtual experiment stand beside the estimates and nowhere in them.

mod tracking;

use super::runs;
use crate::{failure::Failure, output, progress::Progress, report as files};
use overact::Model;
use overact_identification::{Dataset, Identification, identify};
use overact_robot::{InterpretedRobot, load::load_to_serve};
use std::path::PathBuf;

/// Arguments of the command.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Description
    #[arg(value_name = "TOML")]
    file: PathBuf,
    #[command(flatten)]
    runs: runs::Arguments,
    /// Kept actuators of case 2 [default: those of the description]
    #[arg(long, value_delimiter = ',', value_name = "ACTUATORS")]
    kept: Option<Vec<String>>,
    /// Let the virtual robot follow the held-out runs with a PD controller alone and with computed
    /// torques [default: where the runs are virtual and published results lie beside the description]
    #[arg(long)]
    tracking: bool,
    /// Write the tables (with --json the document) to a file instead of stdout
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    #[command(flatten)]
    reports: files::Arguments,
}

/// Runs the command.
///
/// # Errors
/// Logs that can't be used, a virtual experiment that can't be made, or data that determine nothing.
pub(super) fn run(arguments: &Arguments, as_json: bool) -> Result<(), Failure> {
    output::check_folder(arguments.output.as_deref())?;
    let robot = load_to_serve(&arguments.file)?;
    let reports = arguments
        .reports
        .check(&robot, arguments.output.as_deref())?;
    let kept = match &arguments.kept {
        Some(names) => Some(super::kept_actuators(&robot.model, names)?),
        None => None,
    };
    let served = InterpretedRobot::new(robot.model.clone());
    let runs = arguments.runs.runs(&robot, &served, as_json)?;
    let mut settings = arguments.runs.settings(&robot, &served.info(), &runs);
    settings.kept_actuators = kept.unwrap_or(settings.kept_actuators);
    let dataset = Dataset {
        runs: &runs.runs,
        validation: &runs.validation,
        true_values: runs.truth.as_ref(),
    };
    let bar = Progress::new("identifying", as_json);
    let mut result = identify(&served, &dataset, &settings, &|stage| {
        runs::tell(&bar, stage)
    })?;
    drop(bar);
    if !robot.description.identification.essential {
        without_essential(&mut result, robot.description.identification.r_sigma);
    }
    let beside = reports.published().filter(|_| arguments.runs.are_virtual());
    if arguments.tracking || beside.is_some() {
        result.tracking = tracking::tracking(&robot, &served, &result, as_json)?;
    }
    let text = if as_json {
        output::json(&result)?
    } else {
        let beside = reports.published();
        overact_report::report(&result) + &overact_report::beside(&result, beside)
    };
    // All files are written together, so that none is there without the others.
    let mut written = reports.written(&robot, &served.info(), &result)?;
    if let Some(path) = &arguments.output {
        let newline = if text.ends_with('\n') { "" } else { "\n" };
        written.push((path.clone(), format!("{text}{newline}").into_bytes()));
    }
    output::write(written)?;
    match arguments.output {
        Some(_) => Ok(()),
        None => output::print(&text),
    }
}

/// The base parameters only; the setting that kept the elimination from starting is put back.
fn without_essential(result: &mut Identification, r_sigma: f64) {
    let essential = overact_identification::Stage::Essential;
    result
        .estimates
        .retain(|estimate| estimate.stage != essential);
    result.cross_validation.retain(|one| one.stage != essential);
    result.settings.r_sigma = r_sigma;
    let figures = &mut result.figures;
    figures.predictions.retain(|one| one.stage != essential);
    figures.residuals.retain(|one| one.stage != essential);
}
