//! Base, recommended and essential estimates of one projection, with warnings.

use overact::Code;
use std::collections::BTreeMap;

use rayon::prelude::*;

use super::{prepare::PreparedSystem, progress::Progress};
use crate::{
    estimation::{
        correlation::Noise,
        essential::essential,
        estimate::{Estimation, estimate},
        instruments::{
            Instrumental,
            regressor::{ErrorsInRegressor, EstimatePair},
        },
        intervals::Intervals,
        recommended::{BaseEstimate, recommended},
    },
    regression::{
        elimination::eliminate,
        factor::{DATA_RANK_TOLERANCE, Factor},
        projection::Projection,
        system::System,
    },
    result::{Estimate, Estimator, ParameterEstimate, Stage},
    settings::Settings,
};
use overact_logs::{Error, Problem};

/// Condition number of a partition above which the actuator projection is unreliable.
const LARGEST_PARTITION_CONDITION: f64 = 30.0;

/// Relative residual above which the model does not explain the data.
const LARGEST_RELATIVE_ERROR_PERCENT: f64 = 50.0;

/// Estimates of one projection.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct ProjectionEstimates {
    /// Base parameters.
    pub base: Estimate,
    /// Recommended parameters.
    pub recommended: Estimate,
    /// The essential parameters.
    pub essential: Estimate,
    /// Base parameters by ordinary least squares, if the others are weighted.
    pub ordinary: Option<Estimate>,
    /// Base parameters by instrumental variables, if there are instruments.
    pub instrumental: Option<Estimate>,
    /// Effect of regressor errors on the estimates.
    pub errors_in_regressor: ErrorsInRegressor,
    /// Warnings to the user.
    pub warnings: Vec<String>,
}

/// Estimates base, recommended and essential parameters of one of the prepared projections.
///
/// # Errors
/// A projection that is singular on a run, or data that determine no parameter.
pub fn estimate_projection(
    prepared: &PreparedSystem,
    projection: usize,
    settings: &Settings,
    true_values: Option<&BTreeMap<String, f64>>,
) -> Result<ProjectionEstimates, Error> {
    let unknown = || {
        Error::from(Problem::new(
            Code::NOTHING_DETERMINED,
            "the projection was not prepared",
        ))
    };
    let system = prepared.systems.get(projection).ok_or_else(unknown)?;
    let system = system.as_ref().map_err(Clone::clone)?;
    let mut warnings = Vec::new();
    let selection = on_data(prepared, system, &mut warnings)?;
    let Selection { columns, names } = &selection;
    let base = estimate(system, columns, settings)?;
    let more = prepared.covariance_before(projection, columns, &base.weights);
    let (rest, intervals) = rayon::join(
        || essential(system, columns, names, &base, settings),
        || Intervals::new(system, columns, &base).widened(more.as_ref()),
    );
    let rest = rest?;
    warnings.extend(quality_warnings(system, &base));
    let rest_noise = Noise::new(system, &rest.selected, &rest.estimation);
    let start = BaseEstimate {
        selected: columns,
        names,
        estimation: &base,
        intervals: &intervals,
    };
    let chosen = recommended(system, &start, rest.folds.as_ref(), settings)?;
    let chosen_noise = Noise::new(system, &chosen.selected, &chosen.estimation);
    let context = Context {
        prepared,
        projection,
        system,
        truth: truth(prepared, true_values),
        intervals,
        kept_actuators: match system.projection {
            Projection::Platform => Vec::new(),
            _ => system.line_names.clone(),
        },
        weighted: settings.weighted,
    };
    let (instrumental, errors_in_regressor) = context.with_instruments(&selection, &base, settings);
    let recommended = Selection {
        columns: chosen.selected,
        names: chosen.names,
    };
    let essential = Selection {
        columns: rest.selected,
        names: rest.names,
    };
    Ok(ProjectionEstimates {
        ordinary: context.by_ordinary(&selection, settings)?,
        instrumental,
        errors_in_regressor,
        base: context.estimate(Stage::Base, base, rest.noise.as_ref(), &selection),
        recommended: Estimate {
            stop: Some(chosen.stop),
            ..context.estimate(
                Stage::Recommended,
                chosen.estimation,
                chosen_noise.as_ref(),
                &recommended,
            )
        },
        essential: Estimate {
            removals: rest.removals,
            stop: Some(rest.stop),
            ..context.estimate(
                Stage::Essential,
                rest.estimation,
                rest_noise.as_ref(),
                &essential,
            )
        },
        warnings,
    })
}

