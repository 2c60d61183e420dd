//! Validation of estimated parameters on a run, sections 5.3 and 5.4 of the paper.
//!
//! Predicted Γ = W χ is compared with the measured one, line by line, after the decimation of the
//! identification. The torques of all actuators are compared, too. Their prediction is the
//! least-norm one, τ = J_p^inv (J_p^invᵀ J_p^inv)^-1 Γ¹, so a preload of a redundant robot counts
//! as error. The measured torques without preload are those of eq. (50).
//!
//! A run is read once for any number of estimates. Each sample has one row with the measurements
//! and all predictions, and these rows are decimated.

mod layout;

use overact::{Function, Info, Model};
use rayon::prelude::*;
use serde::Serialize;

use crate::{
    blocks::{BLOCK, slice},
    estimation::estimate::{LineError, overall, percent},
    kinematics::{
        Motion, Motions,
        distribution::{least_multipliers, least_norm, product, transposed_product},
    },
    regression::{
        Chunk,
        observer::Observer,
        points::Points,
        projection::{Projection, actuator_units},
        sink::Plan,
    },
    series::{RunFigures, Series},
};
use overact_logs::{Error, Log, monitor::Monitor};

use layout::{Label, Layout, Pair, Sums};

/// Entry of one actuator in Table 3.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TorqueComparison {
    /// Name of the actuator.
    pub actuator: String,
    /// 100 ||τ - τ*||/||τ|| with the least-norm torque τ*.
    pub least_norm_percent: f64,
    /// 100 ||τ - τ*||/||τ|| with the torque τ* of eq. (26) without overconstraint.
    ///
    /// It satisfies the model but is not of least norm. `None` without redundancy, and for models
    /// without closure matrices.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub closure_percent: Option<f64>,
}

/// Prediction errors of parameters on a run.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Validation {
    /// Name of the run.
    pub run: String,
    /// ||Y - W χ|| of all lines (N or N m, mixed for mixed lines).
    pub residual_norm: f64,
    /// 100 ||Y - W χ||/||Y|| of all lines.
    pub relative_error_percent: f64,
    /// Errors of each line of Γ.
    pub lines: Vec<LineError>,
    /// Errors of each actuator's torque, predicted with least norm.
    pub torques: Vec<LineError>,
    /// Errors of each measured torque without its internal part (50).
    ///
    /// Empty without redundancy.
    pub projected_torques: Vec<LineError>,
    /// Errors of each actuator's torque for both predictions.
    pub table: Vec<TorqueComparison>,
    /// Lines of Γ over time.
    pub line_series: Vec<Series>,
    /// Torques over time.
    pub torque_series: Vec<Series>,
}

/// Parameters whose predictions are compared with a run.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Candidate<'a> {
    /// Index of their projection.
    pub(crate) projection: usize,
    /// Indices of their columns among the base parameters.
    pub(crate) selected: &'a [usize],
    /// Values (SI units).
    pub(crate) values: &'a [f64],
}

impl Candidate<'_> {
    /// Predicts the lines of Γ for a sample, and writes measured and predicted values to a row.
    ///
    /// Each equation comes with what was subtracted from its measurement.
    fn predict<'e>(
        &self,
        equations: impl Iterator<Item = (&'e [f64], f64)>,
        place: impl Fn(usize) -> Pair,
        row: &mut [f64],
    ) -> Vec<f64> {
        let mut all = Vec::new();
        for (line, (equation, subtracted)) in equations.enumerate() {
            let terms = self.selected.iter().zip(self.values);
            let own: f64 = terms.map(|(&column, value)| equation[column] * value).sum();
            let predicted = own + subtracted;
            row[place(line).measured] = equation[equation.len() - 1] + subtracted;
            row[place(line).predicted] = predicted;
            all.push(predicted);
        }
        all
    }
}

/// Results on a validation run.
pub(crate) struct Validated {
    /// For each candidate its comparison, or the error.
    pub(crate) validations: Vec<Result<Validation, Error>>,
    /// Motion of the run, for plots.
    pub(crate) motion: RunFigures,
    /// Largest closure residual of the measured positions (m, rad).
    pub(crate) closure_residual: f64,
    /// Statistics of its raw numbers.
    pub(crate) monitor: Monitor,
}

