//! Expected outputs of functions, from the numeric reference.

use super::conversion::payload_joint;
use super::derivatives;
use super::frames::{self, Frames};
use super::sample::fitted_acceleration;
use super::{Failure, Parameters, Sample};
use crate::reference::closure::parasitic_motion::rates;
use crate::reference::dynamics::Partition;
use crate::reference::linear::pseudo_inverse;
use crate::reference::parameters::{
    BODY, INERTIAL, element_start, leg_start, motor_start, names, platform_start,
};
use crate::reference::{Dynamics, Mechanism, State};
use nalgebra::{DMatrix, DVector};
use overact::{Columns, Function};
use overact_codegen::RobotModel;
use overact_codegen::derivation::{BodyParameter, MotionInput};
use std::cell::OnceCell;

/// Reference of a robot with the columns of its model.
#[derive(Clone, Debug)]
pub struct Expected {
    /// The robot as plain data.
    pub mechanism: Mechanism,
    /// Reference columns of the standard parameters.
    pub standard: Vec<usize>,
    /// Reference columns of the base parameters.
    pub base: Vec<usize>,
    /// Parameters regrouped into each base parameter, with coefficients.
    pub regrouped: Vec<Vec<(usize, f64)>>,
    /// Reference columns of the payload's parameters.
    pub payload: Vec<usize>,
    /// Kept actuators of the actuator projection.
    pub kept: Vec<usize>,
    /// Frames on bodies.
    pub frames: Frames,
    /// Relative tolerance of the comparison of derivatives, which are computed by differences.
    pub tolerance_of_derivatives: f64,
}

/// Tolerance of the comparison with the reference.
const TOLERANCE: f64 = 1e-9;
/// The same for robots with cables, whose reference is differentiated numerically.
const CABLE_TOLERANCE: f64 = 1e-8;

impl Expected {
    /// Relative tolerance of the comparison with a model.
    #[must_use]
    pub fn tolerance(&self) -> f64 {
        if self.mechanism.has_cables() {
            CABLE_TOLERANCE
        } else {
            TOLERANCE
        }
    }

