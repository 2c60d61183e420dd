//! Evaluation of one draw: simulation, noise, identification and intervals.

use crate::{Failure, Noise, Subject, draw};
use overact_identification::{
    Estimate, Estimator, Instruments, Log, ModelKind, ParameterEstimate, Settings, Stage,
    estimate_projection, prepare,
};
use overact_robot::beside_simulated;
use overact_simulation::Experiment;

/// Intervals of one estimate of one draw.
#[derive(Debug, Clone, PartialEq)]
pub struct DrawIntervals {
    /// Factors on the description's noise.
    pub noise: Noise,
    /// Model of the estimate.
    pub model: ModelKind,
    /// Stage of the estimate.
    pub stage: Stage,
    /// Estimator.
    pub estimator: Estimator,
    /// Whether position errors were found to bias least squares, if tested.
    pub flagged: Option<bool>,
    /// Parameters with known true values.
    pub parameters: Vec<Interval>,
}

/// Comparison of one 95 % interval with the true value.
#[derive(Debug, Clone, PartialEq)]
pub struct Interval {
    /// Name of the parameter.
    pub name: String,
    /// Whether it contains the true value.
    pub covers: bool,
    /// Width relative to that of the base model's interval.
    pub relative_width: f64,
    /// Error relative to the half width.
    pub miss: f64,
}

/// Evaluates draw number `draw` of a subject under each noise.
///
/// # Errors
/// A draw that cannot be simulated or identified.
pub fn measure(
    subject: &Subject,
    draw: u64,
    noises: &[Noise],
) -> Result<Vec<DrawIntervals>, Failure> {
    let experiment = draw::varied(subject, draw)?;
    let mut encoders: Vec<f64> = noises.iter().map(|noise| noise.encoder).collect();
    encoders.sort_by(f64::total_cmp);
    encoders.dedup();
    let mut counted = Vec::new();
    for encoder in encoders {
        let records = draw::records(subject, &experiment, encoder)?;
        for &noise in noises.iter().filter(|noise| noise.encoder == encoder) {
            let logs = draw::logs(subject, &records, noise.torque, draw)?;
            counted.extend(identified(subject, &experiment, noise, logs)?);
        }
    }
    Ok(counted)
}

/// Identifies from runs and counts the intervals.
///
/// With coarser encoders than described, there is also an estimate by instrumental variables. Its
/// instruments come from the simulated robot, because quantisation errors repeat with a periodic
/// motion.
fn identified(
    subject: &Subject,
    experiment: &Experiment,
    noise: Noise,
    logs: Vec<Log>,
) -> Result<Vec<DrawIntervals>, Failure> {
    let coarse = noise.encoder > 1.0;
    let settings = Settings {
        instruments: if coarse {
            Instruments::Simulated
        } else {
            Instruments::None
        },
        ..subject.settings.clone()
    };
    let logs = if coarse {
        let beside = beside_simulated(subject.model(), experiment, logs, &settings);
        beside.map_err(|error| error.render(false))?
    } else {
        logs
    };
    let projections = subject.projections();
    let prepared = prepare(subject.model(), &logs, &projections, &settings, &|_| {})?;
    let mut counted = Vec::new();
    for projection in 0..projections.len() {
        let truth = Some(&subject.truth);
        let outcome = estimate_projection(&prepared, projection, &settings, truth)?;
        let comparison = &outcome.errors_in_regressor;
        let spoils = comparison.parameters.iter().any(|one| one.spoiled);
        let flagged = comparison
            .agreement
            .as_ref()
            .map(|own| own.differs && spoils);
        let least_squares = [&outcome.base, &outcome.recommended, &outcome.essential];
        for estimate in least_squares.into_iter().chain(&outcome.instrumental) {
            counted.push(DrawIntervals {
                noise,
                model: estimate.model,
                stage: estimate.stage,
                estimator: estimate.estimator,
                flagged,
                parameters: intervals(estimate, &outcome.base),
            });
        }
    }
    Ok(counted)
}

/// Intervals of an estimate, compared with those of the base model.
fn intervals(estimate: &Estimate, base: &Estimate) -> Vec<Interval> {
    let width = |parameter: &ParameterEstimate| {
        let [low, high] = parameter.interval_95;
        high - low
    };
    let one = |parameter: &ParameterEstimate| {
        let truth = parameter.true_value?;
        let whole = base
            .parameters
            .iter()
            .find(|one| one.column == parameter.column)?;
        let [low, high] = parameter.interval_95;
        Some(Interval {
            name: parameter.name.clone(),
            covers: low <= truth && truth <= high,
            relative_width: width(parameter) / width(whole),
            miss: (parameter.value - truth) / (0.5 * width(parameter)),
        })
    };
    estimate.parameters.iter().filter_map(one).collect()
}
