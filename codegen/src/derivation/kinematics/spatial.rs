//! Spatial motions and wrenches of a rigid body, as pairs of vectors in one frame.

use crate::cas::{Arena, Expr, Matrix3, Vector3};

/// Motion of a body: velocity, partial velocity or acceleration.
#[derive(Debug, Clone, Copy)]
pub struct SpatialMotion<'a> {
    /// Linear part, of the reference point.
    pub linear: Vector3<'a>,
    /// Angular part.
    pub angular: Vector3<'a>,
}

/// Force on a body and its moment about the reference point.
#[derive(Debug, Clone, Copy)]
pub struct Wrench<'a> {
    /// Force.
    pub force: Vector3<'a>,
    /// Moment.
    pub moment: Vector3<'a>,
}

impl<'a> SpatialMotion<'a> {
    /// Zero motion.
    #[must_use]
    pub fn zero(arena: &'a Arena) -> Self {
        Self {
            linear: Vector3::zero(arena),
            angular: Vector3::zero(arena),
        }
    }

    /// Velocity of the point at `arm` from the reference point.
    #[must_use]
    pub fn linear_at(&self, arm: Vector3<'a>) -> Vector3<'a> {
        self.linear + self.angular.cross(arm)
    }

    /// Component 0 to 2 of the linear part, or 3 to 5 of the angular part.
    #[must_use]
    pub fn component(&self, row: usize) -> Expr<'a> {
        let part = if row < 3 { self.linear } else { self.angular };
        part.0[row % 3]
    }

    /// The difference from another motion.
    #[must_use]
    pub fn minus(&self, other: &Self) -> Self {
        Self {
            linear: self.linear - other.linear,
            angular: self.angular - other.angular,
        }
    }

    /// The sum with `factor` times another motion.
    #[must_use]
    pub fn plus_scaled(&self, other: &Self, factor: Expr<'a>) -> Self {
        Self {
            linear: self.linear + other.linear.scaled(factor),
            angular: self.angular + other.angular.scaled(factor),
        }
    }
}

impl<'a> Wrench<'a> {
    /// Zero wrench.
    #[must_use]
    pub fn zero(arena: &'a Arena) -> Self {
        Self {
            force: Vector3::zero(arena),
            moment: Vector3::zero(arena),
        }
    }

    /// Power: the product with a velocity about the same point.
    #[must_use]
    pub fn power(&self, motion: &SpatialMotion<'a>) -> Expr<'a> {
        self.force.dot(motion.linear) + self.moment.dot(motion.angular)
    }

    /// The sum of two wrenches about one point.
    #[must_use]
    pub fn plus(&self, other: &Self) -> Self {
        Self {
            force: self.force + other.force,
            moment: self.moment + other.moment,
        }
    }

    /// The sum with `factor` times another wrench.
    #[must_use]
    pub fn plus_scaled(&self, other: &Self, factor: Expr<'a>) -> Self {
        Self {
            force: self.force + other.force.scaled(factor),
            moment: self.moment + other.moment.scaled(factor),
        }
    }

    /// The wrench in other axes.
    #[must_use]
    pub fn rotated(&self, rotation: Matrix3<'a>) -> Self {
        Self {
            force: rotation * self.force,
            moment: rotation * self.moment,
        }
    }

    /// The wrench times a factor.
    #[must_use]
    pub fn scaled(&self, factor: Expr<'a>) -> Self {
        Self {
            force: self.force.scaled(factor),
            moment: self.moment.scaled(factor),
        }
    }
}
