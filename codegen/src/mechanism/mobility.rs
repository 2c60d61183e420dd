//! Motions that the legs allow the platform, regardless of the described motion.
//!
//! The platform is treated as a free body with the twist t of six components. A leg's joints give
//! its end the velocities J q̇ in the components that it shares with the platform, whose velocities
//! there are E t. Velocities that no joint produces are blocked: Nᵀ E t = 0, with N the left null
//! space of J. All legs together allow the null space of these rows. Motions without effect on
//! shared components, such as the rotation of a platform that is a point, are not counted.
//!
//! Every leg follows the described motion, so the allowed motions contain it. The two are equal if
//! their dimensions are. Let the legs allow L motions, more than the r described ones.
//!
//! - If the actuators drive all L motions, the robot has L degrees of freedom, even if its
//!   controller uses only r of them. Of its n torques, n - L are internal, not n - r. Least-norm
//!   torques and preloads of the described robot would then move the platform in the other L - r
//!   directions. Gravity and inertia in these directions need torques that the model lacks. This
//!   holds for n > L too, because the same actuators move and hold the platform. Such a description
//!   is an error.
//! - Otherwise the legs are rods that replace parallelograms, or the platform is loose. The
//!   description cannot distinguish the two. It is accepted, since the former is the usual
//!   description of a Delta.

use super::numeric::{platform_frame, target};
use super::singular_values::{SingularValues, rank};
use super::{End, JointKind, Leg, Mechanism, Motion, TwistCoordinate};
use nalgebra::{DMatrix, Matrix3};

/// Motions that the legs allow the platform at a configuration.
#[derive(Debug)]
pub(super) struct Mobility {
    /// Allowed twists, as columns.
    pub(super) allowed: DMatrix<f64>,
    /// Shared velocities of all legs per twist.
    felt: DMatrix<f64>,
    /// Rank of the blocked directions.
    pub(super) blocked: usize,
}

/// Singular values, of matrices with entries of order one, up to which they count as zero.
const ROUNDING: f64 = 1e-7;

impl Mobility {
    /// The allowed motions at home, where the legs close, with lengths relative to the robot's
    /// size.
    ///
    /// `None` for a robot without a platform and for values that are not finite.
    pub(super) fn at_home(mechanism: &Mechanism) -> Option<Self> {
        let home = &mechanism.home;
        Self::at(mechanism, &home.pose, &home.joints)
    }

    /// The allowed motions at a pose and joint positions that close the legs.
    pub(super) fn at(mechanism: &Mechanism, pose: &[f64], joints: &[f64]) -> Option<Self> {
        let platform = mechanism.platform.as_ref()?;
        let size = mechanism.length_scale();
        let mut constraints = DMatrix::zeros(0, 6);
        let mut felt = DMatrix::zeros(0, 6);
        for (index, leg) in mechanism.legs.iter().enumerate() {
            let end = leg.end.as_ref()?;
            let arms = end_velocities(platform.motion, pose, end, size);
            if leg.cable.is_some() {
                // A cable blocks nothing, since it may pay out.
                felt = stacked(&felt, &arms);
                continue;
            }
            let jacobian = scaled_jacobian(leg, &joints[mechanism.leg_range(index)], size);
            // The left null space is the null space of the transpose.
            let free = SingularValues::new(&jacobian.transpose())?;
            let null = free.null_space(ROUNDING * free.largest());
            constraints = stacked(&constraints, &(null.transpose() * &arms));
            felt = stacked(&felt, &arms);
        }
        let found = SingularValues::new(&constraints)?;
        Some(Self {
            allowed: found.null_space(ROUNDING),
            blocked: found.rank(ROUNDING),
            felt,
        })
    }

    /// Number of independent motions that the legs allow.
    pub(super) fn count(&self) -> usize {
        rank(&(&self.felt * &self.allowed), ROUNDING)
    }

    /// Component of each of six directions, three along and three about the axes, in the allowed
    /// motions.
    pub(super) fn parts(&self) -> [f64; 6] {
        let felt = &self.felt * &self.allowed;
        let Some(found) = SingularValues::new(&felt) else {
            return [0.0; 6];
        };
        // Motions without effect on shared components are left out.
        let none = found.null_space(ROUNDING);
        let kept = &self.allowed - (&self.allowed * &none) * none.transpose();
        std::array::from_fn(|row| kept.row(row).norm())
    }

