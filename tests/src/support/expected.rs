//! What the numeric reference says a function's output is.

use super::sample::fitted_acceleration;
use super::{Failure, Sample};
use crate::reference::linear::pseudo_inverse;
use crate::reference::parameters::{BODY, INERTIAL, leg_start, names, platform_start};
use crate::reference::{Dynamics, Mechanism, State};
use nalgebra::{DMatrix, DVector};
use overact_codegen::RobotModel;
use overact_codegen::derivation::{BodyParameter, Columns, Family, From};

/// The reference of a robot, its columns arranged as the model arranges them.
#[derive(Clone, Debug)]
pub struct Expected {
    /// The robot as plain data.
    pub mechanism: Mechanism,
    /// The reference's columns of the standard parameters.
    pub standard: Vec<usize>,
    /// Of the base parameters.
    pub base: Vec<usize>,
    /// Of the payload's parameters.
    pub payload: Vec<usize>,
    /// Kept actuators of case 2.
    pub kept: Vec<usize>,
}

impl Expected {
    /// The reference for a model.
    ///
    /// # Errors
    ///
    /// If the reference knows no parameter of a name that the model has.
    pub fn new(model: &RobotModel, mechanism: Mechanism) -> Result<Self, Failure> {
        let known = names(&mechanism);
        let columns = |of: &[BodyParameter]| -> Result<Vec<usize>, Failure> {
            let find = |p: &BodyParameter| {
                let name = model.parameter_name(*p);
                let at = known.iter().position(|k| *k == name);
                at.ok_or_else(|| format!("the reference has no `{name}`").into())
            };
            of.iter().map(find).collect()
        };
        Ok(Self {
            standard: columns(&model.selection.standard)?,
            base: columns(&model.selection.base)?,
            payload: columns(&model.selection.payload)?,
            kept: model.selection.kept_actuators.clone(),
            mechanism,
        })
    }

    /// The reference for a model, its columns found by leg, joint and symbol instead of by name.
    #[must_use]
    pub fn by_position(model: &RobotModel, mechanism: Mechanism) -> Self {
        let at = |parameter: &BodyParameter| match *parameter {
            BodyParameter::Leg { leg, joint, symbol } => {
                leg_start(&mechanism, leg) + BODY * joint + symbol as usize
            }
            BodyParameter::Platform(symbol) => platform_start(&mechanism) + symbol as usize,
            BodyParameter::Payload(symbol) => {
                platform_start(&mechanism) + INERTIAL + symbol as usize
            }
        };
        let columns = |of: &[BodyParameter]| of.iter().map(at).collect::<Vec<usize>>();
        Self {
            standard: columns(&model.selection.standard),
            base: columns(&model.selection.base),
            payload: columns(&model.selection.payload),
            kept: model.selection.kept_actuators.clone(),
            mechanism,
        }
    }

    /// Columns of all parameters that inverse dynamics takes.
    #[must_use]
    pub fn parameters(&self) -> Vec<usize> {
        [&self.standard[..], &self.payload].concat()
    }

    /// The reference's output of a function at a sample.
    ///
    /// # Errors
    ///
    /// If the reference can't compute it.
    pub fn output(
        &self,
        family: Family,
        from: From,
        sample: &Sample,
    ) -> Result<DMatrix<f64>, Failure> {
        let dynamic = matches!(
            family,
            Family::IdmRedPlatform(_)
                | Family::IdmRedActuators(_)
                | Family::IdmRedPayload
                | Family::InverseDynamics
        );
        let state = if dynamic && from == From::Actuators {
            &sample.fitted
        } else {
            &sample.state
        };
        let dynamics = Dynamics::new(&self.mechanism, state)?;
        match kinematic(&dynamics, family, sample)? {
            Some(matrix) => Ok(matrix),
            None => self.dynamic(&dynamics, family, sample),
        }
    }

