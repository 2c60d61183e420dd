//! Test result of a fault hypothesis.

use nalgebra::DMatrix;

use crate::estimation::intervals::distributions::{
    detectable_noncentrality, fisher_tail, student_quantile,
};

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
    /// B for the separable columns, base parameters × columns.
    pub(super) regression: DMatrix<f64>,
}

/// Sizes of a group's columns that are just detectable, and shift one parameter most.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct WorstSizes {
    /// Place of the parameter.
    pub(crate) parameter: usize,
    /// Its shift.
    pub(crate) shift: f64,
    /// δ of each separable column, with its place in the group.
    pub(crate) sizes: Vec<(usize, f64)>,
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

    /// Detection limit of a group of columns, for each parameter in the worst combination of them.
    ///
    /// Sizes δ with the covariance C are found with 90 % probability if δᵀ C^-1 δ is the detectable
    /// noncentrality λ. Among these, δ = √λ C b/√(bᵀ C b) shifts a parameter with the row b of B most,
    /// by √(λ bᵀ C b).
    pub(crate) fn worst_sizes(&self, level: f64) -> Vec<WorstSizes> {
        let count = self.sizes.len() as f64;
        let noncentrality = detectable_noncentrality(level, MISSED, count, self.freedom);
        let of_row = |(row, (parameter, _)): (usize, &(usize, f64))| {
            let row = self.regression.row(row).transpose();
            let sizes = &self.covariance * &row;
            let shift = (noncentrality * row.dot(&sizes)).max(0.0).sqrt();
            let factor = noncentrality / shift.max(f64::MIN_POSITIVE);
            let places = self.sizes.iter().map(|(place, _)| *place);
            WorstSizes {
                parameter: *parameter,
                shift,
                sizes: places.zip(sizes.iter().map(|size| factor * size)).collect(),
            }
        };
        self.shifts.iter().enumerate().map(of_row).collect()
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::WaldTest;

    #[test]
    fn worst_sizes_are_just_detectable_and_shift_their_parameter_most() {
        let covariance = DMatrix::from_row_slice(2, 2, &[4.0, 1.0, 1.0, 2.0]);
        let test = WaldTest {
            sizes: vec![(0, 0.0), (3, 0.0)],
            covariance: covariance.clone(),
            deviation: 2.0,
            freedom: 1e3,
            probability: 1.0,
            explained: 0.0,
            noise: 0.0,
            shifts: vec![(7, 0.0), (8, 0.0)],
            regression: DMatrix::from_row_slice(2, 2, &[1.0, 0.0, 0.5, -2.0]),
        };
        let inverse = covariance.try_inverse().unwrap();
        let worst = test.worst_sizes(1e-3);
        let lambda = |sizes: &[f64]| {
            let sizes = DMatrix::from_column_slice(2, 1, sizes);
            (sizes.transpose() * &inverse * &sizes)[(0, 0)]
        };
        for (row, one) in worst.iter().enumerate() {
            assert_eq!(one.parameter, 7 + row);
            assert_eq!([one.sizes[0].0, one.sizes[1].0], [0, 3]);
            let sizes = [one.sizes[0].1, one.sizes[1].1];
            let shift = |sizes: [f64; 2]| {
                test.regression[(row, 0)] * sizes[0] + test.regression[(row, 1)] * sizes[1]
            };
            assert!((shift(sizes) - one.shift).abs() < 1e-12 * one.shift);
            // No other sizes of the same noncentrality shift the parameter more.
            for angle in 0..100 {
                let (sine, cosine) = (0.0628 * f64::from(angle)).sin_cos();
                let factor = (lambda(&sizes) / lambda(&[cosine, sine])).sqrt();
                assert!(shift([factor * cosine, factor * sine]) <= one.shift * (1.0 + 1e-12));
            }
        }
        assert!((lambda(&[worst[0].sizes[0].1, worst[0].sizes[1].1]) - 23.98).abs() < 0.6);
    }
}
