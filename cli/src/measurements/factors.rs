//! `overact identify --factors`: identifies parameters from factor files.

use super::runs;
use crate::{failure::Failure, output, progress::Progress};
use overact_identification::{
    Progress as Doing,
    factors::{Deviations, ExcludedRun, FactorEstimation, gather},
};
use overact_robot::Robot;
use std::{
    fmt::Write,
    path::{Path, PathBuf},
};

/// Options of the identification from factors.
pub(crate) struct Request<'a> {
    pub(crate) description: &'a Path,
    pub(crate) files: &'a [PathBuf],
    pub(crate) skip_bad: bool,
    pub(crate) kept: Option<&'a [String]>,
    pub(crate) output: Option<&'a Path>,
    pub(crate) as_json: bool,
}

/// Identifies a robot from factor files.
///
/// # Errors
/// Files that cannot be used, unless they are to be skipped, or factors that do not match the
/// description.
pub(crate) fn run(request: &Request<'_>) -> Result<(), Failure> {
    let files = request.files.iter().map(PathBuf::as_path);
    let inputs: Vec<&Path> = std::iter::once(request.description).chain(files).collect();
    output::check(&inputs, request.output.as_slice())?;
    let robot = Robot::from_toml(request.description)?;
    let kept = request
        .kept
        .map(|names| overact_robot::kept_actuators(robot.model().model(), names));
    // The settings follow from the sampling frequency of the first run, as for logs.
    let first = gather(request.files, None, true)?;
    let rate = first
        .runs
        .first()
        .map_or(0.0, |run| run.summary.sampling_frequency);
    let mut settings = robot.settings(rate);
    settings.kept_actuators = kept.transpose()?.unwrap_or(settings.kept_actuators);
    let settings_hash = robot.settings_hash(&settings);
    let gathered = gather(request.files, Some(&settings_hash), request.skip_bad)?;
    let bar = Progress::new("identifying", request.as_json);
    let tell = |doing: Doing<'_>| runs::tell(&bar, doing);
    let found = robot.identify_factors(&gathered, &settings, request.skip_bad, &tell)?;
    drop(bar);
    let text = if request.as_json {
        output::json(&found)?
    } else {
        text(&found)
    };
    output::emit(&text, request.output)
}

/// Text output.
fn text(found: &FactorEstimation) -> String {
    let mut text = format!(
        "{} from the factors of {}\n\n",
        found.robot,
        output::counted(found.runs.len(), "run", "runs")
    );
    for estimate in &found.estimates {
        text.push_str(&overact_report::estimate(estimate));
        text.push('\n');
    }
    text.push_str(match found.deviations {
        Deviations::Equations => "Intervals are those of the logs: the files contain the equations.\n",
        Deviations::Parts => {
            "Intervals follow from sums over parts of the runs, not from single equations. They can be wider or\n\
             narrower than those of the logs, and other parameters can be recommended. Standard deviations of\n\
             smaller models assume white residuals. Factor the logs with --equations for the intervals of logs.\n"
        }
    });
    text.push_str("The checks of raw data and residuals need logs and were not made.\n");
    for warning in &found.warnings {
        let _ = writeln!(text, "warning: {warning}");
    }
    text.push_str(&left_out(&found.left_out));
    text
}

/// Omitted runs, one per line.
pub(crate) fn left_out(all: &[ExcludedRun]) -> String {
    let mut text = String::new();
    if !all.is_empty() {
        let _ = writeln!(text, "left out: {}", all.len());
    }
    for one in all {
        let run = one.run.as_ref().map(|run| format!(" run `{run}`:"));
        let _ = writeln!(
            text,
            "  {}:{} {}",
            one.file,
            run.unwrap_or_default(),
            one.message
        );
    }
    text
}
