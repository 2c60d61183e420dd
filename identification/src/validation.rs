//! Validation of estimated parameters on a run, sections 5.3 and 5.4 of the paper.
//!
//! Predicted Γ = W χ is compared with the measured one, line by line, after the same decimation as
//! in the identification. The torques of all actuators are compared, too: the prediction is the
//! least-norm one, τ = J_p^inv (J_p^invᵀ J_p^inv)^-1 Γ¹, so an internal preload of a redundant robot
//! counts as error; without it, the measured torques are those of eq. (50).

use nalgebra::{DMatrix, DVector};
use overact::{Function, Model};
use rayon::prelude::*;
use serde::Serialize;

use crate::{
    blocks::{BLOCK, slice},
    columns::ColumnSet,
    error::Error,
    estimate::{LineError, overall, percent},
    filters::Decimator,
    kinematics::Motion,
    regression::{Equations, Projection, equations},
    settings::Settings,
};

/// Measured and predicted values of one line or torque, decimated.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Series {
    /// Name of the coordinate or actuator.
    pub name: String,
    /// Times, s from the start of the log.
    pub time: Vec<f64>,
    /// Measured values (N, N m).
    pub measured: Vec<f64>,
    /// Predicted values (N, N m).
    pub predicted: Vec<f64>,
}

impl Series {
    /// The errors of the series.
    fn error(&self) -> LineError {
        let square = |sum: f64, value: f64| sum + value * value;
        let residuals = self
            .measured
            .iter()
            .zip(&self.predicted)
            .map(|(m, p)| m - p);
        let residual = residuals.fold(0.0, square).sqrt();
        let measured = self.measured.iter().copied().fold(0.0, square).sqrt();
        LineError::new(&self.name, residual, measured, self.measured.len())
    }
}

/// One actuator's entry in Table 3.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TorqueComparison {
    /// Name of the actuator.
    pub actuator: String,
    /// 100 ||τ - τ*||/||τ||, τ* being the least-norm torque.
    pub least_norm_percent: f64,
    /// The same for the torque of eq. (26) with an overconstraint of zero, which satisfies the model but
    /// is not of least norm; none without redundancy, and for models that lack the closure matrices.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub closure_percent: Option<f64>,
}

/// How well parameters reproduce a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Validation {
    /// Name of the run.
    pub run: String,
    /// ||Y - W χ|| of all lines (N or N m, mixed for mixed lines).
    pub residual_norm: f64,
    /// 100 ||Y - W χ||/||Y|| of all lines.
    pub relative_error_percent: f64,
    /// Each line of Γ.
    pub lines: Vec<LineError>,
    /// Each actuator's torque against the least-norm prediction.
    pub torques: Vec<LineError>,
    /// The same with the measured torques freed of their internal part (50); empty without
    /// redundancy.
    pub projected_torques: Vec<LineError>,
    /// Each actuator's torque against both predictions.
    pub table: Vec<TorqueComparison>,
    /// The lines of Γ over time.
    pub line_series: Vec<Series>,
    /// The torques over time.
    pub torque_series: Vec<Series>,
}

/// Compares a run with the prediction of the parameters `values` in the columns `selected`.
///
/// # Errors
/// As [`equations`].
pub fn validate(
    model: &dyn Model,
    columns: &ColumnSet,
    projection: &Projection,
    motion: &Motion,
    parameters: (&[usize], &[f64]),
    settings: &Settings,
) -> Result<Validation, Error> {
    let equations = equations(model, columns, projection, motion, settings)?;
    validate_equations(
        model, columns, projection, motion, &equations, parameters, settings,
    )
}

