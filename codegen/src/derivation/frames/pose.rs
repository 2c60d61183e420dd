//! Position and orientation of a frame.
//!
//! The orientation is a unit quaternion. Its sign changes continuously with the pose:
//!
//! - on a platform with a quaternion, it is that quaternion times a constant one;
//! - on a platform that turns about one axis, and on bodies whose joints are inputs, it is composed
//!   from sines and cosines of half angles, without a root. A full turn of a joint changes its sign;
//! - on other bodies of loops, sines and cosines of the joints follow from the closures. The
//!   quaternion follows from the rotation matrix, on the side of that at home. It has no value half
//!   a turn from home.
//!
//! Where half angles are needed, all sines and cosines follow from theirs, so that each joint has
//! one trigonometric pair.

use super::Carrier;
use crate::cas::{CosineSine, Expr, Matrix3, Vector3};
use crate::derivation::guard::{Guard, GuardKind};
use crate::derivation::kinematics::configuration::Configuration;
use crate::derivation::kinematics::orientation::Orientation;
use crate::derivation::kinematics::path::{antecedent, link_from_body, orientation, way};
use crate::derivation::kinematics::quaternion::{ConstantQuaternion, Quaternion, half};
use crate::derivation::robot::Robot;
use crate::mechanism::{BodyIndex, Frame, Placement};
use nalgebra::{Matrix3 as NumericMatrix, Rotation3, UnitQuaternion};

/// Pose of a frame.
pub(crate) struct FramePose<'a> {
    /// Position, then the quaternion, w first.
    pub(crate) entries: Vec<Expr<'a>>,
    /// Condition for the quaternion to have a value.
    pub(crate) guard: Option<Guard<'a>>,
}

impl<'a> Robot<'a> {
    /// The pose of a frame in the description's base frame.
    ///
    /// `None` if the configuration does not determine a sine or cosine, or a constant overflows.
    pub(crate) fn frame_pose(&self, frame: &Frame) -> Option<FramePose<'a>> {
        let (position, quaternion, guard) = match Carrier::of(self.mechanism, frame) {
            Carrier::Platform(placements) => {
                let (position, quaternion) = self.pose_on_platform(&placements)?;
                (position, quaternion, None)
            }
            Carrier::Joint(body, placement) => self.pose_on_joint(body, placement)?,
        };
        let position = position + Vector3::constant(self.arena, self.mechanism.origin);
        let entries = position.0.into_iter().chain(quaternion.0);
        Some(FramePose {
            entries: entries.collect(),
            guard,
        })
    }

    /// Position and quaternion of a frame on the platform.
    fn pose_on_platform(&self, placements: &[&Placement]) -> Option<(Vector3<'a>, Quaternion<'a>)> {
        let platform = self.platform.as_ref()?;
        let motion = self.mechanism.platform.as_ref()?.motion;
        let count = self.mechanism.pose_len();
        let mut rotation = platform.rotation;
        let mut quaternion = Quaternion::one(self.arena);
        if let Some(axis) = motion.rotation_axis() {
            let angle = self.arena.input_angle("pose", count - 1);
            let half = self.arena.cosine_and_sine(&angle.times(half())?);
            let CosineSine { cosine, sine } = half.doubled();
            rotation = Matrix3::rotation(axis, cosine, sine);
            quaternion = Quaternion::about(axis, half);
        } else if motion.of_pose().has_quaternion() {
            quaternion = Quaternion(std::array::from_fn(|k| self.pose_entry(count - 4 + k)));
        }
        let position = platform.origin + rotation * self.point(placements);
        for placement in placements {
            quaternion = quaternion.times(&self.constant_quaternion(placement)?);
        }
        Some((position, quaternion))
    }

    /// An element of the pose; zero if the closures keep it at zero.
    fn pose_entry(&self, index: usize) -> Expr<'a> {
        if self.mechanism.still.contains(&index) {
            self.arena.zero()
        } else {
            self.arena.input("pose", index)
        }
    }

    fn constant_quaternion(&self, placement: &Placement) -> Option<Quaternion<'a>> {
        let ConstantQuaternion { factor, quaternion } =
            ConstantQuaternion::new(self.arena, placement.rotation)?;
        let factor = self.arena.number(factor);
        Some(Quaternion(quaternion.0.map(|entry| entry * factor)))
    }

    /// Position and quaternion of a frame on a body that joints move.
    fn pose_on_joint(
        &self,
        body: BodyIndex,
        placement: &Placement,
    ) -> Option<(Vector3<'a>, Quaternion<'a>, Option<Guard<'a>>)> {
        let by_halves = self.configuration.with_half_angles();
        let own = Orientation::fixed(placement.rotation);
        let whole = |configuration: &Configuration<'a>| {
            orientation(self.mechanism, configuration, Some(body))?.followed_by(&own)
        };
        if let Some(quaternion) = whole(&by_halves)?.quaternion(self.arena, &by_halves) {
            let position = self.frame_position(body, placement, &by_halves)?;
            return Some((position, quaternion, None));
        }
        let position = self.frame_position(body, placement, &self.configuration)?;
        let base = Orientation::default();
        let rotation =
            whole(&self.configuration)?.relative(&base, self.arena, &self.configuration)?;
        let at_home = rotation.0.map(|row| row.map(|entry| self.at_home(entry)));
        let at_home = NumericMatrix::from_fn(|i, j| at_home[i][j]);
        let at_home = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix(&at_home));
        let reference = [at_home.w, at_home.i, at_home.j, at_home.k];
        let leg = &self.mechanism.legs[body.leg].name;
        self.arena.enter(leg);
        let (quaternion, length) = Quaternion::near(&rotation, reference);
        self.arena.enter("");
        let guard = Guard {
            value: length,
            kind: GuardKind::Leg(self.at_home(length).abs()),
            leg: leg.clone(),
        };
        Some((position, quaternion, Some(guard)))
    }

    /// The origin of a frame on a body that joints move.
    fn frame_position(
        &self,
        body: BodyIndex,
        placement: &Placement,
        configuration: &Configuration<'a>,
    ) -> Option<Vector3<'a>> {
        let of = |body| orientation(self.mechanism, configuration, body);
        let mut terms = vec![(of(Some(body))?, Vector3::constant(self.arena, placement.at))];
        for (at, _) in way(self.mechanism, None, Some(body)) {
            let link = link_from_body(self.arena, self.mechanism, configuration, at)?;
            terms.push((of(antecedent(self.mechanism, at))?, link));
        }
        Orientation::rotated_sum(&terms, self.arena, configuration)
    }
}
