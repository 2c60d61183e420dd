//! Inverses of small symbolic matrices.
//!
//! A leg's Jacobian is mostly zeros. Its rows and columns are permuted to block triangular form: a
//! perfect matching, then the strongly connected components of the remaining graph. Every diagonal
//! block is inverted on its own. Blocks up to 3 × 3 use the adjugate times the reciprocal of the
//! determinant, one division per block. Larger blocks use Gauss-Jordan elimination with the largest
//! pivots at the home configuration. Constant factors of a whole row are moved into the reciprocal.

use crate::cas::{Expr, Number};

/// A matrix by rows.
pub type Rows<'a> = Vec<Vec<Expr<'a>>>;

/// A row as factor × entries. The factor contains the reciprocal of the determinant.
#[derive(Debug, Clone)]
pub struct ScaledRow<'a> {
    /// The common factor.
    pub factor: Expr<'a>,
    /// The entries without the common factor.
    pub entries: Vec<Expr<'a>>,
}

impl<'a> ScaledRow<'a> {
    /// The row itself.
    #[must_use]
    pub fn values(&self) -> Vec<Expr<'a>> {
        self.entries.iter().map(|&e| self.factor * e).collect()
    }
}

/// The inverse of a matrix.
#[derive(Debug, Clone)]
pub struct Inverse<'a> {
    /// The inverse, by rows.
    pub rows: Rows<'a>,
    /// The same rows without the reciprocals of the determinants.
    pub scaled: Vec<ScaledRow<'a>>,
    /// Divisor of each row: the determinant (or pivot) of its block, up to its sign.
    pub determinants: Vec<Expr<'a>>,
    /// The determinant of the whole matrix.
    pub determinant: Expr<'a>,
    /// Number of rows of the largest block.
    pub largest_block: usize,
}

/// Inverts a square matrix; `home` evaluates an expression at the home configuration.
///
/// `None` if the matrix is singular structurally or at home.
pub fn inverse<'a>(matrix: &Rows<'a>, home: &dyn Fn(Expr<'a>) -> f64) -> Option<Inverse<'a>> {
    let n = matrix.len();
    let arena = matrix.first()?.first()?.arena();
    let row_of = matching(matrix, home)?;
    let blocks = components(matrix, &row_of);
    let zero_row = vec![arena.zero(); n];
    let mut rows: Rows<'a> = vec![zero_row.clone(); n];
    let mut determinants = vec![arena.one(); n];
    // Reorder the rows like the columns, block by block.
    let order: Vec<usize> = blocks
        .iter()
        .flatten()
        .map(|&column| row_of[column])
        .collect();
    let columns: Vec<usize> = blocks.iter().flatten().copied().collect();
    let mut determinant = arena.integer(parity(&order) * parity(&columns));
    let unit = ScaledRow {
        factor: arena.one(),
        entries: zero_row.clone(),
    };
    let mut scaled = vec![unit; n];
    for block in &blocks {
        let block_rows: Vec<usize> = block.iter().map(|&column| row_of[column]).collect();
        let inner: Rows<'a> = block_rows
            .iter()
            .map(|&r| block.iter().map(|&c| matrix[r][c]).collect())
            .collect();
        let (block_inverse, block_determinants, of_block) = invert_block(&inner, home)?;
        determinant = determinant * of_block;
        // Right-hand side after substitution of the unknowns of earlier blocks.
        let right: Rows<'a> = block_rows
            .iter()
            .map(|&r| {
                let mut right = zero_row.clone();
                right[r] = arena.one();
                for column in (0..n).filter(|c| !block.contains(c)) {
                    subtract(&mut right, matrix[r][column], &rows[column]);
                }
                right
            })
            .collect();
        for (i, &column) in block.iter().enumerate() {
            let mut entries = zero_row.clone();
            for (factor, right) in block_inverse[i].entries.iter().zip(&right) {
                subtract(&mut entries, -*factor, right);
            }
            let row = ScaledRow {
                factor: block_inverse[i].factor,
                entries,
            };
            rows[column] = row.values();
            scaled[column] = row;
            determinants[column] = block_determinants[i];
        }
    }
    Some(Inverse {
        rows,
        scaled,
        determinants,
        determinant,
        largest_block: blocks.iter().map(Vec::len).max().unwrap_or(0),
    })
}

/// 1 or -1 for an even or odd permutation.
fn parity(permutation: &[usize]) -> i64 {
    let pairs = (0..permutation.len()).flat_map(|j| (0..j).map(move |i| (i, j)));
    let inversions = pairs
        .filter(|&(i, j)| permutation[i] > permutation[j])
        .count();
    if inversions.is_multiple_of(2) { 1 } else { -1 }
}

/// target -= factor * row
fn subtract<'a>(target: &mut [Expr<'a>], factor: Expr<'a>, row: &[Expr<'a>]) {
    if factor.is_zero() {
        return;
    }
    for (t, r) in target.iter_mut().zip(row) {
        *t = *t - factor * *r;
    }
}

