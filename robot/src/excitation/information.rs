//! Information matrices of runs for weighted least squares (44), for each projection.
//!
//! A row is weighted by its mean noise variance over the run. The platform projection has Γ¹ =
//! J_p^invᵀ τ, the actuator projection Γ² = τ_a + J_a^-T J_bᵀ τ_b.

use super::course::{Bench, Course};
use super::fourier_run::FourierRun;
use crate::error::{Error, Problem};
use nalgebra::{Cholesky, DMatrix, DVector, SymmetricEigen};
use overact_codegen::diagnostic::Code;
use overact_identification::{
    BaseParameters, ColumnSet, Load, ModelKind, PayloadUse, Projection, SampledStates, Settings,
    base_parameters, names_of_loads,
};
use serde::Serialize;
use std::collections::BTreeMap;

/// Ridge on normalised information; a parameter without information then has a finite cost.
const RIDGE: f64 = 1e-8;

/// Noise and sampling frequency of the measured torques.
pub(super) struct TorqueMeasurement {
    /// Standard deviation of each actuator's torque noise, N m or N.
    pub(super) noise: Vec<f64>,
    /// Frequency at which torques are measured, Hz.
    pub(super) sampling: f64,
}

/// Criterion by which runs are judged.
pub(super) struct Question {
    columns: ColumnSet,
    base: BaseParameters,
    projections: Vec<Projection>,
    measurement: TorqueMeasurement,
    /// Values of the base parameters, if known.
    values: Vec<Option<f64>>,
    /// Normalisation factors of the parameters.
    pub(super) scales: Vec<DVector<f64>>,
}

/// How well runs determine the base parameters in one projection.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CaseOfRuns {
    /// Model that the runs are judged for.
    pub model: ModelKind,
    /// Log-determinant of the normalised information matrix; comparable between runs of one search.
    pub log_det: f64,
    /// Condition number of the weighted regressor with columns of unit norm.
    pub condition: f64,
    /// Smallest, median and largest relative standard deviation due to torque noise.
    ///
    /// `None` if the parameter values are unknown.
    pub deviations: Option<[f64; 3]>,
}

impl Question {
    /// Criterion for runs of a robot, some of which carry the payload.
    ///
    /// # Errors
    /// A robot without base parameters.
    pub(super) fn new(
        bench: &Bench<'_>,
        frames: &[FourierRun],
        settings: &Settings,
        truth: Option<&BTreeMap<String, f64>>,
        measurement: TorqueMeasurement,
    ) -> Result<Self, Error> {
        let loads: Vec<Load<'_>> = frames.iter().map(FourierRun::carried).collect();
        let payload = PayloadUse::of_loads(&loads)?;
        let columns = ColumnSet::new(
            bench.model,
            payload != PayloadUse::Absent,
            settings.asymmetric_friction,
            settings.seed,
        )?
        .with_payloads(&names_of_loads(loads.into_iter()))
        .with_friction_signs(bench.model, settings)?;
        let base = base_parameters(bench.model, &columns, payload, settings.seed)?;
        let sizes = bench.info.sizes;
        if sizes.actuators < sizes.dof {
            let message = "the robot has fewer actuators than coordinates";
            let help = "the search for exciting runs requires that actuators drive all coordinates";
            return Err(Problem::new(Code::EXCITATION, message).help(help).into());
        }
        let projections = if sizes.actuators == sizes.dof {
            vec![Projection::Joints]
        } else {
            vec![
                Projection::Platform,
                Projection::Actuators(bench.kept.clone()),
            ]
        };
        let values = truth.map(|truth| base.regrouped(&columns, truth));
        let normal = DVector::from_element(base.columns.len(), 1.0);
        Ok(Self {
            scales: vec![normal; projections.len()],
            columns,
            projections,
            measurement,
            values: values.unwrap_or_default(),
            base,
        })
    }

    /// Number of base parameters.
    pub(super) fn len(&self) -> usize {
        self.base.columns.len()
    }