/// Estimates all prepared projections, in parallel.
pub(super) fn estimate_all(
    prepared: &PreparedSystem,
    settings: &Settings,
    true_values: Option<&BTreeMap<String, f64>>,
    progress: &dyn Fn(Progress<'_>),
) -> Vec<Result<ProjectionEstimates, Error>> {
    for projection in &prepared.projections {
        let model = projection.model();
        progress(Progress::Estimation { model });
    }
    (0..prepared.projections.len())
        .into_par_iter()
        .map(|number| estimate_projection(prepared, number, settings, true_values))
        .collect()
}

/// Known true values of the base parameters, by index.
fn truth(
    prepared: &PreparedSystem,
    true_values: Option<&BTreeMap<String, f64>>,
) -> BTreeMap<usize, f64> {
    let Some(values) = true_values else {
        return BTreeMap::new();
    };
    let base = &prepared.base;
    let regrouped = base.regrouped(&prepared.columns, values);
    let known = regrouped.into_iter().enumerate();
    known
        .filter_map(|(place, value)| value.map(|value| (place, value)))
        .collect()
}

/// Columns of an estimate, by index among the base parameters, with their names.
struct Selection {
    columns: Vec<usize>,
    names: Vec<String>,
}

/// Data that all estimates of a projection share.
struct Context<'a> {
    prepared: &'a PreparedSystem,
    projection: usize,
    system: &'a System,
    truth: BTreeMap<usize, f64>,
    intervals: Intervals,
    kept_actuators: Vec<String>,
    weighted: bool,
}

