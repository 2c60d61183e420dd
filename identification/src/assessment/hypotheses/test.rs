//! Test of a hypothesis: significance, size, and shifts of the parameters.

use nalgebra::DMatrix;
use rayon::prelude::*;

use super::{
    group::Group,
    model_columns::ModelColumns,
    scaled::{Scaled, independent_columns},
    score_covariance::{OrthogonalColumns, RunContribution, ScoreCovariance, score},
    scores::Scores,
    wald_test::WaldTest,
};
use crate::estimation::intervals::distributions::Hotelling;

impl Scores {
    /// The base parameter columns `selected`, followed by the friction rates.
    fn model_columns(&self, selected: &[usize]) -> Option<ModelColumns> {
        ModelColumns::new(&self.layout, &self.runs, &self.means, selected, &self.late)
    }

    /// Tests a group with the base parameter columns `selected` in the model.
    ///
    /// `None` if the data do not separate the group from them.
    pub(crate) fn test(&self, group: &Group, selected: &[usize]) -> Option<WaldTest> {
        if selected != self.selected {
            return self.tested(group, &self.model_columns(selected)?);
        }
        let model_columns = self
            .own
            .model_columns
            .get_or_init(|| self.model_columns(selected));
        let model_columns = model_columns.as_ref()?;
        match group.run {
            // One request computes all hypotheses, since callers need them all.
            None if group.block < self.hypotheses.len() => {
                let all = || {
                    let groups = (0..self.hypotheses.len()).into_par_iter();
                    let one = |number| self.tested(&Group::hypothesis(number), model_columns);
                    groups.map(one).collect()
                };
                let all: &Vec<Option<WaldTest>> = self.own.wald_tests.get_or_init(all);
                all.get(group.block)?.clone()
            }
            _ => self.tested(group, model_columns),
        }
    }

    /// Tests all hypotheses with the estimate's own columns, for later requests.
    pub(crate) fn test_all(&self) {
        let first = Group::hypothesis(0);
        self.test(&first, &self.selected);
    }

    /// Tests a group with these columns in the model.
    fn tested(&self, group: &Group, model_columns: &ModelColumns) -> Option<WaldTest> {
        let layout = &self.layout;
        let columns: Vec<usize> = layout.blocks[group.block].clone();
        let inside = |run: usize| group.run.is_none_or(|own| own == run);
        let selected = model_columns.selected.as_slice();
        let mut cross = DMatrix::zeros(selected.len(), columns.len());
        let mut square = DMatrix::zeros(columns.len(), columns.len());
        for (number, run) in self.runs.iter().enumerate() {
            if inside(number) {
                cross += run.cross_products(layout, 0, selected, &columns);
                square += run.own(layout, group.block, 0);
            }
        }
        // The estimate has no friction rates, so its parameters shift as without them.
        let off = model_columns.estimated(&cross);
        let solved = model_columns.gram.solve(&cross);
        let outside = &square - cross.tr_mul(&solved);
        let independent = independent_columns(&outside, &square);
        let solved = solved.select_columns(&independent);
        let factor = Scaled::new(
            &outside
                .select_rows(&independent)
                .select_columns(&independent),
        )?;
        let white = factor.white(&DMatrix::identity(independent.len(), independent.len()));
        let orthogonal = OrthogonalColumns {
            layout,
            model_columns,
            group: *group,
            independent: &independent,
            solved: &solved,
            white: &white,
        };
        let runs = self.runs.iter().enumerate();
        let contributions: Vec<RunContribution> = runs
            .map(|(number, run)| orthogonal.contribution(number, run, inside(number)))
            .collect();
        self.wald_test(
            &orthogonal,
            &contributions,
            off.select_columns(&independent),
        )
    }

    /// Result from the contributions of all runs; `off` is B for the estimate's own columns.
    fn wald_test(
        &self,
        orthogonal: &OrthogonalColumns<'_>,
        contributions: &[RunContribution],
        off: DMatrix<f64>,
    ) -> Option<WaldTest> {
        let width = orthogonal.independent.len();
        let score = score(contributions, width);
        let ScoreCovariance {
            covariance,
            freedom,
        } = orthogonal.score_covariance(contributions, &self.means, &score)?;
        let count = width as f64;
        if width == 0 || freedom - count < 0.0 {
            return None;
        }
        let as_column = DMatrix::from_column_slice(width, 1, score.as_slice());
        let distance = Scaled::new(&covariance)?.solve(&as_column);
        let test = Hotelling::new(score.dot(&distance.column(0)), count, freedom);
        // z⊥ is orthonormal, so the scores are its sizes.
        let sizes = orthogonal.white.tr_mul(&score);
        let of_sizes = orthogonal.white.tr_mul(&(&covariance * orthogonal.white));
        let total: f64 = self.runs.iter().map(|run| run.square).sum();
        let shifts = &off * &sizes;
        let selected = orthogonal.model_columns.selected.iter().copied();
        Some(WaldTest {
            deviation: of_sizes[(0, 0)].max(0.0).sqrt(),
            freedom,
            probability: test.probability,
            covariance: of_sizes,
            explained: score.norm_squared() / total.max(f64::MIN_POSITIVE),
            noise: covariance.trace() / count / total.max(f64::MIN_POSITIVE),
            sizes: orthogonal
                .independent
                .iter()
                .copied()
                .zip(sizes.iter().copied())
                .collect(),
            shifts: selected.zip(shifts.iter().copied()).collect(),
            regression: off,
        })
    }

    /// Indices of the estimate's parameters.
    pub(crate) fn selected(&self) -> &[usize] {
        &self.selected
    }
}
