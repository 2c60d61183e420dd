//! Actuators that determine the platform's motion at the home configuration.

use super::{BodyIndex, End, Leg, Mechanism, Motion, TwistCoordinate};
use crate::mechanism::numeric::{platform_frame, target};
use crate::mechanism::singular_values::SingularValues;
use nalgebra::{DMatrix, DVector, Vector3};

/// Part of a row of J_p^inv outside the span of earlier rows, relative to its length: below the
/// first value the row is nearly dependent, below the second it is dependent.
const DEPENDENT: [f64; 2] = [1e-2, 1e-6];
/// Singular value of a leg's Jacobian, relative to the largest, up to which it counts as zero.
const SINGULAR: f64 = 1e-9;
/// Length of a row of J_p^inv, relative to the fastest joint's, below which it is rounding.
const ROUNDING: f64 = 1e-10;

/// Velocity components that a leg's end shares with its end body, per independent coordinate.
///
/// Those of chains are relative to the body that the chain starts from, in that body's axes.
#[must_use]
pub(super) fn shared_velocities(
    mechanism: &Mechanism,
    leg: usize,
    pose: &[f64],
    joints: &[f64],
) -> Option<DMatrix<f64>> {
    let end = mechanism.legs[leg].end.as_ref()?;
    match &mechanism.platform {
        Some(platform) if mechanism.is_parasitic() => {
            let free = on_platform(platform.motion.of_pose(), pose, end);
            Some(free * mechanism.platform_jacobian(pose, joints)?)
        }
        Some(platform) => Some(on_platform(platform.motion, pose, end)),
        None => on_skeleton(mechanism, leg, pose, joints),
    }
}

/// Relative velocity of a chain's end point, per joint rate of the skeleton.
fn on_skeleton(
    mechanism: &Mechanism,
    leg: usize,
    pose: &[f64],
    joints: &[f64],
) -> Option<DMatrix<f64>> {
    let chain = &mechanism.legs[leg];
    let end = chain.end.as_ref()?;
    let ground = mechanism.ground_of(leg, pose, joints);
    let point = (ground * mechanism.target(leg, pose, joints)?)
        .translation
        .vector;
    let mut velocities = on_body(mechanism, chain.end_body?, point, pose, joints)?;
    if let Some(own) = chain.base_body {
        velocities -= on_body(mechanism, own, point, pose, joints)?;
    }
    let into = ground.rotation.inverse();
    for mut column in velocities.column_iter_mut() {
        for part in [0, 3] {
            let turned = into * Vector3::new(column[part], column[part + 1], column[part + 2]);
            column.rows_mut(part, 3).copy_from(&turned);
        }
    }
    Some(velocities.select_rows(&end.shared_components()))
}

/// Velocity of a point of a body and its angular velocity, per joint rate of the skeleton.
///
/// For a body of a chain they follow from the rates of the two bodies that the chain connects.
fn on_body(
    mechanism: &Mechanism,
    body: BodyIndex,
    point: Vector3<f64>,
    pose: &[f64],
    joints: &[f64],
) -> Option<DMatrix<f64>> {
    let leg = &mechanism.legs[body.leg];
    let frames = mechanism.frames_of(body.leg, pose, joints);
    let own = leg.body_jacobian(&frames, body.joint, point);
    let rates = match shared_velocities(mechanism, body.leg, pose, joints) {
        Some(shared) => rates_per_velocity(leg, &joints[mechanism.leg_range(body.leg)])? * shared,
        None => mechanism.coordinate_rates(body.leg, pose, joints)?,
    };
    let carried = leg.base_body;
    let carried = carried.map_or_else(
        || Some(DMatrix::zeros(6, mechanism.dof())),
        |base| on_body(mechanism, base, point, pose, joints),
    );
    Some(own * rates + carried?)
}

/// Velocity components that a leg's end shares with the platform, per twist coordinate.
#[must_use]
fn on_platform(motion: Motion, pose: &[f64], end: &End) -> DMatrix<f64> {
    let frame = platform_frame(motion, pose);
    let arm = target(end, &frame).translation.vector - frame.translation.vector;
    let twist = motion.twist();
    let mut columns = DMatrix::zeros(6, twist.len());
    for (c, coordinate) in twist.iter().enumerate() {
        let mut axis = Vector3::zeros();
        let (linear, angular) = match coordinate {
            TwistCoordinate::Linear(a) => {
                axis[*a] = 1.0;
                (axis, Vector3::zeros())
            }
            TwistCoordinate::Angular(a) => {
                axis[*a] = 1.0;
                (axis.cross(&arm), axis)
            }
        };
        for i in 0..3 {
            columns[(i, c)] = linear[i];
            columns[(3 + i, c)] = angular[i];
        }
    }
    columns.select_rows(&end.shared_components())
}

