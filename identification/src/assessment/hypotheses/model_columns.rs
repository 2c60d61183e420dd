//! The model's columns in a test, with the products that all tests share.

use nalgebra::DMatrix;

use super::{
    columns::Layout,
    scaled::Scaled,
    sections::{MotionMean, RunScores},
};

/// Columns of base parameters, and rates of the dry friction columns.
#[derive(Debug, Clone)]
pub(super) struct ModelColumns {
    pub(super) selected: Vec<usize>,
    /// Number of base parameters among them.
    count: usize,
    /// Gram matrix of all columns, and of the base parameters alone.
    pub(super) gram: Scaled,
    whole: Scaled,
    /// For each run, the products of these columns over all cosines.
    pub(super) products: Vec<Vec<DMatrix<f64>>>,
    /// For each periodic motion, the harmonics of the residual after the fit.
    pub(super) left: Vec<Vec<f64>>,
}

impl ModelColumns {
    /// The base parameter columns `selected`, followed by the friction rates `late`.
    ///
    /// `None` if these columns are linearly dependent.
    pub(super) fn new(
        layout: &Layout,
        runs: &[RunScores],
        means: &[MotionMean],
        selected: &[usize],
        late: &[usize],
    ) -> Option<Self> {
        let count = selected.len();
        let selected: Vec<usize> = selected.iter().chain(late).copied().collect();
        let products: Vec<Vec<DMatrix<f64>>> = runs
            .iter()
            .map(|run| {
                let over = |m| run.cross_products(layout, m, &selected, &selected);
                (0..=2 * run.cosines).map(over).collect()
            })
            .collect();
        let start = DMatrix::zeros(selected.len(), selected.len());
        let gram = products.iter().fold(start, |sum, own| sum + &own[0]);
        let whole = Scaled::new(&gram.view((0, 0), (count, count)).clone_owned())?;
        let gram = Scaled::new(&gram)?;
        let inverse = gram.solve(&DMatrix::identity(selected.len(), selected.len()));
        let left = means.iter().map(|own| own.mean.left(&selected, &inverse));
        Some(Self {
            count,
            left: left.collect(),
            whole,
            gram,
            selected,
            products,
        })
    }

    /// Regression of columns on the base parameters alone, from their products.
    pub(super) fn estimated(&self, cross: &DMatrix<f64>) -> DMatrix<f64> {
        self.whole.solve(&cross.rows(0, self.count).clone_owned())
    }
}
