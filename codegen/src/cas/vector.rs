//! Vectors and matrices of expressions in three dimensions.

use super::arena::expr::Expr;
use super::{Arena, Number};
use std::ops::{Add, Mul, Neg, Sub};

/// A vector of three expressions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Vector3<'a>(pub [Expr<'a>; 3]);

/// A 3 x 3 matrix of expressions, row by row.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Matrix3<'a>(pub [[Expr<'a>; 3]; 3]);

impl<'a> Vector3<'a> {
    /// The zero vector.
    #[must_use]
    pub fn zero(arena: &'a Arena) -> Self {
        Self([arena.zero(); 3])
    }

    /// The unit vector of an axis (0, 1, 2).
    #[must_use]
    pub fn unit(arena: &'a Arena, axis: usize) -> Self {
        Self(std::array::from_fn(|i| arena.integer(i64::from(i == axis))))
    }

    /// A vector of constants.
    #[must_use]
    pub fn constant(arena: &'a Arena, components: [Number; 3]) -> Self {
        Self(components.map(|c| arena.number(c)))
    }

    /// First component.
    #[must_use]
    pub const fn x(self) -> Expr<'a> {
        self.0[0]
    }

    /// Second component.
    #[must_use]
    pub const fn y(self) -> Expr<'a> {
        self.0[1]
    }

    /// Third component.
    #[must_use]
    pub const fn z(self) -> Expr<'a> {
        self.0[2]
    }

    /// Whether all components are zero.
    #[must_use]
    pub fn is_zero(self) -> bool {
        self.0.iter().all(|c| c.is_zero())
    }

    /// Scalar product.
    #[must_use]
    pub fn dot(self, other: Self) -> Expr<'a> {
        self.x() * other.x() + self.y() * other.y() + self.z() * other.z()
    }

    /// Vector product.
    #[must_use]
    pub fn cross(self, other: Self) -> Self {
        let ([a, b, c], [x, y, z]) = (self.0, other.0);
        Self([b * z - c * y, c * x - a * z, a * y - b * x])
    }

    /// The vector times a scalar.
    #[must_use]
    pub fn scaled(self, factor: Expr<'a>) -> Self {
        Self(self.0.map(|c| c * factor))
    }
}

impl<'a> Matrix3<'a> {
    /// The identity.
    #[must_use]
    pub fn identity(arena: &'a Arena) -> Self {
        Self(std::array::from_fn(|i| Vector3::unit(arena, i).0))
    }

    /// Whether the matrix is block diagonal: the components `own`, and the others.
    #[must_use]
    pub(crate) fn is_block_diagonal(&self, own: &[usize]) -> bool {
        let pairs = (0..3).flat_map(|i| (0..3).map(move |j| (i, j)));
        let mut across = pairs.filter(|(i, j)| own.contains(i) != own.contains(j));
        across.all(|(i, j)| self.0[i][j].is_zero())
    }

    /// Whether a rotation matrix is a signed permutation, that is, has three nonzero entries.
    #[must_use]
    pub(crate) fn is_signed_permutation(&self) -> bool {
        let entries = || self.0.iter().flatten().filter(|entry| !entry.is_zero());
        entries().count() == 3
    }

    /// Rotation about a coordinate axis (0, 1, 2) by the angle of the given cosine and sine.
    #[must_use]
    pub fn rotation(axis: usize, cosine: Expr<'a>, sine: Expr<'a>) -> Self {
        let mut matrix = Self::identity(cosine.arena());
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        matrix.0[i][i] = cosine;
        matrix.0[j][j] = cosine;
        matrix.0[i][j] = -sine;
        matrix.0[j][i] = sine;
        matrix
    }

    /// Row i.
    #[must_use]
    pub const fn row(self, i: usize) -> Vector3<'a> {
        Vector3(self.0[i])
    }

    /// Column j.
    #[must_use]
    pub fn column(self, j: usize) -> Vector3<'a> {
        Vector3([self.0[0][j], self.0[1][j], self.0[2][j]])
    }

    /// Transpose.
    #[must_use]
    pub fn transposed(self) -> Self {
        Self(std::array::from_fn(|i| {
            std::array::from_fn(|j| self.0[j][i])
        }))
    }
}

impl Add for Vector3<'_> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] + other.0[i]))
    }
}

impl Sub for Vector3<'_> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] - other.0[i]))
    }
}

impl Neg for Vector3<'_> {
    type Output = Self;
    fn neg(self) -> Self {
        Self(self.0.map(Neg::neg))
    }
}

impl<'a> Mul<Vector3<'a>> for Matrix3<'a> {
    type Output = Vector3<'a>;
    fn mul(self, vector: Vector3<'a>) -> Vector3<'a> {
        Vector3(std::array::from_fn(|i| self.row(i).dot(vector)))
    }
}

impl Mul for Matrix3<'_> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| {
            std::array::from_fn(|j| self.row(i).dot(other.column(j)))
        }))
    }
}