    /// Reference for a model.
    ///
    /// # Errors
    ///
    /// If the reference has no parameter with a name of the model.
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
        let regrouped = model.base.iter().map(|base| {
            let (others, coefficients): (Vec<_>, Vec<f64>) = base.regrouped.iter().copied().unzip();
            Ok(columns(&others)?.into_iter().zip(coefficients).collect())
        });
        Ok(Self {
            standard: columns(&model.selection.standard)?,
            base: columns(&model.selection.base)?,
            regrouped: regrouped.collect::<Result<_, Failure>>()?,
            payload: columns(&model.selection.payload)?,
            kept: model.selection.kept_actuators.clone(),
            frames: Frames::of(&model.mechanism),
            tolerance_of_derivatives: TOLERANCE,
            mechanism,
        })
    }

    /// Reference for a model, with columns identified by leg, joint and symbol instead of names.
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
            BodyParameter::Load { payload, symbol } => {
                match payload_joint(&model.mechanism, payload) {
                    Some((leg, joint)) => {
                        leg_start(&mechanism, leg) + BODY * joint + symbol as usize
                    }
                    None => platform_start(&mechanism) + INERTIAL + symbol as usize,
                }
            }
            BodyParameter::Spring(index) => element_start(&mechanism) + index,
            BodyParameter::Motor { motor, symbol } => {
                motor_start(&mechanism) + BODY * motor + symbol as usize
            }
        };
        let columns = |of: &[BodyParameter]| of.iter().map(at).collect::<Vec<usize>>();
        Self {
            standard: columns(&model.selection.standard),
            base: columns(&model.selection.base),
            regrouped: model
                .base
                .iter()
                .map(|base| base.regrouped.iter().map(|(p, c)| (at(p), *c)).collect())
                .collect(),
            payload: columns(&model.selection.payload),
            kept: model.selection.kept_actuators.clone(),
            frames: Frames::of(&model.mechanism),
            tolerance_of_derivatives: TOLERANCE,
            mechanism,
        }
    }

    /// Parameters of inverse dynamics.
    #[must_use]
    pub fn parameters(&self) -> Parameters {
        let alone = |&at: &usize| (at, 1.0);
        let of_base = self.base.iter().zip(&self.regrouped);
        let of_base = of_base.map(|(kept, others)| {
            let others = others.iter().copied();
            std::iter::once(alone(kept)).chain(others).collect()
        });
        let of_payload = self.payload.iter().map(|at| vec![alone(at)]);
        Parameters {
            columns: [&self.standard[..], &self.payload].concat(),
            base: of_base.chain(of_payload).collect(),
        }
    }

    /// Reference at a sample.
    ///
    /// # Errors
    ///
    /// If the reference cannot compute the Jacobians there.
    pub fn at<'a>(&'a self, sample: &'a Sample) -> Result<Truth<'a>, Failure> {
        let side = |state| -> Result<ReferenceSide<'a>, Failure> {
            Ok(ReferenceSide {
                dynamics: Dynamics::new(&self.mechanism, state)?,
                platform: OnceCell::new(),
                loads: OnceCell::new(),
            })
        };
        Ok(Truth {
            expected: self,
            sample,
            here: side(&sample.state)?,
            fitted: side(&sample.fitted)?,
        })
    }

    /// Reference output of a function at a sample.
    ///
    /// # Errors
    ///
    /// If the reference cannot compute it.
    pub fn output(
        &self,
        function: Function,
        from: MotionInput,
        sample: &Sample,
    ) -> Result<DMatrix<f64>, Failure> {
        self.at(sample)?.output(function, from)
    }

    fn chosen(&self, columns: Columns) -> &[usize] {
        match columns {
            Columns::Standard => &self.standard,
            Columns::Base => &self.base,
        }
    }

    /// The orthonormal basis of the null space of (J_p^inv)ᵀ that the model chooses.
    ///
    /// It orthonormalises the unit torques of the projected actuators in order, without components
    /// that move the platform.
    fn null_space(&self, dynamics: &Dynamics<'_>) -> DMatrix<f64> {
        let mut any = dynamics.internal_loads();
        for mut column in any.column_iter_mut() {
            let signed = dynamics.with_tensions(&column.clone_owned());
            column.copy_from(&signed);
        }
        let mut basis = DMatrix::zeros(any.nrows(), 0);
        for projected in (0..any.nrows()).filter(|at| !self.kept.contains(at)) {
            let mut inside = &any * any.row(projected).transpose();
            inside -= &basis * (basis.transpose() * &inside);
            let last = basis.ncols();
            basis = basis.insert_column(last, 0.0);
            basis.set_column(last, &inside.normalize());
        }
        basis
    }
}

/// Reference at one sample; quantities that several functions need are computed once.
#[derive(Debug)]
pub struct Truth<'a> {
    expected: &'a Expected,
    sample: &'a Sample,
    here: ReferenceSide<'a>,
    fitted: ReferenceSide<'a>,
}

/// Reference in the sample's state, or in the one fitted to its actuators.
#[derive(Debug)]
struct ReferenceSide<'a> {
    dynamics: Dynamics<'a>,
    /// Standard regressor of the platform projection, all columns.
    platform: OnceCell<DMatrix<f64>>,
    /// Right-hand sides of (16), all columns.
    loads: OnceCell<DMatrix<f64>>,
}

impl ReferenceSide<'_> {
    fn platform(&self) -> Result<&DMatrix<f64>, Failure> {
        if let Some(known) = self.platform.get() {
            return Ok(known);
        }
        let computed = self.dynamics.idm_red_platform()?;
        Ok(self.platform.get_or_init(|| computed))
    }

    fn partition(&self, kept: &[usize]) -> Result<Partition, Failure> {
        let loads = self
            .loads
            .get_or_init(|| self.dynamics.tree_and_platform_regressor());
        Ok(self.dynamics.partition(kept, loads)?)
    }
}

