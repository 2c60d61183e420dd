//! Whether a suspect is there, how large it is, and what it does to the parameters.

use nalgebra::DMatrix;

use super::{
    scaled::{Scaled, told},
    scores::Scores,
    spread::{Freed, Share, Spread, score},
};
use crate::estimation::intervals::distributions::{fisher_tail, student_quantile};

/// How often a fault that is just large enough to be seen is missed.
const MISSED: f64 = 0.1;

/// Probabilities below are as good as none.
const LEAST_PROBABILITY: f64 = 1e-30;

/// Columns that are tested together: those of a suspect, or of the payload in one run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Group {
    /// The block of their columns.
    block: usize,
    /// The run to which they are confined.
    run: Option<usize>,
}

impl Group {
    /// One suspect, by its number.
    pub(crate) fn suspect(number: usize) -> Self {
        Self {
            block: number,
            run: None,
        }
    }

    /// The payload's parameters in one run.
    pub(crate) fn payload(scores: &Scores, run: usize) -> Self {
        Self {
            block: scores.suspects.len(),
            run: Some(run),
        }
    }
}

/// What speaks against a group of columns.
#[derive(Debug, Clone)]
pub(crate) struct Accused {
    /// δ of each column that the data can tell, by its place in the group.
    pub(crate) sizes: Vec<(usize, f64)>,
    /// Deviation of δ of the first one.
    pub(crate) deviation: f64,
    /// δ of the first one that would be missed one time in ten, at a level.
    freedom: f64,
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

impl Scores {
    /// Tests a group beside the columns `selected` of the base parameters; none where the data can't tell
    /// it from them.
    pub(crate) fn test(&self, group: &Group, selected: &[usize]) -> Option<Accused> {
        let layout = &self.layout;
        // Friction that is late stands behind the columns of the estimate.
        let count = selected.len();
        let selected: Vec<usize> = selected.iter().chain(&self.late).copied().collect();
        let selected = selected.as_slice();
        let columns: Vec<usize> = layout.blocks[group.block].clone().collect();
        let inside = |run: usize| group.run.is_none_or(|own| own == run);
        let mut gram = DMatrix::zeros(selected.len(), selected.len());
        let mut cross = DMatrix::zeros(selected.len(), columns.len());
        let mut square = DMatrix::zeros(columns.len(), columns.len());
        for (number, run) in self.runs.iter().enumerate() {
            let rows = run.cross(layout, 0).select_rows(selected);
            gram += rows.select_columns(selected);
            if inside(number) {
                cross += rows.select_columns(&columns);
                square += run.own(layout, group.block, 0);
            }
        }
        // The estimate has no friction that is late: its parameters are off as if there were none.
        let whole = Scaled::new(&gram.view((0, 0), (count, count)).clone_owned())?;
        let off = whole.solve(&cross.rows(0, count).clone_owned());
        let gram = Scaled::new(&gram)?;
        let solved = gram.solve(&cross);
        let outside = &square - cross.tr_mul(&solved);
        let told = told(&outside, &square);
        let solved = solved.select_columns(&told);
        let factor = Scaled::new(&outside.select_rows(&told).select_columns(&told))?;
        let white = factor.white(&DMatrix::identity(told.len(), told.len()));
        let freed = Freed {
            layout,
            selected,
            gram: &gram,
            block: group.block,
            told: &told,
            solved: &solved,
            white: &white,
        };
        let runs = self.runs.iter().enumerate();
        let shares: Vec<Share> = runs
            .map(|(number, run)| freed.share(run, inside(number)))
            .collect();
        self.accused(&freed, &shares, &off.select_columns(&told))
    }

    /// What the shares of all runs say; `off` is B of the estimate's own columns.
    fn accused(&self, freed: &Freed<'_>, shares: &[Share], off: &DMatrix<f64>) -> Option<Accused> {
        let width = freed.told.len();
        let score = score(shares, width);
        let Spread {
            covariance,
            freedom,
        } = freed.spread(shares, &score)?;
        let count = width as f64;
        let rest = freedom - count + 1.0;
        if width == 0 || rest < 1.0 {
            return None;
        }
        let as_column = DMatrix::from_column_slice(width, 1, score.as_slice());
        let distance = Scaled::new(&covariance)?.solve(&as_column);
        let statistic = rest / (freedom * count) * score.dot(&distance.column(0));
        // z⊥ is orthonormal: the scores are its sizes.
        let sizes = freed.white.tr_mul(&score);
        let first = freed.white.column(0);
        let variance = (first.transpose() * &covariance * first)[(0, 0)];
        let total: f64 = self.runs.iter().map(|run| run.square).sum();
        let moves = off * &sizes;
        let selected = freed.selected.iter().copied();
        Some(Accused {
            deviation: variance.max(0.0).sqrt(),
            freedom,
            probability: fisher_tail(statistic, count, rest),
            explained: score.norm_squared() / total.max(f64::MIN_POSITIVE),
            sizes: freed
                .told
                .iter()
                .copied()
                .zip(sizes.iter().copied())
                .collect(),
            moves: selected.zip(moves.iter().copied()).collect(),
        })
    }

    /// Places of the parameters of the estimate with which the runs were gone through.
    pub(crate) fn selected(&self) -> &[usize] {
        &self.selected
    }
}
