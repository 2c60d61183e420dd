//! Numeric kinematics: positions, orientations and Jacobians in floating point, for the checks at
//! the home configuration that precede the derivation.

use super::{BodyIndex, End, Joint, JointKind, Leg, Mechanism, Motion, Placement};
use nalgebra::{
    DMatrix, DVector, Isometry3, Quaternion, Rotation3, Translation3, UnitQuaternion, Vector3,
};

/// Rotation about the z axis as a displacement.
fn turn_z(angle: f64) -> Isometry3<f64> {
    Isometry3::rotation(Vector3::z() * angle)
}

fn shift(x: f64, z: f64) -> Isometry3<f64> {
    Isometry3::translation(x, 0.0, z)
}

/// The placement as a displacement in floating point.
#[must_use]
pub fn placement_isometry(placement: &Placement) -> Isometry3<f64> {
    let [rx, ry, rz] = placement.rotation.map(crate::cas::Angle::value);
    let rotation = Rotation3::from_euler_angles(rx, ry, rz);
    let [x, y, z] = placement.at.map(crate::cas::Number::value);
    Isometry3::from_parts(Translation3::new(x, y, z), UnitQuaternion::from(rotation))
}

impl Joint {
    /// Displacement from the antecedent frame to the joint's frame, for joint position `q`.
    fn displacement(&self, q: f64) -> Isometry3<f64> {
        let (theta, r) = match self.kind {
            JointKind::Revolute => (self.theta.value() + q, self.r.value()),
            JointKind::Prismatic => (self.theta.value(), self.r.value() + q),
            JointKind::Fixed => (self.theta.value(), self.r.value()),
        };
        turn_z(self.gamma.value())
            * shift(0.0, self.b.value())
            * Isometry3::rotation(Vector3::x() * self.alpha.value())
            * shift(self.d.value(), 0.0)
            * turn_z(theta)
            * shift(0.0, r)
    }
}

impl Leg {
    /// Frames of all joints in the robot's base frame; `q` holds the independent joint positions.
    #[must_use]
    pub fn frames(&self, q: &[f64]) -> Vec<Isometry3<f64>> {
        let independent: Vec<usize> = self.independent().collect();
        let position = |joint: &Joint| -> f64 {
            let parts = joint.variable.iter().map(|(of, factor)| {
                let at = independent.iter().position(|i| i == of);
                at.map_or(0.0, |at| q[at]) * factor.value()
            });
            parts.sum()
        };
        let mut frames: Vec<Isometry3<f64>> = Vec::new();
        for joint in &self.joints {
            let from = joint
                .antecedent
                .map_or_else(|| placement_isometry(&self.base), |a| frames[a]);
            frames.push(from * joint.displacement(position(joint)));
        }
        frames
    }

    /// Velocity and angular velocity of the end per independent joint rate, 6 × m.
    ///
    /// Both are in the base frame, at the end's origin.
    #[must_use]
    pub fn end_jacobian(&self, q: &[f64]) -> DMatrix<f64> {
        self.end_jacobian_at(&self.frames(q))
    }

    /// [`Self::end_jacobian`] from the known frames of all joints.
    #[must_use]
    pub fn end_jacobian_at(&self, frames: &[Isometry3<f64>]) -> DMatrix<f64> {
        match frames.last() {
            Some(last) => self.body_jacobian(frames, frames.len() - 1, last.translation.vector),
            None => DMatrix::zeros(6, self.independent().count()),
        }
    }

    /// The velocity of a point of a body and its angular velocity per independent joint rate.
    #[must_use]
    pub(crate) fn body_jacobian(
        &self,
        frames: &[Isometry3<f64>],
        body: usize,
        point: Vector3<f64>,
    ) -> DMatrix<f64> {
        let independent: Vec<usize> = self.independent().collect();
        let mut jacobian = DMatrix::zeros(6, independent.len());
        let mut on_path = vec![false; self.joints.len()];
        let mut at = Some(body);
        while let Some(joint) = at {
            on_path[joint] = true;
            at = self.joints[joint].antecedent;
        }
        for (index, joint) in self.joints.iter().enumerate().filter(|(i, _)| on_path[*i]) {
            let axis = frames[index] * Vector3::z();
            let arm = point - frames[index].translation.vector;
            let (linear, angular) = match joint.kind {
                JointKind::Revolute => (axis.cross(&arm), axis),
                JointKind::Prismatic => (axis, Vector3::zeros()),
                JointKind::Fixed => continue,
            };
            for (of, factor) in &joint.variable {
                let Some(column) = independent.iter().position(|i| i == of) else {
                    continue;
                };
                for i in 0..3 {
                    jacobian[(i, column)] += linear[i] * factor.value();
                    jacobian[(3 + i, column)] += angular[i] * factor.value();
                }
            }
        }
        jacobian
    }
}