/// Compares a run with the predictions of several sets of parameters.
///
/// A projection that is singular on the run has an error instead.
///
/// # Errors
/// A run that does not fit, a sample outside the workspace, a file that cannot be read.
pub(crate) fn validate(
    observer: &Observer<'_>,
    log: &Log,
    candidates: &[Candidate<'_>],
    progress: &dyn Fn(usize, usize),
) -> Result<Validated, Error> {
    let info = observer.model.info();
    let mut motions = Motions::new(observer.model, log, observer.settings)?;
    let samples = motions.samples();
    let decimator = observer
        .settings
        .decimator(observer.settings.decimation, log.sampling_frequency())?;
    let layout = Layout::new(info.sizes, candidates.len(), offers_closure(observer.model));
    let mut stream = decimator.stream(layout.width(), samples)?;
    let mut failed: Vec<Option<Error>> = observer.projections.iter().map(|_| None).collect();
    let plan = Plan::new(decimator.kept(samples), 0);
    let stride = plan.stride();
    let mut points = Points::new(observer, log, &decimator, samples, &plan);
    let mut sums = Sums::new(&layout, stride);
    let mut closure_residual = 0.0_f64;
    let mut counted = observer.settings.validation_samples;
    let prediction_rows = PredictionRows {
        observer,
        layout: &layout,
        candidates,
    };
    while let Some(motion) = motions.next()? {
        closure_residual = closure_residual.max(motion.closure_residual);
        let blocks = motion.samples.div_ceil(BLOCK);
        let chunks = observer.chunks(&motion, 0..blocks, &mut failed)?;
        let rows = |(index, chunk)| prediction_rows.of(&motion, index * BLOCK, chunk, &failed);
        let rows = chunks.par_iter().enumerate().map(rows);
        let rows = rows.collect::<Result<Vec<Vec<f64>>, Error>>()?;
        let mut kept = Vec::new();
        rows.iter().for_each(|rows| stream.push(rows, &mut kept));
        if let Some(left) = &mut counted {
            kept.truncate(*left * layout.width());
            *left -= kept.len() / layout.width();
        }
        sums.take(&kept);
        let conditions: Vec<_> = chunks.into_iter().map(|chunk| chunk.conditions).collect();
        points.take(&motion, &conditions);
        progress(motions.done(), log.samples());
    }
    progress(log.samples(), log.samples());
    let first = observer.settings.skip_start + decimator.first(samples);
    let time = |point: usize| {
        (first + point * stride * decimator.factor()) as f64 / log.sampling_frequency()
    };
    let actuators = labels(info.actuators.iter().copied(), actuator_units(&info));
    let of_candidate = |(number, candidate): (usize, &Candidate<'_>)| {
        let projection = &observer.projections[candidate.projection];
        if let Some(error) = &failed[candidate.projection] {
            return Err(error.clone());
        }
        let names = projection.line_names(&info);
        let names = names.iter().map(String::as_str);
        let lines = labels(names, projection.line_units(&info));
        Ok(validation(
            &sums,
            number,
            log.name(),
            &actuators,
            &lines,
            &time,
        ))
    };
    points.partitions(observer.projections);
    let validations = candidates.iter().enumerate().map(of_candidate).collect();
    Ok(Validated {
        validations,
        motion: points.figures,
        closure_residual,
        monitor: motions.into_monitor(),
    })
}

/// Names with their units.
fn labels<'a>(names: impl Iterator<Item = &'a str>, units: Vec<&'static str>) -> Vec<Label<'a>> {
    let pairs = names.zip(units);
    pairs.map(|(name, unit)| Label { name, unit }).collect()
}

/// Comparison of one candidate.
fn validation(
    sums: &Sums<'_>,
    candidate: usize,
    run: &str,
    actuators: &[Label<'_>],
    names: &[Label<'_>],
    time: &dyn Fn(usize) -> f64,
) -> Validation {
    let layout = sums.layout();
    let lines: Vec<Pair> = (0..names.len())
        .map(|line| layout.line(candidate, line))
        .collect();
    let torques = |of: fn(&Layout, usize, usize) -> Option<Pair>| -> Vec<Pair> {
        (0..actuators.len())
            .filter_map(|actuator| of(layout, candidate, actuator))
            .collect()
    };
    let torque_pairs = torques(|layout, c, actuator| Some(layout.torque(c, actuator)));
    let errors = |pairs: &[Pair], names: &[Label<'_>]| -> Vec<LineError> {
        let named = pairs.iter().zip(names);
        named
            .map(|(pair, label)| sums.error(*label, *pair))
            .collect()
    };
    let series = |pairs: &[Pair], names: &[Label<'_>]| -> Vec<Series> {
        let named = pairs.iter().zip(names);
        named
            .map(|(pair, label)| sums.series(label.name, *pair, time))
            .collect()
    };
    let line_errors = errors(&lines, names);
    let (residual_norm, measured_norm) = overall(&line_errors);
    let torque_errors = errors(&torque_pairs, actuators);
    Validation {
        run: run.to_owned(),
        residual_norm,
        relative_error_percent: percent(residual_norm, measured_norm),
        table: torque_errors
            .iter()
            .enumerate()
            .map(|(actuator, error)| TorqueComparison {
                actuator: error.name.clone(),
                least_norm_percent: error.relative_error_percent,
                closure_percent: layout
                    .closure_torque(candidate, actuator)
                    .map(|pair| sums.error(actuators[actuator], pair).relative_error_percent),
            })
            .collect(),
        projected_torques: errors(&torques(Layout::projected_torque), actuators),
        line_series: series(&lines, names),
        torque_series: series(&torque_pairs, actuators),
        lines: line_errors,
        torques: torque_errors,
    }
}

/// Rows of the measurements and predictions of a run.
struct PredictionRows<'a> {
    observer: &'a Observer<'a>,
    layout: &'a Layout,
    candidates: &'a [Candidate<'a>],
}

impl PredictionRows<'_> {
    /// Rows of a chunk, which starts with sample `first` of the motion.
    fn of(
        &self,
        motion: &Motion,
        first: usize,
        chunk: &Chunk,
        failed: &[Option<Error>],
    ) -> Result<Vec<f64>, Error> {
        let (observer, layout) = (self.observer, self.layout);
        let info = observer.model.info();
        let (n, r) = (info.sizes.actuators, info.sizes.dof);
        let count = BLOCK.min(motion.samples - first);
        let pose = slice(&motion.pose, info.sizes.pose, first, count);
        let jacobians = motion.inverse_jacobians(observer.model, first, count)?;
        let closures = if layout.closure() {
            closures(observer.model, pose, count)
        } else {
            None
        };
        let mut torques = slice(&motion.torques, n, first, count).to_vec();
        if !motion.subtracted.is_empty() {
            let own = slice(&motion.subtracted, n, first, count);
            torques
                .iter_mut()
                .zip(own)
                .for_each(|(all, own)| *all += own);
        }
        let mut rows = vec![0.0; count * layout.width()];
        for (sample, row) in rows.chunks_exact_mut(layout.width()).enumerate() {
            let jacobian = slice(&jacobians, n * r, sample, 1);
            let Some(distribution) = least_norm(jacobian, r) else {
                let error = overact::Error::SingularPlatform {
                    actuators: overact::ActuatorGroup::All,
                    condition: f64::INFINITY,
                };
                return Err(motion.outside(first + sample, error).into());
            };
            let measured = slice(&torques, n, sample, 1);
            row[layout.measured()].copy_from_slice(measured);
            if let Some(range) = layout.projected() {
                let gamma = transposed_product(jacobian, measured, r);
                product(&distribution, &gamma, &mut row[range]);
            }
            for (number, candidate) in self.candidates.iter().enumerate() {
                if failed[candidate.projection].is_some() {
                    continue;
                }
                let projection = &observer.projections[candidate.projection];
                let lines = chunk.lines[candidate.projection].iter().enumerate();
                let subtracted = chunk.subtracted.get(candidate.projection);
                let equations = lines.map(|(line, rows)| {
                    let own = subtracted.map_or(0.0, |lines| lines[line][sample]);
                    (slice(rows, observer.base.len() + 1, sample, 1), own)
                });
                let predicted = candidate.predict(equations, |line| layout.line(number, line), row);
                let place = &mut row[layout.predicted_torques(number)];
                if *projection == Projection::Joints {
                    place.copy_from_slice(&predicted);
                    continue;
                }
                let gamma = platform_input(projection, &info, jacobian, &predicted);
                product(&distribution, &gamma, place);
                if let (Some(range), Some(closures)) = (layout.closure_torques(number), &closures) {
                    let closure = slice(closures, n * n, sample, 1);
                    if let Some(other) = least_multipliers(jacobian, closure, r) {
                        product(&other, &gamma, &mut row[range]);
                    }
                }
            }
        }
        Ok(rows)
    }
}

