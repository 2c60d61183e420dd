//! Small dense matrices for several samples in parallel, without allocation.
//!
//! Each entry is a vector of the samples' values. All lanes perform every operation, and each lane
//! takes only what it needs. A sample's result is thus independent of its neighbours.

/// Samples in parallel; many enough that the compiler vectorises loops instead of unrolling them.
pub(super) const LANES: usize = 16;

/// A value of each sample.
pub(super) type Lanes = [f64; LANES];

/// Largest number of sweeps; the singular values of small matrices converge before.
const SWEEPS: usize = 30;

/// Cosine of the angle between two columns that count as orthogonal.
///
/// It bounds the relative error of the singular values. Another sweep would gain only the last
/// digits.
const ORTHOGONAL: f64 = 1e-13;

/// Cosine from which one sweep makes columns orthogonal: its error is the square.
const NEARLY: f64 = 1e-8;

/// Values of successive rows of `size` numbers; missing lanes repeat the last one.
#[inline(always)]
pub(super) fn lanes(rows: &[f64], size: usize, of: impl Fn(&[f64]) -> f64) -> Lanes {
    let last = rows.len() / size - 1;
    let mut values = [0.0; LANES];
    for (lane, value) in values.iter_mut().enumerate() {
        let first = lane.min(last) * size;
        *value = of(&rows[first..first + size]);
    }
    values
}

/// Solves symmetric positive definite systems in place, from the upper triangle.
///
/// As [`overact::forward::solve_positive_definite`]; `false` if a pivot is below `least` times the
/// largest diagonal entry.
#[inline(always)]
pub(super) fn solved(matrix: &mut [Lanes], vector: &mut [Lanes], least: f64) -> [bool; LANES] {
    let r = vector.len();
    let (mut largest, mut is_regular) = ([0.0; LANES], [true; LANES]);
    for k in 0..r {
        for lane in 0..LANES {
            largest[lane] = f64::max(largest[lane], matrix[k * r + k][lane]);
        }
    }
    for k in 0..r {
        let (pivot, known) = (matrix[k * r + k], vector[k]);
        for lane in 0..LANES {
            is_regular[lane] &= pivot[lane] > least * largest[lane];
        }
        for i in k + 1..r {
            let mut factor = [0.0; LANES];
            for lane in 0..LANES {
                factor[lane] = matrix[k * r + i][lane] / pivot[lane];
                vector[i][lane] -= factor[lane] * known[lane];
            }
            for j in i..r {
                for lane in 0..LANES {
                    matrix[i * r + j][lane] -= factor[lane] * matrix[k * r + j][lane];
                }
            }
        }
    }
    for k in (0..r).rev() {
        for lane in 0..LANES {
            let mut rest = 0.0;
            for j in k + 1..r {
                rest += matrix[k * r + j][lane] * vector[j][lane];
            }
            vector[k][lane] = (vector[k][lane] - rest) / matrix[k * r + k][lane];
        }
    }
    is_regular
}

/// Condition number of a matrix with columns of `n` values.
///
/// One-sided Jacobi rotations make the columns orthogonal.
#[inline(always)]
pub(super) fn orthogonalised(columns: &mut [Lanes], n: usize) -> Lanes {
    let r = columns.len() / n.max(1);
    for _ in 0..SWEEPS {
        let mut goes_on = false;
        for p in 0..r {
            for q in p + 1..r {
                let (left, right) = columns.split_at_mut(q * n);
                goes_on |= turn(&mut left[p * n..(p + 1) * n], &mut right[..n]);
            }
        }
        if !goes_on {
            break;
        }
    }
    let (mut least, mut largest) = ([f64::INFINITY; LANES], [0.0; LANES]);
    for column in columns.chunks_exact(n.max(1)) {
        let square = product(column, column);
        for lane in 0..LANES {
            least[lane] = f64::min(least[lane], square[lane]);
            largest[lane] = f64::max(largest[lane], square[lane]);
        }
    }
    // A matrix that is not finite has no condition number, either.
    std::array::from_fn(|lane| {
        if least[lane] > 0.0 && largest[lane].is_finite() {
            (largest[lane] / least[lane]).sqrt()
        } else {
            f64::INFINITY
        }
    })
}