/// Assigns a different row with a nonzero entry to every column, by augmenting paths.
///
/// Entries that are large at home are tried first.
fn matching<'a>(matrix: &Rows<'a>, home: &dyn Fn(Expr<'a>) -> f64) -> Option<Vec<usize>> {
    let n = matrix.len();
    let mut column_of: Vec<Option<usize>> = vec![None; n];
    for column in 0..n {
        let mut visited = vec![false; n];
        if !augment(matrix, column, &mut visited, &mut column_of, home) {
            return None;
        }
    }
    let mut row_of = vec![0; n];
    for (row, column) in column_of.iter().enumerate() {
        row_of[(*column)?] = row;
    }
    Some(row_of)
}

fn augment<'a>(
    matrix: &Rows<'a>,
    column: usize,
    visited: &mut [bool],
    column_of: &mut [Option<usize>],
    home: &dyn Fn(Expr<'a>) -> f64,
) -> bool {
    let mut candidates: Vec<(f64, usize)> = (0..matrix.len())
        .filter(|&r| !matrix[r][column].is_zero())
        .map(|r| (home(matrix[r][column]).abs(), r))
        .collect();
    candidates.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    for (_, row) in candidates {
        if std::mem::replace(&mut visited[row], true) {
            continue;
        }
        let free = match column_of[row] {
            None => true,
            Some(other) => augment(matrix, other, visited, column_of, home),
        };
        if free {
            column_of[row] = Some(column);
            return true;
        }
    }
    false
}

/// The blocks of columns in an order in which each depends only on earlier ones (Tarjan).
fn components(matrix: &Rows<'_>, row_of: &[usize]) -> Vec<Vec<usize>> {
    struct Search<'s, 'a> {
        matrix: &'s Rows<'a>,
        row_of: &'s [usize],
        index: Vec<Option<usize>>,
        low: Vec<usize>,
        stack: Vec<usize>,
        blocks: Vec<Vec<usize>>,
        next: usize,
    }
    impl Search<'_, '_> {
        fn visit(&mut self, v: usize) {
            self.index[v] = Some(self.next);
            self.low[v] = self.next;
            self.next += 1;
            self.stack.push(v);
            for w in 0..self.matrix.len() {
                if w == v || self.matrix[self.row_of[v]][w].is_zero() {
                    continue;
                }
                match self.index[w] {
                    None => {
                        self.visit(w);
                        self.low[v] = self.low[v].min(self.low[w]);
                    }
                    Some(at) if self.stack.contains(&w) => self.low[v] = self.low[v].min(at),
                    Some(_) => {}
                }
            }
            if Some(self.low[v]) == self.index[v] {
                let start = self.stack.iter().position(|&w| w == v).unwrap_or(0);
                let mut block = self.stack.split_off(start);
                block.sort_unstable();
                self.blocks.push(block);
            }
        }
    }
    let n = matrix.len();
    let mut search = Search {
        matrix,
        row_of,
        index: vec![None; n],
        low: vec![0; n],
        stack: Vec::new(),
        blocks: Vec::new(),
        next: 0,
    };
    for v in 0..n {
        if search.index[v].is_none() {
            search.visit(v);
        }
    }
    search.blocks
}

/// Rows of the inverse, the divisor of each, and the determinant.
type BlockInverse<'a> = (Vec<ScaledRow<'a>>, Vec<Expr<'a>>, Expr<'a>);

fn invert_block<'a>(block: &Rows<'a>, home: &dyn Fn(Expr<'a>) -> f64) -> Option<BlockInverse<'a>> {
    match block.len() {
        1..=3 => by_adjugate(block),
        _ => by_elimination(block, home),
    }
}

/// Inverse by cofactors over the determinant.
fn by_adjugate<'a>(block: &Rows<'a>) -> Option<BlockInverse<'a>> {
    let n = block.len();
    let adjugate = adjugate(block);
    let determinant: Expr<'a> = (0..n).map(|k| block[0][k] * adjugate[k][0]).sum();
    if determinant.is_zero() {
        return None;
    }
    let (scale, base) = determinant.factor_and_base();
    let reciprocal = base.reciprocal();
    let rows = adjugate
        .iter()
        .map(|row| scaled_row(row, reciprocal, scale))
        .collect();
    Some((rows, vec![determinant; n], determinant))
}

