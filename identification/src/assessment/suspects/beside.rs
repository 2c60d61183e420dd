//! The columns of the model beside which suspects are tested, with what all tests share.

use nalgebra::DMatrix;

use super::{columns::Layout, scaled::Scaled, sections::RunScores};
use crate::estimation::returning::Mean;

/// Columns of base parameters and of friction that is late.
#[derive(Debug, Clone)]
pub(super) struct Beside {
    pub(super) selected: Vec<usize>,
    /// How many of them are those of base parameters.
    count: usize,
    /// Their Gram matrix, and that of the base parameters alone.
    pub(super) gram: Scaled,
    whole: Scaled,
    /// For each run the products of the columns with each other over all cosines.
    pub(super) products: Vec<Vec<DMatrix<f64>>>,
    /// What the fit leaves of the harmonics of each motion that returns.
    pub(super) left: Vec<Vec<f64>>,
}

impl Beside {
    /// The columns `selected` of base parameters, and those of friction that is `late` behind them; none
    /// where they depend on each other.
    pub(super) fn new(
        layout: &Layout,
        (runs, means): (&[RunScores], &[(Vec<usize>, Mean)]),
        (selected, late): (&[usize], &[usize]),
    ) -> Option<Self> {
        let count = selected.len();
        let selected: Vec<usize> = selected.iter().chain(late).copied().collect();
        let products: Vec<Vec<DMatrix<f64>>> = runs
            .iter()
            .map(|run| {
                let both = (selected.as_slice(), selected.as_slice());
                let over = |m| run.beside(layout, m, both);
                (0..=2 * run.cosines).map(over).collect()
            })
            .collect();
        let start = DMatrix::zeros(selected.len(), selected.len());
        let gram = products.iter().fold(start, |sum, own| sum + &own[0]);
        let whole = Scaled::new(&gram.view((0, 0), (count, count)).clone_owned())?;
        let gram = Scaled::new(&gram)?;
        let inverse = gram.solve(&DMatrix::identity(selected.len(), selected.len()));
        let left = means.iter().map(|(_, mean)| mean.left(&selected, &inverse));
        Some(Self {
            count,
            left: left.collect(),
            whole,
            gram,
            selected,
            products,
        })
    }

    /// What the base parameters alone explain of columns, by the products of these with all columns.
    pub(super) fn estimated(&self, cross: &DMatrix<f64>) -> DMatrix<f64> {
        self.whole.solve(&cross.rows(0, self.count).clone_owned())
    }
}
