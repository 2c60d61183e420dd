//! The platform's pose, twist t = D v and acceleration as vectors in the base frame, eq. (14).
//!
//! For a chain of a skeleton, the platform is the chain's end body, relative to the body at its
//! start.

use super::orientation::constant_rotation;
use super::path::Path;
use super::spatial::{SpatialMotion, Wrench};
use crate::cas::{Arena, CosineSine, Expr, Matrix3, Number, Vector3};
use crate::mechanism::{Motion, Placement, TwistCoordinate};

/// Position and orientation of the platform frame in the base frame.
#[derive(Debug, Clone)]
pub struct PlatformPose<'a> {
    arena: &'a Arena,
    directions: Directions<'a>,
    /// Origin, m.
    pub origin: Vector3<'a>,
    /// Orientation.
    pub rotation: Matrix3<'a>,
}

/// Directions in which the independent coordinates move the platform: the columns of D.
#[derive(Debug, Clone)]
pub(crate) enum Directions<'a> {
    /// Along and about axes of the base frame.
    Axes(Motion),
    /// By the joints on the path to a body.
    Joints(Box<Path<'a>>),
}

impl<'a> Directions<'a> {
    /// Components on the independent coordinates of a force at `arm` from the platform's origin and
    /// a moment.
    pub(crate) fn components(&self, arm: Vector3<'a>, wrench: Wrench<'a>) -> Vec<Expr<'a>> {
        match self {
            Self::Axes(motion) => on_twist(&motion.twist(), arm, wrench),
            Self::Joints(path) => {
                let Wrench { force, moment } = wrench;
                let about_origin = arm.cross(force) + moment;
                let columns = path.columns.iter();
                columns
                    .map(|c| c.linear.dot(force) + c.angular.dot(about_origin))
                    .collect()
            }
        }
    }

    /// Transforms the motions of the end body of a path to those of other coordinates.
    pub(crate) fn project(
        &mut self,
        project: &dyn Fn(&[SpatialMotion<'a>]) -> Vec<SpatialMotion<'a>>,
    ) {
        if let Self::Joints(path) = self {
            path.columns = project(&path.columns);
        }
    }

    /// Velocity of the point at `arm` and angular velocity, per independent rate.
    pub(crate) fn columns(&self, arena: &'a Arena, arm: Vector3<'a>) -> Vec<SpatialMotion<'a>> {
        let (unit, zero) = (
            |axis: usize| Vector3::unit(arena, axis),
            Vector3::zero(arena),
        );
        match self {
            Self::Axes(motion) => {
                let column = |c: &TwistCoordinate| match c {
                    TwistCoordinate::Linear(axis) => SpatialMotion {
                        linear: unit(*axis),
                        angular: zero,
                    },
                    TwistCoordinate::Angular(axis) => SpatialMotion {
                        linear: unit(*axis).cross(arm),
                        angular: unit(*axis),
                    },
                };
                motion.twist().iter().map(column).collect()
            }
            Self::Joints(path) => {
                let column = |own: &SpatialMotion<'a>| SpatialMotion {
                    linear: own.linear_at(arm),
                    angular: own.angular,
                };
                path.columns.iter().map(column).collect()
            }
        }
    }
}

/// Velocity and acceleration of the platform.
#[derive(Debug, Clone)]
pub struct PlatformMotion<'a> {
    /// Velocity of the origin, m/s.
    pub velocity: Vector3<'a>,
    /// Angular velocity, rad/s.
    pub angular_velocity: Vector3<'a>,
    /// Acceleration of the origin, m/s².
    pub acceleration: Vector3<'a>,
    /// Angular acceleration, rad/s².
    pub angular_acceleration: Vector3<'a>,
    /// `([ω̇]× + [ω]×[ω]×) R` if the platform rotates about more than one axis.
    ///
    /// Its columns are also the forces of the first moments.
    pub centripetal: Option<Matrix3<'a>>,
}

/// Components on the twist coordinates of a force at `arm` from the platform's origin and a moment.
pub(crate) fn on_twist<'a>(
    twist: &[TwistCoordinate],
    arm: Vector3<'a>,
    wrench: Wrench<'a>,
) -> Vec<Expr<'a>> {
    let Wrench { force, moment } = wrench;
    let turned = arm.cross(force) + moment;
    let entry = |c: &TwistCoordinate| match c {
        TwistCoordinate::Linear(axis) => force.0[*axis],
        TwistCoordinate::Angular(axis) => turned.0[*axis],
    };
    twist.iter().map(entry).collect()
}

impl<'a> PlatformPose<'a> {
    /// The pose as inputs `pose[i]`, except for coordinates that are known to be zero.
    #[must_use]
    pub fn new(arena: &'a Arena, motion: Motion, still: &[usize]) -> Self {
        let zero = arena.zero();
        let count = motion.pose_coordinates().len();
        let input = |i: usize| {
            if still.contains(&i) {
                zero
            } else {
                arena.input("pose", i)
            }
        };
        let mut origin = [zero; 3];
        for (i, coordinate) in motion.twist().iter().enumerate() {
            if let TwistCoordinate::Linear(axis) = coordinate {
                origin[*axis] = input(i);
            }
        }
        let mut rotation = Matrix3::identity(arena);
        if let Some(axis) = motion.rotation_axis() {
            let phi = arena.input_angle("pose", count - 1);
            let CosineSine { cosine, sine } = arena.cosine_and_sine(&phi);
            rotation = Matrix3::rotation(axis, cosine.named("c_phi"), sine.named("s_phi"));
        } else if motion.has_quaternion() {
            rotation = quaternion_rotation(std::array::from_fn(|i| input(count - 4 + i)));
        }
        Self {
            arena,
            directions: Directions::Axes(motion),
            origin: Vector3(origin),
            rotation,
        }
    }

