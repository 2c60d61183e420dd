//! Motions of a platform, their coordinates x and their twists t = D v, eq. (14).
//!
//! The twist is the velocity of the platform's origin and its angular velocity, both in the base
//! frame. Every independent coordinate v moves the platform along a constant direction of that
//! six-vector, so D is constant with one unit column per coordinate. For parasitic motion
//! (`parasitic`), the legs' closures add entries that change with the pose. Orientations in space
//! are unit quaternions (w, x, y, z), which have no representation singularity; their v is the
//! angular velocity.

use super::model::Motion;

/// An independent coordinate of the twist: a unit column of D.
///
/// For parasitic motion, it is the unit entry of the column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TwistCoordinate {
    /// Velocity of the platform's origin along a coordinate axis, m/s.
    Linear(usize),
    /// Angular velocity about a coordinate axis, rad/s.
    Angular(usize),
}

const AXES: [&str; 3] = ["x", "y", "z"];

impl Motion {
    /// The two axes of the plane normal to `axis`, in right-handed order.
    const fn plane(axis: usize) -> [usize; 2] {
        [(axis + 1) % 3, (axis + 2) % 3]
    }

    /// The independent twist coordinates v.
    #[must_use]
    pub fn twist(self) -> Vec<TwistCoordinate> {
        use TwistCoordinate::{Angular, Linear};
        match self {
            Self::FixedAxis { axis } => vec![Linear(axis)],
            Self::Rotation { axis } => vec![Angular(axis)],
            Self::Point { axis } => Self::plane(axis).map(Linear).to_vec(),
            Self::Planar { axis } => {
                let [a, b] = Self::plane(axis);
                vec![Linear(a), Linear(b), Angular(axis)]
            }
            Self::Translation => (0..3).map(Linear).collect(),
            Self::Schoenflies { axis } => (0..3).map(Linear).chain([Angular(axis)]).collect(),
            Self::Spherical => (0..3).map(Angular).collect(),
            Self::Spatial => (0..3).map(Linear).chain((0..3).map(Angular)).collect(),
            Self::Parasitic { independent } => {
                let all = Self::Spatial.twist().into_iter().zip(independent);
                all.filter_map(|(coordinate, is_own)| is_own.then_some(coordinate))
                    .collect()
            }
        }
    }

    /// Names of the numbers in a pose.
    #[must_use]
    pub fn pose_coordinates(self) -> Vec<&'static str> {
        const QUATERNION: [&str; 4] = ["qw", "qx", "qy", "qz"];
        match self {
            Self::FixedAxis { axis } => vec![AXES[axis]],
            Self::Rotation { .. } => vec!["phi"],
            Self::Point { axis } => Self::plane(axis).map(|a| AXES[a]).to_vec(),
            Self::Planar { axis } => {
                let [a, b] = Self::plane(axis);
                vec![AXES[a], AXES[b], "phi"]
            }
            Self::Translation => AXES.to_vec(),
            Self::Schoenflies { .. } => vec!["x", "y", "z", "phi"],
            Self::Spherical => QUATERNION.to_vec(),
            Self::Spatial | Self::Parasitic { .. } => AXES.into_iter().chain(QUATERNION).collect(),
        }
    }

    /// Names of the twist coordinates.
    #[must_use]
    pub fn twist_names(self) -> Vec<String> {
        let name = |c: &TwistCoordinate| match c {
            TwistCoordinate::Linear(a) => format!("v_{}", AXES[*a]),
            TwistCoordinate::Angular(a) => format!("omega_{}", AXES[*a]),
        };
        self.twist().iter().map(name).collect()
    }

    /// The axis of the only rotation, for motions whose orientation is one angle `phi`.
    #[must_use]
    pub const fn rotation_axis(self) -> Option<usize> {
        match self {
            Self::Rotation { axis } | Self::Planar { axis } | Self::Schoenflies { axis } => {
                Some(axis)
            }
            _ => None,
        }
    }

    /// Whether the orientation is a quaternion.
    #[must_use]
    pub const fn has_quaternion(self) -> bool {
        matches!(
            self,
            Self::Spherical | Self::Spatial | Self::Parasitic { .. }
        )
    }
}