/// Adjugate of a matrix of up to three rows: its entry (i, j) is the cofactor of (j, i).
#[must_use]
pub fn adjugate<'a>(block: &Rows<'a>) -> Rows<'a> {
    let n = block.len();
    let minor = |skip_row: usize, skip_column: usize| {
        let rest: Vec<Vec<Expr<'a>>> = (0..n)
            .filter(|&r| r != skip_row)
            .map(|r| {
                (0..n)
                    .filter(|&c| c != skip_column)
                    .map(|c| block[r][c])
                    .collect()
            })
            .collect();
        match rest.len() {
            0 => block[0][0].arena().one(),
            1 => rest[0][0],
            _ => rest[0][0] * rest[1][1] - rest[0][1] * rest[1][0],
        }
    };
    let cofactor = |i: usize, j: usize| {
        if (i + j).is_multiple_of(2) {
            minor(j, i)
        } else {
            -minor(j, i)
        }
    };
    (0..n)
        .map(|i| (0..n).map(|j| cofactor(i, j)).collect())
        .collect()
}

/// row × reciprocal / scale, with common constants of the row moved into the factor.
fn scaled_row<'a>(row: &[Expr<'a>], reciprocal: Expr<'a>, scale: Number) -> ScaledRow<'a> {
    let parts: Vec<(Number, Expr<'a>)> = row.iter().map(|e| e.factor_and_base()).collect();
    let size = |n: Number| if n.value() < 0.0 { -n } else { n };
    let mut factors = parts
        .iter()
        .filter(|(_, base)| !base.is_zero())
        .map(|(f, _)| size(*f));
    let first = factors.next().unwrap_or(Number::ONE);
    if factors.all(|f| f == first) {
        let factor = reciprocal * (first / scale);
        let entries = parts.iter().map(|(f, base)| *base * (*f / first)).collect();
        return ScaledRow { factor, entries };
    }
    ScaledRow {
        factor: reciprocal * (Number::ONE / scale),
        entries: row.to_vec(),
    }
}

/// Inverse by Gauss-Jordan elimination; each pivot is the largest at home among remaining rows and
/// columns.
fn by_elimination<'a>(
    block: &Rows<'a>,
    home: &dyn Fn(Expr<'a>) -> f64,
) -> Option<BlockInverse<'a>> {
    let n = block.len();
    let arena = block[0][0].arena();
    let mut left = block.clone();
    let mut right: Rows<'a> = (0..n)
        .map(|i| (0..n).map(|j| arena.integer(i64::from(i == j))).collect())
        .collect();
    let mut row_of = vec![usize::MAX; n];
    let mut pivots = vec![arena.one(); n];
    for _ in 0..n {
        let free_rows = (0..n).filter(|r| !row_of.contains(r));
        let (row, column) = free_rows
            .flat_map(|r| (0..n).map(move |c| (r, c)))
            .filter(|&(r, c)| row_of[c] == usize::MAX && !left[r][c].is_zero())
            .max_by(|a, b| {
                home(left[a.0][a.1])
                    .abs()
                    .total_cmp(&home(left[b.0][b.1]).abs())
            })?;
        row_of[column] = row;
        pivots[column] = left[row][column];
        let reciprocal = left[row][column].reciprocal();
        left[row] = left[row].iter().map(|&e| e * reciprocal).collect();
        right[row] = right[row].iter().map(|&e| e * reciprocal).collect();
        for other in (0..n).filter(|&r| r != row) {
            let factor = left[other][column];
            let (pivot_left, pivot_right) = (left[row].clone(), right[row].clone());
            subtract(&mut left[other], factor, &pivot_left);
            subtract(&mut right[other], factor, &pivot_right);
        }
    }
    let one = arena.one();
    let row = |&r: &usize| ScaledRow {
        factor: one,
        entries: right[r].clone(),
    };
    let determinant = pivots
        .iter()
        .copied()
        .fold(arena.integer(parity(&row_of)), |d, p| d * p);
    Some((row_of.iter().map(row).collect(), pivots, determinant))
}
