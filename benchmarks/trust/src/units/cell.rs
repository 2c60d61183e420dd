//! Result of an identification of a log with a unit error.

use super::slip::{Drives, Signal, Slip, slips};
use crate::{Failure, Subject};
use overact_identification::{
    Check, CheckKind, Dataset, Grade, Identification, Log, Settings, identify,
};
use overact_simulation::{Record, simulate};

/// Tolerance factor of a reported factor.
const ALIKE: f64 = 1.5;

/// Cell of the matrix: a robot, a unit error, and whether the description has `filter_cutoff`.
#[derive(Debug, Clone, serde::Serialize)]
pub struct Cell {
    /// Name of the robot.
    pub robot: String,
    /// Unit error; `None` for the unchanged log.
    pub slip: Option<Slip>,
    /// Whether `filter_cutoff` is given.
    pub with_cutoff: bool,
    /// Verdict.
    pub verdict: Verdict,
    /// Whether the signal and the factor are reported.
    pub named: bool,
    /// First words of the report.
    pub words: String,
}

/// Verdict on a log.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// An error.
    Error,
    /// An estimate with a grade.
    Graded(Grade),
}

/// All cells of a robot, first those without a unit error.
///
/// # Errors
/// An experiment that fails.
pub fn cells(subject: &Subject, only: &str) -> Result<Vec<Cell>, Failure> {
    let records = simulate(subject.model(), &subject.experiment, &|_, _| ());
    let records = records.map_err(|error| error.to_string())?;
    let info = subject.info();
    let slips = slips(&info).into_iter().map(Some);
    let slips = slips.filter(|slip| slip.is_some_and(|slip| slip.unit.contains(only)));
    let mut all = Vec::new();
    for slip in std::iter::once(None).chain(slips) {
        let mut own = records.clone();
        if let Some(slip) = slip {
            own.iter_mut().for_each(|record| slip.apply(&info, record));
        }
        for with_cutoff in [true, false] {
            let cell = cell(subject, slip, own.clone(), with_cutoff);
            eprintln!("{cell:?}");
            all.push(cell);
        }
    }
    Ok(all)
}

/// A cell.
fn cell(subject: &Subject, slip: Option<Slip>, records: Vec<Record>, with_cutoff: bool) -> Cell {
    let result = identified(subject, records, with_cutoff);
    let (verdict, named, words) = match &result {
        Ok(result) => {
            let found: Vec<&Check> = result.checks.iter().filter(|one| !one.passed).collect();
            let named = slip.is_some_and(|slip| found.iter().any(|check| names(check, &slip)));
            let words = found
                .iter()
                .map(|check| check.located())
                .collect::<Vec<_>>()
                .join(" | ");
            (Verdict::Graded(result.grade()), named, words)
        }
        Err(error) => {
            let words = error.to_string();
            let named = slip.is_some_and(|slip| words.contains(question(&slip)));
            (Verdict::Error, named, words)
        }
    };
    Cell {
        robot: subject.info().name.to_owned(),
        slip,
        with_cutoff,
        verdict,
        named,
        words,
    }
}

/// Whether a check reports a unit error: signal and factor, or the gain of the only affected drive.
fn names(check: &Check, slip: &Slip) -> bool {
    if slip.signal == Signal::Torques
        && slip.drives == Drives::One
        && check.kind == CheckKind::WrongGain
    {
        return true;
    }
    if check.kind == CheckKind::Degrees {
        return slip.unit == "deg";
    }
    let ratio = check.factor.map_or(0.0, |factor| factor / slip.factor);
    check.signal == Some(slip.signal.name()) && (1.0 / ALIKE..ALIKE).contains(&ratio)
}

/// Question in an error message that identifies a unit error.
fn question(slip: &Slip) -> &'static str {
    match slip.unit {
        "ms" => "in milliseconds?",
        "µs" => "in microseconds?",
        "ns" => "in nanoseconds?",
        "min" => "in minutes?",
        "deg" => "degrees",
        "mrad" => "in mrad?",
        "turns" => "in turns?",
        "mm" => "in mm?",
        _ => "torques in",
    }
}

/// Identifies from records as the command line does.
fn identified(
    subject: &Subject,
    records: Vec<Record>,
    with_cutoff: bool,
) -> Result<Identification, Failure> {
    let frequency = records.first().map_or(0.0, |record| record.sampling_hz);
    let settings = settings(subject, frequency, with_cutoff);
    let log = |record: Record| {
        let n = record.actuators.len();
        let (positions, torques) = (record.positions, record.torques);
        Log::new(
            record.name,
            record.sampling_hz,
            n,
            positions,
            torques,
            record.payload,
        )
    };
    let runs: Vec<Log> = records.into_iter().map(log).collect::<Result<_, _>>()?;
    let dataset = Dataset {
        runs: &runs,
        validation: &[],
        true_values: Some(&subject.truth),
        variants: &subject.variants.lent(),
        scales: Some(&subject.scales),
    };
    Ok(identify(subject.model(), &dataset, &settings, &|_| {})?)
}

/// Settings of a description with or without `filter_cutoff`, for a sampling frequency (Hz).
fn settings(subject: &Subject, frequency: f64, with_cutoff: bool) -> Settings {
    let described = subject.settings_at(frequency);
    let usual = Settings::for_sampling_frequency(frequency, &subject.info());
    let own = subject.experiment.sampling_hz;
    let cutoff = |frequency: f64| subject.settings_at(frequency).filter_cutoff_hz;
    let is_given = (cutoff(own) - cutoff(2.0 * own)).abs() < f64::EPSILON * cutoff(own);
    let settings = if with_cutoff {
        Settings {
            filter_cutoff_hz: if is_given { cutoff(own) } else { 0.05 * own },
            ..described
        }
    } else {
        Settings {
            filter_cutoff_hz: usual.filter_cutoff_hz,
            decimation: usual.decimation,
            ..described
        }
    };
    settings.trimmed(frequency)
}
