//! Platform motions: pose coordinates, twist coordinates and the matrix D of (14).
//!
//! The twist t holds the linear velocity of the platform's origin and the angular velocity, both
//! in the base frame. The free coordinates v give it by t = D v. D is constant for every motion
//! here, so the derivative of the twist is D v̇.

use super::placement::{Frame, logarithm};
use nalgebra::{DMatrix, DVector, Quaternion, Rotation3, UnitQuaternion, Vector3, Vector6};

/// Free motions of the platform.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Motion {
    /// No platform: a serial or tree robot. Pose and twist coordinates are the joints'.
    None,
    /// No platform, but chains between bodies of a tree with this number of independent joints,
    /// which come first. Pose and twist coordinates are theirs.
    Joints(usize),
    /// Translation along a fixed axis. Pose: the distance from a point of it.
    Slide {
        /// Point of the axis.
        point: Vector3<f64>,
        /// Unit direction of the axis.
        direction: Vector3<f64>,
    },
    /// Rotation about a fixed axis through a point, where the platform's origin stays. Pose: angle.
    Hinge {
        /// Point of the axis.
        point: Vector3<f64>,
        /// Unit direction of the axis.
        direction: Vector3<f64>,
    },
    /// A point in the plane normal to a coordinate axis. Pose: the two coordinates after it in cyclic
    /// order, x, y for z.
    Point(usize),
    /// Motion in the plane normal to a coordinate axis. Pose: the same, and φ about the axis.
    Planar(usize),
    /// Translations. Pose: x, y, z.
    Translation,
    /// Translations and rotation about a coordinate axis. Pose: x, y, z, φ.
    Schoenflies(usize),
    /// Rotations about the base origin. Pose: unit quaternion w, x, y, z.
    Spherical,
    /// Any motion. Pose: x, y, z and unit quaternion w, x, y, z.
    Spatial,
    /// Motion of a free body that its legs restrict: the independent components among six. Pose: as
    /// for any motion.
    Parasitic([bool; 6]),
}

impl Motion {
    /// Number of free coordinates; 0 without a platform.
    #[must_use]
    pub fn dof(&self) -> usize {
        match self {
            Self::Joints(count) => *count,
            _ => self.twist_basis().ncols(),
        }
    }

    /// Whether there is a platform.
    #[must_use]
    pub const fn has_platform(&self) -> bool {
        !matches!(self, Self::None | Self::Joints(_))
    }

    /// Matrix D of t = D v, 6 x r (14).
    #[must_use]
    pub fn twist_basis(&self) -> DMatrix<f64> {
        let rows: Vec<usize> = match self {
            Self::None | Self::Joints(_) => Vec::new(),
            Self::Slide { direction, .. } => return column(*direction, Vector3::zeros()),
            Self::Hinge { direction, .. } => return column(Vector3::zeros(), *direction),
            Self::Point(axis) => plane(*axis).to_vec(),
            Self::Planar(axis) => [&plane(*axis)[..], &[3 + axis]].concat(),
            Self::Translation => (0..3).collect(),
            Self::Schoenflies(axis) => vec![0, 1, 2, 3 + axis],
            Self::Spherical => (3..6).collect(),
            Self::Spatial => (0..6).collect(),
            Self::Parasitic(_) => self.independent(),
        };
        let mut basis = DMatrix::zeros(6, rows.len());
        for (at, &row) in rows.iter().enumerate() {
            basis[(row, at)] = 1.0;
        }
        basis
    }

    /// Placement of the platform frame in the base frame.
    #[must_use]
    pub fn placement(&self, pose: &[f64]) -> Frame {
        match *self {
            Self::None | Self::Joints(_) => Frame::identity(),
            Self::Slide { point, direction } => still(point + direction * pose[0]),
            Self::Hinge { point, direction } => {
                Frame::new(Rotation3::new(direction * pose[0]).into_inner(), point)
            }
            Self::Point(axis) => still(in_plane(axis, pose)),
            Self::Planar(axis) => still(in_plane(axis, pose)) * about(axis, pose[2]),
            Self::Translation => Frame::at(pose[0], pose[1], pose[2]),
            Self::Schoenflies(axis) => Frame::at(pose[0], pose[1], pose[2]) * about(axis, pose[3]),
            Self::Spherical => Frame::new(orientation(pose).into_inner(), Vector3::zeros()),
            Self::Spatial | Self::Parasitic(_) => Frame::new(
                orientation(&pose[3..]).into_inner(),
                Vector3::new(pose[0], pose[1], pose[2]),
            ),
        }
    }

