//! Covariance of the scores of fault hypotheses.
//!
//! It is estimated as for parameters of the model (see `estimation::intervals::scores`). The
//! hypotheses' columns, orthogonalised to the model's, count as columns of the model.

use nalgebra::{DMatrix, DVector};

use super::{
    columns::Layout,
    group::Group,
    model_columns::ModelColumns,
    sections::{MotionMean, RunScores},
};
use crate::estimation::{
    correlation::square,
    periodic_variance::{SumVariance, VarianceRatio},
};

/// Orthonormal columns of a group outside the model's columns: z⊥ = (z - W B) Mᵀ.
pub(super) struct OrthogonalColumns<'a> {
    pub(super) layout: &'a Layout,
    /// Columns of the model.
    pub(super) model_columns: &'a ModelColumns,
    /// The group, and its independent columns by place in the block.
    pub(super) group: Group,
    pub(super) independent: &'a [usize],
    /// B, columns of the model × columns of the group.
    pub(super) solved: &'a DMatrix<f64>,
    /// M.
    pub(super) white: &'a DMatrix<f64>,
}

/// Contribution of one run, as sums over cosines.
pub(super) struct RunContribution {
    /// Wᵀ z⊥, z⊥ᵀ z⊥ and z⊥ᵀ ρ for each cosine.
    fitted: Vec<DMatrix<f64>>,
    own: Vec<DMatrix<f64>>,
    scores: Vec<DVector<f64>>,
    cosines: usize,
}

/// Covariance of the scores, and its degrees of freedom.
pub(super) struct ScoreCovariance {
    pub(super) covariance: DMatrix<f64>,
    pub(super) freedom: f64,
}

