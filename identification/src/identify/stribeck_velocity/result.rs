//! Estimated Stribeck velocities, and the effect of their uncertainty on the parameters.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};
use overact::Model;
use overact_logs::{Error, Log, significant};
use serde::Serialize;

use super::equations::systems;
use crate::{
    identify::prepare::PreparedSystem,
    regression::{
        observer::Observer, system::System, uncertainty_propagation::PropagatedUncertainty,
    },
    settings::Settings,
};

/// Change of ln v for the derivative of a column.
const STEP: f64 = 1e-3;

/// Ratio of half a 95 % interval to the standard deviation of a normal distribution.
const NORMAL: f64 = 1.96;

/// Stribeck velocity of one joint or motor.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StribeckVelocity {
    /// Name of the parameter of its friction, `fst_…`.
    pub parameter: String,
    /// Unit of velocities, rad/s or m/s.
    pub unit: &'static str,
    /// Velocity of the description.
    pub described: f64,
    /// Estimate; `None` if the data do not determine it.
    pub estimate: Option<VelocityEstimate>,
}

/// Estimate of a Stribeck velocity.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct VelocityEstimate {
    /// Velocity, rad/s or m/s.
    pub value: f64,
    /// 95 % interval.
    pub interval_95: [f64; 2],
}

/// Stribeck velocities of all joints and motors.
#[derive(Debug, Clone, PartialEq)]
pub struct StribeckVelocities {
    /// Each joint.
    pub joints: Vec<StribeckVelocity>,
    /// Coefficient f of each joint with an estimate, N m or N.
    pub(super) coefficients: BTreeMap<String, f64>,
}

impl StribeckVelocities {
    /// Velocities by parameter, for [`Settings::stribeck_velocities`].
    #[must_use]
    pub fn velocities(&self) -> BTreeMap<String, f64> {
        let velocity = |joint: &StribeckVelocity| {
            let estimate = joint.estimate.map(|own| own.value);
            (joint.parameter.clone(), estimate.unwrap_or(joint.described))
        };
        self.joints.iter().map(velocity).collect()
    }

    /// Warnings about velocities that the data do not determine.
    #[must_use]
    pub fn warnings(&self) -> Vec<String> {
        let joints = self.joints.iter().filter(|joint| joint.estimate.is_none());
        let warning = |joint: &StribeckVelocity| {
            format!(
                "the Stribeck velocity of `{}` is not determined and stays {} {}: record longer runs with slow motions and reversals of this joint",
                joint.parameter,
                significant(joint.described, 3),
                joint.unit
            )
        };
        joints.map(warning).collect()
    }

    /// The system with the uncertainty of the velocities.
    pub(in crate::identify) fn propagated(
        &self,
        mut prepared: PreparedSystem,
        model: &dyn Model,
        runs: &[Log],
        settings: &Settings,
    ) -> Result<PreparedSystem, Error> {
        let mut columns = prepared.columns.clone();
        let (mut picked, count) = (prepared.base.columns.clone(), prepared.base.columns.len());
        let (mut coefficients, mut variances) = (Vec::new(), Vec::new());
        for joint in &self.joints {
            let own = { columns.as_slice() }
                .iter()
                .position(|one| one.name == joint.parameter);
            let (Some(column), Some(estimate)) = (own, joint.estimate) else {
                continue;
            };
            let Some(coefficient) = self.coefficients.get(&joint.parameter) else {
                continue;
            };
            for step in [-STEP, STEP] {
                picked.push(columns.add_stribeck(column, estimate.value * step.exp()));
            }
            coefficients.push(coefficient / (2.0 * STEP));
            let [low, high] = estimate.interval_95;
            variances.push(((high / low).ln() / (2.0 * NORMAL)).powi(2));
        }
        let Some(last) = coefficients.len().checked_sub(1) else {
            return Ok(prepared);
        };
        // Columns of the base, then derivatives by ln v; the last one replaces Y.
        let slope = |number: usize| {
            let mut slope = DVector::zeros(picked.len());
            slope[count + 2 * number] = -coefficients[number];
            slope[count + 2 * number + 1] = coefficients[number];
            slope
        };
        let mut all = DMatrix::identity(picked.len(), count + last);
        (0..last).for_each(|number| all.set_column(count + number, &slope(number)));
        let projections = &prepared.projections;
        let observer = Observer {
            model,
            columns: &columns,
            base: &picked,
            projections,
            settings,
        };
        let lines = |system: Result<System, Error>| {
            let lines = system.map_or_else(|_| Vec::new(), |own| own.lines);
            let combined = lines
                .iter()
                .map(|line| line.combined_with(&all, &slope(last)));
            combined.collect()
        };
        let projections = systems(&observer, runs)?.into_iter().map(lines).collect();
        let covariance = DMatrix::from_diagonal(&DVector::from_vec(variances));
        prepared.propagated_uncertainty =
            Some(PropagatedUncertainty::new(projections, count, covariance));
        Ok(prepared)
    }
}
