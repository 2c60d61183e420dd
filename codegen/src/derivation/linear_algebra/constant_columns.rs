//! Linear systems with constant columns, solved for any right-hand side.
//!
//! The constraint rows of a platform contain directions that often are constant, as for a leg in a
//! fixed plane. Unknowns with constant columns are eliminated first, with constants alone. The
//! system of the other unknowns is smaller, and each unknown of the first kind follows from one
//! row. For three legs in planes at 120° one equation remains, for the rotation about the normal.

use super::elimination::{Inverse, Rows, ScaledRow, inverse};
use crate::cas::{Expr, Number};

/// A square system A x = y, with A prepared for solving.
#[derive(Debug)]
pub(crate) struct Solved<'a> {
    /// Elimination steps with constant factors, in order.
    steps: Vec<Step<'a>>,
    /// The remaining rows and unknowns, and the inverse of their submatrix.
    rows: Vec<usize>,
    columns: Vec<usize>,
    inverse: Vec<ScaledRow<'a>>,
    /// Divisors of that inverse.
    pub(crate) determinants: Vec<Expr<'a>>,
}

/// An unknown with a constant column, and the row from which it follows.
#[derive(Debug)]
struct Step<'a> {
    row: usize,
    column: usize,
    pivot: Number,
    /// Factors by which the row is subtracted from the other remaining rows.
    others: Vec<(usize, Number)>,
    /// Entries of the row at the time of the step.
    entries: Vec<Expr<'a>>,
}

impl<'a> Solved<'a> {
    /// Prepares A; `home` evaluates an expression at home. `None` for a singular matrix.
    pub(crate) fn new(matrix: &Rows<'a>, home: &dyn Fn(Expr<'a>) -> f64) -> Option<Self> {
        let n = matrix.len();
        let mut left = matrix.clone();
        let (mut rows, mut columns): (Vec<usize>, Vec<usize>) =
            ((0..n).collect(), (0..n).collect());
        let mut steps = Vec::new();
        while let Some(step) = step(&left, &rows, &columns) {
            rows.retain(|&row| row != step.row);
            columns.retain(|&column| column != step.column);
            for &(row, factor) in &step.others {
                for (entry, own) in left[row].iter_mut().zip(&step.entries) {
                    *entry = *entry - *own * factor;
                }
            }
            steps.push(step);
        }
        let rest: Rows<'a> = rows
            .iter()
            .map(|&row| columns.iter().map(|&column| left[row][column]).collect())
            .collect();
        let (inverse, determinants) = if rest.is_empty() {
            (Vec::new(), Vec::new())
        } else {
            let Inverse {
                scaled,
                determinants,
                ..
            } = inverse(&rest, home)?;
            (scaled, determinants)
        };
        Some(Self {
            steps,
            rows,
            columns,
            inverse,
            determinants,
        })
    }

    /// x for a right-hand side.
    pub(crate) fn solve(&self, right: &[Expr<'a>]) -> Vec<Expr<'a>> {
        let mut right = right.to_vec();
        for step in &self.steps {
            for &(row, factor) in &step.others {
                right[row] = right[row] - right[step.row] * factor;
            }
        }
        let mut x = right.clone();
        for (&column, row) in self.columns.iter().zip(&self.inverse) {
            let parts = row.entries.iter().zip(&self.rows);
            let sum: Expr<'a> = parts.map(|(entry, &row)| *entry * right[row]).sum();
            x[column] = row.factor * sum;
        }
        // Unknowns of later steps and of the remaining system are known by now.
        let mut known = self.columns.clone();
        for step in self.steps.iter().rev() {
            let others = known.iter().map(|&column| step.entries[column] * x[column]);
            let rest = others.fold(right[step.row], |rest, part| rest - part);
            x[step.column] = rest * (Number::ONE / step.pivot);
            known.push(step.column);
        }
        x
    }
}

/// The next unknown with a constant column in the remaining system, with its largest entry as
/// pivot.
fn step<'a>(left: &Rows<'a>, rows: &[usize], columns: &[usize]) -> Option<Step<'a>> {
    columns.iter().find_map(|&column| {
        let constant = |&row: &usize| Some((row, left[row][column].as_number()?));
        let constants: Vec<(usize, Number)> = rows.iter().map(constant).collect::<Option<_>>()?;
        let size = |number: Number| number.value().abs();
        let largest = constants.iter().copied().filter(|(_, own)| !own.is_zero());
        let (row, pivot) = largest.reduce(|best, other| {
            // Rounding does not decide between equal entries.
            let better = size(other.1) > size(best.1) * (1.0 + 1e-6);
            if better { other } else { best }
        })?;
        let others = constants
            .into_iter()
            .filter(|&(own, number)| own != row && !number.is_zero());
        Some(Step {
            row,
            column,
            pivot,
            others: others.map(|(own, number)| (own, number / pivot)).collect(),
            entries: left[row].clone(),
        })
    })
}