impl Truth<'_> {
    /// Reference dynamics in the sample's state.
    #[must_use]
    pub const fn dynamics(&self) -> &Dynamics<'_> {
        &self.here.dynamics
    }

    /// Reference columns of the model's standard parameters.
    #[must_use]
    pub fn standard(&self) -> &[usize] {
        &self.expected.standard
    }

    /// Actuator projection in the sample's state for any kept actuators, with all columns.
    ///
    /// # Errors
    ///
    /// If the partition is singular there.
    pub fn partition(&self, kept: &[usize]) -> Result<Partition, Failure> {
        self.here.partition(kept)
    }

    /// The output of a function.
    ///
    /// # Errors
    ///
    /// If the reference can't compute it.
    pub fn output(&self, function: Function, from: MotionInput) -> Result<DMatrix<f64>, Failure> {
        let dynamic = matches!(
            function,
            Function::IdmRedPlatform(_)
                | Function::IdmRedActuators(_)
                | Function::IdmRedPayload
                | Function::InverseDynamics(_)
        );
        let fitted = dynamic && from == MotionInput::Actuators;
        let side = if fitted { &self.fitted } else { &self.here };
        let own = frames::output(&self.expected.frames, &side.dynamics, function, self.sample)?;
        if let Some(matrix) = own {
            return Ok(matrix);
        }
        let tolerance = self.expected.tolerance_of_derivatives;
        let own = derivatives::output(&side.dynamics, function, self.sample, tolerance)?;
        if let Some(matrix) = own {
            return Ok(matrix);
        }
        match kinematic(&side.dynamics, function, self.sample)? {
            Some(matrix) => Ok(matrix),
            None => self.dynamic(side, function),
        }
    }

    fn dynamic(
        &self,
        side: &ReferenceSide<'_>,
        function: Function,
    ) -> Result<DMatrix<f64>, Failure> {
        let (expected, dynamics) = (self.expected, &side.dynamics);
        let chi = &self.sample.all_parameters;
        let torques = DVector::from_column_slice(&self.sample.torques);
        let torques = dynamics.with_tensions(&torques);
        let least_norm = || dynamics.least_norm_torques(chi);
        let has_cables = dynamics.mechanism.has_cables();
        Ok(match function {
            Function::IdmRedPlatform(columns) => {
                side.platform()?.select_columns(expected.chosen(columns))
            }
            Function::IdmRedActuators(columns) => {
                let partition = side.partition(&expected.kept)?;
                partition.regressor.select_columns(expected.chosen(columns))
            }
            Function::IdmRedPayload => side.platform()?.select_columns(&expected.payload),
            Function::IdmRedPayloadActuators => {
                let partition = side.partition(&expected.kept)?;
                partition.regressor.select_columns(&expected.payload)
            }
            Function::ProjectActuators => {
                let partition = side.partition(&expected.kept)?;
                let projected = torques.select_rows(&partition.projected);
                vector(&(torques.select_rows(&expected.kept) - partition.projection * projected))
            }
            // Base parameters contain all others by regrouping: the torques and the motion are the
            // same.
            Function::InverseDynamics(_) if has_cables => vector(&dynamics.tensions(chi)?),
            Function::InverseDynamics(_) => vector(&least_norm()?),
            Function::InverseDynamicsPreloaded => {
                let preload = DVector::from_column_slice(&self.sample.preload);
                let torques = dynamics.with_tensions(&least_norm()?);
                vector(&(torques + expected.null_space(dynamics) * preload))
            }
            Function::MassMatrix(_) => dynamics.mass_matrix_and_bias(chi)?.0,
            Function::Bias(_) => vector(&dynamics.mass_matrix_and_bias(chi)?.1),
            Function::ForwardDynamics(_) => {
                let (mass, bias) = dynamics.mass_matrix_and_bias(chi)?;
                let forces = dynamics.jacobians.inverse.transpose() * &torques - bias;
                let solved = mass.lu().solve(&forces);
                vector(&solved.ok_or("the mass matrix is singular")?)
            }
            Function::ProjectTorques => {
                vector(&dynamics.with_tensions(&dynamics.project_torques(&torques)))
            }
            Function::NullSpace => expected.null_space(dynamics),
            other => return Err(format!("the reference has no {other:?}").into()),
        })
    }
}