/// Rotates two columns until they are orthogonal.
///
/// `false` if they were nearly orthogonal for all samples, so that no further sweep is needed.
#[inline(always)]
fn turn(x: &mut [Lanes], y: &mut [Lanes]) -> bool {
    let (a, b, c) = (product(x, x), product(y, y), product(x, y));
    let (mut cosine, mut sine) = ([1.0; LANES], [0.0; LANES]);
    for lane in 0..LANES {
        let (twice, difference) = (2.0 * c[lane], b[lane] - a[lane]);
        let root = (difference * difference + twice * twice).sqrt();
        let tangent = twice * 1.0_f64.copysign(difference) / (difference.abs() + root);
        cosine[lane] = 1.0 / (tangent * tangent + 1.0).sqrt();
        sine[lane] = cosine[lane] * tangent;
    }
    let (mut turning, mut far) = ([0.0; LANES], [0.0; LANES]);
    for lane in 0..LANES {
        // Compare squared cosines, since roots and quotients are slow. NaN counts as not
        // orthogonal.
        let (square, size) = (c[lane] * c[lane], a[lane] * b[lane]);
        let rests = square <= ORTHOGONAL * ORTHOGONAL * size;
        turning[lane] = if rests { 0.0 } else { 1.0 };
        far[lane] = if square <= NEARLY * NEARLY * size {
            0.0
        } else {
            1.0
        };
        cosine[lane] = if rests { 1.0 } else { cosine[lane] };
        sine[lane] = if rests { 0.0 } else { sine[lane] };
    }
    if turning == [0.0; LANES] {
        return false;
    }
    for (x, y) in x.iter_mut().zip(y) {
        for lane in 0..LANES {
            let (a, b) = (x[lane], y[lane]);
            x[lane] = cosine[lane] * a - sine[lane] * b;
            y[lane] = sine[lane] * a + cosine[lane] * b;
        }
    }
    far != [0.0; LANES]
}

/// The scalar product.
#[inline(always)]
fn product(a: &[Lanes], b: &[Lanes]) -> Lanes {
    let mut sum = [0.0; LANES];
    for (a, b) in a.iter().zip(b) {
        for lane in 0..LANES {
            sum[lane] += a[lane] * b[lane];
        }
    }
    sum
}

/// Determinant by elimination with pivots, in place.
#[inline(always)]
pub(super) fn eliminated(matrix: &mut [Lanes], r: usize) -> Lanes {
    let (mut determinant, mut is_zero) = ([1.0; LANES], [false; LANES]);
    for k in 0..r {
        for i in k + 1..r {
            let larger = larger(matrix, r, k, i);
            exchange(matrix, r, k, i, &larger);
            for lane in 0..LANES {
                let own = determinant[lane];
                determinant[lane] = if larger[lane] { -own } else { own };
            }
        }
        let diagonal = matrix[k * r + k];
        for lane in 0..LANES {
            determinant[lane] *= diagonal[lane];
            is_zero[lane] |= diagonal[lane] == 0.0;
        }
        for i in k + 1..r {
            let column = matrix[i * r + k];
            for j in k + 1..r {
                let above = matrix[k * r + j];
                for lane in 0..LANES {
                    matrix[i * r + j][lane] -= column[lane] / diagonal[lane] * above[lane];
                }
            }
        }
    }
    std::array::from_fn(|lane| {
        if is_zero[lane] {
            0.0
        } else {
            determinant[lane]
        }
    })
}

