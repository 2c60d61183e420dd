//! Intervals of the estimates that contain the true value as often as they say.
//!
//! - `scores`: the covariance of the base estimate, whatever the residual is like in time and size,
//!   and the degrees of freedom of its variances.
//! - `repeats`: how much larger it is for what returns with the motion.
//! - `periods`: how much larger it is for what returns from period to period.
//! - `parts`: the covariance from sums over parts of the runs, where factors are all there is.
//! - `distributions`: Student's distribution and its kin.
//!
//! The interval of base parameter i is χ_i ± t_0.975(ν_i) σ_i.
//!
//! A model with fewer parameters has smaller deviations, which hold if the cancelled parameters are
//! exactly zero. Nobody knows that: they were cancelled because these data did not speak loudly for
//! them. An interval that is shorter than the base model's and still contains the truth as often,
//! whatever the cancelled parameters are, does not exist (Leeb and Pötscher, *Econometric Theory* 21,
//! 2005). So the interval of a parameter in a smaller model is that of the base model. An estimate
//! that lies outside of it has been moved there by cancelling, and the data speak against it.
//!
//! One thing more has been decided: that the parameter stays. Of parameters whose effect is hardly larger
//! than the noise those stay whose errors happen to be large, and their intervals would contain the truth
//! in half of the cases. If all p base parameters were zero, the largest |χ_i|/σ_i would be below
//! t_1-0.025/p in 95 % of all cases (Bonferroni): what is beyond stays, whatever chance does. What is below
//! may be a choice of chance. Of intervals χ_i ± t_1-0.025k/p σ_i of k chosen parameters no more than 5 %
//! miss the truth in the mean, however they are chosen (Benjamini and Yekutieli, *J. American Statistical
//! Association* 100, 2005), so it gets this one.

pub(crate) mod distributions;
mod parts;
mod periods;
pub(crate) mod repeats;
pub(crate) mod scores;

use nalgebra::{DMatrix, DVector};

use super::estimate::Estimation;
use crate::regression::system::System;
use distributions::student_quantile;
use repeats::ratios;
use scores::{Context, Covariance};

/// What an interval may miss.
const MISSES: f64 = 0.05;

/// The base estimates with what is known of their uncertainty.
#[derive(Debug, Clone)]
pub(crate) struct Intervals {
    columns: Vec<usize>,
    values: Vec<f64>,
    covariance: DMatrix<f64>,
    /// Degrees of freedom of the covariance as a whole.
    freedom: f64,
    /// Degrees of freedom of each variance.
    freedoms: Vec<f64>,
}

impl Intervals {
    /// Those of the base `estimation` of the columns `selected`. Without successive equations they are
    /// those of sums over parts, and where these tell too little those under white residuals.
    pub(crate) fn new(system: &System, selected: &[usize], estimation: &Estimation) -> Self {
        let context = Context::new(selected, estimation);
        let found = Self::of_context(system, &context);
        found
            .or_else(|| Self::of_parts(system, &context))
            .unwrap_or_else(|| {
                let square = estimation.residual_deviation.powi(2);
                let (columns, values) = (selected.to_vec(), &estimation.values);
                Self::known(columns, values, context.inverse * square, f64::INFINITY)
            })
    }

    /// Those of any linear estimate; none without successive equations.
    pub(crate) fn of_context(system: &System, context: &Context<'_>) -> Option<Self> {
        let columns = context.selected.to_vec();
        let values = &context.estimation.values;
        let mut covariance = Covariance::new(system, context)?;
        let mut sorted = covariance.freedoms.clone();
        sorted.sort_by(f64::total_cmp);
        let freedom = sorted[sorted.len() / 2];
        covariance.enlarge(&ratios(system, context));
        let variances: Vec<f64> = covariance.matrix.diagonal().iter().copied().collect();
        let freedoms = covariance.freedoms.clone();
        covariance.enlarge(&periods::ratios(system, context, (&variances, &freedoms)));
        Some(Self {
            columns,
            values: values.clone(),
            covariance: covariance.matrix,
            freedom,
            freedoms: covariance.freedoms,
        })
    }