/// Smallest eigenvalue of the normalised mass matrix for which the motion is compared.
const SMALLEST_MASS_EIGENVALUE: f64 = 1e-8;

/// Whether every motion has kinetic energy at all samples.
///
/// A description may omit the parameters of everything that a joint moves; torques then do not
/// determine its acceleration.
///
/// # Errors
///
/// If the reference can't compute the mass matrix.
pub fn has_masses(truths: &[Truth<'_>]) -> Result<bool, Failure> {
    for truth in truths {
        let mass = truth.output(Function::MassMatrix(Columns::Standard), MotionInput::Pose)?;
        let scale = mass.diagonal().map(|entry| entry.sqrt().recip());
        let scaled = DMatrix::from_diagonal(&scale) * mass * DMatrix::from_diagonal(&scale);
        let is_finite = scaled.iter().all(|entry| entry.is_finite());
        if !is_finite || scaled.symmetric_eigenvalues().min() < SMALLEST_MASS_EIGENVALUE {
            return Ok(false);
        }
    }
    Ok(true)
}

/// Output of functions without parameters; `None` for others.
fn kinematic(
    dynamics: &Dynamics<'_>,
    function: Function,
    sample: &Sample,
) -> Result<Option<DMatrix<f64>>, Failure> {
    let (mechanism, state, jacobians) = (dynamics.mechanism, dynamics.state, &dynamics.jacobians);
    Ok(Some(match function {
        Function::PoseInClosedForm => DMatrix::from_column_slice(state.pose.len(), 1, &state.pose),
        Function::Joints => vector(&state.q),
        Function::ActuatorPositions => vector(&(&jacobians.transmission * &state.q)),
        Function::PoseStep => {
            let measured = DVector::from_column_slice(&sample.missed);
            let reached = &jacobians.transmission * &state.q;
            vector(&(pseudo_inverse(&jacobians.inverse) * (measured - reached)))
        }
        Function::InverseJacobian => jacobians.inverse.clone(),
        Function::Jacobian => pseudo_inverse(&jacobians.inverse),
        Function::ClosurePlatformJacobian => jacobians.a_p.clone(),
        Function::ClosureActuatorJacobian => jacobians.b_p.clone(),
        Function::LegsJacobian => jacobians.legs.clone(),
        Function::LegsPlatformJacobian => jacobians.platform.clone(),
        Function::PlatformJacobian => rates(mechanism, &state.pose, &state.q)?[1].clone(),
        // The pose is one of the robot's.
        Function::BlockedError => DMatrix::zeros(6 - mechanism.dof(), 1),
        Function::PoseJacobian => jacobians.joints.select_rows(&mechanism.in_pose()),
        Function::PoseError => DMatrix::zeros(state.pose.len() - mechanism.dof(), 1),
        Function::JointVelocities => vector(&state.qd),
        Function::JointAccelerations => vector(&state.qdd),
        Function::TwistFromActuators => vector(&sample.fitted.twist),
        Function::AccelerationFromActuators => {
            let measured = DVector::from_column_slice(&sample.actuator_accelerations);
            vector(&fitted_acceleration(
                mechanism,
                state,
                &state.twist,
                &measured,
            )?)
        }
        Function::ProjectPlatform => {
            let torques = DVector::from_column_slice(&sample.torques);
            vector(&dynamics.project_on_platform(&dynamics.with_tensions(&torques)))
        }
        _ => return Ok(None),
    }))
}

/// State shifted by full turns to the joints that a model gives.
///
/// # Errors
///
/// If a joint does not differ by full turns.
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