/// Joint rates of a leg per velocity of its end, by least squares.
///
/// `None` if the Jacobian is not finite.
#[must_use]
pub(super) fn rates_per_velocity(leg: &Leg, joints: &[f64]) -> Option<DMatrix<f64>> {
    let found = SingularValues::new(&leg.closure_jacobian(joints))?;
    Some(found.pseudo_inverse(SINGULAR * found.largest()))
}

impl Mechanism {
    /// Joint rates of a leg without an end, which are independent coordinates themselves unless
    /// they are dependent.
    fn coordinate_rates(&self, leg: usize, pose: &[f64], joints: &[f64]) -> Option<DMatrix<f64>> {
        if self.has_dependent_joints() {
            let range = self.leg_range(leg);
            let all = self.rates_of_joints(pose, joints)?;
            return Some(all.rows(range.start, range.len()).into_owned());
        }
        let own = self.coordinate_range(leg);
        Some(DMatrix::from_fn(own.len(), self.dof(), |row, column| {
            f64::from(u8::from(own.start + row == column))
        }))
    }

    /// Rates of all joints per twist coordinate at the home configuration, n_t × r.
    ///
    /// `None` if a leg is singular there.
    #[must_use]
    pub(crate) fn rates_at_home(&self) -> Option<DMatrix<f64>> {
        if self.is_tree() {
            return Some(DMatrix::identity(self.dof(), self.dof()));
        }
        if self.has_dependent_joints() {
            return self.rates_of_joints(&self.home.pose, &self.home.joints);
        }
        let mut all = DMatrix::zeros(self.joints().len(), self.dof());
        for (index, leg) in self.legs.iter().enumerate() {
            let range = self.leg_range(index);
            let (pose, joints) = (&self.home.pose, &self.home.joints);
            let Some(velocities) = shared_velocities(self, index, pose, joints) else {
                all.rows_mut(range.start, range.len())
                    .copy_from(&self.coordinate_rates(index, pose, joints)?);
                continue;
            };
            let rates = if leg.cable.is_some() {
                self.cable_row(index, pose, joints)? * velocities
            } else {
                rates_per_velocity(leg, &joints[range.clone()])? * velocities
            };
            all.rows_mut(range.start, range.len()).copy_from(&rates);
        }
        Some(all)
    }

    /// The first r actuators that determine the platform's motion at home, preferably well
    /// conditioned.
    ///
    /// Fewer than r if all actuators together do not determine it.
    #[must_use]
    pub(crate) fn independent_actuators(&self) -> Vec<usize> {
        let Some(rates) = self.rates_at_home() else {
            return Vec::new();
        };
        let jacobian = self.actuator_rows(&rates);
        let least = ROUNDING * rates.row_iter().map(|row| row.norm()).fold(0.0, f64::max);
        let [well, at_all] = DEPENDENT.map(|limit| independent_rows(&jacobian, least, limit));
        if well.len() == self.dof() {
            well
        } else {
            at_all
        }
    }
}

/// The first independent rows: longer than `least`, and with more than the fraction `limit` of
/// their length outside the span of earlier rows.
fn independent_rows(matrix: &DMatrix<f64>, least: f64, limit: f64) -> Vec<usize> {
    let mut basis: Vec<DVector<f64>> = Vec::new();
    let mut chosen = Vec::new();
    for (index, row) in matrix.row_iter().enumerate() {
        let row = row.transpose();
        let mut rest = row.clone();
        // The second pass removes the rounding errors of the first.
        for _ in 0..2 {
            for known in &basis {
                rest -= known * known.dot(&rest);
            }
        }
        let is_new = row.norm() > least && rest.norm() > limit * row.norm();
        if is_new && chosen.len() < matrix.ncols() {
            basis.push(rest.normalize());
            chosen.push(index);
        }
    }
    chosen
}
