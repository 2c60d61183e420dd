//! Leg closures of a mechanism with changed lengths: Newton's method and derivatives.
//!
//! Let f(x, q, p) = 0 be the constrained components of the displacement from the leg's end to its
//! place on the platform. With J_k = −∂f/∂q and J_tk = ∂f/∂v, eq. (9), dq = J_k^-1 (J_tk v + ∂f/∂p
//! dp). A length moves the end along the length's axis, independently of its value.

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

/// Largest number of Newton steps of a leg; started from the previous sample, two or three suffice.
const STEPS: usize = 30;

/// Residual below which a leg counts as closed (m, rad).
const CLOSED: f64 = 1e-13;

/// Residual below which an iteration without progress is accepted as rounding (m, rad).
const ROUNDING: f64 = 1e-10;

/// Longest step of a joint (rad, m); longer ones may jump to another working mode.
const LONGEST_STEP: f64 = 0.5;

/// Geometry of an interpreted robot.
#[derive(Debug)]
pub(crate) struct MechanismGeometry<'a> {
    model: &'a InterpretedRobot,
    mechanism: &'a Mechanism,
    /// Motion type of the platform.
    motion: Motion,
    lengths: Vec<LegLength>,
    parameters: Vec<GeometryParameter>,
    /// For each leg, the constrained components of its end.
    rows: Vec<Vec<usize>>,
}

impl<'a> MechanismGeometry<'a> {
    /// Geometry of a robot; `None` if it has no platform, or cables, which have no joints.
    pub(crate) fn new(model: &'a InterpretedRobot) -> Option<Self> {
        let mechanism = &model.model().mechanism;
        let motion = mechanism.platform.as_ref()?.motion;
        if mechanism.has_cables() {
            return None;
        }
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

    /// Leg with changed lengths.
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
    /// Closes a leg, starting from its previous joint positions.
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

    /// Derivatives of a leg's joints with respect to the twist and to each parameter.
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
            .map(|coordinate| EndMotion::unit_twist(coordinate, arm).components(rows))
            .collect();
        let moves: Vec<DVector<f64>> = self
            .described
            .lengths
            .iter()
            .map(|own| {
                let own = (own.leg == index).then_some(own.length);
                let way = own.map(|length| end_miss(leg, length, &frames, platform));
                let motion = EndMotion {
                    linear: way.unwrap_or_default(),
                    angular: Vector3::zeros(),
                };
                motion.components(rows)
            })
            .collect();
        let by_twist = jacobian.solve(&DMatrix::from_columns(&twists))?;
        let by_length = jacobian.solve(&DMatrix::from_columns(&moves))?;
        Some((by_twist, by_length))
    }
}

/// Displacement or velocity of a leg's end.
struct EndMotion {
    linear: Vector3<f64>,
    angular: Vector3<f64>,
}

impl EndMotion {
    /// Motion of a platform point at `arm` from the origin for a unit twist coordinate.
    fn unit_twist(coordinate: TwistCoordinate, arm: Vector3<f64>) -> Self {
        let unit = |axis: usize| Vector3::from_fn(|row, _| if row == axis { 1.0 } else { 0.0 });
        match coordinate {
            TwistCoordinate::Linear(axis) => Self {
                linear: unit(axis),
                angular: Vector3::zeros(),
            },
            TwistCoordinate::Angular(axis) => Self {
                linear: unit(axis).cross(&arm),
                angular: unit(axis),
            },
        }
    }

    /// Components in the constrained rows.
    fn components(&self, rows: &[usize]) -> DVector<f64> {
        let parts = [self.linear, self.angular];
        let values = rows.iter().map(|row| parts[row / 3][row % 3]);
        DVector::from_iterator(rows.len(), values)
    }
}

/// Closure residual of a leg, in the constrained components.
fn miss(rows: &[usize], last: &Isometry3<f64>, target: &Isometry3<f64>) -> DVector<f64> {
    let motion = EndMotion {
        linear: target.translation.vector - last.translation.vector,
        angular: (target.rotation * last.rotation.inverse()).scaled_axis(),
    };
    motion.components(rows)
}

/// ∂f/∂p: derivative of the closure residual with respect to a length.
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
    let along = |joint: usize, way: Vector3<f64>| {
        if is_on_way(leg, joint) {
            -way
        } else {
            Vector3::zeros()
        }
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

/// Whether a joint is on the path from the leg's base to its end.
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
        let joints = info.sizes.joints;
        let (mut by_pose, mut by_parameter) =
            (DMatrix::zeros(joints, r), DMatrix::zeros(joints, m));
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
            by_pose
                .rows_mut(range.start, range.len())
                .copy_from(&by_twist);
            by_parameter
                .rows_mut(range.start, range.len())
                .copy_from(&by_length);
        }
        for (actuator, &joint) in info.actuated_joints.iter().enumerate() {
            let alone = [(joint, 1.0)];
            let terms = match model.actuator_terms(actuator) {
                [] => &alone[..],
                terms => terms,
            };
            let mut position = 0.0;
            for &(joint, factor) in terms {
                position += factor * memory[joint];
                let mut row = reached.by_pose.row_mut(actuator);
                row += by_pose.row(joint) * factor;
                let mut row = reached.by_parameter.row_mut(actuator);
                row += by_parameter.row(joint) * factor;
            }
            reached.positions.push(position);
        }
        Ok(())
    }
}