/// [`validate`] with the equations of the run at hand, for several sets of parameters.
///
/// # Errors
/// As [`equations`].
pub fn validate_equations(
    model: &dyn Model,
    columns: &ColumnSet,
    projection: &Projection,
    motion: &Motion,
    equations: &Equations,
    (selected, values): (&[usize], &[f64]),
    settings: &Settings,
) -> Result<Validation, Error> {
    let info = model.info();
    let decimator = Decimator::new(settings.decimation)?;
    let time: Vec<f64> = (decimator.first(motion.samples)..motion.samples)
        .step_by(decimator.factor())
        .map(|sample| motion.time(sample))
        .collect();
    let names = projection.line_names(&info);
    let line_series: Vec<Series> = equations
        .lines
        .iter()
        .zip(&names)
        .map(|(rows, name)| line_series(name, &time, rows, selected, values))
        .collect();
    let torques = least_norm_torques(model, columns, motion, selected, values)?;
    let n = info.sizes.actuators;
    let against = |measured: &[f64]| -> Result<Vec<Series>, Error> {
        let decimated = |rows: &[f64], actuator: usize| {
            let column: Vec<f64> = rows.iter().skip(actuator).step_by(n).copied().collect();
            decimator.apply(&column)
        };
        let series = info.actuators.iter().enumerate().map(|(actuator, name)| {
            Ok(Series {
                name: (*name).to_owned(),
                time: time.clone(),
                measured: decimated(measured, actuator)?,
                predicted: decimated(&torques.predicted, actuator)?,
            })
        });
        series.collect()
    };
    let torque_series = against(&motion.torques)?;
    let projected = if n > info.sizes.dof {
        against(&torques.measured)?
    } else {
        Vec::new()
    };
    let lines: Vec<LineError> = line_series.iter().map(Series::error).collect();
    let (residual_norm, measured_norm) = overall(&lines);
    Ok(Validation {
        run: motion.run.clone(),
        residual_norm,
        relative_error_percent: percent(residual_norm, measured_norm),
        table: torque_series
            .iter()
            .map(|series| TorqueComparison {
                actuator: series.name.clone(),
                least_norm_percent: series.error().relative_error_percent,
                closure_percent: None,
            })
            .collect(),
        torques: torque_series.iter().map(Series::error).collect(),
        projected_torques: projected.iter().map(Series::error).collect(),
        lines,
        line_series,
        torque_series,
    })
}

/// Measured and predicted values of one line of Γ from its equations.
fn line_series(
    name: &str,
    time: &[f64],
    rows: &DMatrix<f64>,
    selected: &[usize],
    values: &[f64],
) -> Series {
    let mut predicted = DVector::zeros(rows.nrows());
    for (&column, value) in selected.iter().zip(values) {
        predicted.axpy(*value, &rows.column(column), 1.0);
    }
    Series {
        name: name.to_owned(),
        time: time.to_vec(),
        measured: rows.column(rows.ncols() - 1).iter().copied().collect(),
        predicted: predicted.iter().copied().collect(),
    }
}

/// Torques of least norm, samples x n at the full rate.
#[derive(Default)]
struct LeastNorm {
    /// Those that parameters ask for.
    predicted: Vec<f64>,
    /// The measured ones without their internal part, (50).
    measured: Vec<f64>,
}

/// The least-norm torques of the prediction and of the measurement.
fn least_norm_torques(
    model: &dyn Model,
    columns: &ColumnSet,
    motion: &Motion,
    selected: &[usize],
    values: &[f64],
) -> Result<LeastNorm, Error> {
    let sizes = model.info().sizes;
    let (r, n) = (sizes.dof, sizes.actuators);
    let block = |index: usize| -> Result<LeastNorm, Error> {
        let first = index * BLOCK;
        let count = BLOCK.min(motion.samples - first);
        let at = |error: overact::SampleError| {
            Error::from(motion.outside(first + error.sample, error.error))
        };
        let pose = slice(&motion.pose, sizes.pose, first, count);
        let twist = slice(&motion.twist, r, first, count);
        let acceleration = slice(&motion.acceleration, r, first, count);
        let w = columns
            .evaluate(model, &[pose, twist, acceleration], count, motion.payload)
            .map_err(at)?;
        let mut jacobians = vec![0.0; count * n * r];
        model
            .evaluate(Function::InverseJacobian, &[pose], &mut jacobians)
            .map_err(at)?;
        let torques = slice(&motion.torques, n, first, count);
        let mut block = LeastNorm::default();
        for sample in 0..count {
            let rows = w.chunks_exact(columns.len()).skip(sample * r).take(r);
            let gamma = rows.map(|row| selected.iter().zip(values).map(|(&c, v)| row[c] * v).sum());
            let gamma = DVector::from_iterator(r, gamma);
            let jacobian = DMatrix::from_row_slice(n, r, slice(&jacobians, n * r, sample, 1));
            let torque = DVector::from_row_slice(slice(torques, n, sample, 1));
            let normal = (jacobian.transpose() * &jacobian).lu();
            let solve = |gamma: &DVector<f64>| normal.solve(gamma).map(|scaled| &jacobian * scaled);
            match (solve(&gamma), solve(&(jacobian.transpose() * torque))) {
                (Some(predicted), Some(measured)) => {
                    block.predicted.extend(predicted.iter());
                    block.measured.extend(measured.iter());
                }
                _ => {
                    let error = overact::Error::SingularPlatform {
                        actuators: "actuators",
                        condition: f64::INFINITY,
                    };
                    return Err(motion.outside(first + sample, error).into());
                }
            }
        }
        Ok(block)
    };
    let blocks: Vec<LeastNorm> = (0..motion.samples.div_ceil(BLOCK))
        .into_par_iter()
        .map(block)
        .collect::<Result<_, Error>>()?;
    let mut all = LeastNorm::default();
    for block in blocks {
        all.predicted.extend(block.predicted);
        all.measured.extend(block.measured);
    }
    Ok(all)
}
