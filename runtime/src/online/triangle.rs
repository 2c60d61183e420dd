//! Operations on the triangle R and the right side z of R χ = z.
//!
//! R is p × p, upper triangular, row by row in a slice of p² numbers; entries below the diagonal
//! are not read. No function panics, whatever the lengths of the slices: they use iterators, which
//! end with the shorter slice.

use super::bounds;
use crate::float::Float;

/// Rows of R with their right sides and numbers.
fn rows<'a, T>(
    factor: &'a [T],
    side: &'a [T],
) -> impl DoubleEndedIterator<Item = (usize, (&'a [T], &'a T))> + ExactSizeIterator {
    factor.chunks_exact(side.len().max(1)).zip(side).enumerate()
}

/// What remains of a row after it is rotated into R.
#[derive(Debug, Clone, Copy)]
pub(super) struct Remainder<T> {
    /// What remains of the right side: the innovation in its standard deviations.
    pub(super) side: T,
    /// Product of the cosines: σ over the innovation's standard deviation.
    pub(super) cosines: T,
}

/// Rotates a row and its right side into R and z by Givens rotations, from column `first` on.
///
/// The row is overwritten. Entries before `first` have to be zero. Diagonal entries stay
/// nonnegative and do not decrease, not even by rounding.
pub(super) fn rotate_in<T: Float>(
    factor: &mut [T],
    side: &mut [T],
    row: &mut [T],
    y: T,
    first: usize,
) -> Remainder<T> {
    let smallest = bounds::smallest::<T>();
    let mut rest = Remainder {
        side: y,
        cosines: T::of(1.0),
    };
    let pivots = factor.chunks_exact_mut(side.len().max(1)).zip(side);
    for (place, (pivots, z)) in pivots.enumerate().skip(first) {
        let mut pairs = pivots.iter_mut().zip(row.iter_mut()).skip(place);
        let Some((diagonal, entry)) = pairs.next() else {
            break;
        };
        let (a, b) = (*diagonal, *entry);
        if b.abs() < smallest {
            continue;
        }
        let root = (a * a + b * b).sqrt();
        let (cosine, sine) = (a / root, b / root);
        *diagonal = root;
        for (upper, lower) in pairs {
            let (u, l) = (*upper, *lower);
            *upper = cosine * u + sine * l;
            *lower = cosine * l - sine * u;
        }
        let (u, l) = (*z, rest.side);
        *z = cosine * u + sine * l;
        rest.side = cosine * l - sine * u;
        rest.cosines *= cosine;
    }
    rest
}

/// Rotates rows `upper` and `upper + 1` of R and z by an angle, from column `first` on.
fn rotate_rows<T: Float>(
    factor: &mut [T],
    side: &mut [T],
    upper: usize,
    first: usize,
    cosine: T,
    sine: T,
) {
    let width = side.len();
    let pair = factor.get_mut(upper * width..(upper + 2) * width);
    let Some((above, below)) = pair.and_then(|pair| pair.split_at_mut_checked(width)) else {
        return;
    };
    let turn = |a: &mut T, b: &mut T| {
        let (u, l) = (*a, *b);
        *a = cosine * u + sine * l;
        *b = cosine * l - sine * u;
    };
    for (a, b) in above.iter_mut().zip(below).skip(first) {
        turn(a, b);
    }
    if let Some([a, b]) = side.get_mut(upper..upper + 2) {
        turn(a, b);
    }
}

/// Multiplies R and z by a factor.
pub(super) fn scale<T: Float>(factor: &mut [T], side: &mut [T], by: T) {
    let all = factor.iter_mut().chain(side);
    all.for_each(|number| *number = scaled(*number, by));
}

/// A product; zero if its square would not be a normal number, since numbers that decay further
/// become slow to compute with.
fn scaled<T: Float>(number: T, by: T) -> T {
    let product = number * by;
    if product.abs() < bounds::smallest::<T>() {
        T::ZERO
    } else {
        product
    }
}

/// Multiplies the information along Λ w by λ: R becomes (I - (1 - √λ) û ûᵀ) R, with û along R w.
///
/// Rotations turn û into the first unit vector, so that R becomes an upper Hessenberg matrix. Its
/// first row is scaled by √λ, and rotations make it triangular again. `direction` has p numbers of
/// memory. Rows that are zero forget nothing.
pub(super) fn forget_along<T: Float>(
    factor: &mut [T],
    side: &mut [T],
    row: &[T],
    root_of_lambda: T,
    direction: &mut [T],
) {
    let largest = row.iter().fold(T::ZERO, |most, w| most.max(w.abs()));
    if largest < bounds::smallest::<T>() {
        return;
    }
    for ((place, (pivots, _)), u) in rows(factor, side).zip(direction.iter_mut()) {
        let products = pivots.iter().zip(row).skip(place);
        *u = products.map(|(r, w)| *r * (*w / largest)).sum();
    }
    let longest = direction.iter().fold(T::ZERO, |most, u| most.max(u.abs()));
    if !(longest >= bounds::smallest::<T>() && longest.is_finite()) {
        return;
    }
    direction.iter_mut().for_each(|u| *u /= longest);
    let count = side.len();
    for upper in (0..count.saturating_sub(1)).rev() {
        let Some([a, b]) = direction.get_mut(upper..upper + 2) else {
            continue;
        };
        if b.abs() < bounds::smallest::<T>() {
            continue;
        }
        let root = (*a * *a + *b * *b).sqrt();
        let (cosine, sine) = (*a / root, *b / root);
        *a = root;
        // R has no entry to the left of the diagonal of the upper row.
        clear_below(factor, count, upper);
        rotate_rows(factor, side, upper, upper, cosine, sine);
    }
    let first_row = factor.iter_mut().take(count);
    let first_numbers = first_row.chain(side.iter_mut().take(1));
    first_numbers.for_each(|number| *number = scaled(*number, root_of_lambda));
    for upper in 0..count.saturating_sub(1) {
        let diagonal = factor.get(upper * count + upper).copied();
        let below = factor.get((upper + 1) * count + upper).copied();
        let (Some(a), Some(b)) = (diagonal, below) else {
            break;
        };
        if b.abs() >= bounds::smallest::<T>() {
            let root = (a * a + b * b).sqrt();
            rotate_rows(factor, side, upper, upper, a / root, b / root);
        }
        clear_below(factor, count, upper);
    }
    make_diagonal_nonnegative(factor, side);
}