impl Context<'_> {
    /// Combines an estimation with names and true values, without removals.
    fn estimate(
        &self,
        stage: Stage,
        estimation: Estimation,
        noise: Option<&Noise>,
        selection: &Selection,
    ) -> Estimate {
        Estimate {
            model: self.system.projection.model(),
            kept_actuators: self.kept_actuators.clone(),
            stage,
            estimator: Estimator::LeastSquares,
            weighted: self.weighted,
            parameters: self.parameters(
                &estimation,
                &self.intervals,
                &self.correlated(&estimation, noise, &selection.columns),
                selection,
            ),
            residual_norm: estimation.residual_norm,
            relative_error_percent: estimation.relative_error_percent,
            condition_number: estimation.condition_number,
            equations: estimation.equations,
            residual_deviation: estimation.residual_deviation,
            lines: estimation.lines,
            weights: estimation.weights,
            partition: self.system.partition.clone(),
            removals: Vec::new(),
            stop: None,
        }
    }

    /// Base parameters by ordinary least squares, if weighting is on and there are several lines.
    fn by_ordinary(
        &self,
        selection: &Selection,
        settings: &Settings,
    ) -> Result<Option<Estimate>, Error> {
        let selected = &selection.columns;
        if !settings.weighted || self.system.lines.len() < 2 {
            return Ok(None);
        }
        let settings = Settings {
            weighted: false,
            ..settings.clone()
        };
        let estimation = estimate(self.system, selected, &settings)?;
        let more = self
            .prepared
            .covariance_before(self.projection, selected, &estimation.weights);
        let intervals = Intervals::new(self.system, selected, &estimation);
        let intervals = intervals.widened(more.as_ref());
        let white = estimation.standard_deviations.iter();
        let pairs = white.zip(intervals.deviations());
        let correlated: Vec<f64> = pairs.map(|(white, own)| white.max(own)).collect();
        Ok(Some(Estimate {
            estimator: Estimator::OrdinaryLeastSquares,
            weighted: false,
            parameters: self.parameters(&estimation, &intervals, &correlated, selection),
            ..self.estimate(Stage::Base, estimation, None, selection)
        }))
    }

    /// Instrumental-variable estimate, if possible, and its comparison with least squares.
    fn with_instruments(
        &self,
        selection: &Selection,
        base: &Estimation,
        settings: &Settings,
    ) -> (Option<Estimate>, ErrorsInRegressor) {
        let selected = &selection.columns;
        let instrument_runs = &self.prepared.instrument_runs;
        let why = instrument_runs.missing.as_ref().map(ToString::to_string);
        let model = self.system.projection.model();
        let comparison = ErrorsInRegressor {
            runs: instrument_runs.runs.clone(),
            simulated: instrument_runs.simulated.clone(),
            ..ErrorsInRegressor::without(model, settings.instruments, why)
        };
        if self.system.instruments.is_empty() {
            return (None, comparison);
        }
        let found = match Instrumental::new(self.system, selected, base) {
            Ok(found) => found,
            Err(error) => {
                let missing = Some(error.to_string());
                return (
                    None,
                    ErrorsInRegressor {
                        missing,
                        ..comparison
                    },
                );
            }
        };
        let units: Vec<&str> = selected.iter().map(|column| self.unit(*column)).collect();
        let estimates = EstimatePair {
            system: self.system,
            selected,
            least_squares: base,
            deviations: &self.intervals.deviations(),
            instrumental: &found,
        };
        let comparison = comparison.compared(&estimates, &selection.names, &units);
        let estimation = found.estimation.clone();
        // Both estimates are close, so the effect of gains is that on least squares.
        let more = self
            .prepared
            .covariance_before(self.projection, selected, &base.weights);
        let own = found.intervals.clone();
        let own = own.map(|own| own.widened(more.as_ref()));
        let intervals = own.as_ref().unwrap_or(&self.intervals);
        let white = estimation.standard_deviations.iter();
        let pairs = white.zip(intervals.deviations());
        let correlated: Vec<f64> = pairs.map(|(white, own)| white.max(own)).collect();
        let estimate = Estimate {
            estimator: Estimator::InstrumentalVariables,
            parameters: self.parameters(&estimation, intervals, &correlated, selection),
            ..self.estimate(Stage::Base, estimation, None, selection)
        };
        (Some(estimate), comparison)
    }

    /// Standard deviations for correlated residuals, or white ones if unknown.
    ///
    /// They include the uncertainty of previous identifications, such as gains.
    fn correlated(
        &self,
        estimation: &Estimation,
        noise: Option<&Noise>,
        selected: &[usize],
    ) -> Vec<f64> {
        let own = noise.map_or_else(
            || self.without_noise(estimation, selected),
            |noise| noise.deviations(selected, estimation),
        );
        let Some(more) =
            self.prepared
                .covariance_before(self.projection, selected, &estimation.weights)
        else {
            return own;
        };
        let more = more.diagonal();
        let each = own.iter().zip(more.iter());
        each.map(|(own, more)| (own * own + more).sqrt()).collect()
    }

    /// Standard deviations without successive equations: white ones, or larger ones of the
    /// intervals.
    ///
    /// The latter apply to the full base model only; intervals of smaller models are those of the
    /// base model anyway.
    fn without_noise(&self, estimation: &Estimation, selected: &[usize]) -> Vec<f64> {
        let white = estimation.standard_deviations.iter();
        if !self.system.stretches.is_empty() || selected.len() < self.intervals.deviations().len() {
            return white.copied().collect();
        }
        let pairs = white.zip(selected);
        pairs
            .map(|(white, &column)| {
                self.intervals
                    .deviation_of(column)
                    .map_or(*white, |own| white.max(own))
            })
            .collect()
    }

    /// SI unit of a base parameter.
    fn unit(&self, column: usize) -> &'static str {
        let standard = self.prepared.base.columns.get(column);
        let standard = standard.and_then(|&k| self.prepared.columns.as_slice().get(k));
        standard.map_or("", |column| column.unit)
    }

    /// Combines estimates, names and true values.
    fn parameters(
        &self,
        estimation: &Estimation,
        intervals: &Intervals,
        correlated: &[f64],
        selection: &Selection,
    ) -> Vec<ParameterEstimate> {
        let parameter = |(place, (&column, name)): (usize, (&usize, &String))| {
            let value = estimation.values[place];
            let true_value = self.truth.get(&column).copied();
            let interval_95 = intervals
                .of(column, selection.columns.len())
                .unwrap_or([value; 2]);
            ParameterEstimate {
                name: name.clone(),
                unit: self.unit(column).to_owned(),
                column,
                value,
                standard_deviation: estimation.standard_deviations[place],
                relative_standard_deviation_percent: estimation
                    .relative_standard_deviations_percent[place],
                correlated_standard_deviation: correlated[place],
                interval_95,
                outside: !(interval_95[0]..=interval_95[1]).contains(&value),
                true_value,
                error_percent: true_value
                    .filter(|truth| *truth != 0.0)
                    .map(|truth| 100.0 * (value - truth) / truth.abs()),
            }
        };
        selection
            .columns
            .iter()
            .zip(&selection.names)
            .enumerate()
            .map(parameter)
            .collect()
    }
}

