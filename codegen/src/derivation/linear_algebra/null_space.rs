//! Internal torques: the orthonormal basis N of the null space of (J_p^inv)ᵀ.
//!
//! The basis results from Gram-Schmidt orthogonalisation. The start vectors are the unit torques of
//! the redundant actuators, projected onto the null space. Column k is zero on the redundant
//! actuators before the k-th and positive on the k-th.
//!
//! With the kept rows J_a of J_p^inv, inverted once, c_j = J_a^-T j_j are the torques of the kept
//! actuators that equal a unit torque of the redundant actuator j; [-c_j; e_j] is internal. In
//! these coordinates the kept rows are the identity, and JᵀJ of the kept actuators and the
//! redundant ones from j on is 1 + Σ c cᵀ. Its inverse Q is updated from the last redundant
//! actuator to the first (J. Sherman, W. J. Morrison, 1950). With y = Q c_k, η = 1 + c_k · y and
//! u = y/√η, column k is 1/√η on its own actuator, -u on the kept ones and -c_j · u on the later
//! redundant ones; Q becomes Q - u uᵀ. This takes r³ operations once, r² per redundant actuator,
//! and r per entry of the result.

use super::elimination::{Inverse, Rows};
use super::linear::dot;
use crate::cas::{Arena, Expr};

/// N, n × (n - r), from the rows of J_p^inv; `inverse` is that of the kept rows.
#[must_use]
pub fn null_space<'a>(
    arena: &'a Arena,
    jacobian: &Rows<'a>,
    kept: &[usize],
    inverse: &Inverse<'a>,
) -> Rows<'a> {
    let (n, r) = (jacobian.len(), kept.len());
    let projected: Vec<usize> = (0..n).filter(|i| !kept.contains(i)).collect();
    let shares = projected.iter().map(|&i| {
        let share = share(&jacobian[i], inverse, projected.len() < r);
        for (at, entry) in kept.iter().zip(&share) {
            let _ = entry.named(&format!("share_{}_{}", at + 1, i + 1));
        }
        share
    });
    let shares: Rows<'a> = shares.collect();
    let mut metric = Metric::new(arena, r, projected.len() > r);
    let mut basis: Rows<'a> = vec![vec![arena.zero(); projected.len()]; n];
    for k in (0..projected.len()).rev() {
        let turned = metric.apply(&shares[k]);
        let label = projected[k] + 1;
        let square = arena.one() + dot(&shares[k], &turned);
        let norm = square.sqrt().named(&format!("norm_{label}"));
        let scale = norm.reciprocal().named(&format!("inv_norm_{label}"));
        let unit: Vec<Expr<'a>> = turned.iter().map(|&y| y * scale).collect();
        basis[projected[k]][k] = scale;
        for (&at, &u) in kept.iter().zip(&unit) {
            basis[at][k] = -u;
        }
        for (share, &at) in shares.iter().zip(&projected).skip(k + 1) {
            basis[at][k] = -dot(share, &unit);
        }
        metric.subtract(unit);
    }
    basis
}

/// c = J_a^-T j, by the rows of the inverse or, for few rows j, by its scaled rows.
fn share<'a>(row: &[Expr<'a>], inverse: &Inverse<'a>, is_one_of_few: bool) -> Vec<Expr<'a>> {
    let column = |entries: &dyn Fn(usize, usize) -> Expr<'a>, by: &[Expr<'a>], c: usize| {
        (0..by.len())
            .map(|a| by[a] * entries(a, c))
            .sum::<Expr<'a>>()
    };
    let columns = 0..row.len();
    if !is_one_of_few {
        let entry = |a: usize, c: usize| inverse.rows[a][c];
        return columns.map(|c| column(&entry, row, c)).collect();
    }
    let scaled = row.iter().zip(&inverse.scaled);
    let scaled: Vec<Expr<'a>> = scaled.map(|(&j, row)| j * row.factor).collect();
    let entry = |a: usize, c: usize| inverse.scaled[a].entries[c];
    columns.map(|c| column(&entry, &scaled, c)).collect()
}

/// Q = 1 - Σ u uᵀ, as a matrix or, for few u, as a list of u.
enum Metric<'a> {
    Matrix(Rows<'a>),
    Units(Rows<'a>),
}

impl<'a> Metric<'a> {
    /// The identity.
    fn new(arena: &'a Arena, size: usize, as_matrix: bool) -> Self {
        let entry = |i: usize, j: usize| arena.integer(i64::from(i == j));
        let row = |i: usize| (0..size).map(|j| entry(i, j)).collect();
        if as_matrix {
            Self::Matrix((0..size).map(row).collect())
        } else {
            Self::Units(Vec::new())
        }
    }

    /// Q c.
    fn apply(&self, share: &[Expr<'a>]) -> Vec<Expr<'a>> {
        match self {
            Self::Matrix(rows) => rows.iter().map(|row| dot(row, share)).collect(),
            Self::Units(units) => units.iter().fold(share.to_vec(), |sum, unit| {
                let along = dot(unit, share);
                let terms = sum.iter().zip(unit);
                terms.map(|(&s, &u)| s - along * u).collect()
            }),
        }
    }

    /// Subtracts u uᵀ.
    fn subtract(&mut self, unit: Vec<Expr<'a>>) {
        match self {
            Self::Units(units) => units.push(unit),
            Self::Matrix(rows) => {
                for i in 0..unit.len() {
                    for j in i..unit.len() {
                        rows[i][j] = rows[i][j] - unit[i] * unit[j];
                        rows[j][i] = rows[i][j];
                    }
                }
            }
        }
    }
}
