//! Collects runs from factor files: compatible ones, each once.

use overact::Code;
use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
};

use super::{
    excluded_run::{ExcludedRun, Reason},
    read::read_factors,
    run::RunFactors,
};
use overact_logs::{Error, Problem};

/// Runs of several files, and what was left out.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct CollectedRuns {
    /// Runs, in the order of the files.
    pub runs: Vec<RunFactors>,
    /// Runs and files that were left out.
    pub left_out: Vec<ExcludedRun>,
}

/// Reads factor files.
///
/// Duplicate runs are counted once and reported. Other unusable runs are left out if `skip_bad`.
/// `settings_hash` is the required hash of description and settings. By default it is the most
/// frequent one, or the first of equally frequent ones.
///
/// # Errors
/// All unusable runs and files together, unless they are skipped; no run at all.
pub fn gather(
    files: &[PathBuf],
    settings_hash: Option<&str>,
    skip_bad: bool,
) -> Result<CollectedRuns, Error> {
    let mut left_out = Vec::new();
    let mut found: Vec<(String, RunFactors)> = Vec::new();
    for path in files {
        read_into(path, &mut found, &mut left_out);
    }
    let settings_hash = settings_hash
        .map(str::to_owned)
        .or_else(|| most_frequent_hash(&found));
    let alike =
        |(_, run): &&(String, RunFactors)| Some(&run.settings_hash) == settings_hash.as_ref();
    let model = found.iter().find(alike).map(|(_, run)| run.clone());
    let mut seen: BTreeMap<String, String> = BTreeMap::new();
    let mut runs = Vec::new();
    for (file, run) in found {
        let name = Some(run.summary.name.clone());
        if settings_hash
            .as_ref()
            .is_some_and(|settings_hash| *settings_hash != run.settings_hash)
        {
            let (reason, message) = (Reason::Unlike, difference(&run, model.as_ref()));
            left_out.push(ExcludedRun {
                file,
                run: name,
                reason,
                message,
            });
            continue;
        }
        if let Some(other) = seen.get(&run.content) {
            let message = format!("it is the same run as {other} and counts once");
            let reason = Reason::Twice;
            left_out.push(ExcludedRun {
                file,
                run: name,
                reason,
                message,
            });
            continue;
        }
        seen.insert(run.content.clone(), format!("`{}` in {file}", run.title()));
        runs.push(run);
    }
    if !skip_bad {
        let bad = left_out.iter().filter(|one| one.reason != Reason::Twice);
        Error::check(bad.map(ExcludedRun::problem).collect())?;
    }
    if runs.is_empty() {
        let mut problems: Vec<Problem> = left_out.iter().map(ExcludedRun::problem).collect();
        problems.push(
            Problem::new(Code::FACTORS, "no run is left in the factor files")
                .help("give at least one"),
        );
        return Err(problems.into());
    }
    Ok(CollectedRuns { runs, left_out })
}

fn read_into(path: &Path, found: &mut Vec<(String, RunFactors)>, left_out: &mut Vec<ExcludedRun>) {
    let file = path.display().to_string();
    let damaged = match read_factors(path) {
        Ok(read) => {
            found.extend(read.runs.into_iter().map(|run| (file.clone(), run)));
            read.damaged
        }
        Err(damaged) => vec![damaged],
    };
    left_out.extend(damaged.into_iter().map(|one| ExcludedRun {
        file: file.clone(),
        run: one.run,
        reason: one.reason,
        message: one.message,
    }));
}

/// Describes how a run differs from a compatible one, as far as the files show.
fn difference(run: &RunFactors, other: Option<&RunFactors>) -> String {
    let made = "it was made with another description, or with other settings of filters and model";
    let rate = run.summary.sampling_frequency;
    let why = match other {
        Some(other) if other.robot != run.robot => {
            format!(
                "it is of the robot `{}`, the others of `{}`",
                run.robot, other.robot
            )
        }
        Some(other) if other.summary.sampling_frequency != rate => format!(
            "it was sampled at {rate} Hz, the others at {} Hz, and settings follow from the rate",
            other.summary.sampling_frequency
        ),
        _ => format!(
            "it is of a robot `{}`, but the text of the description differs (a comment suffices), or other actuators were kept",
            run.robot
        ),
    };
    format!("{made}: {why}")
}

/// The most frequent hash of description and settings; the first of equally frequent ones.
fn most_frequent_hash(found: &[(String, RunFactors)]) -> Option<String> {
    let count = |settings_hash: &str| {
        found
            .iter()
            .filter(|(_, run)| run.settings_hash == settings_hash)
            .count()
    };
    let mut best: Option<(usize, &str)> = None;
    for (_, run) in found {
        let own = count(&run.settings_hash);
        if best.is_none_or(|(largest, _)| own > largest) {
            best = Some((own, &run.settings_hash));
        }
    }
    best.map(|(_, settings_hash)| settings_hash.to_owned())
}