    /// Pose after a displacement given in twist coordinates.
    ///
    /// A rotation displacement is a rotation vector in the base frame, applied after the pose.
    #[must_use]
    pub fn displace(&self, pose: &[f64], displacement: &DVector<f64>) -> Vec<f64> {
        let turn_at = match self {
            Self::Spherical => 0,
            Self::Spatial => 3,
            // Displacement of the independent components, or of all six.
            Self::Parasitic(_) if displacement.len() < 6 => {
                let whole = self.twist_basis() * displacement;
                return Self::Spatial.displace(pose, &whole);
            }
            Self::Parasitic(_) => 3,
            _ => {
                return pose
                    .iter()
                    .zip(displacement)
                    .map(|(x, dx)| x + dx)
                    .collect();
            }
        };
        let turn = UnitQuaternion::new(Vector3::new(
            displacement[turn_at],
            displacement[turn_at + 1],
            displacement[turn_at + 2],
        ));
        let turned = turn * UnitQuaternion::new_normalize(quaternion(&pose[turn_at..]));
        let mut moved: Vec<f64> = (0..turn_at)
            .map(|axis| pose[axis] + displacement[axis])
            .collect();
        moved.extend([turned.w, turned.i, turned.j, turned.k]);
        moved
    }

    /// Independent components of a platform with parasitic motion; empty for others.
    #[must_use]
    pub fn independent(&self) -> Vec<usize> {
        match self {
            Self::Parasitic(own) => (0..6).filter(|&at| own[at]).collect(),
            _ => Vec::new(),
        }
    }

    /// Basis for the projection of the platform's wrench: D of (14), or all six components with
    /// parasitic motion.
    #[must_use]
    pub fn free_basis(&self) -> DMatrix<f64> {
        match self {
            Self::Parasitic(_) => Self::Spatial.twist_basis(),
            _ => self.twist_basis(),
        }
    }

    /// Displacement from one pose to another, in twist coordinates; with parasitic motion in all
    /// six components.
    #[must_use]
    pub fn displacement(&self, from: &[f64], to: &[f64]) -> DVector<f64> {
        if !self.has_platform() {
            return DVector::from_iterator(from.len(), to.iter().zip(from).map(|(b, a)| b - a));
        }
        let (a, b) = (self.placement(from), self.placement(to));
        let shift = b.position - a.position;
        let turn = logarithm(&(b.rotation * a.rotation.transpose()));
        let both = Vector6::new(shift.x, shift.y, shift.z, turn.x, turn.y, turn.z);
        self.free_basis().transpose() * both
    }
}

/// The two coordinate axes after `axis` in cyclic order.
fn plane(axis: usize) -> [usize; 2] {
    [(axis + 1) % 3, (axis + 2) % 3]
}

fn in_plane(axis: usize, pose: &[f64]) -> Vector3<f64> {
    let mut point = Vector3::zeros();
    for (of, value) in plane(axis).into_iter().zip(pose) {
        point[of] = *value;
    }
    point
}

fn still(position: Vector3<f64>) -> Frame {
    Frame::new(Frame::identity().rotation, position)
}

fn about(axis: usize, angle: f64) -> Frame {
    let mut turn = Vector3::zeros();
    turn[axis] = angle;
    Frame::new(Rotation3::new(turn).into_inner(), Vector3::zeros())
}

fn column(linear: Vector3<f64>, angular: Vector3<f64>) -> DMatrix<f64> {
    let entries = linear.iter().chain(angular.iter()).copied();
    DMatrix::from_iterator(6, 1, entries)
}

fn quaternion(pose: &[f64]) -> Quaternion<f64> {
    Quaternion::new(pose[0], pose[1], pose[2], pose[3])
}

/// Rotation of a unit quaternion, which is not normalised here.
fn orientation(pose: &[f64]) -> Rotation3<f64> {
    UnitQuaternion::new_unchecked(quaternion(pose)).to_rotation_matrix()
}