    fn dynamic(
        &self,
        dynamics: &Dynamics<'_>,
        family: Family,
        sample: &Sample,
    ) -> Result<DMatrix<f64>, Failure> {
        let chi = &sample.all_parameters;
        let torques = DVector::from_column_slice(&sample.torques);
        let least_norm = || dynamics.least_norm_torques(chi);
        Ok(match family {
            Family::IdmRedPlatform(columns) => dynamics
                .idm_red_platform()?
                .select_columns(self.chosen(columns)),
            Family::IdmRedActuators(columns) => {
                let partition = dynamics.idm_red_actuators(&self.kept)?;
                partition.regressor.select_columns(self.chosen(columns))
            }
            Family::IdmRedPayload => dynamics.idm_red_platform()?.select_columns(&self.payload),
            Family::IdmRedPayloadActuators => {
                let partition = dynamics.idm_red_actuators(&self.kept)?;
                partition.regressor.select_columns(&self.payload)
            }
            Family::ProjectActuators => {
                let partition = dynamics.idm_red_actuators(&self.kept)?;
                let projected = torques.select_rows(&partition.projected);
                vector(&(torques.select_rows(&self.kept) - partition.projection * projected))
            }
            Family::InverseDynamics => vector(&least_norm()?),
            Family::InverseDynamicsPreloaded => {
                let preload = DVector::from_column_slice(&sample.preload);
                vector(&(least_norm()? + self.null_space(dynamics) * preload))
            }
            Family::MassMatrix => dynamics.mass_matrix_and_bias(chi)?.0,
            Family::Bias => vector(&dynamics.mass_matrix_and_bias(chi)?.1),
            Family::ProjectTorques => vector(&dynamics.project_torques(&torques)),
            Family::NullSpace => self.null_space(dynamics),
            other => return Err(format!("the reference has no {other:?}").into()),
        })
    }

    fn chosen(&self, columns: Columns) -> &[usize] {
        match columns {
            Columns::Standard => &self.standard,
            Columns::Base => &self.base,
        }
    }

    /// The null space of a robot with one redundant actuator: a direction, positive on the actuator
    /// that case 2 projects.
    fn null_space(&self, dynamics: &Dynamics<'_>) -> DMatrix<f64> {
        let mut basis = dynamics.internal_loads();
        let projected = (0..basis.nrows()).find(|at| !self.kept.contains(at));
        if basis.ncols() == 1 && projected.is_some_and(|at| basis[(at, 0)] < 0.0) {
            basis.neg_mut();
        }
        basis
    }
}

/// The functions that know of no parameter; none for the others.
fn kinematic(
    dynamics: &Dynamics<'_>,
    family: Family,
    sample: &Sample,
) -> Result<Option<DMatrix<f64>>, Failure> {
    let (mechanism, state, jacobians) = (dynamics.mechanism, dynamics.state, &dynamics.jacobians);
    Ok(Some(match family {
        Family::Joints => vector(&state.q),
        Family::ActuatorPositions => vector(&state.q.select_rows(&mechanism.actuated())),
        Family::InverseJacobian => jacobians.inverse.clone(),
        Family::Jacobian => pseudo_inverse(&jacobians.inverse),
        Family::ClosurePlatformJacobian => jacobians.a_p.clone(),
        Family::ClosureActuatorJacobian => jacobians.b_p.clone(),
        Family::LegsJacobian => jacobians.legs.clone(),
        Family::LegsPlatformJacobian => jacobians.platform.clone(),
        Family::JointVelocities => vector(&state.qd),
        Family::JointAccelerations => vector(&state.qdd),
        Family::TwistFromActuators => vector(&sample.fitted.twist),
        Family::AccelerationFromActuators => {
            let measured = DVector::from_column_slice(&sample.actuator_accelerations);
            vector(&fitted_acceleration(
                mechanism,
                state,
                &state.twist,
                &measured,
            )?)
        }
        Family::ProjectPlatform => {
            let torques = DVector::from_column_slice(&sample.torques);
            vector(&dynamics.project_on_platform(&torques))
        }
        _ => return Ok(None),
    }))
}

/// A state that differs by whole turns of joints, with the joints that a model gives.
///
/// # Errors
///
/// If a joint is no whole number of turns away.
pub fn with_joints_of_model(
    mechanism: &Mechanism,
    state: &State,
    joints: &[f64],
    tolerance: f64,
) -> Result<State, Failure> {
    let turn = std::f64::consts::TAU;
    let near = DVector::from_column_slice(joints);
    for (at, (found, expected)) in near.iter().zip(&state.q).enumerate() {
        let off = (found - expected) / turn;
        if (off - off.round()).abs() * turn > tolerance {
            return Err(format!("joint {at}: {found} against {expected}").into());
        }
    }
    let State {
        pose,
        twist,
        acceleration,
        ..
    } = state;
    Ok(State::solve_near(
        mechanism,
        &near,
        pose,
        twist,
        acceleration,
    )?)
}

fn vector(values: &DVector<f64>) -> DMatrix<f64> {
    DMatrix::from_column_slice(values.len(), 1, values.as_slice())
}