/// B_p of the closure at some poses, n × n each, if the model has it.
fn closures(model: &dyn Model, poses: &[f64], count: usize) -> Option<Vec<f64>> {
    let sizes = model.info().sizes;
    let mut joints = vec![0.0; count * sizes.joints];
    model
        .evaluate(Function::Joints, &[poses], &mut joints)
        .ok()?;
    let mut closures = vec![0.0; count * sizes.actuators * sizes.actuators];
    model
        .evaluate(
            Function::ClosureActuatorJacobian,
            &[poses, &joints],
            &mut closures,
        )
        .ok()?;
    Some(closures)
}

/// Whether torques by eq. (26) are available: the robot is redundant with closure matrices.
fn offers_closure(model: &dyn Model) -> bool {
    let info = model.info();
    info.sizes.actuators > info.sizes.dof && closures(model, info.home_pose, 1).is_some()
}

/// Γ¹ of the inputs Γ of a projection: themselves for the platform, J_aᵀ Γ² for kept actuators.
pub(crate) fn platform_input(
    projection: &Projection,
    info: &Info<'_>,
    jacobian: &[f64],
    inputs: &[f64],
) -> Vec<f64> {
    let Some(kept) = projection.kept(info) else {
        return inputs.to_vec();
    };
    let mut torques = vec![0.0; info.sizes.actuators];
    kept.iter()
        .zip(inputs)
        .for_each(|(&k, value)| torques[k] = *value);
    transposed_product(jacobian, &torques, info.sizes.dof)
}
