//! Durbin-Wu-Hausman test: do least squares and instrumental variables agree?
//!
//! If the regressor has no errors, both estimates are consistent and their difference d is noise.
//! It is linear in the data with the influence M = [-(Wᵀ Λ² W)^-1, (Zᵀ Λ² W)^-1]. Its covariance V
//! is therefore estimated like that of any linear estimate (see `intervals::scores`), for residuals
//! of any correlation and size. The textbook difference of two covariances requires white
//! residuals. Then
//!
//! ```text
//! F = (ν - k + 1)/(ν k) dᵀ V^-1 d
//! ```
//!
//! has Fisher's distribution with k and ν - k + 1 degrees of freedom (Hotelling), where k is the
//! rank of V; columns without errors do not count. For each parameter, d_i/√V_ii has Student's
//! distribution with ν_i degrees of freedom. A parameter differs at the level of the test divided
//! by the number of parameters (Bonferroni), or at 5 % if the joint test rejects. If k exceeds ν/2, the joint test is that of the
//! parameter with the largest difference.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

use super::Instrumental;
use crate::{
    estimation::{
        estimate::Estimation,
        intervals::{
            distributions::{Hotelling, student_tail},
            scores::{Context, Covariance},
        },
    },
    regression::system::System,
};

/// Level of the test.
///
/// It is the part of one of twelve families of checks of a false-alarm rate of 1 % per report.
pub(crate) const LEVEL: f64 = 0.01 / 12.0;

/// Level of the test of one parameter if the joint test rejects.
const PROTECTED_LEVEL: f64 = 0.05;

/// Smallest eigenvalue of the scaled V that counts, relative to the largest.
///
/// Below it, the estimates can only differ by a hundredth of the largest difference.
const SMALLEST_DIRECTION: f64 = 1e-4;

/// A difference below this fraction of the standard deviation is rounding.
const SMALLEST_DIFFERENCE: f64 = 1e-6;

/// Result of the test.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Hausman {
    /// F.
    pub(crate) statistic: f64,
    /// k and ν - k + 1.
    pub(crate) freedoms: [f64; 2],
    /// p-value.
    pub(crate) probability: f64,
    /// Whether all parameters are tested together, instead of the one with the largest difference.
    pub(crate) together: bool,
    /// Difference of each parameter.
    pub(crate) parameters: Vec<Difference>,
}

/// Difference between both estimates of a parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Difference {
    /// d_i, instrumental variables minus least squares.
    pub(crate) difference: f64,
    /// √V_ii.
    pub(crate) deviation: f64,
    /// p-value.
    pub(crate) probability: f64,
}

impl Hausman {
    /// Compares the estimates of the columns `selected`; `None` without successive equations.
    pub(crate) fn new(
        system: &System,
        selected: &[usize],
        least_squares: &Estimation,
        instrumental: &Instrumental,
    ) -> Option<Self> {
        let context = Context::new(selected, least_squares);
        let mut influence = instrumental.influence()?;
        let p = selected.len();
        influence.columns_mut(0, p).copy_from(&-&context.inverse);
        let covariance = Covariance::new(system, &context.with_influence(influence))?;
        let pairs = instrumental.estimation.values.iter();
        let pairs = pairs.zip(&least_squares.values);
        let differences: Vec<f64> = pairs.map(|(z, w)| z - w).collect();
        let parameters = (0..p).map(|i| {
            let deviation = covariance.matrix[(i, i)].sqrt();
            let scale = least_squares.standard_deviations[i];
            let noise = SMALLEST_DIFFERENCE * scale;
            let (d, freedom) = (differences[i], covariance.freedoms[i]);
            let same = d.abs() <= noise || (deviation == 0.0 && d.abs() <= scale);
            Difference {
                difference: d,
                deviation,
                probability: if same {
                    1.0
                } else {
                    student_tail(d / deviation, freedom)
                },
            }
        });
        Some(Self::judged(parameters.collect(), &covariance))
    }

    /// The joint test.
    fn judged(parameters: Vec<Difference>, covariance: &Covariance) -> Self {
        let differs = |i: &usize| parameters[*i].probability < 1.0;
        let places: Vec<usize> = (0..parameters.len()).filter(differs).collect();
        let mut freedoms: Vec<f64> = places.iter().map(|&i| covariance.freedoms[i]).collect();
        freedoms.sort_by(f64::total_cmp);
        let Some(&freedom) = freedoms.get(freedoms.len() / 2) else {
            return Self {
                statistic: 0.0,
                freedoms: [0.0, f64::INFINITY],
                probability: 1.0,
                together: true,
                parameters,
            };
        };
        let (square, rank) = distance(&parameters, &places, &covariance.matrix);
        if rank > 0.5 * freedom {
            return Self::of_the_largest(parameters, &places, covariance);
        }
        let Hotelling {
            statistic,
            rest,
            probability,
        } = Hotelling::new(square, rank, freedom);
        Self {
            statistic,
            freedoms: [rank, rest],
            probability,
            together: true,
            parameters,
        }
    }

    /// The joint test if there are too few degrees of freedom for all parameters together.
    fn of_the_largest(
        parameters: Vec<Difference>,
        places: &[usize],
        covariance: &Covariance,
    ) -> Self {
        let least = |a: &&usize, b: &&usize| {
            let [a, b] = [a, b].map(|place| parameters[**place].probability);
            a.total_cmp(&b)
        };
        let place = places.iter().min_by(least).copied().unwrap_or_default();
        let own = parameters[place];
        let count = places.len() as f64;
        Self {
            statistic: (own.difference / own.deviation).powi(2),
            freedoms: [1.0, covariance.freedoms[place]],
            probability: (count * own.probability).min(1.0),
            together: false,
            parameters,
        }
    }

    /// Whether the estimates differ significantly.
    pub(crate) fn rejects(&self) -> bool {
        self.probability < LEVEL
    }

    /// Whether a parameter differs significantly.
    ///
    /// If the joint test rejects, it protects the tests of single parameters (Fisher's least
    /// significant difference), which need no division of the level.
    pub(crate) fn differs(&self, parameter: &Difference) -> bool {
        let alone = parameter.probability * (self.parameters.len() as f64) < LEVEL;
        alone || self.rejects() && parameter.probability < PROTECTED_LEVEL
    }
}

/// dᵀ V^-1 d of some parameters, scaled by their standard deviations, and the rank of V.
fn distance(parameters: &[Difference], places: &[usize], covariance: &DMatrix<f64>) -> (f64, f64) {
    let deviation = |place: usize| parameters[places[place]].deviation;
    let scaled = DMatrix::from_fn(places.len(), places.len(), |i, j| {
        covariance[(places[i], places[j])] / (deviation(i) * deviation(j))
    });
    let values = places.iter().map(|&place| {
        let own = parameters[place];
        own.difference / own.deviation
    });
    let values = DVector::from_iterator(places.len(), values);
    let system = SymmetricEigen::new(scaled);
    let floor = SMALLEST_DIRECTION * system.eigenvalues.max();
    let pairs = system
        .eigenvalues
        .iter()
        .zip(system.eigenvectors.column_iter());
    let kept = pairs.filter(|(value, _)| **value > floor);
    kept.fold((0.0, 0.0), |(square, rank), (value, direction)| {
        (square + direction.dot(&values).powi(2) / value, rank + 1.0)
    })
}
