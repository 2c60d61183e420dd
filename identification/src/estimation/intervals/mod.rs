//! 95 % confidence intervals that hold for any residual and after elimination of parameters.
//!
//! - `scores`: covariance of the base estimate for any residual, with degrees of freedom.
//! - `periodic_power`: its increase from residuals at the frequencies of the motion.
//! - `periods`: its increase from residuals that are equal in all periods.
//! - `sessions`: their increase from changes of the robot between recording sessions.
//! - `parts`: covariance from sums over parts of the runs, if only their factors are stored.
//! - `distributions`: Student's and related distributions.
//!
//! The interval of base parameter i is χ_i ± t_0.975(ν_i) σ_i.
//!
//! **Eliminated parameters.** A smaller model has smaller standard deviations, which hold if the
//! eliminated parameters are exactly zero. That is unknown: they were eliminated because these data
//! hardly determine them. No shorter interval has the same coverage for all values of the
//! eliminated parameters (Leeb and Pötscher, *Econometric Theory* 21, 2005). A parameter of a
//! smaller model therefore has the interval of the base model. If elimination moves an estimate
//! outside, the data contradict it.
//!
//! **Selected parameters.** Parameters with weak effects are selected if their errors are large,
//! and their intervals would have about 50 % coverage. If all p base parameters were zero, the
//! largest
//! |χ_i|/σ_i would be below t_1-0.025/p in 95 % of all cases (Bonferroni). Above this limit, chance
//! does not affect the selection. Below it, the interval of one of k selected parameters is χ_i ±
//! t_1-0.025k/p σ_i. At most 5 % of such intervals miss the truth on average, for any selection
//! rule (Benjamini and Yekutieli, *J. American Statistical Association* 100, 2005).

pub(crate) mod distributions;
mod parts;
pub(crate) mod periodic_power;
mod periods;
pub(crate) mod scores;
mod sessions;

use nalgebra::{DMatrix, DVector};

use super::estimate::Estimation;
use crate::regression::system::System;
use distributions::student_quantile;
use periodic_power::ratios;
use scores::{Context, Covariance};

/// Probability that an interval misses the true value.
pub(crate) const MISSES: f64 = 0.05;

/// Base estimates with their covariance.
#[derive(Debug, Clone)]
pub(crate) struct Intervals {
    columns: Vec<usize>,
    values: Vec<f64>,
    covariance: DMatrix<f64>,
    /// Degrees of freedom of the whole covariance.
    freedom: f64,
    /// Degrees of freedom of each variance.
    freedoms: Vec<f64>,
}

impl Intervals {
    /// Intervals of the base `estimation` of the columns `selected`.
    ///
    /// Without successive equations, they use sums over parts. If these are insufficient, they
    /// assume white residuals.
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

    /// Intervals of any linear estimate; `None` without successive equations.
    pub(crate) fn of_context(system: &System, context: &Context<'_>) -> Option<Self> {
        let columns = context.selected.to_vec();
        let values = &context.estimation.values;
        let mut covariance = Covariance::new(system, context)?;
        let mut sorted = covariance.freedoms.clone();
        sorted.sort_by(f64::total_cmp);
        let freedom = sorted[sorted.len() / 2];
        covariance.enlarge(&ratios(system, context));
        covariance.enlarge(&periods::ratios(system, context, &covariance));
        let variances: Vec<f64> = covariance.matrix.diagonal().iter().copied().collect();
        if let Some(ratios) = sessions::ratios(system, context, &variances) {
            covariance.enlarge(&ratios);
        }
        Some(Self {
            columns,
            values: values.clone(),
            covariance: covariance.matrix,
            freedom,
            freedoms: covariance.freedoms,
        })
    }

    /// Intervals from sums over parts of the runs.
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

    /// Standard deviation of the estimate of a column.
    pub(crate) fn deviation_of(&self, column: usize) -> Option<f64> {
        let place = self.columns.iter().position(|own| *own == column)?;
        Some(self.covariance[(place, place)].sqrt())
    }

    /// Adds the covariance of other, independent errors of the estimates.
    pub(crate) fn widened(mut self, covariance: Option<&DMatrix<f64>>) -> Self {
        if let Some(more) = covariance {
            self.covariance += more;
        }
        self
    }

    /// Standard deviation of each estimate.
    pub(crate) fn deviations(&self) -> Vec<f64> {
        let variances = self.covariance.diagonal();
        variances.iter().map(|variance| variance.sqrt()).collect()
    }

    /// Intervals of estimates with a known covariance and its degrees of freedom.
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

    /// Covariance of the estimates.
    pub(crate) const fn covariance(&self) -> &DMatrix<f64> {
        &self.covariance
    }

    /// Degrees of freedom of each variance.
    pub(crate) fn freedoms(&self) -> &[f64] {
        &self.freedoms
    }

    /// Interval of a column in a model with this number of `parameters`.
    ///
    /// `None` if the column was not estimated.
    pub(crate) fn of(&self, column: usize, parameters: usize) -> Option<[f64; 2]> {
        let place = self.columns.iter().position(|own| *own == column)?;
        let all = self.columns.len() as f64;
        let chosen = parameters as f64 / all;
        let [low, high] = self.around(place, MISSES / all);
        let may_be_chance = low < 0.0 && high > 0.0;
        let misses = MISSES * if may_be_chance { chosen } else { 1.0 };
        Some(self.around(place, misses))
    }

    /// χ ± t σ of the parameter at `place`, which misses the truth with probability `misses`.
    fn around(&self, place: usize, misses: f64) -> [f64; 2] {
        let (value, freedom) = (self.values[place], self.freedoms[place]);
        let deviation = self.covariance[(place, place)].sqrt();
        let half = student_quantile(misses, freedom) * deviation;
        [value - half, value + half]
    }

    /// χᵀ V^-1 χ of some columns, and the degrees of freedom of V; `None` if V is singular.
    pub(crate) fn distance(&self, columns: &[usize]) -> Option<(f64, f64)> {
        let place = |column: &usize| self.columns.iter().position(|own| own == column);
        let places: Vec<usize> = columns.iter().map(place).collect::<Option<_>>()?;
        let matrix = self.covariance.select_rows(&places).select_columns(&places);
        // Scaled by the standard deviations, to be independent of units.
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
