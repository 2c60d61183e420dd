//! A mechanism with changed lengths, evaluated leg by leg: Newton's method on the closure of a leg, and
//! the derivatives of its joints along the pose and by its lengths.
//!
//! In the components that count, the end of a leg with joints q misses its place on the platform by
//! f(x, q, p) = 0. With J_k = -∂f/∂q and J_tk = ∂f/∂v, eq. (9), dq = J_k^-1 (J_tk v + ∂f/∂p dp). The end
//! moves with a length along the axis on which the length lies, whatever its value is.

use super::length::{LegLength, Length, lengths};
use crate::interpreted::InterpretedRobot;
use nalgebra::{DMatrix, DVector, Isometry3, Vector3};
use overact::{Error, Function, Model};
use overact_codegen::mechanism::{
    Leg, Mechanism, Motion, TwistCoordinate,
    numeric::{platform_frame, target},
    placement_isometry,
};
use overact_identification::{ChangedGeometry, Geometry, GeometryParameter, Reached};

/// Newton steps of a leg, at most; from the sample's last joints it takes two or three.
const STEPS: usize = 30;

/// The end has met the platform when it misses it by less (m, rad).
const CLOSED: f64 = 1e-13;

/// Steps that no longer make the miss smaller end the iteration when it is below this: rounding.
const ROUNDING: f64 = 1e-10;

/// A joint that would step farther (rad, m) may jump to another working mode.
const LONGEST_STEP: f64 = 0.5;

/// The geometry of an interpreted robot.
#[derive(Debug)]
pub(crate) struct MechanismGeometry<'a> {
    model: &'a InterpretedRobot,
    mechanism: &'a Mechanism,
    /// How the platform moves.
    motion: Motion,
    lengths: Vec<LegLength>,
    parameters: Vec<GeometryParameter>,
    /// For each leg the components of its end's motion that count.
    rows: Vec<Vec<usize>>,
}

impl<'a> MechanismGeometry<'a> {
    /// The geometry of a described robot; `None` without a platform, on which legs end.
    pub(crate) fn new(model: &'a InterpretedRobot) -> Option<Self> {
        let mechanism = &model.model().mechanism;
        let motion = mechanism.platform.as_ref()?.motion;
        let (lengths, parameters) = lengths(mechanism);
        let legs = 0..mechanism.legs.len();
        Some(Self {
            model,
            mechanism,
            motion,
            lengths,
            parameters,
            rows: legs.map(|leg| mechanism.closure_rows(leg)).collect(),
        })
    }

    /// A leg with changed lengths.
    fn changed_leg(&self, leg: usize, changes: &[f64]) -> Leg {
        let mut own = self.mechanism.legs[leg].clone();
        for (length, change) in self.lengths.iter().zip(changes) {
            if length.leg == leg {
                length.length.add(&mut own, *change);
            }
        }
        own
    }
}

/// A mechanism with changed lengths.
struct ChangedMechanism<'a> {
    described: &'a MechanismGeometry<'a>,
    legs: Vec<Leg>,
}

impl ChangedMechanism<'_> {
    /// Closes a leg from the joints that it had last.
    fn close(&self, index: usize, target: &Isometry3<f64>, q: &mut [f64]) -> Result<(), Error> {
        let (leg, rows) = (&self.legs[index], &self.described.rows[index]);
        let mut least = f64::INFINITY;
        for _ in 0..STEPS {
            let frames = leg.frames(q);
            let error = miss(rows, frames.last().unwrap_or(target), target);
            let size = error.amax();
            if size < CLOSED || (size < ROUNDING && size >= least) {
                return Ok(());
            }
            least = least.min(size);
            let jacobian = leg.end_jacobian_at(&frames).select_rows(rows);
            let Some(step) = jacobian.lu().solve(&error) else {
                break;
            };
            let shorter = (LONGEST_STEP / step.amax()).min(1.0);
            for (q, step) in q.iter_mut().zip(step.iter()) {
                *q += shorter * step;
            }
        }
        let leg = self.described.model.leg_name(index);
        Err(Error::OutOfReach { leg })
    }

    /// The derivatives of a leg's joints: along the twist, and by each parameter.
    fn derivatives(
        &self,
        index: usize,
        platform: &Isometry3<f64>,
        q: &[f64],
    ) -> Option<(DMatrix<f64>, DMatrix<f64>)> {
        let (leg, rows) = (&self.legs[index], &self.described.rows[index]);
        let frames = leg.frames(q);
        let last = frames.last()?;
        let jacobian = leg.end_jacobian_at(&frames).select_rows(rows).lu();
        let motion = self.described.motion;
        let arm = last.translation.vector - platform.translation.vector;
        let twists: Vec<DVector<f64>> = motion
            .twist()
            .into_iter()
            .map(|coordinate| counted(end_velocity(coordinate, arm), rows))
            .collect();
        let moves: Vec<DVector<f64>> = self
            .described
            .lengths
            .iter()
            .map(|own| {
                let own = (own.leg == index).then_some(own.length);
                let way = own.map(|length| end_miss(leg, length, &frames, platform));
                counted((way.unwrap_or_default(), Vector3::zeros()), rows)
            })
            .collect();
        let by_twist = jacobian.solve(&DMatrix::from_columns(&twists))?;
        let by_length = jacobian.solve(&DMatrix::from_columns(&moves))?;
        Some((by_twist, by_length))
    }
}

