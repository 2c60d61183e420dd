//! Updates an R factor with more equations, by Householder reflections.
//!
//! Reflection j moves the entries of column j of the new rows into R_jj. It changes row j of R
//! only, since the others are already zero in column j.

use nalgebra::DMatrix;
#[cfg(target_arch = "x86_64")]
use pulp::NullaryFnOnce;

/// Partial sums of a scalar product.
const LANES: usize = 8;

/// Replaces the upper triangular factor `r` by that of [r; rows]; overwrites `rows`.
pub(super) fn update(r: &mut DMatrix<f64>, rows: &mut DMatrix<f64>) {
    let count = rows.nrows();
    reflect(r, rows, &|_| count);
}

/// The same for upper triangular rows, whose columns stay zero below the diagonal.
pub(super) fn update_by_triangle(r: &mut DMatrix<f64>, rows: &mut DMatrix<f64>) {
    let count = rows.nrows();
    reflect(r, rows, &|column| count.min(column + 1));
}

/// Reflects rows whose columns have `height` leading non-zero entries.
fn reflect(r: &mut DMatrix<f64>, rows: &mut DMatrix<f64>, height: &dyn Fn(usize) -> usize) {
    let work = Update { r, rows, height };
    #[cfg(target_arch = "x86_64")]
    if let Some(simd) = pulp::x86::V3::try_new() {
        simd.vectorize(work);
        return;
    }
    work.run();
}

/// Vectorised update.
struct Update<'a> {
    r: &'a mut DMatrix<f64>,
    rows: &'a mut DMatrix<f64>,
    /// Number of non-zero entries of a column.
    height: &'a dyn Fn(usize) -> usize,
}

#[cfg(target_arch = "x86_64")]
impl NullaryFnOnce for Update<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        self.run();
    }
}

impl Update<'_> {
    #[inline(always)]
    fn run(self) {
        let (size, count) = (self.r.ncols(), self.rows.nrows());
        if count == 0 {
            return;
        }
        for j in 0..size {
            let (_, rest) = self.rows.as_mut_slice().split_at_mut(j * count);
            let (axis, others) = rest.split_at_mut(count);
            let height = (self.height)(j);
            let axis = &axis[..height];
            let square = product(axis, axis);
            if square == 0.0 {
                continue;
            }
            let before = self.r[(j, j)];
            let after = (before * before + square).sqrt();
            // The sign that avoids cancellation; the row changes its sign afterwards.
            let first = before + after;
            let scale = 2.0 / (first * first + square);
            for (place, column) in others.chunks_exact_mut(count).enumerate() {
                let column = &mut column[..height];
                let top = &mut self.r[(j, j + 1 + place)];
                let part = scale * (first * *top + product(axis, column));
                *top = part * first - *top;
                for (to, from) in column.iter_mut().zip(axis.iter()) {
                    *to -= part * from;
                }
            }
            self.r[(j, j)] = after;
        }
    }
}

/// Scalar product with partial sums.
#[inline(always)]
fn product(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; LANES];
    let (first, second) = (a.chunks_exact(LANES), b.chunks_exact(LANES));
    let rest = first.remainder().iter().zip(second.remainder());
    let rest: f64 = rest.map(|(a, b)| a * b).sum();
    for (a, b) in first.zip(second) {
        for lane in 0..LANES {
            sums[lane] += a[lane] * b[lane];
        }
    }
    sums.iter().sum::<f64>() + rest
}

#[cfg(test)]
mod tests {
    use super::{update, update_by_triangle};
    use nalgebra::DMatrix;

    #[test]
    fn updated_factors_equal_one_decomposition() {
        let value = |i: usize, j: usize| ((i * i + 3 * j) as f64 * 0.37).sin() + 0.1 * j as f64;
        let all = DMatrix::from_fn(61, 7, |i, j| if j == 4 { 0.0 } else { value(i, j) });
        let mut r = DMatrix::zeros(7, 7);
        for (first, count) in [(0, 3), (3, 40), (43, 0), (43, 18)] {
            update(&mut r, &mut all.rows(first, count).clone_owned());
        }
        let wanted = all.tr_mul(&all);
        assert!((r.tr_mul(&r) - &wanted).amax() < 1e-12 * wanted.amax());
        let below = (0..7).flat_map(|j| (j + 1..7).map(move |i| (i, j)));
        assert!(below.into_iter().all(|place| r[place] == 0.0));
        assert!(r.diagonal().iter().all(|entry| *entry >= 0.0));

        let mut both = r.clone();
        update_by_triangle(&mut both, &mut r.clone());
        assert!((both.tr_mul(&both) - 2.0 * &wanted).amax() < 1e-12 * wanted.amax());
    }
}
