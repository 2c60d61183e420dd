//! Linear algebra of transmissions on arrays of constant size.

use super::Error;
use crate::float::Float;

/// Smallest length of a column, relative to the longest, by which a joint is scaled.
///
/// It is far below the effect of a change of units, and far above rounding.
const SMALLEST_SCALE: f64 = 1e-5;

/// Checks that all numbers of an input are finite.
pub(super) fn finite<T: Float>(input: &'static str, numbers: &[T]) -> Result<(), Error> {
    if numbers.iter().all(|number| number.is_finite()) {
        Ok(())
    } else {
        Err(Error::NotFinite { input })
    }
}

/// A vector, if no element overflowed.
pub(super) fn vector<T: Float, const K: usize>(numbers: [T; K]) -> Result<[T; K], Error> {
    if numbers.iter().all(|number| number.is_finite()) {
        Ok(numbers)
    } else {
        Err(Error::Overflow)
    }
}

/// A matrix, if no element overflowed.
pub(super) fn matrix<T: Float, const K: usize, const L: usize>(
    numbers: [[T; L]; K],
) -> Result<[[T; L]; K], Error> {
    if numbers
        .as_flattened()
        .iter()
        .all(|number| number.is_finite())
    {
        Ok(numbers)
    } else {
        Err(Error::Overflow)
    }
}

/// Scalar product.
pub(super) fn dot<T: Float>(a: &[T], b: &[T]) -> T {
    let products = a.iter().zip(b);
    products.fold(T::ZERO, |sum, (x, y)| sum + *x * *y)
}

/// A x.
pub(super) fn times<T: Float, const K: usize, const L: usize>(
    a: &[[T; L]; K],
    x: &[T; L],
) -> [T; K] {
    core::array::from_fn(|k| dot(&a[k], x))
}

/// Aᵀ x.
pub(super) fn transposed_times<T: Float, const K: usize, const L: usize>(
    a: &[[T; L]; K],
    x: &[T; K],
) -> [T; L] {
    let mut result = [T::ZERO; L];
    for (row, factor) in a.iter().zip(x) {
        for (sum, entry) in result.iter_mut().zip(row) {
            *sum += *entry * *factor;
        }
    }
    result
}

/// Aᵀ diag(d) A.
pub(super) fn congruence<T: Float, const K: usize, const L: usize>(
    a: &[[T; L]; K],
    d: &[T; K],
) -> [[T; L]; L] {
    let mut result = [[T::ZERO; L]; L];
    for (row, factor) in a.iter().zip(d) {
        for (sums, left) in result.iter_mut().zip(row) {
            let scaled = *left * *factor;
            for (sum, right) in sums.iter_mut().zip(row) {
                *sum += scaled * *right;
            }
        }
    }
    result
}

/// Aᵀ S A.
pub(super) fn transformed<T: Float, const K: usize, const L: usize>(
    a: &[[T; L]; K],
    s: &[[T; K]; K],
) -> [[T; L]; L] {
    // Rows of S A.
    let product: [[T; L]; K] = core::array::from_fn(|k| transposed_times(a, &s[k]));
    let mut result = [[T::ZERO; L]; L];
    for (left, right) in a.iter().zip(&product) {
        for (sums, factor) in result.iter_mut().zip(left) {
            for (sum, entry) in sums.iter_mut().zip(right) {
                *sum += *factor * *entry;
            }
        }
    }
    result
}

/// Lengths of the columns, at least [`SMALLEST_SCALE`] of the longest; zero for a zero matrix.
pub(super) fn scales<T: Float, const N: usize, const R: usize>(jacobian: &[[T; R]; N]) -> [T; R] {
    let mut squares = [T::ZERO; R];
    for row in jacobian {
        for (sum, entry) in squares.iter_mut().zip(row) {
            *sum += *entry * *entry;
        }
    }
    let lengths = squares.map(T::sqrt);
    let longest = lengths.iter().fold(T::ZERO, |most, own| most.max(*own));
    lengths.map(|own| own.max(longest * T::of(SMALLEST_SCALE)))
}