    /// Information matrix of a run for each projection.
    ///
    /// `None` if the model has no value or the kept actuators do not determine the motion.
    pub(super) fn information(
        &self,
        bench: &Bench<'_>,
        frame: &FourierRun,
        course: &Course,
    ) -> Option<Vec<DMatrix<f64>>> {
        let states = SampledStates {
            samples: course.samples,
            interval: 1.0 / (frame.fundamental * course.samples as f64),
            pose: &course.states.pose,
            twist: &course.states.twist,
            acceleration: &course.states.acceleration,
            carried: frame.carried(),
        };
        let lines = self
            .columns
            .evaluate(bench.model, &states, &self.base.columns, 0)
            .ok()?;
        let weight = frame.duration * self.measurement.sampling / course.samples as f64;
        let of = |projection: &Projection| match projection.kept(&bench.info) {
            None => Some(self.sum(&lines, &self.platform_noise(bench, course), weight)),
            Some(kept) => {
                let (lines, variances) = self.on_actuators(bench, course, &lines, &kept)?;
                Some(self.sum(&lines, &variances, weight))
            }
        };
        self.projections.iter().map(of).collect()
    }

    /// Σ Wᵀ W / σ² over the rows, times `weight`.
    fn sum(&self, lines: &[Vec<f64>], variances: &[f64], weight: f64) -> DMatrix<f64> {
        let width = self.len();
        let mut sum = DMatrix::zeros(width, width);
        for (line, variance) in lines.iter().zip(variances) {
            let transposed = DMatrix::from_column_slice(width, line.len() / width, line);
            let square = &transposed * transposed.transpose();
            sum += square * (weight / variance);
        }
        sum
    }

    /// Mean noise variance of each row of Γ¹.
    fn platform_noise(&self, bench: &Bench<'_>, course: &Course) -> Vec<f64> {
        let r = bench.info.sizes.dof;
        let mut sums = vec![0.0; r];
        for (row, noise) in course
            .jacobian
            .chunks_exact(r)
            .zip(self.measurement.noise.iter().cycle())
        {
            for (sum, entry) in sums.iter_mut().zip(row) {
                *sum += (entry * noise).powi(2) / course.samples as f64;
            }
        }
        sums
    }

    /// Rows of Γ² = J_a^-T Γ¹, and their mean noise variances.
    fn on_actuators(
        &self,
        bench: &Bench<'_>,
        course: &Course,
        lines: &[Vec<f64>],
        kept: &[usize],
    ) -> Option<(Vec<Vec<f64>>, Vec<f64>)> {
        let (n, r) = (bench.info.sizes.actuators, bench.info.sizes.dof);
        let width = self.len();
        let mut projected = vec![vec![0.0; course.samples * width]; r];
        let mut variances = vec![0.0; r];
        for (sample, jacobian) in course.jacobian.chunks_exact(n * r).enumerate() {
            let part = DMatrix::from_fn(r, r, |row, column| jacobian[kept[row] * r + column]);
            let inverse = part.try_inverse()?;
            let own = sample * width..(sample + 1) * width;
            for (a, to) in projected.iter_mut().enumerate() {
                let to = &mut to[own.clone()];
                for (line, from) in lines.iter().enumerate() {
                    let factor = inverse[(line, a)];
                    let from = &from[own.clone()];
                    to.iter_mut()
                        .zip(from)
                        .for_each(|(to, from)| *to += factor * from);
                }
            }
            for (a, variance) in variances.iter_mut().enumerate() {
                for (row, noise) in jacobian.chunks_exact(r).zip(&self.measurement.noise) {
                    let share: f64 = (0..r).map(|line| inverse[(line, a)] * row[line]).sum();
                    *variance += (share * noise).powi(2) / course.samples as f64;
                }
            }
        }
        Some((projected, variances))
    }

    /// Sets the normalisation factors so that each parameter alone has information 1 in typical
    /// runs.
    pub(super) fn normalise(&mut self, typical: &[DMatrix<f64>]) {
        let factor = |value: &f64| {
            if *value > 0.0 {
                value.sqrt().recip()
            } else {
                1.0
            }
        };
        let factors = |matrix: &DMatrix<f64>| {
            DVector::from_iterator(matrix.nrows(), matrix.diagonal().iter().map(factor))
        };
        self.scales = typical.iter().map(factors).collect();
    }