    /// The body at the end of a path.
    #[must_use]
    pub(crate) fn on_body(arena: &'a Arena, path: Path<'a>) -> Self {
        Self {
            arena,
            origin: path.origin,
            rotation: path.rotation,
            directions: Directions::Joints(Box::new(path)),
        }
    }

    /// Transforms the motions of the end body of a path to those of other coordinates.
    pub(crate) fn project_directions(
        &mut self,
        project: &dyn Fn(&[SpatialMotion<'a>]) -> Vec<SpatialMotion<'a>>,
    ) {
        self.directions.project(project);
    }

    /// Directions in which the independent coordinates move the platform.
    pub(crate) const fn directions(&self) -> &Directions<'a> {
        &self.directions
    }

    /// Vector from the platform's origin to a platform point, in the base frame.
    #[must_use]
    pub fn arm(&self, at: [Number; 3]) -> Vector3<'a> {
        self.rotation * Vector3::constant(self.arena, at)
    }

    /// A row of the six-vector (Ṗ, ω) of a platform point, per independent coordinate.
    #[must_use]
    pub(crate) fn row(&self, at: [Number; 3], row: usize) -> Vec<Expr<'a>> {
        let columns = self.directions.columns(self.arena, self.arm(at));
        columns.iter().map(|c| c.component(row)).collect()
    }

    /// Orientation of a frame that is fixed on the platform.
    #[must_use]
    pub fn orientation(&self, placement: &Placement) -> Matrix3<'a> {
        self.rotation * constant_rotation(self.arena, placement.rotation)
    }

    /// Velocities and accelerations from the twist coordinates v and their derivatives.
    ///
    /// For the end body of a path, from the quasi-velocities of all legs before, leg by leg.
    #[must_use]
    pub fn motion(&self, twist: &[Expr<'a>], acceleration: &[Expr<'a>]) -> PlatformMotion<'a> {
        let own = match &self.directions {
            Directions::Axes(motion) => motion,
            Directions::Joints(path) => return self.motion_along(path, twist, acceleration),
        };
        let spread = |values: &[Expr<'a>]| {
            let mut linear = Vector3::zero(self.arena);
            let mut angular = linear;
            for (coordinate, &value) in own.twist().iter().zip(values) {
                match coordinate {
                    TwistCoordinate::Linear(axis) => linear.0[*axis] = value,
                    TwistCoordinate::Angular(axis) => angular.0[*axis] = value,
                }
            }
            (linear, angular)
        };
        let (velocity, angular_velocity) = spread(twist);
        let (linear_acceleration, angular_acceleration) = spread(acceleration);
        let turns_freely = own.has_quaternion();
        let centripetal = turns_freely
            .then(|| centripetal(angular_velocity, angular_acceleration) * self.rotation);
        PlatformMotion {
            centripetal,
            velocity,
            angular_velocity,
            acceleration: linear_acceleration,
            angular_acceleration,
        }
    }

    /// Motion of the end body of a path.
    fn motion_along(
        &self,
        path: &Path<'a>,
        rates: &[Expr<'a>],
        accelerations: &[Expr<'a>],
    ) -> PlatformMotion<'a> {
        let moved = path.motion(rates, accelerations);
        PlatformMotion {
            centripetal: path
                .turns_freely()
                .then(|| centripetal(moved.omega, moved.alpha) * self.rotation),
            velocity: moved.velocity,
            angular_velocity: moved.omega,
            acceleration: moved.acceleration,
            angular_acceleration: moved.alpha,
        }
    }
}

impl<'a> PlatformMotion<'a> {
    /// Velocity of the point at `arm` from the origin.
    #[must_use]
    pub(crate) fn point_velocity(&self, arm: Vector3<'a>) -> Vector3<'a> {
        self.velocity + self.angular_velocity.cross(arm)
    }

    /// Acceleration of the platform point `at` (platform frame), which is at `arm` from the origin.
    #[must_use]
    pub fn point_acceleration(&self, at: [Number; 3], arm: Vector3<'a>) -> Vector3<'a> {
        if let Some(matrix) = self.centripetal {
            let at = Vector3::constant(self.acceleration.x().arena(), at);
            return self.acceleration + matrix * at;
        }
        let omega = self.angular_velocity;
        self.acceleration + self.angular_acceleration.cross(arm) + omega.cross(omega.cross(arm))
    }
}

/// `[ω̇]× + [ω]×[ω]×`, with shared products ω_i ω_j.
#[must_use]
pub fn centripetal<'a>(omega: Vector3<'a>, alpha: Vector3<'a>) -> Matrix3<'a> {
    let ([x, y, z], [ax, ay, az]) = (omega.0, alpha.0);
    let (xx, yy, zz) = (x * x, y * y, z * z);
    let (xy, xz, yz) = (x * y, x * z, y * z);
    Matrix3([
        [-(yy + zz), xy - az, xz + ay],
        [xy + az, -(xx + zz), yz - ax],
        [xz - ay, yz + ax, -(xx + yy)],
    ])
}

/// The rotation matrix of a unit quaternion (w, x, y, z).
fn quaternion_rotation(quaternion: [Expr<'_>; 4]) -> Matrix3<'_> {
    let [w, x, y, z] = quaternion;
    let arena = w.arena();
    let (one, two) = (arena.one(), arena.integer(2));
    let (x2, y2, z2) = (two * x, two * y, two * z);
    Matrix3([
        [one - y2 * y - z2 * z, x2 * y - z2 * w, x2 * z + y2 * w],
        [x2 * y + z2 * w, one - x2 * x - z2 * z, y2 * z - x2 * w],
        [x2 * z - y2 * w, y2 * z + x2 * w, one - x2 * x - y2 * y],
    ])
}