/// J⁺ of a Jacobian of full column rank, and its condition number.
///
/// Columns are scaled to the length 1 and made orthonormal by the Gram-Schmidt process, twice
/// (Giraud, Langou, Rozložník 2005). The condition number is ‖J‖ ‖J⁺‖/R of the scaled Jacobian in
/// the Frobenius norm, which is 1 for orthogonal columns.
pub(super) fn pseudo_inverse<T: Float, const N: usize, const R: usize>(
    jacobian: &[[T; R]; N],
) -> Result<([[T; N]; R], T), Error> {
    let singular = |condition: T| Error::Singular {
        condition: condition.into(),
    };
    let scales = scales(jacobian);
    if N < R || scales.iter().any(|scale| *scale <= T::ZERO) {
        return Err(singular(T::INFINITY));
    }
    if scales.iter().any(|scale| !scale.is_finite()) {
        return Err(Error::Overflow);
    }
    let mut columns: [[T; N]; R] =
        core::array::from_fn(|i| core::array::from_fn(|a| jacobian[a][i] / scales[i]));
    let norm = sum_of_squares(&columns).sqrt();
    // Upper triangle of the factorisation.
    let mut upper = [[T::ZERO; R]; R];
    for k in 0..R {
        let (done, rest) = columns.split_at_mut(k);
        let Some(own) = rest.first_mut() else { break };
        for _ in 0..2 {
            for (row, direction) in upper.iter_mut().zip(done.iter()) {
                let along = dot(direction, own);
                row[k] += along;
                for (entry, part) in own.iter_mut().zip(direction) {
                    *entry -= along * *part;
                }
            }
        }
        let length = dot(own, own).sqrt();
        if length <= T::ZERO {
            return Err(singular(T::INFINITY));
        }
        upper[k][k] = length;
        own.iter_mut().for_each(|entry| *entry /= length);
    }
    for i in (0..R).rev() {
        let (before, after) = columns.split_at_mut(i + 1);
        let Some(own) = before.last_mut() else { break };
        for (direction, factor) in after.iter().zip(upper[i].iter().skip(i + 1)) {
            for (entry, part) in own.iter_mut().zip(direction) {
                *entry -= *factor * *part;
            }
        }
        own.iter_mut().for_each(|entry| *entry /= upper[i][i]);
    }
    let condition = norm * sum_of_squares(&columns).sqrt() / T::of(R as f64);
    // False for NaN too.
    let is_regular = condition < T::of(T::LIMITS.partition);
    if !is_regular {
        return Err(singular(condition));
    }
    for (row, scale) in columns.iter_mut().zip(&scales) {
        row.iter_mut().for_each(|entry| *entry /= *scale);
    }
    Ok((columns, condition))
}

fn sum_of_squares<T: Float, const K: usize, const L: usize>(all: &[[T; L]; K]) -> T {
    dot(all.as_flattened(), all.as_flattened())
}

/// Whether the determinant of a matrix is positive, by elimination with pivots.
pub(super) fn has_positive_determinant<T: Float, const R: usize>(mut matrix: [[T; R]; R]) -> bool {
    let mut is_positive = true;
    for k in 0..R {
        let mut pivot = k;
        for row in k + 1..R {
            if matrix[row][k].abs() > matrix[pivot][k].abs() {
                pivot = row;
            }
        }
        if pivot != k {
            matrix.swap(pivot, k);
            is_positive = !is_positive;
        }
        let (done, rest) = matrix.split_at_mut(k + 1);
        let Some(own) = done.last() else { break };
        // Both are false for zero and NaN.
        let (is_above, is_below) = (own[k] > T::ZERO, own[k] < T::ZERO);
        if is_below {
            is_positive = !is_positive;
        } else if !is_above {
            return false;
        }
        for row in rest {
            let factor = row[k] / own[k];
            for (entry, above) in row.iter_mut().zip(own).skip(k + 1) {
                *entry -= factor * *above;
            }
        }
    }
    is_positive
}

/// Solves S x = b of a positive semidefinite S with a diagonal of ones.
///
/// `None` if S is singular.
pub(super) fn solve_definite<T: Float, const N: usize>(
    mut matrix: [[T; N]; N],
    mut right: [T; N],
) -> Option<[T; N]> {
    // Lower triangle L of S = L Lᵀ, in place.
    for k in 0..N {
        let (done, rest) = matrix.split_at_mut(k);
        let own = rest.first_mut()?;
        for (column, above) in done.iter().enumerate() {
            let known = dot(&own[..column], &above[..column]);
            own[column] = (own[column] - known) / above[column];
        }
        let pivot = own[k] - dot(&own[..k], &own[..k]);
        // False for NaN too.
        let is_regular = pivot > T::of(T::LIMITS.singular);
        if !is_regular {
            return None;
        }
        own[k] = pivot.sqrt();
        let known = dot(&own[..k], &right[..k]);
        right[k] = (right[k] - known) / own[k];
    }
    for k in (0..N).rev() {
        let mut rest = right[k];
        for row in k + 1..N {
            rest -= matrix[row][k] * right[row];
        }
        right[k] = rest / matrix[k][k];
    }
    Some(right)
}
