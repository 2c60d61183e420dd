//! Correlations of the residuals of actuators, from the products of [`Pairs`].

use nalgebra::{DMatrix, DVector};

use super::{pairs::Pairs, scaled::Scaled, scores::Scores};
use crate::estimation::intervals::distributions::fisher_tail;

/// Largest standard deviation of a correlation that is reported.
const LARGEST_DEVIATION: f64 = 0.1;

/// Correlation of the residuals of two actuators.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Correlation {
    /// The two actuators.
    pub(crate) actuators: (usize, usize),
    /// σ_kl/√(σ_kk σ_ll).
    pub(crate) value: f64,
    /// σ_kl.
    pub(crate) covariance: f64,
    /// Size by standard deviation, and the degrees of freedom of the latter.
    pub(crate) strength: f64,
    pub(crate) freedom: f64,
    /// p-value.
    pub(crate) probability: f64,
}

impl Scores {
    /// Correlations of the residuals of all actuator pairs, as far as the motion determines them.
    ///
    /// Each pair is fitted separately, together with the variances σ_kk.
    pub(crate) fn correlations(&self) -> Vec<Correlation> {
        let Some(run) = self.runs.first() else {
            return Vec::new();
        };
        let places = || run.pairs.pairs.iter().enumerate();
        let own: Vec<usize> = places()
            .filter(|(_, (k, l))| k == l)
            .map(|(place, _)| place)
            .collect();
        let off_diagonal = places().filter(|(_, (k, l))| k != l);
        off_diagonal
            .filter_map(|(place, &(first, second))| {
                let mut chosen = own.clone();
                chosen.push(place);
                self.correlation(first, second, &chosen)
            })
            .collect()
    }

    /// Correlation of two actuators, whose pair is the last of the `chosen` indices.
    fn correlation(&self, first: usize, second: usize, chosen: &[usize]) -> Option<Correlation> {
        let count = chosen.len();
        let of = |run: &Pairs, m: usize| run.gram(m).select_rows(chosen).select_columns(chosen);
        let (mut gram, mut score) = (DMatrix::zeros(count, count), DMatrix::zeros(count, 1));
        for run in &self.runs {
            gram += of(&run.pairs, 0);
            score += run.pairs.scores.select_rows(chosen).columns(0, 1);
        }
        let factor = Scaled::new(&gram)?;
        let sizes = factor.solve(&score).column(0).clone_owned();
        let (mut variance, mut squares) = (0.0, 0.0);
        for run in &self.runs {
            let scores = run.pairs.scores.select_rows(chosen);
            let sums: Vec<DVector<f64>> = (1..=run.cosines)
                .map(|b| scores.column(b) - of(&run.pairs, b) * &sizes)
                .collect();
            let sums = factor.solve(&DMatrix::from_columns(&sums));
            // The cosines of a covariance have the mean square 1.
            let share = 2.0 * sums.row(count - 1).norm_squared() / run.cosines as f64;
            variance += share;
            squares += share * share / run.cosines as f64;
        }
        let by_chance = variance.sqrt();
        let [periodic_variance, scatter] = self.periodic_variance(first, second);
        (variance, squares) = (variance + periodic_variance, squares + scatter);
        let scale = (sizes[first] * sizes[second]).sqrt();
        let strength = sizes[count - 1].abs() / variance.sqrt();
        let freedom = variance * variance / squares;
        let sound = scale > 0.0 && strength.is_finite() && freedom >= 1.0;
        let is_determined = by_chance <= LARGEST_DEVIATION * scale;
        (sound && is_determined).then(|| Correlation {
            actuators: (first, second),
            value: sizes[count - 1] / scale,
            covariance: sizes[count - 1],
            strength,
            freedom,
            probability: fisher_tail(strength * strength, 1.0, freedom),
        })
    }

    /// Variance that periodic residuals add to the mean of a product of two actuators.
    ///
    /// The second value is its square by its degrees of freedom. Both are zero unless the lines are
    /// the actuators' equations. The residuals of the lines are weighted, the product is not.
    fn periodic_variance(&self, first: usize, second: usize) -> [f64; 2] {
        let Some(weights) = &self.actuator_weights else {
            return [0.0; 2];
        };
        let weight = |line: usize| weights.get(line).copied().unwrap_or(1.0);
        let weight = weight(first) * weight(second);
        let lines = self.runs.first().map_or(0, |run| run.lines);
        let equations: usize = self.runs.iter().map(|run| run.equations).sum();
        let instants = equations as f64 / lines.max(1) as f64;
        let products = self.means.iter().map(|own| own.mean.product(first, second));
        let [sum, scatter] = products.fold([0.0; 2], |all, own| [all[0] + own[0], all[1] + own[1]]);
        let scale = (weight * instants).powi(2);
        [sum / scale, scatter / scale.powi(2)]
    }
}
