//! Increase of the covariance from residuals that are equal in all periods and runs.
//!
//! The other estimates treat pieces of a run as independent. A residual that repeats in all of them
//! violates that. Its effect is estimated from the mean over all periods.

use nalgebra::{DMatrix, DVector};

use super::scores::{Context, Covariance};
use crate::{
    estimation::periodic_variance::{Mean, SumVariance, VarianceRatio},
    regression::system::System,
};

/// Ratio of each parameter's variance to that of `covariance`, with its degrees of freedom.
pub(super) fn ratios(
    system: &System,
    context: &Context<'_>,
    covariance: &Covariance,
) -> Vec<VarianceRatio> {
    let p = context.selected.len();
    let influence = context.influence();
    // In the mean over all periods, the instruments equal the columns.
    let mut combinations = influence.columns(0, p).transpose();
    if influence.ncols() > p {
        combinations += influence.columns(p, p).transpose();
    }
    let places: Vec<usize> = (0..p).collect();
    let mut sum_variances = vec![SumVariance::default(); p];
    for phase_sums in &system.phase_sums {
        let weighted = |line: usize, rows: DMatrix<f64>| {
            let weight = context.estimation.weights[line];
            let columns = rows.select_columns(context.selected) * weight;
            let y = rows.column(rows.ncols() - 1) * weight;
            let values = DVector::from_column_slice(&context.estimation.values);
            let residual = y - &columns * values;
            (columns, residual)
        };
        let Some(mean) = Mean::new(phase_sums, weighted) else {
            continue;
        };
        let left = mean.left(&places, &context.inverse);
        let own = mean.sum_variances(&combinations, &left, None);
        for (all, own) in sum_variances.iter_mut().zip(own) {
            *all = all.and(own);
        }
    }
    if system.phase_sums.is_empty() {
        return vec![VarianceRatio::ONE; p];
    }
    let (variances, squares) = (covariance.matrix.diagonal(), context.inverse.diagonal());
    let each = sum_variances.iter().zip(&variances).zip(&squares);
    let ratios = each
        .zip(&covariance.freedoms)
        .map(|(((sum_variance, variance), square), own)| {
            LogarithmicRatio::new(sum_variance.by(*variance, *square), *own)
        });
    enlarged(&ratios.collect::<Vec<_>>())
}

/// Smallest mean log ratio that increases the covariance.
///
/// It is that of faultless virtual robots in runs of ten seconds, whose intervals are wide enough.
const LEAST_MEAN: f64 = 0.5;

/// Logarithm of an estimated ratio of two variances.
#[derive(Debug, Clone, Copy)]
struct LogarithmicRatio {
    /// The logarithm, corrected for bias.
    logarithm: f64,
    /// Its sampling variance.
    variance: f64,
    /// Degrees of freedom of the ratio.
    freedom: f64,
}

impl LogarithmicRatio {
    /// Logarithm of a ratio to a variance with `other_freedom` degrees of freedom.
    fn new(estimate: VarianceRatio, other_freedom: f64) -> Self {
        let VarianceRatio { ratio, freedom } = estimate;
        Self {
            logarithm: ratio.ln() + 1.0 / freedom - 1.0 / other_freedom,
            variance: 2.0 / freedom + 2.0 / other_freedom,
            freedom,
        }
    }

    fn is_sound(&self) -> bool {
        self.logarithm.is_finite() && self.variance.is_finite() && self.variance > 0.0
    }
}

/// Shrunken ratios above one, if their mean is clearly above one.
///
/// Single ratios scatter, and using only those above one would overestimate the variance. They are
/// shrunk towards their mean as far as their spread is random (James and Stein).
fn enlarged(ratios: &[LogarithmicRatio]) -> Vec<VarianceRatio> {
    let sound = || ratios.iter().filter(|one| one.is_sound());
    let weights: f64 = sound().map(|one| 1.0 / one.variance).sum();
    let mean = sound().map(|one| one.logarithm / one.variance).sum::<f64>() / weights;
    if weights.is_nan() || mean < LEAST_MEAN {
        return vec![VarianceRatio::ONE; ratios.len()];
    }
    let apart = sound().map(|one| (one.logarithm - mean).powi(2) / one.variance - 1.0);
    // Variance of the true ratios.
    let between = (apart.sum::<f64>() / weights).max(0.0);
    let enlarged = |one: &LogarithmicRatio| {
        if !one.is_sound() {
            return VarianceRatio::ONE;
        }
        let own = between / (between + one.variance);
        let logarithm = mean + own * (one.logarithm - mean);
        if logarithm > 0.0 {
            VarianceRatio {
                ratio: logarithm.exp(),
                freedom: one.freedom / own.max(f64::MIN_POSITIVE),
            }
        } else {
            VarianceRatio::ONE
        }
    };
    ratios.iter().map(enlarged).collect()
}

#[cfg(test)]
mod tests {
    use super::{LEAST_MEAN, LogarithmicRatio, VarianceRatio, enlarged};

    fn logarithms(ratios: &[f64]) -> Vec<LogarithmicRatio> {
        let estimate = |ratio: f64| VarianceRatio {
            ratio,
            freedom: 20.0,
        };
        let one = |ratio: &f64| LogarithmicRatio::new(estimate(*ratio), 40.0);
        ratios.iter().map(one).collect()
    }

    #[test]
    fn random_variance_ratios_enlarge_no_interval() {
        let found = enlarged(&logarithms(&[0.6, 1.7, 1.1, 0.8, 1.3, 0.9]));
        assert!(found.iter().all(|own| own.ratio == 1.0), "{found:?}");
    }

    #[test]
    fn variance_ratios_are_shrunk_towards_their_mean() {
        let found = enlarged(&logarithms(&[2.5, 4.0, 3.0, 2.8, 3.6]));
        let first = found[0].ratio;
        assert!(first.ln() > LEAST_MEAN);
        assert!(
            found.iter().all(|own| (own.ratio - first).abs() < 1e-9),
            "{found:?}"
        );
        // If the true ratios differ, each keeps most of its own value.
        let found = enlarged(&logarithms(&[1.0, 1.1, 30.0, 40.0, 0.9, 35.0]));
        assert!(found[0].ratio < 2.0 && found[3].ratio > 20.0, "{found:?}");
        assert!(
            found[3].freedom < 25.0 && found[0].ratio >= 1.0,
            "{found:?}"
        );
    }
}
