//! Unit quaternions (w, x, y, z) of orientations.
//!
//! A turn about z by θ is (cos θ/2, 0, 0, sin θ/2). Products of such turns have length 1 without a
//! square root, and change continuously with the angles.

use crate::cas::{Angle, Arena, CosineSine, Expr, Matrix3, Number, Ratio};

/// A unit quaternion, w first.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Quaternion<'a>(pub(crate) [Expr<'a>; 4]);

impl<'a> Quaternion<'a> {
    /// The identity.
    pub(crate) fn one(arena: &'a Arena) -> Self {
        let (one, zero) = (arena.one(), arena.zero());
        Self([one, zero, zero, zero])
    }

    /// A rotation about a coordinate axis (0, 1, 2), from cosine and sine of half its angle.
    pub(crate) fn about(axis: usize, half: CosineSine<'a>) -> Self {
        let zero = half.cosine.arena().zero();
        let mut entries = [half.cosine, zero, zero, zero];
        entries[1 + axis] = half.sine;
        Self(entries)
    }

    /// The product, which rotates by `other` first.
    pub(crate) fn times(&self, other: &Self) -> Self {
        let ([a, b, c, d], [w, x, y, z]) = (self.0, other.0);
        Self([
            a * w - b * x - c * y - d * z,
            a * x + b * w + c * z - d * y,
            a * y + c * w + d * x - b * z,
            a * z + d * w + b * y - c * x,
        ])
    }

    /// The quaternion of a rotation matrix on the side of a constant one.
    ///
    /// With K = 4 q qᵀ, whose entries are linear in the matrix, K r = 4 (q · r) q has the direction
    /// of q. It vanishes only half a turn from the constant rotation r. Also returns |K r|, which
    /// must not be zero.
    pub(crate) fn near(rotation: &Matrix3<'a>, reference: [f64; 4]) -> (Self, Expr<'a>) {
        let m = rotation.0;
        let arena = m[0][0].arena();
        let one = arena.one();
        let [w, x, y, z] = reference.map(|value| arena.number(Number::float(value)));
        let diagonal = [
            one + m[0][0] + m[1][1] + m[2][2],
            one + m[0][0] - m[1][1] - m[2][2],
            one - m[0][0] + m[1][1] - m[2][2],
            one - m[0][0] - m[1][1] + m[2][2],
        ];
        let axial = [m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1]];
        let (xy, xz, yz) = (m[0][1] + m[1][0], m[0][2] + m[2][0], m[1][2] + m[2][1]);
        let along = [
            diagonal[0] * w + axial[0] * x + axial[1] * y + axial[2] * z,
            axial[0] * w + diagonal[1] * x + xy * y + xz * z,
            axial[1] * w + xy * x + diagonal[2] * y + yz * z,
            axial[2] * w + xz * x + yz * y + diagonal[3] * z,
        ];
        let length = along.iter().map(|entry| entry.squared()).sum::<Expr<'a>>();
        let length = length.sqrt();
        let shrink = length.reciprocal();
        (Self(along.map(|entry| entry * shrink)), length)
    }
}

/// Half of an angle.
pub(crate) fn half() -> Ratio {
    Ratio::new(1, 2).unwrap_or(Ratio::ONE)
}

/// A constant quaternion as a factor and a quaternion that may have another length.
///
/// If its entries have one magnitude, as those of right angles have, they become ±1, and products
/// with them are additions.
pub(crate) struct ConstantQuaternion<'a> {
    /// The factor.
    pub(crate) factor: Number,
    /// The quaternion divided by the factor.
    pub(crate) quaternion: Quaternion<'a>,
}

impl<'a> ConstantQuaternion<'a> {
    /// Rz(rz) Ry(ry) Rx(rx) of constant angles; `None` on overflow of a constant.
    pub(crate) fn new(arena: &'a Arena, rotation: [Angle; 3]) -> Option<Self> {
        let about = |axis: usize| {
            let (cosine, sine) = rotation[axis].times(half())?.cosine_and_sine();
            Some(Quaternion::about(
                axis,
                CosineSine {
                    cosine: arena.number(cosine),
                    sine: arena.number(sine),
                },
            ))
        };
        let whole = about(2)?.times(&about(1)?).times(&about(0)?);
        let numbers = whole.0.map(|entry| entry.as_number());
        let present = || numbers.iter().flatten().filter(|number| !number.is_zero());
        let first = *present().next()?;
        let is_alike = present().all(|&number| number == first || number == -first);
        if !is_alike || first.is_one() {
            return Some(Self {
                factor: Number::ONE,
                quaternion: whole,
            });
        }
        let sign = |number: Option<Number>| match number {
            Some(own) if own == first => arena.one(),
            Some(own) if !own.is_zero() => -arena.one(),
            _ => arena.zero(),
        };
        Some(Self {
            factor: first,
            quaternion: Quaternion(numbers.map(sign)),
        })
    }
}
