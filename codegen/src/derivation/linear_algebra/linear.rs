//! Symbolic least squares on the actuators: the pseudo-inverse of J_p^inv, eqs. (21) and (22).
//!
//! S = (J_p^inv)ᵀ J_p^inv is symmetric, and positive definite outside singularities. It is factored
//! as L D Lᵀ without square roots.

use super::elimination::Rows;
use crate::cas::Expr;
use crate::derivation::names::name_matrix;

/// S = L D Lᵀ.
#[derive(Debug)]
pub struct Factored<'a> {
    /// Unit lower triangular L (entries below the diagonal).
    lower: Rows<'a>,
    /// The reciprocals of D.
    reciprocals: Vec<Expr<'a>>,
    /// D.
    pub pivots: Vec<Expr<'a>>,
}

/// Scalar product of two rows.
#[must_use]
pub fn dot<'a>(a: &[Expr<'a>], b: &[Expr<'a>]) -> Expr<'a> {
    a.iter().zip(b).map(|(x, y)| *x * *y).sum()
}

/// Transpose.
#[must_use]
pub fn transposed<'a>(rows: &Rows<'a>) -> Rows<'a> {
    let width = rows.first().map_or(0, Vec::len);
    (0..width)
        .map(|c| rows.iter().map(|row| row[c]).collect())
        .collect()
}

/// Product of two matrices.
#[must_use]
pub fn product<'a>(a: &Rows<'a>, b: &Rows<'a>) -> Rows<'a> {
    let columns = transposed(b);
    a.iter()
        .map(|row| columns.iter().map(|c| dot(row, c)).collect())
        .collect()
}

/// Matrix times vector.
#[must_use]
pub fn apply<'a>(matrix: &Rows<'a>, vector: &[Expr<'a>]) -> Vec<Expr<'a>> {
    matrix.iter().map(|row| dot(row, vector)).collect()
}

impl<'a> Factored<'a> {
    /// Factors S = JᵀJ.
    #[must_use]
    pub fn normal(jacobian: &Rows<'a>) -> Self {
        let columns = transposed(jacobian);
        let s: Rows<'a> = columns
            .iter()
            .map(|a| columns.iter().map(|b| dot(a, b)).collect())
            .collect();
        name_matrix(&s, "s");
        Self::of(s)
    }

    /// Factors a symmetric matrix.
    #[must_use]
    pub fn of(mut s: Rows<'a>) -> Self {
        let n = s.len();
        let mut reciprocals = Vec::new();
        let mut pivots = Vec::new();
        let mut lower = s.clone();
        for k in 0..n {
            let pivot = s[k][k];
            let reciprocal = pivot.reciprocal();
            for i in k + 1..n {
                let factor = s[i][k] * reciprocal;
                lower[i][k] = factor;
                let pivot_column: Vec<Expr<'a>> = s.iter().map(|row| row[k]).collect();
                for (j, entry) in pivot_column.iter().enumerate().take(i + 1).skip(k + 1) {
                    s[i][j] = s[i][j] - factor * *entry;
                    s[j][i] = s[i][j];
                }
            }
            pivots.push(pivot);
            reciprocals.push(reciprocal);
        }
        for (k, (pivot, reciprocal)) in pivots.iter().zip(&reciprocals).enumerate() {
            let _ = pivot.named(&format!("pivot_{}", k + 1));
            let _ = reciprocal.named(&format!("inv_pivot_{}", k + 1));
            for (i, row) in lower.iter().enumerate().skip(k + 1) {
                let _ = row[k].named(&format!("l_{}_{}", i + 1, k + 1));
            }
        }
        // The Schur complements below the pivots.
        name_matrix(&s, "schur");
        Self {
            lower,
            reciprocals,
            pivots,
        }
    }

    /// Solves S x = y.
    #[must_use]
    pub fn solve(&self, right: &[Expr<'a>]) -> Vec<Expr<'a>> {
        let n = right.len();
        let mut x = right.to_vec();
        for i in 0..n {
            for k in 0..i {
                x[i] = x[i] - self.lower[i][k] * x[k];
            }
        }
        for i in (0..n).rev() {
            x[i] = x[i] * self.reciprocals[i];
            for k in i + 1..n {
                x[i] = x[i] - self.lower[k][i] * x[k];
            }
        }
        x
    }
}

/// Adds a vector to a sum.
pub(crate) fn add_to<'a>(total: &mut [Expr<'a>], part: Vec<Expr<'a>>) {
    for (t, p) in total.iter_mut().zip(part) {
        *t = *t + p;
    }
}