impl OrthogonalColumns<'_> {
    /// Contribution of the run with this number; the columns are zero unless `inside`.
    pub(super) fn contribution(
        &self,
        number: usize,
        run: &RunScores,
        inside: bool,
    ) -> RunContribution {
        let count = 2 * run.cosines + 1;
        let mut contribution = RunContribution {
            fitted: Vec::with_capacity(count),
            own: Vec::with_capacity(count),
            scores: Vec::with_capacity(count),
            cosines: run.cosines,
        };
        let columns: Vec<usize> = self.columns().collect();
        let turned = self.white.transpose();
        let (p, width) = self.solved.shape();
        let selected = self.model_columns.selected.as_slice();
        for (m, products) in self.model_columns.products[number].iter().enumerate() {
            let mut fitted = -(products * self.solved);
            let mut own = DMatrix::zeros(width, width);
            let all = run.scores().column(m);
            let mut score = DVector::zeros(width);
            if inside {
                let cross = run.cross_products(self.layout, m, selected, &columns);
                own -= cross.tr_mul(self.solved);
                fitted += cross;
                let block = run.own(self.layout, self.group.block, m);
                own += block
                    .select_rows(self.independent)
                    .select_columns(self.independent);
                score += all.select_rows(&columns);
            }
            own -= self.solved.tr_mul(&fitted);
            score -= self.solved.tr_mul(&all.select_rows(selected));
            debug_assert_eq!(fitted.nrows(), p);
            contribution.fitted.push(fitted * &turned);
            contribution.own.push(self.white * own * &turned);
            contribution.scores.push(self.white * score);
        }
        contribution
    }

    /// Columns of the group among all columns.
    fn columns(&self) -> impl Iterator<Item = usize> {
        let block = &self.layout.blocks[self.group.block];
        self.independent.iter().map(|place| block[*place])
    }

    /// Covariance of all runs' scores if the faults had these `sizes`.
    pub(super) fn score_covariance(
        &self,
        contributions: &[RunContribution],
        means: &[MotionMean],
        sizes: &DVector<f64>,
    ) -> Option<ScoreCovariance> {
        let width = sizes.len();
        let mut covariance = DMatrix::zeros(width, width);
        let mut moments = vec![(0.0, 0.0); width];
        for contribution in contributions {
            let count = contribution.cosines;
            let sums = DMatrix::from_columns(
                &(1..=count)
                    .map(|b| &contribution.scores[b] - &contribution.own[b] * sizes)
                    .collect::<Vec<_>>(),
            );
            // The cosines of the covariance have the mean square 1.
            covariance += 2.0 * &sums * sums.transpose() / count as f64;
            for (i, (expected, squares)) in moments.iter_mut().enumerate() {
                let white = self.under_white_noise(contribution, i);
                *expected += white.trace() / count as f64;
                *squares += white.norm_squared() / (count * count) as f64;
            }
        }
        let sound = |(expected, squares): &(f64, f64)| *expected > 0.0 && *squares > 0.0;
        if !moments.iter().all(sound) {
            return None;
        }
        for (i, (expected, _)) in moments.iter().enumerate() {
            let factor = 1.0 / expected.sqrt();
            covariance.row_mut(i).scale_mut(factor);
            covariance.column_mut(i).scale_mut(factor);
        }
        let freedoms = moments.iter().map(|(mean, squares)| mean * mean / squares);
        let freedom = freedoms.fold(f64::INFINITY, f64::min);
        let score_covariance = ScoreCovariance {
            covariance,
            freedom,
        };
        Some(score_covariance.enlarged(&self.sum_variances(means, sizes)))
    }

    /// Variances of the scores from periodic residuals, if the faults had these `sizes`.
    ///
    /// Empty if the group is confined to one of several runs of a motion.
    fn sum_variances(&self, means: &[MotionMean], sizes: &DVector<f64>) -> Vec<SumVariance> {
        let width = sizes.len();
        let mut all = vec![SumVariance::default(); width];
        let turned = self.white.transpose();
        let model_part = -(self.solved * &turned);
        for (MotionMean { runs, mean }, left) in means.iter().zip(&self.model_columns.left) {
            let mut combinations = DMatrix::zeros(self.layout.columns, width);
            for (row, column) in self.model_columns.selected.iter().enumerate() {
                combinations.set_row(*column, &model_part.row(row));
            }
            let inside = self.group.run.is_none_or(|own| runs.contains(&own));
            if inside && self.group.run.is_some() && runs.len() > 1 {
                return Vec::new();
            }
            if inside {
                for (row, column) in self.columns().enumerate() {
                    combinations.set_row(column, &turned.row(row));
                }
            }
            let own = mean.sum_variances(&combinations, left, Some(sizes));
            let both = all.iter_mut().zip(own);
            both.for_each(|(all, own)| *all = all.and(own));
        }
        all
    }

    /// C of column i: covariance of its cosine sums for a white residual of unit variance.
    ///
    /// The residual is taken before the fit.
    fn under_white_noise(&self, contribution: &RunContribution, i: usize) -> DMatrix<f64> {
        let count = contribution.cosines;
        let root = std::f64::consts::SQRT_2;
        let of = |all: &[DMatrix<f64>]| {
            let columns: Vec<DVector<f64>> =
                (1..=count).map(|b| all[b].column(i).scale(root)).collect();
            DMatrix::from_columns(&columns)
        };
        let (model, group) = (
            self.model_columns.gram.white(&of(&contribution.fitted)),
            of(&contribution.own),
        );
        let taken = square(&model) + square(&group);
        let spectrum = |m: usize| contribution.own[m][(i, i)];
        DMatrix::from_fn(count, count, |a, b| {
            spectrum(a.abs_diff(b)) + spectrum(a + b + 2) - taken[(a, b)]
        })
    }
}

impl ScoreCovariance {
    /// Increases the covariance to that of periodic residuals, if that is larger.
    ///
    /// Periodic residuals are equal in every period, so slow variations of the scores miss them.
    fn enlarged(mut self, sum_variances: &[SumVariance]) -> Self {
        let all = sum_variances.iter().copied().reduce(SumVariance::and);
        let Some(all) = all.filter(|all| all.square > 0.0) else {
            return self;
        };
        // The columns are orthonormal.
        let VarianceRatio { ratio, freedom } =
            all.by(self.covariance.trace(), sum_variances.len() as f64);
        if ratio > 1.0 && ratio.is_finite() {
            self.covariance *= ratio;
            if sum_variances.len() == 1 {
                self.freedom = 1.0 / (1.0 / self.freedom + 1.0 / freedom);
            }
        }
        self
    }
}

/// Scores of all runs together.
pub(super) fn score(contributions: &[RunContribution], width: usize) -> DVector<f64> {
    let start = DVector::zeros(width);
    contributions
        .iter()
        .fold(start, |sum, contribution| sum + &contribution.scores[0])
}
