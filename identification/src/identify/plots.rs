//! Plots of an identification, from data kept by the pass over the runs.

use overact::Code;
use overact::{Function, Model};

use super::{
    figures::{ActuatorRange, CorrelationFigures, Figures, PredictionFigures, ResidualFigures},
    prepare::PreparedSystem,
};
use crate::{
    estimation::correlation::line_residual,
    kinematics::distribution::{least_norm, product},
    regression::{factor::Factor, projection::Projection, system::System},
    result::{CrossValidation, Estimate},
    series::{LineResidual, ResidualSeries, RunFigures, Series},
    settings::Settings,
    validation::platform_input,
};
use overact_logs::Error;

/// Plots of an identification.
///
/// Each estimate comes with the number of its projection. `others` are the motions of the
/// validation runs.
///
/// # Errors
/// A pose at which the model has no value, although it had one before.
pub(super) fn figures(
    model: &dyn Model,
    prepared: &PreparedSystem,
    estimates: &[(usize, Estimate)],
    cross_validation: &[CrossValidation],
    others: Vec<RunFigures>,
    settings: &Settings,
) -> Result<Figures, Error> {
    let own = prepared.observations.iter().map(|observation| RunFigures {
        identified: true,
        ..observation.figures.clone()
    });
    let mut predictions = Vec::new();
    for (projection, estimate) in estimates {
        for run in 0..prepared.observations.len() {
            predictions.push(prediction(model, prepared, run, *projection, estimate)?);
        }
    }
    predictions.extend(cross_validation.iter().map(|one| PredictionFigures {
        run: one.run.clone(),
        identified: false,
        model: one.model,
        stage: one.stage,
        lines: one.line_series.clone(),
        torques: one.torque_series.clone(),
    }));
    let residuals = estimates.iter().filter_map(|(projection, estimate)| {
        let system = prepared.systems[*projection].as_ref().ok()?;
        Some(residual(prepared, *projection, system, estimate, settings))
    });
    let residuals = residuals.collect();
    let correlations = estimates.iter().filter_map(|(projection, estimate)| {
        let system = prepared.systems[*projection].as_ref().ok()?;
        correlation(system, estimate)
    });
    Ok(Figures {
        runs: own.chain(others).collect(),
        predictions,
        residuals,
        correlations: correlations.collect(),
        ranges: ranges(model, prepared),
    })
}

/// Correlation of an estimate's parameters; `None` for dependent columns.
///
/// The covariance of weighted least squares is σ² R^-1 R^-T (47).
fn correlation(system: &System, estimate: &Estimate) -> Option<CorrelationFigures> {
    let selected = estimate.columns();
    let reduced = Factor::reduced_together(&system.lines, &estimate.weights, &selected);
    let inverse = reduced.triangle.try_inverse()?;
    let covariance = &inverse * inverse.transpose();
    let deviation = |index: usize| covariance[(index, index)].sqrt();
    let row = |i: usize| -> Vec<f64> {
        let row = covariance.row(i);
        let pairs = row.iter().enumerate();
        pairs
            .map(|(j, value)| value / (deviation(i) * deviation(j)))
            .collect()
    };
    let names = estimate.parameters.iter().map(|one| one.name.clone());
    Some(CorrelationFigures {
        model: estimate.model,
        stage: estimate.stage,
        names: names.collect(),
        correlation: (0..selected.len()).map(row).collect(),
    })
}

