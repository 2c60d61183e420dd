//! Whether a suspect is there, how large it is, and what it does to the parameters.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use super::scores::Scores;
use crate::estimation::intervals::{
    distributions::{fisher_tail, student_quantile},
    scores::cosines,
};

/// A column whose part outside the others is below this part of its square can't be told from them.
const LEAST_OUTSIDE: f64 = 1e-8;

/// How often a fault that is just large enough to be seen is missed.
const MISSED: f64 = 0.1;

/// Columns that are tested together.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Group {
    /// Places of the columns behind those of the base parameters.
    columns: Vec<usize>,
    /// The run to which they are confined.
    run: Option<usize>,
}

impl Group {
    /// One suspect, by its number.
    pub(crate) fn suspect(number: usize) -> Self {
        Self {
            columns: vec![number],
            run: None,
        }
    }

    /// The payload's parameters in one run.
    pub(crate) fn payload(scores: &Scores, run: usize) -> Self {
        let first = scores.suspects.len();
        Self {
            columns: (first..first + scores.payload.len()).collect(),
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
        let size = self.runs.first()?.gram.nrows();
        let base = size - self.suspects.len() - self.payload.len();
        let own: Vec<usize> = group.columns.iter().map(|column| base + column).collect();
        let inside = |run: usize| group.run.is_none_or(|own| own == run);
        let mut gram = DMatrix::zeros(selected.len(), selected.len());
        let mut cross = DMatrix::zeros(selected.len(), own.len());
        let mut square = DMatrix::zeros(own.len(), own.len());
        for (number, run) in self.runs.iter().enumerate() {
            let rows = run.gram.select_rows(selected);
            gram += rows.select_columns(selected);
            if inside(number) {
                cross += rows.select_columns(&own);
                square += run.gram.select_rows(&own).select_columns(&own);
            }
        }
        let solved = Scaled::new(&gram)?.solve(&cross);
        let outside = &square - cross.tr_mul(&solved);
        // Columns that the data can tell from the model's.
        let told: Vec<usize> = (0..own.len())
            .filter(|&i| outside[(i, i)] > LEAST_OUTSIDE * square[(i, i)])
            .collect();
        if told.is_empty() {
            return None;
        }
        let solved = solved.select_columns(&told);
        let outside = outside.select_rows(&told).select_columns(&told);
        let places: Vec<usize> = told.iter().map(|&i| own[i]).collect();
        let spread = self.spread(&solved, selected, &places, &inside)?;
        let (score, variance, freedom) = spread;
        let factor = Scaled::new(&outside)?;
        let sizes = factor.solve(&DMatrix::from_column_slice(told.len(), 1, score.as_slice()));
        let count = told.len() as f64;
        let rest = freedom - count + 1.0;
        if rest < 1.0 {
            return None;
        }
        let distance = Scaled::new(&variance)?.solve(&DMatrix::from_column_slice(
            told.len(),
            1,
            score.as_slice(),
        ));
        let statistic = rest / (freedom * count) * score.dot(&distance.column(0));
        let covariance = factor.solve(&variance);
        let covariance = factor.solve(&covariance.transpose());
        let total: f64 = self.runs.iter().map(|run| run.square).sum();
        let moves = &solved * &sizes;
        Some(Accused {
            deviation: covariance[(0, 0)].max(0.0).sqrt(),
            freedom,
            probability: fisher_tail(statistic, count, rest),
            explained: score.dot(&sizes.column(0)) / total.max(f64::MIN_POSITIVE),
            sizes: told.into_iter().zip(sizes.iter().copied()).collect(),
            moves: selected
                .iter()
                .copied()
                .zip(moves.iter().copied())
                .collect(),
        })
    }

    /// Places of the parameters of the estimate with which the runs were gone through.
    pub(crate) fn selected(&self) -> &[usize] {
        &self.selected
    }

    /// The scores of columns freed of the base parameters' by `solved`, their covariance by equally
    /// weighted cosines (see the module `intervals::scores`) and its degrees of freedom.
    fn spread(
        &self,
        solved: &DMatrix<f64>,
        selected: &[usize],
        own: &[usize],
        inside: &dyn Fn(usize) -> bool,
    ) -> Option<(DVector<f64>, DMatrix<f64>, f64)> {
        let mut score = DVector::zeros(own.len());
        let mut variance = DMatrix::zeros(own.len(), own.len());
        let mut squares = 0.0;
        for (number, run) in self.runs.iter().enumerate() {
            let mut sections = -solved.tr_mul(&run.sections.select_rows(selected));
            if inside(number) {
                sections += run.sections.select_rows(own);
            }
            score += sections.column_sum();
            let count = cosines(run.instants).min(sections.ncols() / 2).max(1);
            let waves = DMatrix::from_fn(sections.ncols(), count, |k, b| {
                let angle = (b + 1) as f64 * (k as f64 + 0.5) / sections.ncols() as f64;
                std::f64::consts::SQRT_2 * (std::f64::consts::PI * angle).cos()
            });
            let sums = sections * waves;
            let share = &sums * sums.transpose() / count as f64;
            squares += share[(0, 0)].powi(2) / count as f64;
            variance += share;
        }
        let whole: f64 = variance[(0, 0)];
        let freedom = whole * whole / squares;
        (freedom.is_finite() && freedom >= 1.0).then_some((score, variance, freedom))
    }
}

/// The Cholesky factor of a positive definite matrix, scaled so that units do not matter.
struct Scaled {
    scales: DVector<f64>,
    factor: Cholesky<f64, Dyn>,
}

impl Scaled {
    fn new(matrix: &DMatrix<f64>) -> Option<Self> {
        let scales = matrix.diagonal().map(|square: f64| 1.0 / square.sqrt());
        let scaled = DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, j| {
            matrix[(i, j)] * scales[i] * scales[j]
        });
        let sound = scales.iter().all(|scale| scale.is_finite());
        let factor = Cholesky::new(scaled).filter(|_| sound)?;
        Some(Self { scales, factor })
    }

    fn solve(&self, rhs: &DMatrix<f64>) -> DMatrix<f64> {
        let scale = |mut matrix: DMatrix<f64>| {
            for (mut row, scale) in matrix.row_iter_mut().zip(self.scales.iter()) {
                row *= *scale;
            }
            matrix
        };
        scale(self.factor.solve(&scale(rhs.clone())))
    }
}
