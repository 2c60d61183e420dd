//! Pseudo-inertia of a body from its ten inertial parameters, and back.
//!
//! J = ∫ [p/ℓ; 1] [p/ℓ; 1]ᵀ dm with a length ℓ, so that all entries are masses:
//!
//! | entries | value |
//! |---|---|
//! | J₁₁ | (yy + zz - xx) / (2 ℓ²), and cyclic permutations |
//! | J₁₂ | -xy / ℓ², and likewise J₁₃, J₂₃ |
//! | J₁₄ | mx / ℓ, and likewise J₂₄, J₃₄ |
//! | J₄₄ | m |
//!
//! The parameters belong to a body if and only if J is positive semidefinite (Wensing, Kim, Slotine
//! 2018).

use crate::float::Float;

/// Lower triangle of a symmetric 4 × 4 matrix, row by row: 11, 21, 22, 31, 32, 33, 41, …, 44.
pub(super) type Triangle<T> = [T; 10];

/// The ten inertial parameters in the order of
/// [`StandardParameter::INERTIA`](crate::StandardParameter::INERTIA).
pub(super) type Inertia<T> = [T; 10];

/// J of a body, for a length ℓ.
pub(super) fn pseudo_inertia<T: Float>(inertia: &Inertia<T>, length: T) -> Triangle<T> {
    let [xx, xy, xz, yy, yz, zz, mx, my, mz, m] = *inertia;
    let half = T::of(0.5);
    let square = length * length;
    [
        half * (yy + zz - xx) / square,
        -xy / square,
        half * (xx + zz - yy) / square,
        -xz / square,
        -yz / square,
        half * (xx + yy - zz) / square,
        mx / length,
        my / length,
        mz / length,
        m,
    ]
}

/// The ten parameters of J.
pub(super) fn inertia<T: Float>(pseudo: &Triangle<T>, length: T) -> Inertia<T> {
    let [a, d, b, e, f, c, x, y, z, m] = *pseudo;
    let square = length * length;
    [
        (b + c) * square,
        -d * square,
        -e * square,
        (a + c) * square,
        -f * square,
        (a + b) * square,
        x * length,
        y * length,
        z * length,
        m,
    ]
}

/// Places of row and column in the triangle, the row at least the column.
const fn place(row: usize, column: usize) -> usize {
    row * (row + 1) / 2 + column
}

/// L with L Lᵀ = J; `None` unless J is positive definite within rounding.
pub(super) fn cholesky<T: Float>(pseudo: &Triangle<T>) -> Option<Triangle<T>> {
    let mut lower = [T::ZERO; 10];
    for row in 0..4 {
        for column in 0..=row {
            let mut rest = pseudo[place(row, column)];
            for k in 0..column {
                rest -= lower[place(row, k)] * lower[place(column, k)];
            }
            lower[place(row, column)] = if column < row {
                rest / lower[place(column, column)]
            } else if rest > T::of(T::LIMITS.pivot) * pseudo[place(row, row)] {
                rest.sqrt()
            } else {
                return None;
            };
        }
    }
    lower.iter().all(|x| x.is_finite()).then_some(lower)
}

/// L⁻¹ of a lower triangular L.
pub(super) fn inverse<T: Float>(lower: &Triangle<T>) -> Triangle<T> {
    let mut inverse = [T::ZERO; 10];
    for column in 0..4 {
        for row in column..4 {
            let mut rest = T::of(f64::from(u8::from(row == column)));
            for k in column..row {
                rest -= lower[place(row, k)] * inverse[place(k, column)];
            }
            inverse[place(row, column)] = rest / lower[place(row, row)];
        }
    }
    inverse
}

/// Row and column of an entry of the triangle.
const ENTRIES: [[usize; 2]; 10] = [
    [0, 0],
    [1, 0],
    [1, 1],
    [2, 0],
    [2, 1],
    [2, 2],
    [3, 0],
    [3, 1],
    [3, 2],
    [3, 3],
];

/// N E Nᵀ of a lower triangular N, with E of an entry of the triangle; entries off the diagonal
/// times √2, so that the sum of squares is that of the whole matrix.
pub(super) fn transformed<T: Float>(lower: &Triangle<T>, entry: usize) -> Triangle<T> {
    let [p, q] = ENTRIES.get(entry).copied().unwrap_or_default();
    // Column `column` of N.
    let at = |row: usize, column: usize| {
        let own = lower.get(place(row, column)).filter(|_| row >= column);
        own.copied().unwrap_or(T::ZERO)
    };
    let root = T::of(core::f64::consts::SQRT_2);
    let mut result = [T::ZERO; 10];
    for (own, [a, b]) in result.iter_mut().zip(ENTRIES) {
        let product = at(a, p) * at(b, q);
        let both = if p == q {
            product
        } else {
            product + at(a, q) * at(b, p)
        };
        *own = if a == b { both } else { root * both };
    }
    result
}

/// Whether an entry of the triangle is on the diagonal.
pub(super) fn is_diagonal(entry: usize) -> bool {
    ENTRIES
        .get(entry)
        .is_some_and(|[row, column]| row == column)
}