/// The platform frame of a pose in the base frame.
#[must_use]
pub fn platform_frame(motion: Motion, pose: &[f64]) -> Isometry3<f64> {
    let mut at = Vector3::zeros();
    let mut rotation = UnitQuaternion::identity();
    let quaternion =
        |q: &[f64]| UnitQuaternion::from_quaternion(Quaternion::new(q[0], q[1], q[2], q[3]));
    match motion {
        Motion::FixedAxis { axis } => at[axis] = pose[0],
        Motion::Point { axis } | Motion::Planar { axis } => {
            at[(axis + 1) % 3] = pose[0];
            at[(axis + 2) % 3] = pose[1];
        }
        Motion::Translation
        | Motion::Schoenflies { .. }
        | Motion::Spatial
        | Motion::Parasitic { .. } => {
            at = Vector3::new(pose[0], pose[1], pose[2]);
        }
        Motion::Rotation { .. } | Motion::Spherical => {}
    }
    if let Some(axis) = motion.rotation_axis() {
        let mut direction = Vector3::zeros();
        direction[axis] = pose[pose.len() - 1];
        rotation = UnitQuaternion::from_scaled_axis(direction);
    }
    if motion.has_quaternion() {
        rotation = quaternion(&pose[pose.len() - 4..]);
    }
    Isometry3::from_parts(Translation3::from(at), rotation)
}

/// Required position of a leg's last frame for a platform frame; a point end uses only its origin.
#[must_use]
pub fn target(end: &End, platform: &Isometry3<f64>) -> Isometry3<f64> {
    match end {
        End::Rigid(placement) => platform * placement_isometry(placement),
        End::Point { at, .. } => {
            let [x, y, z] = at.map(crate::cas::Number::value);
            platform * Isometry3::translation(x, y, z)
        }
    }
}

impl Mechanism {
    /// Required position of a leg's last frame at a pose, relative to the frame of the leg's base.
    ///
    /// That is the robot's base frame, or the frame of the body that the leg starts from. `joints`
    /// holds the positions of all joints, but only earlier legs are read. `None` for a leg without
    /// an end.
    #[must_use]
    pub fn target(&self, leg: usize, pose: &[f64], joints: &[f64]) -> Option<Isometry3<f64>> {
        let end = self.legs[leg].end.as_ref()?;
        if let Some(platform) = &self.platform {
            return Some(target(end, &platform_frame(platform.motion, pose)));
        }
        let carrier = self.body_frame(self.legs[leg].end_body?, pose, joints);
        let from = self.ground_of(leg, pose, joints).inverse();
        Some(target(end, &(from * carrier)))
    }

    /// Frame of the leg's base body in the robot's base frame; reads `joints` of earlier legs only.
    #[must_use]
    pub fn ground_of(&self, leg: usize, pose: &[f64], joints: &[f64]) -> Isometry3<f64> {
        let body = self.legs[leg].base_body;
        body.map_or_else(Isometry3::identity, |body| {
            self.body_frame(body, pose, joints)
        })
    }

    /// Frame of a body that carries chains, in the robot's base frame.
    #[must_use]
    pub fn body_frame(&self, body: BodyIndex, pose: &[f64], joints: &[f64]) -> Isometry3<f64> {
        self.frames_of(body.leg, pose, joints)[body.joint]
    }

    /// Frames of a leg's joints in the robot's base frame. The joints of legs without an end are
    /// the pose.
    #[must_use]
    pub(crate) fn frames_of(
        &self,
        leg: usize,
        pose: &[f64],
        joints: &[f64],
    ) -> Vec<Isometry3<f64>> {
        let own = match self.legs[leg].end {
            None => &pose[self.coordinate_range(leg)],
            Some(_) => &joints[self.leg_range(leg)],
        };
        let ground = self.ground_of(leg, pose, joints);
        let frames = self.legs[leg].frames(own).into_iter();
        frames.map(|frame| ground * frame).collect()
    }
}

impl Leg {
    /// Components of the six-vector (position, orientation) that the leg's end shares with the
    /// platform.
    #[must_use]
    pub(crate) fn shared_components(&self) -> Vec<usize> {
        let end = self.end.as_ref();
        end.map_or_else(Vec::new, End::shared_components)
    }

