//! Gains of the drives, as they are printed and as they are serialised.

use nalgebra::DMatrix;
use serde::Serialize;

/// Deviations by which a gain differs from that of the description before it is worth a warning.
const DEVIATIONS: f64 = 3.0;

/// Part by which a gain differs from that of the description before it is worth a warning.
const PART: f64 = 0.02;

/// The gain of one drive.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DriveGain {
    /// Name of the actuator.
    pub actuator: String,
    /// Torque (N m) or force (N) of the drive for each unit of it in the log: the gain relative to that of
    /// the description, by which the log was made.
    pub factor: f64,
    /// Standard deviation of the factor.
    pub deviation: f64,
    /// The factor by total least squares, for comparison: they take all columns for equally wrong. None
    /// where they have no solution.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub total_least_squares: Option<f64>,
}

impl DriveGain {
    /// Whether the description's gain is wrong: by more than three deviations and more than 2 %.
    #[must_use]
    pub fn is_wrong(&self) -> bool {
        let difference = (self.factor - 1.0).abs();
        difference > DEVIATIONS * self.deviation && difference > PART
    }
}

/// A base parameter that was estimated together with the gains.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct JointParameter {
    /// Its name: the kept parameter's, with the suffix `R` where others are regrouped into it. What is known
    /// is not among them.
    pub name: String,
    /// SI unit.
    pub unit: String,
    /// Estimate.
    pub value: f64,
    /// Standard deviation, which the gains' own is part of.
    pub deviation: f64,
}

/// What an identification of the gains found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Gains {
    /// One for each actuator.
    pub drives: Vec<DriveGain>,
    /// The base parameters that were unknown.
    pub parameters: Vec<JointParameter>,
    /// Number of equations.
    pub equations: usize,
    /// Covariance of the gains, one row for each actuator.
    #[serde(skip)]
    pub(super) covariance: DMatrix<f64>,
}

impl Gains {
    /// The covariance of the parts δg/g of themselves by which the gains are off.
    pub(super) fn relative_covariance(&self) -> DMatrix<f64> {
        let factors = self.factors();
        DMatrix::from_fn(factors.len(), factors.len(), |i, j| {
            self.covariance[(i, j)] / (factors[i] * factors[j])
        })
    }

    /// By what the torques of each actuator are to be multiplied.
    #[must_use]
    pub fn factors(&self) -> Vec<f64> {
        self.drives.iter().map(|one| one.factor).collect()
    }

    /// What is said of gains that the description has wrong.
    #[must_use]
    pub fn warnings(&self) -> Vec<String> {
        let wrong: Vec<&DriveGain> = self.drives.iter().filter(|one| one.is_wrong()).collect();
        if let Some(factor) = self.common_factor() {
            return vec![format!(
                "all drives give {factor:.4} times the torque that the description says: either all `torque_gain`s are wrong by one factor, or what is known in `[identification.known]` is: a mass that is {factor:.4} times as large as the true one does the same"
            )];
        }
        wrong
            .into_iter()
            .map(|one| {
                format!(
                    "the drive of `{}` gives {:.4} times the torque that the description says, with a standard deviation of {:.4}: check its `torque_gain`",
                    one.actuator, one.factor, one.deviation
                )
            })
            .collect()
    }

    /// The factor by which all drives of several are wrong alike, as far as their deviations tell.
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

/// Deviations within which gains are alike.
const ALIKE: f64 = 3.0;

#[cfg(test)]
mod tests {
    use super::DriveGain;

    #[test]
    fn a_gain_is_wrong_beyond_three_deviations_and_two_per_cent() {
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
