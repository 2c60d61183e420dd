//! Gains of the drives, for printing and serialisation.

use nalgebra::DMatrix;
use serde::Serialize;

use super::known_values::RedundantValue;
use crate::regression::torque_uncertainty::TorqueCorrection;

/// Smallest significant difference from the description, in standard deviations.
const DEVIATIONS: f64 = 3.0;

/// Smallest relevant relative difference from the description.
const PART: f64 = 0.02;

/// Gain of one drive.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DriveGain {
    /// Name of the actuator.
    pub actuator: String,
    /// Gain relative to the described one: actual torque (N m) or force (N) by the logged one.
    pub factor: f64,
    /// Standard deviation of the factor.
    pub deviation: f64,
    /// Factor by ordinary total least squares, for comparison; `None` without a solution.
    ///
    /// It assumes equal errors in all columns.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub total_least_squares: Option<f64>,
}

impl DriveGain {
    /// Whether the described gain is wrong: by more than three σ and more than 2 %.
    #[must_use]
    pub fn is_wrong(&self) -> bool {
        let difference = (self.factor - 1.0).abs();
        difference > DEVIATIONS * self.deviation && difference > PART
    }
}

/// A base parameter estimated together with the gains.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct JointParameter {
    /// Name of the kept parameter, with the suffix `R` if others are regrouped into it.
    ///
    /// Known parameters are not included.
    pub name: String,
    /// SI unit.
    pub unit: String,
    /// Estimate.
    pub value: f64,
    /// Standard deviation, including the uncertainty of the gains.
    pub deviation: f64,
}

/// Result of an identification of gains.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Gains {
    /// One gain for each actuator.
    pub drives: Vec<DriveGain>,
    /// Unknown base parameters.
    pub parameters: Vec<JointParameter>,
    /// Number of equations.
    pub equations: usize,
    /// Known values that the others determine, too.
    #[serde(skip)]
    pub(crate) redundant: Vec<RedundantValue>,
    /// Covariance of the gains, one row for each actuator.
    #[serde(skip)]
    pub(super) covariance: DMatrix<f64>,
}

impl Gains {
    /// Effect of the relative errors δg/g on torques that have been multiplied by the gains.
    pub(crate) fn correction(&self) -> TorqueCorrection<'_> {
        TorqueCorrection {
            actuators: (0..self.drives.len()).collect(),
            covariance: self.relative_covariance(),
            derivative: &|_, torque, _| torque,
        }
    }

    /// Covariance of the relative errors δg/g of the gains.
    fn relative_covariance(&self) -> DMatrix<f64> {
        let factors = self.factors();
        DMatrix::from_fn(factors.len(), factors.len(), |i, j| {
            self.covariance[(i, j)] / (factors[i] * factors[j])
        })
    }

    /// Factors for the torques of each actuator.
    #[must_use]
    pub fn factors(&self) -> Vec<f64> {
        self.drives.iter().map(|one| one.factor).collect()
    }

    /// Warnings about wrong gains in the description.
    #[must_use]
    pub fn warnings(&self) -> Vec<String> {
        let wrong: Vec<&DriveGain> = self.drives.iter().filter(|one| one.is_wrong()).collect();
        if let Some(factor) = self.common_factor() {
            return vec![format!(
                "all drives give {factor:.4} times the described torque: either all `torque_gain`s are wrong by one factor, or the known values in `[identification.known]` are: a mass that is {factor:.4} times the true one has the same effect"
            )];
        }
        wrong
            .into_iter()
            .map(|one| {
                format!(
                    "the drive of `{}` gives {:.4} times the described torque, with a standard deviation of {:.4}: check its `torque_gain`",
                    one.actuator, one.factor, one.deviation
                )
            })
            .collect()
    }

    /// Common factor of all gains, if they are equally wrong within their standard deviations.
    fn common_factor(&self) -> Option<f64> {
        let all = &self.drives;
        if all.len() < 2 || !all.iter().all(DriveGain::is_wrong) {
            return None;
        }
        let mean = all.iter().map(|one| one.factor).sum::<f64>() / all.len() as f64;
        let alike = |one: &DriveGain| (one.factor - mean).abs() < ALIKE * one.deviation;
        all.iter().all(alike).then_some(mean)
    }
}

/// Largest difference of equal gains, in standard deviations.
const ALIKE: f64 = 3.0;

#[cfg(test)]
mod tests {
    use super::DriveGain;

    #[test]
    fn a_wrong_gain_exceeds_three_deviations_and_two_per_cent() {
        let gain = |factor, deviation| DriveGain {
            actuator: String::from("leg1"),
            factor,
            deviation,
            total_least_squares: None,
        };
        assert!(gain(1.05, 0.01).is_wrong() && gain(0.95, 0.01).is_wrong());
        assert!(!gain(1.05, 0.02).is_wrong());
        assert!(!gain(1.015, 0.001).is_wrong());
    }
}