    /// Number of coordinates of the described motion that the legs allow.
    pub(super) fn of(&self, motion: Motion) -> usize {
        let wanted = directions(motion);
        // Dimension of the intersection: dim A + dim B - dim (A + B).
        let both =
            DMatrix::from_fn(
                6,
                self.allowed.ncols() + wanted.ncols(),
                |row, column| match column.checked_sub(self.allowed.ncols()) {
                    None => self.allowed[(row, column)],
                    Some(column) => wanted[(row, column)],
                },
            );
        self.allowed.ncols() + wanted.ncols() - rank(&both, ROUNDING)
    }

    /// Number of allowed motions that the actuators determine.
    pub(super) fn driven(&self, mechanism: &Mechanism) -> usize {
        let home = &mechanism.home;
        let size = mechanism.length_scale();
        let rates = |(index, leg): (usize, &Leg)| -> Option<DMatrix<f64>> {
            let range = mechanism.leg_range(index);
            let platform = mechanism.platform.as_ref()?;
            let arms = end_velocities(platform.motion, &home.pose, leg.end.as_ref()?, size);
            if leg.cable.is_some() {
                let row = mechanism.cable_row(index, &home.pose, &home.joints)?;
                return Some(row * arms * &self.allowed);
            }
            let jacobian = scaled_jacobian(leg, &home.joints[range], size);
            let found = SingularValues::new(&jacobian)?;
            Some(found.pseudo_inverse(ROUNDING * found.largest()) * arms * &self.allowed)
        };
        let mut all = DMatrix::zeros(0, self.allowed.ncols());
        for leg in mechanism.legs.iter().enumerate() {
            let Some(rates) = rates(leg) else { return 0 };
            all = stacked(&all, &rates);
        }
        rank(&mechanism.actuator_rows(&all), ROUNDING)
    }
}

/// The shared velocities of a leg's end per twist of the platform as a free body.
pub(super) fn end_velocities(motion: Motion, pose: &[f64], end: &End, size: f64) -> DMatrix<f64> {
    let frame = platform_frame(motion, pose);
    let arm = (target(end, &frame).translation.vector - frame.translation.vector) / size;
    let mut all = DMatrix::identity(6, 6);
    // v + ω × arm.
    let turned: Matrix3<f64> = -arm.cross_matrix();
    all.view_mut((0, 3), (3, 3)).copy_from(&turned);
    all.select_rows(&end.shared_components())
}

/// A leg's closure Jacobian with lengths in units of `size`.
fn scaled_jacobian(leg: &Leg, joints: &[f64], size: f64) -> DMatrix<f64> {
    let mut jacobian = leg.closure_jacobian(joints);
    for (mut row, component) in jacobian.row_iter_mut().zip(leg.shared_components()) {
        if component < 3 {
            row /= size;
        }
    }
    for (mut column, joint) in jacobian.column_iter_mut().zip(leg.independent()) {
        if leg.joints[joint].kind == JointKind::Prismatic {
            column *= size;
        }
    }
    jacobian
}

/// Twists of a motion, as columns.
fn directions(motion: Motion) -> DMatrix<f64> {
    let twist = motion.twist();
    let row = |coordinate: &TwistCoordinate| match coordinate {
        TwistCoordinate::Linear(axis) => *axis,
        TwistCoordinate::Angular(axis) => 3 + axis,
    };
    DMatrix::from_fn(6, twist.len(), |r, c| {
        f64::from(u8::from(row(&twist[c]) == r))
    })
}

/// Stacks two matrices vertically.
pub(super) fn stacked(above: &DMatrix<f64>, below: &DMatrix<f64>) -> DMatrix<f64> {
    DMatrix::from_fn(
        above.nrows() + below.nrows(),
        above.ncols(),
        |row, column| match row.checked_sub(above.nrows()) {
            None => above[(row, column)],
            Some(row) => below[(row, column)],
        },
    )
}