    /// Sum of the log-determinants of the normalised information over the projections.
    pub(super) fn score(&self, information: &[DMatrix<f64>]) -> f64 {
        let cases = information.iter().zip(&self.scales);
        cases.map(|(matrix, scales)| log_det(matrix, scales)).sum()
    }

    /// Evaluates how well the runs determine the parameters in each projection.
    pub(super) fn judge(&self, information: &[DMatrix<f64>]) -> Vec<CaseOfRuns> {
        let cases = self.projections.iter().zip(information).zip(&self.scales);
        let case =
            |((projection, matrix), scales): ((&Projection, &DMatrix<f64>), &DVector<f64>)| {
                CaseOfRuns {
                    model: projection.model(),
                    log_det: log_det(matrix, scales),
                    condition: condition(matrix),
                    deviations: self.deviations(matrix),
                }
            };
        cases.map(case).collect()
    }

    /// Smallest, median and largest relative standard deviation of parameters with known values.
    fn deviations(&self, information: &DMatrix<f64>) -> Option<[f64; 3]> {
        let inverse = Cholesky::new(correlation(information))?.inverse();
        let relative = |(index, value): (usize, &Option<f64>)| {
            let value = value.filter(|value| *value != 0.0)?;
            let variance = inverse[(index, index)] / information[(index, index)];
            Some(variance.sqrt() / value.abs())
        };
        let mut all: Vec<f64> = self
            .values
            .iter()
            .enumerate()
            .filter_map(relative)
            .collect();
        all.sort_by(f64::total_cmp);
        Some([*all.first()?, *all.get(all.len() / 2)?, *all.last()?])
    }
}

/// Log-determinant of normalised information with the ridge.
fn log_det(information: &DMatrix<f64>, scales: &DVector<f64>) -> f64 {
    let count = information.nrows();
    let scaled = DMatrix::from_fn(count, count, |i, j| {
        let ridge = if i == j { RIDGE } else { 0.0 };
        information[(i, j)] * scales[i] * scales[j] + ridge
    });
    let factor = Cholesky::new(scaled);
    let sum = |l: DMatrix<f64>| {
        l.diagonal()
            .iter()
            .map(|entry| 2.0 * entry.ln())
            .sum::<f64>()
    };
    // Rounding may make a matrix without information indefinite; only the ridge remains.
    factor.map_or(count as f64 * RIDGE.ln(), |factor| sum(factor.unpack()))
}

/// Information matrix scaled to a unit diagonal.
fn correlation(information: &DMatrix<f64>) -> DMatrix<f64> {
    let norms = information.diagonal().map(f64::sqrt);
    DMatrix::from_fn(information.nrows(), information.ncols(), |i, j| {
        information[(i, j)] / (norms[i] * norms[j])
    })
}

/// Condition number of the regressor with unit columns; infinite if a column is zero.
fn condition(information: &DMatrix<f64>) -> f64 {
    let matrix = correlation(information);
    if matrix.iter().any(|entry| !entry.is_finite()) {
        return f64::INFINITY;
    }
    let values = SymmetricEigen::new(matrix).eigenvalues;
    if values.min() > 0.0 {
        (values.max() / values.min()).sqrt()
    } else {
        f64::INFINITY
    }
}

#[cfg(test)]
mod tests {
    use super::{condition, log_det};
    use nalgebra::{DMatrix, DVector};

    #[test]
    fn condition_and_determinant_match_the_columns() {
        // Columns of norms 2 and 3 at 60 degrees: WᵀW is [[4, 3], [3, 9]]; unit columns have
        // eigenvalues 1 ± 1/2.
        let matrix = DMatrix::from_row_slice(2, 2, &[4.0, 3.0, 3.0, 9.0]);
        assert!((condition(&matrix) - 3.0_f64.sqrt()).abs() < 1e-12);
        let found = log_det(&matrix, &DVector::from_element(2, 1.0));
        assert!((found - 27.0_f64.ln()).abs() < 1e-6);
        let halved = log_det(&matrix, &DVector::from_column_slice(&[0.5, 1.0]));
        assert!((found - halved - 4.0_f64.ln()).abs() < 1e-6);
        let unknown = DMatrix::from_row_slice(2, 2, &[4.0, 0.0, 0.0, 0.0]);
        assert_eq!(condition(&unknown), f64::INFINITY);
    }
}
