//! Standard deviations of calibrated parameters.
//!
//! The error of an estimate is Σ_t u_tᵀ ε_t, with the influence u_t = J'_t N^-1 of sample t and the
//! noise ε in units of the sensors. With autocovariances c_k of the noise, equal for all sensors,
//! its variance is
//!
//! ```text
//! v_i = c_0 l_i0 + 2 Σ_k c_k l_ik,   l_ik = Σ_t u_ti · u_(t+k)i,
//! ```
//!
//! which is σ² (N^-1)_ii for white noise. Encoder noise is not always white: electronics average,
//! and slow motion stays within one step for many samples. Errors of the geometry are never white.
//! The autocovariances come from `correlation`. The result is at least the standard deviation for
//! white noise. The degrees of freedom are 2 v²/var(v), with var(v) from the uncertainty of the
//! noise coefficients.

use nalgebra::DVector;

use super::{
    correlation::Noise,
    elimination::Eliminated,
    fit::{Fit, inverted, restricted},
};
use crate::estimation::intervals::distributions::student_quantile;

/// Step of a noise coefficient for numerical derivatives, in standard deviations.
const TRIED: f64 = 1e-3;

/// Uncertainty of fitted parameters.
#[derive(Debug, Clone)]
pub(super) struct Deviations {
    /// Standard deviation of each parameter.
    pub(super) each: Vec<f64>,
    /// Degrees of freedom of each variance.
    pub(super) freedoms: Vec<f64>,
}

impl Deviations {
    /// Uncertainty of a fit to samples of runs; `None` if it does not determine a parameter.
    pub(super) fn new(fit: &Fit, of_runs: &[usize], redundancy: usize) -> Option<Self> {
        let selected = &fit.selected;
        let inverse = inverted(&restricted(&fit.normal.matrix, selected))?;
        let equations = of_runs.iter().sum::<usize>() * redundancy;
        let free = equations.saturating_sub(selected.len()).max(1) as f64;
        let white = variance(fit.normal.square, equations, selected.len());
        let noise = Noise::new(&fit.equations, of_runs, selected, equations);
        let (mut each, mut freedoms) = (Vec::new(), Vec::new());
        for place in 0..selected.len() {
            let weights = inverse.column(place).into_owned();
            let influence = Influence::new(&fit.equations, of_runs, selected, &weights);
            let white = white * inverse[(place, place)];
            let correlated = influence.variance(&noise);
            each.push(white.max(correlated).sqrt());
            freedoms.push(if correlated > white {
                influence.freedom(&noise, correlated, free)
            } else {
                free
            });
        }
        Some(Self { each, freedoms })
    }

    /// Half width of a parameter's interval that misses the true value with probability `misses`.
    pub(super) fn half(&self, place: usize, misses: f64) -> f64 {
        student_quantile(misses, self.freedoms[place]) * self.each[place]
    }
}

/// Mean square residual of equations from which `parameters` were fitted.
pub(super) fn variance(square: f64, equations: usize, parameters: usize) -> f64 {
    square / equations.saturating_sub(parameters).max(1) as f64
}

/// l_k of a parameter, for all lags of the longest run.
struct Influence(Vec<f64>);

impl Influence {
    /// l of the parameter with the column `weights` of N^-1.
    fn new(
        samples: &[Eliminated],
        of_runs: &[usize],
        selected: &[usize],
        weights: &DVector<f64>,
    ) -> Self {
        let longest = of_runs.iter().copied().max().unwrap_or(0);
        let mut products = vec![0.0; longest];
        let mut first = 0;
        for &count in of_runs {
            let run = &samples[first..first + count];
            first += count;
            let each = run.iter().map(|one| influence(one, selected, weights));
            let each: Vec<DVector<f64>> = each.collect();
            for (lag, product) in products.iter_mut().enumerate().take(count) {
                let pairs = each.iter().zip(each.iter().skip(lag));
                *product += pairs.map(|(now, later)| now.dot(later)).sum::<f64>();
            }
        }
        Self(products)
    }

    /// v of the parameter for a noise.
    fn variance(&self, noise: &Noise) -> f64 {
        let covariances = noise.autocovariances(self.0.len());
        let terms = covariances.iter().zip(&self.0).enumerate();
        let sum: f64 = terms
            .map(|(lag, (c, l))| if lag == 0 { c * l } else { 2.0 * c * l })
            .sum();
        sum.max(0.0)
    }

    /// Degrees of freedom of v, where `free` equations determine the noise.
    fn freedom(&self, noise: &Noise, variance: f64, free: f64) -> f64 {
        let Some(uncertainty) = noise.uncertainty(free) else {
            return 1.0;
        };
        let slope = |place: usize| {
            let step = TRIED * uncertainty[(place, place)].sqrt();
            let mut changed = noise.clone();
            changed.coefficients[place] += step;
            (self.variance(&changed) / variance).ln() / step
        };
        let slopes = DVector::from_fn(noise.coefficients.len(), |place, _| slope(place));
        let of_coefficients = slopes.dot(&(uncertainty * &slopes));
        // The variance of ln σ² is 2/`free`.
        let freedom = 2.0 / (2.0 / free + of_coefficients);
        if freedom.is_finite() {
            freedom.clamp(1.0, free)
        } else {
            1.0
        }
    }
}

/// u of a sample.
fn influence(sample: &Eliminated, selected: &[usize], weights: &DVector<f64>) -> DVector<f64> {
    let mut sum = DVector::zeros(sample.residual.len());
    for (&place, weight) in selected.iter().zip(weights.iter()) {
        sum.axpy(*weight, &sample.columns.column(place), 1.0);
    }
    sum
}