/// Motion of each actuator in the training runs, without limits.
fn ranges(model: &dyn Model, prepared: &PreparedSystem) -> Vec<ActuatorRange> {
    let info = model.info();
    let units = info.actuator_is_revolute.iter();
    let units = units.map(|is_revolute| if *is_revolute { "rad" } else { "m" });
    let actuators = info.actuators.iter().zip(units).enumerate();
    let range = |(place, (name, unit)): (usize, (&&str, &'static str))| {
        let mut range = ActuatorRange {
            actuator: (*name).to_owned(),
            unit,
            position: [f64::INFINITY, f64::NEG_INFINITY],
            ..ActuatorRange::default()
        };
        for observation in &prepared.observations {
            if let Some((low, high)) = observation.monitor.bounds().get(place) {
                let [lowest, highest] = range.position;
                range.position = [lowest.min(*low), highest.max(*high)];
            }
            if let Some(own) = observation.figures.velocities.get(place) {
                range.velocity = range.velocity.max(own.largest_velocity);
                range.acceleration = range.acceleration.max(own.largest_acceleration);
            }
        }
        range
    };
    actuators.map(range).collect()
}

/// Residual of an estimate over time, with autocorrelation and spectrum.
fn residual(
    prepared: &PreparedSystem,
    projection: usize,
    system: &System,
    estimate: &Estimate,
    settings: &Settings,
) -> ResidualFigures {
    let frequency = prepared
        .runs
        .first()
        .map_or(1.0, |run| run.sampling_frequency);
    let interval = settings.decimation as f64 / frequency;
    let (selected, values) = (estimate.columns(), estimate.values());
    let line = |line: usize| {
        let runs =
            prepared
                .observations
                .iter()
                .zip(&prepared.points)
                .map(|(observation, points)| {
                    let rows = &points[projection][line];
                    let mut residual = rows.column(rows.ncols() - 1).clone_owned();
                    for (&column, value) in selected.iter().zip(&values) {
                        residual.axpy(-value, &rows.column(column), 1.0);
                    }
                    ResidualSeries {
                        run: observation.figures.run.clone(),
                        time: observation.figures.time.clone(),
                        residual: residual.iter().copied().collect(),
                    }
                });
        LineResidual {
            runs: runs.collect(),
            ..line_residual(system, line, &selected, &values, interval)
        }
    };
    ResidualFigures {
        model: estimate.model,
        stage: estimate.stage,
        lines: (0..system.lines.len()).map(line).collect(),
    }
}

/// Measured and predicted inputs of a training run at the plotted points.
///
/// Torques are predicted from the decimated Γ, since J_p^inv changes slowly.
fn prediction(
    model: &dyn Model,
    prepared: &PreparedSystem,
    run: usize,
    projection: usize,
    estimate: &Estimate,
) -> Result<PredictionFigures, Error> {
    let info = model.info();
    let (n, r) = (info.sizes.actuators, info.sizes.dof);
    let observation = &prepared.observations[run];
    let time = &observation.figures.time;
    let names = prepared.projections[projection].line_names(&info);
    let (selected, values) = (estimate.columns(), estimate.values());
    let lines: Vec<Series> = prepared.points[run][projection]
        .iter()
        .zip(names)
        .map(|(rows, name)| {
            let predicted = |row: usize| -> f64 {
                let terms = selected.iter().zip(&values);
                terms
                    .map(|(&column, value)| rows[(row, column)] * value)
                    .sum()
            };
            Series {
                name,
                time: time.clone(),
                measured: rows.column(rows.ncols() - 1).iter().copied().collect(),
                predicted: (0..rows.nrows()).map(predicted).collect(),
            }
        })
        .collect();
    let poses: Vec<f64> = (0..time.len())
        .flat_map(|point| {
            observation
                .figures
                .pose
                .iter()
                .map(move |series| series[point])
        })
        .collect();
    let mut jacobians = vec![0.0; time.len() * n * r];
    model
        .evaluate(Function::InverseJacobian, &[&poses], &mut jacobians)
        .map_err(|error| overact_logs::Problem::new(Code::NO_EFFECT, error.to_string()))?;
    let mut torques: Vec<Series> = info
        .actuators
        .iter()
        .map(|name| Series {
            name: (*name).to_owned(),
            time: time.clone(),
            ..Series::default()
        })
        .collect();
    let points = jacobians
        .chunks_exact(n * r)
        .zip(observation.torques.chunks_exact(n));
    for (point, (jacobian, measured)) in points.enumerate() {
        let inputs: Vec<f64> = lines.iter().map(|line| line.predicted[point]).collect();
        let predicted = distributed(&prepared.projections[projection], model, jacobian, &inputs);
        for (series, (measured, predicted)) in
            torques.iter_mut().zip(measured.iter().zip(predicted))
        {
            series.measured.push(*measured);
            series.predicted.push(predicted);
        }
    }
    Ok(PredictionFigures {
        run: observation.figures.run.clone(),
        identified: true,
        model: estimate.model,
        stage: estimate.stage,
        lines,
        torques,
    })
}

/// Torques of all actuators for predicted inputs Γ, with least norm if redundant.
fn distributed(
    projection: &Projection,
    model: &dyn Model,
    jacobian: &[f64],
    inputs: &[f64],
) -> Vec<f64> {
    if *projection == Projection::Joints {
        return inputs.to_vec();
    }
    let info = model.info();
    let gamma = platform_input(projection, &info, jacobian, inputs);
    let mut torques = vec![0.0; info.sizes.actuators];
    if let Some(distribution) = least_norm(jacobian, info.sizes.dof) {
        product(&distribution, &gamma, &mut torques);
    }
    torques
}