    /// Closure error of the leg's end in its shared components (m, rad, in the base frame).
    #[must_use]
    pub fn closure_error(&self, q: &[f64], target: &Isometry3<f64>) -> DVector<f64> {
        let last = self.frames(q).pop().unwrap_or(*target);
        let linear = target.translation.vector - last.translation.vector;
        let angular = (target.rotation * last.rotation.inverse()).scaled_axis();
        let component = |row: usize| [linear, angular][row / 3][row % 3];
        DVector::from_iterator(
            self.shared_components().len(),
            self.shared_components().into_iter().map(component),
        )
    }

    /// Rows of [`Self::end_jacobian`] of the shared components.
    #[must_use]
    pub(crate) fn closure_jacobian(&self, q: &[f64]) -> DMatrix<f64> {
        self.end_jacobian(q).select_rows(&self.shared_components())
    }
}

/// Indices of well conditioned rows, as many as columns, in ascending order.
///
/// Greedy: each step takes the row with the longest part outside the span of the rows before.
/// Returns fewer rows if the rank is smaller.
#[must_use]
pub(crate) fn best_conditioned(matrix: &DMatrix<f64>) -> Vec<usize> {
    let mut rest = matrix.clone();
    let least = 1e-6 * matrix.amax();
    let mut chosen: Vec<usize> = Vec::new();
    while chosen.len() < matrix.ncols() {
        let free = (0..rest.nrows()).filter(|row| !chosen.contains(row));
        // Rounding does not decide between equal rows: the first is taken.
        let longest = free.fold(None, |best: Option<(usize, f64)>, row| {
            let length = rest.row(row).norm();
            match best {
                Some((_, known)) if length <= known * (1.0 + 1e-9) => best,
                _ => Some((row, length)),
            }
        });
        let Some((row, length)) = longest.filter(|(_, length)| *length > least) else {
            break;
        };
        let direction = rest.row(row) / length;
        for mut other in rest.row_iter_mut() {
            let along = other.dot(&direction);
            other -= &direction * along;
        }
        chosen.push(row);
    }
    chosen.sort_unstable();
    chosen
}

impl Mechanism {
    /// Range of a leg's joint positions within q_t.
    #[must_use]
    pub fn leg_range(&self, leg: usize) -> std::ops::Range<usize> {
        let start = self.legs[..leg]
            .iter()
            .map(|l| l.independent().count())
            .sum::<usize>();
        start..start + self.legs[leg].independent().count()
    }

    /// Independent rows of a leg's end velocity that determine the joint rates at home, in
    /// ascending order.
    ///
    /// Rows refer to the six-vector (velocity, angular velocity). Legs that may block directions of
    /// a pose with dependent coordinates use the best conditioned rows, others the first.
    #[must_use]
    pub fn closure_rows(&self, leg: usize) -> Vec<usize> {
        let home = &self.home.joints[self.leg_range(leg)];
        let jacobian = self.legs[leg].end_jacobian(home);
        if self.has_dependent_coordinates() {
            let shared = self.legs[leg].shared_components();
            let best = best_conditioned(&jacobian.select_rows(&shared));
            return best.into_iter().map(|row| shared[row]).collect();
        }
        let mut basis: Vec<nalgebra::DVector<f64>> = Vec::new();
        let mut selected = Vec::new();
        for row in self.legs[leg].shared_components() {
            let mut vector = jacobian.row(row).transpose();
            let size = vector.norm();
            for known in &basis {
                vector -= known * known.dot(&vector);
            }
            if vector.norm() > 1e-6 * size.max(1e-6) && basis.len() < jacobian.ncols() {
                basis.push(vector.normalize());
                selected.push(row);
            }
        }
        selected
    }

    /// Typical length of the robot, m: mean distance of the legs' ends from their bases at home.
    #[must_use]
    pub fn length_scale(&self) -> f64 {
        let reach = |(index, leg): (usize, &Leg)| {
            if leg.cable.is_some() {
                return self.home.joints[self.leg_range(index).start];
            }
            let frames = leg.frames(&self.home.joints[self.leg_range(index)]);
            let last = frames
                .last()
                .map(|f| f.translation.vector)
                .unwrap_or_default();
            let first = frames
                .first()
                .map(|f| f.translation.vector)
                .unwrap_or_default();
            (last - first).norm()
        };
        let sum: f64 = self.legs.iter().enumerate().map(reach).sum();
        (sum / self.legs.len().max(1) as f64).max(1e-3)
    }
}
