//! Test result of a fault hypothesis.

use nalgebra::DMatrix;

use crate::estimation::intervals::distributions::{fisher_tail, student_quantile};

/// Probability with which a just detectable fault is missed.
const MISSED: f64 = 0.1;

/// Smallest probability; smaller ones are treated as this.
const LEAST_PROBABILITY: f64 = 1e-30;

/// Wald test of a group of columns against the residual.
#[derive(Debug, Clone)]
pub(crate) struct WaldTest {
    /// δ of each separable column, with its place in the group.
    pub(crate) sizes: Vec<(usize, f64)>,
    /// Covariance of all δ.
    pub(crate) covariance: DMatrix<f64>,
    /// Standard deviation of the first δ.
    pub(crate) deviation: f64,
    /// Degrees of freedom of that standard deviation.
    pub(super) freedom: f64,
    /// p-value of the scores.
    pub(crate) probability: f64,
    /// Fraction of the squared residual that the group explains.
    pub(crate) explained: f64,
    /// Fraction that a column explains by chance, from the covariance of the scores.
    pub(crate) noise: f64,
    /// B δ for each base parameter of the estimate: place and shift.
    pub(crate) shifts: Vec<(usize, f64)>,
}

impl WaldTest {
    /// δ of the first column.
    pub(crate) fn size(&self) -> f64 {
        self.sizes.first().map_or(0.0, |(_, size)| *size)
    }

    /// The δ of largest magnitude, with its sign.
    pub(crate) fn largest(&self) -> f64 {
        let sizes = self.sizes.iter().map(|(_, size)| *size);
        sizes.fold(
            0.0,
            |most: f64, one| if one.abs() > most.abs() { one } else { most },
        )
    }

    /// Strength of the result in standard deviations.
    ///
    /// |δ|/σ for one column; for several columns the Student quantile of equal probability.
    pub(crate) fn strength(&self) -> f64 {
        match self.sizes.len() {
            1 => self.size().abs() / self.deviation,
            _ => self.quantile(self.probability.max(LEAST_PROBABILITY)),
        }
    }

    /// Explained fraction of the squared residual, less what more than one column explain by chance.
    ///
    /// The penalty of each further column is that of Akaike's criterion.
    pub(crate) fn evidence(&self) -> f64 {
        self.explained - 2.0 * (self.sizes.len() as f64 - 1.0) * self.noise
    }

    /// p-value of the first δ if the true size were as large as `harmless`.
    pub(crate) fn probability_beyond(&self, harmless: f64) -> f64 {
        let beyond = (self.size().abs() - harmless).max(0.0) / self.deviation;
        fisher_tail(beyond * beyond, 1.0, self.freedom)
    }

    /// Student quantile: standard deviations that chance exceeds with probability `level`.
    pub(crate) fn quantile(&self, level: f64) -> f64 {
        student_quantile(level, self.freedom)
    }

    /// Detection limit: the size that is found with 90 % probability at a level.
    pub(crate) fn visible(&self, level: f64) -> f64 {
        let quantile = student_quantile(level, self.freedom);
        (quantile + student_quantile(2.0 * MISSED, self.freedom)) * self.deviation
    }
}