/// The components of a motion (velocity, angular velocity) that count.
fn counted((linear, angular): (Vector3<f64>, Vector3<f64>), rows: &[usize]) -> DVector<f64> {
    let parts = [linear, angular];
    let values = rows.iter().map(|row| parts[row / 3][row % 3]);
    DVector::from_iterator(rows.len(), values)
}

/// By how much a leg's last frame misses its place, in the components that count.
fn miss(rows: &[usize], last: &Isometry3<f64>, target: &Isometry3<f64>) -> DVector<f64> {
    let linear = target.translation.vector - last.translation.vector;
    let angular = (target.rotation * last.rotation.inverse()).scaled_axis();
    counted((linear, angular), rows)
}

/// The motion that a platform point at `arm` from the origin has per unit of a twist coordinate.
fn end_velocity(coordinate: TwistCoordinate, arm: Vector3<f64>) -> (Vector3<f64>, Vector3<f64>) {
    let unit = |axis: usize| Vector3::from_fn(|row, _| if row == axis { 1.0 } else { 0.0 });
    match coordinate {
        TwistCoordinate::Linear(axis) => (unit(axis), Vector3::zeros()),
        TwistCoordinate::Angular(axis) => (unit(axis).cross(&arm), unit(axis)),
    }
}

/// ∂f/∂p: by how much more the end misses its place per unit of a length.
fn end_miss(
    leg: &Leg,
    length: Length,
    frames: &[Isometry3<f64>],
    platform: &Isometry3<f64>,
) -> Vector3<f64> {
    let antecedent = |joint: usize| {
        let before = leg.joints[joint].antecedent;
        before.map_or_else(
            || placement_isometry(&leg.base).rotation,
            |at| frames[at].rotation,
        )
    };
    let unit = |axis: usize| Vector3::from_fn(|row, _| if row == axis { 1.0 } else { 0.0 });
    let along = |joint: usize, way: Vector3<f64>| match is_on_way(leg, joint) {
        true => -way,
        false => Vector3::zeros(),
    };
    match length {
        Length::B(joint) => along(joint, antecedent(joint) * Vector3::z()),
        Length::D(joint) => {
            let gamma = Isometry3::rotation(Vector3::z() * leg.joints[joint].gamma.value());
            along(joint, antecedent(joint) * (gamma * Vector3::x()))
        }
        Length::R(joint) => along(joint, frames[joint] * Vector3::z()),
        Length::Base(axis) => -unit(axis),
        Length::End(axis) => platform * unit(axis),
    }
}

/// Whether a joint is on the way from the leg's base to its end.
fn is_on_way(leg: &Leg, joint: usize) -> bool {
    let mut at = leg.joints.len().checked_sub(1);
    while let Some(index) = at {
        if index == joint {
            return true;
        }
        at = leg.joints[index].antecedent;
    }
    false
}

impl Geometry for MechanismGeometry<'_> {
    fn parameters(&self) -> &[GeometryParameter] {
        &self.parameters
    }

    fn memory(&self) -> usize {
        self.model.info().sizes.joints
    }

    fn remember(&self, pose: &[f64], memory: &mut [f64]) -> Result<(), Error> {
        let found = self.model.evaluate(Function::Joints, &[pose], memory);
        found.map_err(|error| error.error)
    }

    fn changed(&self, changes: &[f64]) -> Box<dyn ChangedGeometry + '_> {
        let legs = 0..self.mechanism.legs.len();
        Box::new(ChangedMechanism {
            described: self,
            legs: legs.map(|leg| self.changed_leg(leg, changes)).collect(),
        })
    }
}

impl ChangedGeometry for ChangedMechanism<'_> {
    fn evaluate(
        &self,
        pose: &[f64],
        memory: &mut [f64],
        reached: &mut Reached,
    ) -> Result<(), Error> {
        let (model, mechanism) = (self.described.model, self.described.mechanism);
        let info = model.info();
        let (n, r, m) = (
            info.sizes.actuators,
            info.sizes.dof,
            self.described.lengths.len(),
        );
        reached.positions.clear();
        reached.by_pose = DMatrix::zeros(n, r);
        reached.by_parameter = DMatrix::zeros(n, m);
        let platform = platform_frame(self.described.motion, pose);
        let mut actuators = info.actuated_joints.iter().enumerate().peekable();
        for (index, leg) in self.legs.iter().enumerate() {
            let Some(end) = &leg.end else { continue };
            let range = mechanism.leg_range(index);
            let q = &mut memory[range.clone()];
            self.close(index, &target(end, &platform), q)?;
            let (by_twist, by_length) =
                self.derivatives(index, &platform, q)
                    .ok_or(Error::SingularLeg {
                        leg: model.leg_name(index),
                        condition: f64::INFINITY,
                    })?;
            while let Some((actuator, &joint)) = actuators.next_if(|(_, at)| range.contains(at)) {
                let own = joint - range.start;
                reached.positions.push(q[own]);
                reached.by_pose.set_row(actuator, &by_twist.row(own));
                reached.by_parameter.set_row(actuator, &by_length.row(own));
            }
        }
        Ok(())
    }
}