/// Transforms the identity `inverse` to the inverse of `matrix`; `false` if singular.
#[inline(always)]
pub(super) fn invert<const LANES: usize>(
    matrix: &mut [[f64; LANES]],
    inverse: &mut [[f64; LANES]],
    r: usize,
) -> [bool; LANES] {
    let mut is_regular = [true; LANES];
    for k in 0..r {
        for i in k + 1..r {
            let larger = larger(matrix, r, k, i);
            exchange(matrix, r, k, i, &larger);
            exchange(inverse, r, k, i, &larger);
        }
        let diagonal = matrix[k * r + k];
        for lane in 0..LANES {
            is_regular[lane] &= diagonal[lane] != 0.0 && diagonal[lane].is_finite();
        }
        let mut reciprocal = diagonal;
        for lane in 0..LANES {
            reciprocal[lane] = 1.0 / diagonal[lane];
        }
        for own in [&mut *matrix, &mut *inverse] {
            for value in &mut own[k * r..(k + 1) * r] {
                for lane in 0..LANES {
                    value[lane] *= reciprocal[lane];
                }
            }
        }
        for i in (0..r).filter(|i| *i != k) {
            let factor = matrix[i * r + k];
            for own in [&mut *matrix, &mut *inverse] {
                for j in 0..r {
                    let above = own[k * r + j];
                    for lane in 0..LANES {
                        own[i * r + j][lane] -= factor[lane] * above[lane];
                    }
                }
            }
        }
    }
    is_regular
}

/// Whether the entry of column `k` is larger in row `i` than in row `k`.
#[inline(always)]
fn larger<const LANES: usize>(
    matrix: &[[f64; LANES]],
    r: usize,
    k: usize,
    i: usize,
) -> [bool; LANES] {
    let (above, below) = (&matrix[k * r + k], &matrix[i * r + k]);
    std::array::from_fn(|lane| below[lane].abs() > above[lane].abs())
}

/// Exchanges two rows in the lanes that need it.
#[inline(always)]
fn exchange<const LANES: usize>(
    matrix: &mut [[f64; LANES]],
    r: usize,
    a: usize,
    b: usize,
    wanted: &[bool; LANES],
) {
    for j in 0..r {
        let (above, below) = (matrix[a * r + j], matrix[b * r + j]);
        for lane in 0..LANES {
            let wanted = wanted[lane];
            matrix[a * r + j][lane] = if wanted { below[lane] } else { above[lane] };
            matrix[b * r + j][lane] = if wanted { above[lane] } else { below[lane] };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Lanes, eliminated, invert};
    use nalgebra::DMatrix;

    /// Matrices row by row. Without pivots they are inaccurate or divide by zero; the last one is
    /// singular.
    const NEEDS_PIVOTS: [[f64; 9]; 8] = [
        [0.0, 2.0, 1.0, 1.0, 0.0, 3.0, 4.0, 1.0, 0.0],
        [1e-17, 1.0, 2.0, 1.0, 1.0, 1.0, 2.0, -1.0, 1.0],
        [1e-17, 1.0, 2.0, 1.0, 0.0, 0.0, 2.0, -1.0, 1.0],
        [1.0, 2.0, 3.0, 1.0, 2.0, -1.0, 0.5, 3.0, 1.0],
        [3.0, 1.0, -2.0, 3.0, 1.0 + 1e-17, 4.0, 1.0, 5.0, 9.0],
        [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0],
        [1.0, 2.0, 0.0, 2.0, 4.0, 0.0, 0.0, 0.0, 1.0],
    ];

    /// Missing lanes repeat the last one.
    fn side_by_side(rows: &[[f64; 9]]) -> [Lanes; 9] {
        let last = rows.len() - 1;
        std::array::from_fn(|entry| std::array::from_fn(|lane| rows[lane.min(last)][entry]))
    }

    #[test]
    fn rows_are_exchanged_for_small_pivots() {
        let determinants = eliminated(&mut side_by_side(&NEEDS_PIVOTS), 3);
        let mut inverses = side_by_side(&[[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]]);
        let is_regular = invert(&mut side_by_side(&NEEDS_PIVOTS), &mut inverses, 3);
        for (lane, rows) in NEEDS_PIVOTS.iter().enumerate() {
            let matrix = DMatrix::from_row_slice(3, 3, rows);
            let expected = matrix.determinant();
            let miss = (determinants[lane] - expected).abs();
            assert!(miss <= 1e-14 * expected.abs(), "{miss:e}");
            assert_eq!(is_regular[lane], lane + 1 < NEEDS_PIVOTS.len(), "{rows:?}");
            if is_regular[lane] {
                let inverse = DMatrix::from_fn(3, 3, |i, j| inverses[3 * i + j][lane]);
                let miss = (matrix * inverse - DMatrix::identity(3, 3)).abs().max();
                assert!(miss < 1e-14, "{rows:?}: {miss:e}");
            }
        }
    }
}
