//! The rotation of a joint, applied to vectors and symmetric matrices in both directions.

use super::configuration::Configuration;
use super::joint::joint_turn;
use super::orientation::constant_rotation;
use super::rates::parallel;
use super::spatial::Wrench;
use crate::cas::{Angle, Arena, CosineSine, Direction, Expr, Matrix3, Ratio, Vector3};
use crate::mechanism::Leg;

/// The rotation between the antecedent frame and a joint's frame.
#[derive(Debug)]
pub(crate) struct Turn<'a> {
    /// Rot(z, γ) Rot(x, α) where the axes are not parallel.
    tilt: Option<Tilt<'a>>,
    /// Cosine and sine of the subsequent turn about z.
    unit: CosineSine<'a>,
    /// The turn about z as a matrix.
    matrix: Matrix3<'a>,
}

/// A constant rotation as a matrix, and cosine and sine of its rotations about z and x.
#[derive(Debug)]
struct Tilt<'a> {
    matrix: Matrix3<'a>,
    about_z: CosineSine<'a>,
    about_x: CosineSine<'a>,
}

impl<'a> Turn<'a> {
    /// The rotation of a joint; `None` if the configuration does not determine its sine or cosine.
    pub(crate) fn new(
        arena: &'a Arena,
        leg: &Leg,
        index: usize,
        first_joint: usize,
        configuration: &Configuration<'a>,
    ) -> Option<Self> {
        let joint = &leg.joints[index];
        let theta = joint_turn(leg, index, first_joint, configuration)?;
        let same_axis = parallel(joint.alpha) == Some(Ratio::ONE);
        let (tilt, angle) = if same_axis {
            (None, theta.plus(&Direction::constant(joint.gamma))?)
        } else {
            (Some(Tilt::new(arena, joint.gamma, joint.alpha)), theta)
        };
        let unit = configuration.unit(&angle)?;
        Some(Self {
            tilt,
            unit,
            matrix: Matrix3::rotation(2, unit.cosine, unit.sine),
        })
    }

    /// Transforms a vector from the antecedent frame to the joint's frame.
    pub(crate) fn apply(&self, vector: Vector3<'a>) -> Vector3<'a> {
        let tilt = self.tilt.as_ref();
        let vector = tilt.map_or(vector, |tilt| tilt.matrix.transposed() * vector);
        self.matrix.transposed() * vector
    }

    /// Transforms a vector from the joint's frame to the antecedent frame.
    pub(crate) fn back(&self, vector: Vector3<'a>) -> Vector3<'a> {
        let vector = self.matrix * vector;
        let tilt = self.tilt.as_ref();
        tilt.map_or(vector, |tilt| tilt.matrix * vector)
    }

    /// Rotates a wrench from the joint's axes into those of the antecedent frame.
    pub(crate) fn back_wrench(&self, wrench: &Wrench<'a>) -> Wrench<'a> {
        Wrench {
            force: self.back(wrench.force),
            moment: self.back(wrench.moment),
        }
    }

    /// Transforms a symmetric matrix from the joint's frame to the antecedent frame.
    pub(crate) fn back_symmetric(&self, matrix: Matrix3<'a>) -> Matrix3<'a> {
        let turned = turned(matrix, 2, self.unit);
        let Some(tilt) = &self.tilt else {
            return turned;
        };
        self::turned(self::turned(turned, 0, tilt.about_x), 2, tilt.about_z)
    }
}

impl<'a> Tilt<'a> {
    fn new(arena: &'a Arena, gamma: Angle, alpha: Angle) -> Self {
        let number = |angle: Angle| {
            let (cosine, sine) = angle.cosine_and_sine();
            CosineSine {
                cosine: arena.number(cosine),
                sine: arena.number(sine),
            }
        };
        let about_z = constant_rotation(arena, [Angle::ZERO, Angle::ZERO, gamma]);
        let about_x = constant_rotation(arena, [alpha, Angle::ZERO, Angle::ZERO]);
        Self {
            matrix: about_z * about_x,
            about_z: number(gamma),
            about_x: number(alpha),
        }
    }
}

/// R S Rᵀ for a symmetric matrix S and a rotation R about a coordinate axis.
///
/// Takes ten operations for the 2 × 2 block of the other two axes and six for the remaining
/// entries. With e = s (S_ii - S_jj) + 2 c S_ij the diagonal changes by -s e and s e, and the entry
/// S_ij becomes c e - S_ij.
pub(crate) fn turned<'a>(
    matrix: Matrix3<'a>,
    axis: usize,
    CosineSine { cosine, sine }: CosineSine<'a>,
) -> Matrix3<'a> {
    let (i, j, k) = ((axis + 1) % 3, (axis + 2) % 3, axis);
    let m = matrix.0;
    let twice = m[i][j] + m[i][j];
    let e = sine * (m[i][i] - m[j][j]) + cosine * twice;
    let moved = sine * e;
    let mut turned = matrix;
    let mut set = |a: usize, b: usize, value: Expr<'a>| {
        turned.0[a][b] = value;
        turned.0[b][a] = value;
    };
    set(i, i, m[i][i] - moved);
    set(j, j, m[j][j] + moved);
    set(i, j, cosine * e - m[i][j]);
    set(i, k, cosine * m[i][k] - sine * m[j][k]);
    set(j, k, sine * m[i][k] + cosine * m[j][k]);
    turned
}
