//! What a test says of a suspect.

use crate::estimation::intervals::distributions::{fisher_tail, student_quantile};

/// How often a fault that is just large enough to be seen is missed.
const MISSED: f64 = 0.1;

/// Probabilities below are as good as none.
const LEAST_PROBABILITY: f64 = 1e-30;

/// What speaks against a group of columns.
#[derive(Debug, Clone)]
pub(crate) struct Accused {
    /// δ of each column that the data can tell, by its place in the group.
    pub(crate) sizes: Vec<(usize, f64)>,
    /// Deviation of δ of the first one.
    pub(crate) deviation: f64,
    /// δ of the first one that would be missed one time in ten, at a level.
    pub(super) freedom: f64,
    /// How probable such scores are by chance.
    pub(crate) probability: f64,
    /// The part of the squared residual that it explains.
    pub(crate) explained: f64,
    /// B δ for each base parameter of the estimate: place, and by how much it is off.
    pub(crate) moves: Vec<(usize, f64)>,
}

impl Accused {
    /// δ of the first column.
    pub(crate) fn size(&self) -> f64 {
        self.sizes.first().map_or(0.0, |(_, size)| *size)
    }

    /// The largest δ of its columns, with its sign.
    pub(crate) fn largest(&self) -> f64 {
        let sizes = self.sizes.iter().map(|(_, size)| *size);
        sizes.fold(
            0.0,
            |most: f64, one| if one.abs() > most.abs() { one } else { most },
        )
    }

    /// What speaks against it, in deviations: |δ| by its deviation for one column, for several what would
    /// be as improbable for one.
    pub(crate) fn strength(&self) -> f64 {
        match self.sizes.len() {
            1 => self.size().abs() / self.deviation,
            _ => self.quantile(self.probability.max(LEAST_PROBABILITY)),
        }
    }

    /// How probable a size of the first column is by chance, were the true one as large as `harmless`.
    pub(crate) fn probability_beyond(&self, harmless: f64) -> f64 {
        let beyond = (self.size().abs() - harmless).max(0.0) / self.deviation;
        fisher_tail(beyond * beyond, 1.0, self.freedom)
    }

    /// How many deviations chance exceeds as often as `level`.
    pub(crate) fn quantile(&self, level: f64) -> f64 {
        student_quantile(level, self.freedom)
    }

    /// The size that these data would show nine times in ten at a level.
    pub(crate) fn visible(&self, level: f64) -> f64 {
        let quantile = student_quantile(level, self.freedom);
        (quantile + student_quantile(2.0 * MISSED, self.freedom)) * self.deviation
    }
}
