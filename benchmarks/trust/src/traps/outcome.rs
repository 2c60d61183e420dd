//! Parameter errors of an identification, and its verdict.

use super::{Trap, known_fault::KnownFault};
use crate::{Failure, Subject};
use overact_identification::{
    Check, CheckKind, Dataset, Estimate, Grade, Identification, LineError, Log, Stage, identify,
};
use overact_simulation::{Experiment, Record, simulate};
use serde::Serialize;

/// Half width of a 95 % interval in standard deviations.
const HALF_WIDTH: f64 = 1.96;

/// Errors above this number of standard deviations must be reported.
const LARGEST_ERROR: f64 = 3.0;

/// Level of a test family: a false alarm rate of a hundredth per report, shared by ten families
/// (`identification/src/assessment/checks/level.rs`).
const LEVEL: f64 = 0.01 / 10.0;

/// Detection rate below which a fault counts as invisible.
const INVISIBLE: f64 = 0.1;

/// Result of an identification of data with a known fault.
#[derive(Debug, Clone, Serialize)]
pub struct Outcome {
    /// Robot.
    pub robot: String,
    /// Fault.
    pub trap: String,
    /// Largest error of a recommended parameter of the first model, in standard deviations, and its
    /// name; `None` without an estimate.
    pub worst: Option<(f64, String)>,
    /// Largest error among the parameters that the verdict permits to use.
    pub worst_listed: Option<(f64, String)>,
    /// Size of the fault for a test that knows it, in standard deviations.
    ///
    /// It is the square root of the increase of the squared residual relative to the residual's
    /// standard deviation; `None` for faultless data.
    pub oracle: Option<f64>,
    /// Size of the fault in standard deviations of faultless data, if every report searches for it.
    pub honest: Option<f64>,
    /// Detection rate of a test at the report's level.
    ///
    /// It uses the standard deviation in faultless data if known, else white noise with everything
    /// else known.
    pub power: Option<f64>,
    /// Grade; `None` if the data are rejected with an error.
    pub grade: Option<Grade>,
    /// Failed checks.
    pub found: Vec<String>,
    /// First reason, or the error.
    pub words: String,
    /// Whether the report states as an assumption that such a fault may be hidden.
    pub assumed: bool,
}

/// Assessment of an outcome.
///
/// Parameters that may be used must be correct within three standard deviations, unless the fault
/// is named or invisible.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Standing {
    /// All usable parameters are within three standard deviations.
    Right,
    /// A usable parameter is wrong, and a failed check explains it.
    Named,
    /// A usable parameter is wrong, and no test of these data could detect it.
    Invisible,
    /// A usable parameter is wrong, and an assumption of the report covers it.
    Assumed,
    /// A usable parameter is wrong without any explanation.
    Missed,
}

impl Outcome {
    /// Assessment of the outcome.
    #[must_use]
    pub fn standing(&self) -> Standing {
        match &self.worst_listed {
            Some((size, _)) if *size > LARGEST_ERROR => {}
            _ => return Standing::Right,
        }
        if !self.found.is_empty() {
            Standing::Named
        } else if self.power.is_some_and(|power| power < INVISIBLE) {
            Standing::Invisible
        } else if self.assumed {
            Standing::Assumed
        } else {
            Standing::Missed
        }
    }
}

impl Standing {
    /// Name of the assessment.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Right => "",
            Self::Named => "named",
            Self::Invisible => "invisible",
            Self::Assumed => "assumption",
            Self::Missed => "MISSED",
        }
    }
}

/// Power of a two-sided test with a threshold in standard deviations.
fn power(deviations: f64, threshold: f64) -> f64 {
    let tail = |at: f64| 0.5 * libm::erfc(at / std::f64::consts::SQRT_2);
    tail(threshold - deviations) + tail(threshold + deviations)
}

/// Two-sided normal quantile of a level, a lower bound for tests of a family.
fn quantile(level: f64) -> f64 {
    let (mut low, mut high) = (0.0, 10.0);
    for _ in 0..60 {
        let middle: f64 = 0.5 * (low + high);
        let beyond = libm::erfc(middle / std::f64::consts::SQRT_2);
        *(if beyond > level { &mut low } else { &mut high }) = middle;
    }
    low
}

/// Records of a subject's experiment, the input of all traps.
///
/// # Errors
/// A run that fails.
pub fn prepared(subject: &Subject, experiment: &Experiment) -> Result<Vec<Record>, Failure> {
    Ok(simulate(subject.model(), experiment, &|_, _| ()).map_err(|error| error.to_string())?)
}