    /// Those of sums over parts of the runs.
    fn of_parts(system: &System, context: &Context<'_>) -> Option<Self> {
        let covariance = parts::covariance(system, context)?;
        let mut sorted = covariance.freedoms.clone();
        sorted.sort_by(f64::total_cmp);
        Some(Self {
            columns: context.selected.to_vec(),
            values: context.estimation.values.clone(),
            freedom: *sorted.get(sorted.len() / 2)?,
            covariance: covariance.matrix,
            freedoms: covariance.freedoms,
        })
    }

    /// The standard deviation of the estimate of a column.
    pub(crate) fn deviation_of(&self, column: usize) -> Option<f64> {
        let place = self.columns.iter().position(|own| *own == column)?;
        Some(self.covariance[(place, place)].sqrt())
    }

    /// With what else makes the estimates err, independently of their residual.
    pub(crate) fn widened(mut self, covariance: Option<&DMatrix<f64>>) -> Self {
        if let Some(more) = covariance {
            self.covariance += more;
        }
        self
    }

    /// The standard deviation of each estimate.
    pub(crate) fn deviations(&self) -> Vec<f64> {
        let variances = self.covariance.diagonal();
        variances.iter().map(|variance| variance.sqrt()).collect()
    }

    /// Those of estimates with a known covariance of so many degrees of freedom.
    pub(crate) fn known(
        columns: Vec<usize>,
        values: &[f64],
        covariance: DMatrix<f64>,
        freedom: f64,
    ) -> Self {
        Self {
            freedoms: vec![freedom; values.len()],
            columns,
            values: values.to_vec(),
            covariance,
            freedom,
        }
    }

    /// The covariance of the estimates.
    pub(crate) const fn covariance(&self) -> &DMatrix<f64> {
        &self.covariance
    }

    /// The degrees of freedom of each variance.
    pub(crate) fn freedoms(&self) -> &[f64] {
        &self.freedoms
    }

    /// The interval of a column in a model of so many of the parameters; none that was not estimated.
    pub(crate) fn of(&self, column: usize, parameters: usize) -> Option<[f64; 2]> {
        let place = self.columns.iter().position(|own| *own == column)?;
        let all = self.columns.len() as f64;
        let chosen = parameters as f64 / all;
        let [low, high] = self.around(place, MISSES / all);
        let may_be_chance = low < 0.0 && high > 0.0;
        let misses = MISSES * if may_be_chance { chosen } else { 1.0 };
        Some(self.around(place, misses))
    }

    /// χ ± t σ of the parameter at a place, which misses the truth with this probability.
    fn around(&self, place: usize, misses: f64) -> [f64; 2] {
        let (value, freedom) = (self.values[place], self.freedoms[place]);
        let deviation = self.covariance[(place, place)].sqrt();
        let half = student_quantile(misses, freedom) * deviation;
        [value - half, value + half]
    }

    /// χᵀ V^-1 χ of some columns, and the degrees of freedom of V; none where V is singular.
    pub(crate) fn distance(&self, columns: &[usize]) -> Option<(f64, f64)> {
        let place = |column: &usize| self.columns.iter().position(|own| own == column);
        let places: Vec<usize> = columns.iter().map(place).collect::<Option<_>>()?;
        let matrix = self.covariance.select_rows(&places).select_columns(&places);
        // Divided by their deviations, so that units do not matter.
        let scales = matrix.diagonal().map(|variance| 1.0 / variance.sqrt());
        let scaled = DMatrix::from_fn(places.len(), places.len(), |i, j| {
            matrix[(i, j)] * scales[i] * scales[j]
        });
        let values = scales.zip_map(
            &DVector::from_iterator(places.len(), places.iter().map(|place| self.values[*place])),
            |scale, value| scale * value,
        );
        let solved = scaled.cholesky()?.solve(&values);
        Some((values.dot(&solved), self.freedom))
    }
}

#[cfg(test)]
mod tests;