/// Sets the entry below the diagonal in a column to zero.
fn clear_below<T: Float>(factor: &mut [T], count: usize, column: usize) {
    if let Some(entry) = factor.get_mut((column + 1) * count + column) {
        *entry = T::ZERO;
    }
}

/// Changes the signs of rows with a negative diagonal entry.
pub(super) fn make_diagonal_nonnegative<T: Float>(factor: &mut [T], side: &mut [T]) {
    let rows = factor.chunks_exact_mut(side.len().max(1)).zip(side);
    for (place, (row, z)) in rows.enumerate() {
        if row.get(place).is_some_and(|diagonal| *diagonal < T::ZERO) {
            row.iter_mut().for_each(|r| *r = -*r);
            *z = -*z;
        }
    }
}

/// Whether each diagonal entry of R is nonzero within rounding of its column.
pub(super) fn is_regular<T: Float>(factor: &[T], count: usize) -> bool {
    let limit = bounds::regular::<T>();
    (0..count).all(|column| {
        let diagonal = factor.get(column * count + column);
        let diagonal = diagonal.copied().unwrap_or(T::ZERO);
        diagonal >= bounds::smallest::<T>()
            && diagonal > limit * column_length(factor, count, column)
    })
}

/// Length of a column of R.
pub(super) fn column_length<T: Float>(factor: &[T], count: usize, column: usize) -> T {
    let entries = factor.iter().skip(column).step_by(count.max(1));
    let squares = entries.take(column + 1).map(|r| *r * *r);
    squares.sum::<T>().sqrt()
}

/// Solves R χ = z. Whether all numbers of the solution are finite.
pub(super) fn solve<T: Float>(factor: &[T], side: &[T], solution: &mut [T]) -> bool {
    let mut is_finite = true;
    for (place, (row, z)) in rows(factor, side).rev() {
        let mut rest = *z;
        for (r, x) in row.iter().zip(solution.iter()).skip(place + 1) {
            rest -= *r * *x;
        }
        let diagonal = row.get(place).copied().unwrap_or(T::ZERO);
        if let Some(x) = solution.get_mut(place) {
            *x = rest / diagonal;
            is_finite &= x.is_finite();
        }
    }
    is_finite
}

/// Solves R χ = z for the parameters that do not depend on undetermined ones; the others are NaN.
///
/// A parameter is undetermined if its diagonal entry is zero within rounding of its column.
pub(super) fn solve_determined<T: Float>(factor: &[T], side: &[T], solution: &mut [T]) {
    for (place, (row, z)) in rows(factor, side).rev() {
        let diagonal = row.get(place).copied().unwrap_or(T::ZERO);
        let mut rest = *z;
        for (r, x) in row.iter().zip(solution.iter()).skip(place + 1) {
            if r.abs() > T::ZERO {
                rest -= *r * *x;
            }
        }
        let limit = bounds::regular::<T>() * column_length(factor, side.len(), place);
        let is_determined = diagonal >= bounds::smallest::<T>() && diagonal > limit;
        if let Some(x) = solution.get_mut(place) {
            *x = if is_determined {
                rest / diagonal
            } else {
                T::NAN
            };
        }
    }
}

/// Row `place` of R⁻¹. Whether all its numbers are finite.
pub(super) fn inverse_row<T: Float>(factor: &[T], place: usize, inverse: &mut [T]) -> bool {
    let count = inverse.len();
    // Until its turn, an entry has the sum over the rows above.
    for (column, entry) in inverse.iter_mut().enumerate() {
        *entry = if column == place {
            T::of(-1.0)
        } else {
            T::ZERO
        };
    }
    let mut is_finite = true;
    for (at, row) in factor.chunks_exact(count.max(1)).enumerate().skip(place) {
        let mut pairs = row.iter().zip(inverse.iter_mut()).skip(at);
        let Some((diagonal, entry)) = pairs.next() else {
            break;
        };
        // Columns of zeros have no diagonal entry, and rows above do not refer to them.
        let own = if entry.abs() > T::ZERO {
            -*entry / *diagonal
        } else {
            T::ZERO
        };
        *entry = own;
        is_finite &= own.is_finite();
        for (r, sum) in pairs {
            *sum += own * *r;
        }
    }
    is_finite
}

/// Lengths of the rows of R⁻¹: the standard deviations. Whether all are finite.
pub(super) fn standard_deviations<T: Float>(
    factor: &[T],
    work: &mut [T],
    deviations: &mut [T],
) -> bool {
    let mut is_finite = true;
    for (place, deviation) in deviations.iter_mut().enumerate() {
        is_finite &= inverse_row(factor, place, work);
        let squares = work.iter().skip(place).map(|u| *u * *u);
        *deviation = squares.sum::<T>().sqrt();
        is_finite &= deviation.is_finite();
    }
    is_finite
}