/// Outcome of a trap, given the identifications of its records and of `faultless` ones.
#[must_use]
pub fn outcome(
    subject: &Subject,
    trap: &Trap,
    records: Vec<Record>,
    faultless: &Identification,
) -> Outcome {
    let result = identified(subject, records);
    let start = Outcome {
        robot: subject.info().name.to_owned(),
        trap: trap.name.clone(),
        worst: None,
        worst_listed: None,
        oracle: None,
        honest: None,
        power: None,
        grade: None,
        found: Vec::new(),
        words: String::new(),
        assumed: trap.assumed.is_some(),
    };
    match result {
        Ok(result) => {
            let oracle = oracle(&result, faultless);
            let actuators = subject.info().actuators;
            let known = trap.known.first();
            let honest = known.and_then(|known| honest(faultless, known, actuators));
            let is_stated = |known: &KnownFault| known.stated_in(&result, actuators).is_some();
            let at_report = honest.map(|(size, threshold)| power(size, threshold));
            Outcome {
                oracle,
                honest: honest.map(|(size, _)| size),
                power: at_report.or(oracle.map(|size| power(size, quantile(LEVEL)))),
                assumed: start.assumed || trap.known.iter().any(is_stated),
                ..summary(&result, start)
            }
        }
        Err(error) => Outcome {
            words: error.to_string(),
            ..start
        },
    }
}

/// Failed checks of an identification of faultless records.
///
/// # Errors
/// Records that cannot be identified.
pub fn clean(subject: &Subject, records: Vec<Record>) -> Result<(Grade, Vec<Check>), Failure> {
    let result = identified(subject, records)?;
    let grade = result.grade();
    Ok((
        grade,
        result
            .checks
            .into_iter()
            .filter(|check| !check.passed)
            .collect(),
    ))
}

/// Increase of the squared residual of the base parameters due to a fault, in standard deviations.
fn oracle(result: &Identification, faultless: &Identification) -> Option<f64> {
    let [with, without] = [result, faultless].map(|one| one.estimates.first());
    let (with, without) = (with?, without?);
    let lines = with.lines.iter().zip(&without.lines).zip(&without.weights);
    let added: f64 = lines
        .map(|((with, without), weight)| {
            let per = |line: &LineError| line.residual_norm.powi(2) / line.equations as f64;
            weight * weight * (per(with) - per(without)) * without.equations as f64
        })
        .sum();
    Some(added.max(0.0).sqrt() / without.residual_deviation)
}

/// Size of a fault in standard deviations of faultless data, and the threshold of its check.
fn honest(
    faultless: &Identification,
    known: &KnownFault,
    actuators: &[&str],
) -> Option<(f64, f64)> {
    let (check, limit) = known.limit_in(faultless, actuators)?;
    if check.kind != CheckKind::EncoderOffset {
        // The thresholds of other checks allow for harmless sizes.
        return None;
    }
    Some((known.size?.abs() / limit.deviation, check.threshold))
}

/// Identifies from records.
///
/// # Errors
/// Records that cannot be identified.
pub fn identified(subject: &Subject, records: Vec<Record>) -> Result<Identification, Failure> {
    let log = |record: Record| {
        let n = record.actuators.len();
        Log::new(
            record.name,
            record.sampling_hz,
            n,
            record.positions,
            record.torques,
            record.payload,
        )
    };
    let runs = records
        .into_iter()
        .map(log)
        .collect::<Result<Vec<Log>, _>>()?;
    identified_logs(subject, &runs)
}

/// Identifies from logs.
///
/// # Errors
/// Logs that cannot be identified.
pub fn identified_logs(subject: &Subject, runs: &[Log]) -> Result<Identification, Failure> {
    let dataset = Dataset {
        runs,
        validation: &[],
        true_values: Some(&subject.truth),
        variants: &subject.variants.lent(),
        scales: Some(&subject.scales),
    };
    Ok(identify(
        subject.model(),
        &dataset,
        &subject.settings,
        &|_| {},
    )?)
}

fn summary(result: &Identification, start: Outcome) -> Outcome {
    let verdict = result.verdicts.first();
    let listed = |name: &str| {
        verdict.is_none_or(|verdict| {
            verdict.grade == Grade::Use
                || verdict.grade == Grade::UseListed && verdict.listed.iter().any(|one| one == name)
        })
    };
    let recommended = result
        .estimates
        .iter()
        .find(|one| one.stage == Stage::Recommended);
    let errors = recommended.map(errors).unwrap_or_default();
    let worst = |of: &dyn Fn(&str) -> bool| {
        let own = errors.iter().filter(|(_, name)| of(name));
        own.max_by(|a, b| a.0.total_cmp(&b.0)).cloned()
    };
    let found = result.checks.iter().filter(|check| !check.passed);
    let mut kinds: Vec<String> = found.map(|check| check.kind.name().to_owned()).collect();
    kinds.dedup();
    Outcome {
        worst: worst(&|_| true),
        worst_listed: worst(&listed),
        grade: Some(result.grade()),
        found: kinds,
        words: match verdict {
            Some(verdict) if verdict.grade != Grade::Use => verdict.reasons.first().cloned(),
            _ => result
                .checks
                .iter()
                .find(|check| !check.passed)
                .map(Check::located),
        }
        .unwrap_or_default(),
        ..start
    }
}

/// Errors of the parameters in standard deviations.
fn errors(estimate: &Estimate) -> Vec<(f64, String)> {
    let parameters = estimate.parameters.iter();
    let error = parameters.filter_map(|one| {
        let half = 0.5 * (one.interval_95[1] - one.interval_95[0]);
        Some((
            (one.value - one.true_value?).abs() * HALF_WIDTH / half,
            one.name.clone(),
        ))
    });
    error.collect()
}