/// Base parameters that the data separate, with their names; warns of the others.
fn on_data(
    prepared: &PreparedSystem,
    system: &System,
    warnings: &mut Vec<String>,
) -> Result<Selection, Error> {
    let base = &prepared.base;
    let ones = vec![1.0; system.lines.len()];
    let all = Factor::merged(&system.lines, &ones);
    let places: Vec<usize> = (0..base.columns.len()).collect();
    let found = eliminate(all.matrix(), &places, DATA_RANK_TOLERANCE);
    let name = |place: usize| base.names.get(place).map_or("", String::as_str);
    let label = system.projection.model().label();
    for &column in &found.zero {
        warnings.push(format!(
            "{label}: `{}` is not identifiable: its column is zero on these data",
            name(column)
        ));
    }
    for (column, coefficients) in &found.dependent {
        let others: Vec<String> = coefficients
            .iter()
            .map(|(kept, _)| format!("`{}`", name(*kept)))
            .collect();
        warnings.push(format!(
            "{label}: `{}` is not identifiable: on these data its column is a combination of those of {}",
            name(*column),
            others.join(", ")
        ));
    }
    if found.kept.is_empty() {
        return Err(nothing_moves(prepared, system).into());
    }
    let names = found
        .kept
        .iter()
        .map(|&column| name(column).to_owned())
        .collect();
    Ok(Selection {
        columns: found.kept,
        names,
    })
}

/// The problem of data without motion, or with all motion excluded.
fn nothing_moves(prepared: &PreparedSystem, system: &System) -> Problem {
    let still = prepared.left_out();
    let left: usize = system.lines.iter().map(Factor::equations).sum();
    let problem = |message: String| Problem::new(Code::NOTHING_DETERMINED, message);
    if still == 0 {
        return problem(String::from(
            "the data determine no parameter: the robot stands still",
        ))
        .help("record runs in which the robot moves");
    }
    problem(format!(
        "the data determine no parameter: `standstill_velocity` skips {still} of {} equations",
        still + left
    ))
    .help("lower `standstill_velocity` of [identification], or check the units of the log: is the time in milliseconds? Units of positions are `position_scale` of [data]")
}

/// Warnings about a system or its estimate.
fn quality_warnings(system: &System, base: &Estimation) -> Vec<String> {
    let label = system.projection.model().label();
    let mut warnings = Vec::new();
    if let Some(partition) = &system.partition
        && partition.largest > LARGEST_PARTITION_CONDITION
        && matches!(system.projection, Projection::Actuators(_))
    {
        warnings.push(format!(
            "{label}: the condition number of the kept actuators reaches {:.1} ({}, t = {:.3} s), above {LARGEST_PARTITION_CONDITION}; keep other actuators or use the platform projection",
            partition.largest, partition.run, partition.time
        ));
    }
    if base.relative_error_percent > LARGEST_RELATIVE_ERROR_PERCENT {
        warnings.push(format!(
            "{label}: the relative error is {:.0} %: the model does not explain the torques; check signs, units and gains",
            base.relative_error_percent
        ));
    }
    warnings
}
