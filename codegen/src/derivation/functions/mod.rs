//! The functions that every robot has, as named inputs and output expressions.

mod actuators;
mod derivative_functions;
mod divisors;
mod dynamic_functions;
mod frame_functions;
pub(crate) mod inventory;
mod kinematic_functions;
mod mass_functions;
mod matrices;
pub(crate) mod sums;

use crate::cas::{Arena, Expr};
use crate::derivation::context::{DerivationContext, column};
use crate::derivation::derivation_error::DerivationError;
use crate::derivation::forward::closed_form::closed_form;
use crate::derivation::function_form::FunctionForm;
use crate::derivation::guard::{Guard, GuardKind};
use crate::derivation::linear_algebra::elimination::Rows;
use crate::derivation::motion_input::MotionInput;
use crate::derivation::selection::{JointsBy, Selection};
use crate::mechanism::Mechanism;
use derivative_functions::Variable;
use overact_core::Function;

/// A function as expressions.
#[derive(Debug)]
pub struct Derived<'a> {
    /// Names and lengths of the inputs.
    pub inputs: Vec<(&'static str, usize)>,
    /// Rows and columns of the output; one column for a vector.
    pub shape: (usize, usize),
    /// The output, row-major.
    pub entries: Vec<Expr<'a>>,
    /// Guards of the output.
    pub guards: Vec<Guard<'a>>,
    /// Guards of all divisors of the output.
    pub divisors: Vec<Guard<'a>>,
}

impl Derived<'_> {
    /// The columns that are not identically zero.
    #[must_use]
    pub(crate) fn present_columns(&self) -> Vec<usize> {
        let (rows, columns) = self.shape;
        let is_present = |&c: &usize| (0..rows).any(|r| !self.entries[r * columns + c].is_zero());
        (0..columns).filter(is_present).collect()
    }

    /// Removes all columns but some.
    pub(crate) fn keep_columns(&mut self, kept: &[usize]) {
        let (rows, columns) = self.shape;
        let row = |r: usize| kept.iter().map(move |c| r * columns + c);
        let entries = (0..rows).flat_map(row).map(|at| self.entries[at]);
        self.entries = entries.collect();
        self.shape = (rows, kept.len());
    }
}

/// Derives a function in its own graph.
///
/// # Errors
/// See [`DerivationError`].
pub fn derive<'a>(
    arena: &'a Arena,
    mechanism: &'a Mechanism,
    selection: &Selection,
    function: Function,
    from: MotionInput,
) -> Result<Derived<'a>, DerivationError> {
    let derived = match function {
        Function::PoseInClosedForm => pose_in_closed_form(arena, mechanism)?,
        Function::TotalMass => mass_functions::total_mass(arena, selection),
        _ => {
            let form = FunctionForm { function, from };
            derive_with(arena, mechanism, selection, form, |context| {
                context.rows(function)
            })?
        }
    };
    with_divisors(arena, mechanism, derived)
}

/// Guards the divisors of the output.
pub(crate) fn with_divisors<'a>(
    arena: &'a Arena,
    mechanism: &Mechanism,
    mut derived: Derived<'a>,
) -> Result<Derived<'a>, DerivationError> {
    // Conditions on the pose are computed separately and may have more divisors than the output.
    let of_pose = derived.guards.iter();
    let of_pose = of_pose.filter(|guard| matches!(guard.kind, GuardKind::Closed(_)));
    let mut computed = derived.entries.clone();
    computed.extend(of_pose.map(|guard| guard.value));
    derived.divisors = divisors::conditions(arena, mechanism, &computed, &derived.guards);
    let singular = |guard: &&Guard<'_>| guard.kind.home().is_some_and(|home| !home.is_finite());
    let mut guards = derived.guards.iter().chain(&derived.divisors);
    match guards.find(singular) {
        Some(guard) => Err(DerivationError::SingularHome {
            leg: guard.leg.clone(),
        }),
        None => Ok(derived),
    }
}

/// Derives a function of the configuration whose output is made by `rows`.
pub(crate) fn derive_with<'a, 's>(
    arena: &'a Arena,
    mechanism: &'a Mechanism,
    selection: &'s Selection,
    form: FunctionForm,
    rows: impl FnOnce(&mut DerivationContext<'a, 's>) -> Result<Rows<'a>, DerivationError>,
) -> Result<Derived<'a>, DerivationError> {
    let FunctionForm { function, from } = form;
    // Forward kinematics yields a closed pose; functions that project onto the closures start from
    // other poses.
    let brings_back = matches!(
        function,
        Function::BlockedError
            | Function::BlockedJacobian
            | Function::PoseError
            | Function::PoseErrorJacobian
    );
    let closes = matches!(function, Function::ClosureError | Function::LegsJacobian);
    let still = if brings_back || closes {
        &[][..]
    } else {
        &mechanism.still
    };
    let mut context = DerivationContext::new(arena, mechanism, selection, from, still)?;
    let rows = rows(&mut context)?;
    context.robot.give_names();
    let shape = (rows.len(), rows.first().map_or(0, Vec::len));
    let mut guards = context.robot.guards.clone();
    guards.extend(context.guards);
    // If Newton's method finds the joints, functions of the pose call those of the joints.
    let is_of_pose = match selection.joints {
        JointsBy::Newton => from != MotionInput::Actuators,
        JointsBy::Rule => from == MotionInput::Pose,
    };
    // Coordinates assumed zero violate this more than any quantity derived from them.
    if from != MotionInput::Actuators {
        guards.extend(context.robot.still_guards(still));
    }
    if is_of_pose && !brings_back && !closes {
        guards.extend(context.robot.closed_guards());
    }
    if brings_back {
        guards.retain(|guard| !matches!(guard.kind, GuardKind::Coordinates(_)));
    }
    Ok(Derived {
        inputs: context.inputs,
        shape,
        entries: rows.concat(),
        guards,
        divisors: Vec::new(),
    })
}

/// Forward kinematics in closed form.
fn pose_in_closed_form<'a>(
    arena: &'a Arena,
    mechanism: &'a Mechanism,
) -> Result<Derived<'a>, DerivationError> {
    let found = closed_form(arena, mechanism).ok_or(DerivationError::ForwardKinematics)?;
    let guards = found.reach.into_iter().map(|(reach, leg)| Guard {
        value: reach.radicand,
        kind: GuardKind::Reach(mechanism.home.value(arena, reach.radicand).abs()),
        leg,
    });
    Ok(Derived {
        inputs: vec![("actuators", mechanism.actuator_count())],
        shape: (found.pose.len(), 1),
        entries: found.pose,
        guards: guards.collect(),
        divisors: Vec::new(),
    })
}

impl<'a> DerivationContext<'a, '_> {
    /// The output of each function, row by row.
    fn rows(&mut self, function: Function) -> Result<Rows<'a>, DerivationError> {
        let n = self.robot.mechanism.actuator_count();
        Ok(match function {
            Function::PoseInClosedForm | Function::TotalMass => {
                return Err(DerivationError::ForwardKinematics);
            }
            Function::Joints => column(self.joint_positions()),
            Function::ActuatorPositions => column(self.actuator_positions()),
            Function::PoseStep => column(self.pose_step()),
            Function::InverseJacobian => self.robot.inverse_jacobian(),
            Function::Jacobian => self.pseudo_inverse(),
            Function::ClosurePlatformJacobian => self.closure_matrices().0,
            Function::ClosureActuatorJacobian => self.closure_matrices().1,
            Function::LegsJacobian => self.leg_matrices().0,
            Function::LegsPlatformJacobian => self.leg_matrices().1,
            Function::ClosureError => self.closure_error(),
            Function::PlatformJacobian | Function::PoseJacobian => self.platform_jacobian(),
            Function::BlockedError | Function::PoseError => self.blocked_error(),
            Function::BlockedJacobian | Function::PoseErrorJacobian => self.blocked_jacobian(),
            Function::JointVelocities => {
                let twist = self.twist();
                let still = self.zeros();
                column(self.joint_motion(&twist, &still).0)
            }
            Function::JointAccelerations => {
                let (twist, acceleration) = (self.twist(), self.acceleration());
                column(self.joint_motion(&twist, &acceleration).1)
            }
            Function::TwistFromActuators => {
                let rates = self.input("actuator_velocities", n);
                column(self.least_squares(&rates))
            }
            Function::AccelerationFromActuators => {
                let twist = self.twist();
                column(self.acceleration_of(&twist))
            }
            Function::IdmRedPlatform(columns) => self.on_platform(&self.chosen(columns)),
            Function::IdmRedActuators(columns) => self.on_actuators(&self.chosen(columns))?,
            Function::IdmRedPayload => self.on_platform(&self.selection.payload),
            Function::IdmRedPayloadActuators => self.on_actuators(&self.selection.payload)?,
            Function::ProjectPlatform => {
                let torques = self.input("torques", n);
                column(self.robot.projected_torques(&torques))
            }
            Function::ProjectActuators => self.project_actuators(n)?,
            Function::InverseDynamics(of) if self.robot.mechanism.has_cables() => {
                self.tension_system(of)?
            }
            Function::InverseDynamics(of) => column(self.least_norm_torques(of)),
            Function::InverseDynamicsPreloaded => self.preloaded_torques(n)?,
            Function::MassMatrix(of) => self.mass_matrix(of),
            Function::Bias(of) => {
                let twist = self.twist();
                let still = self.zeros();
                column(self.projected_dynamics(of, &twist, &still))
            }
            Function::ForwardDynamics(of) => column(self.forward_dynamics(of, n)),
            Function::ProjectTorques => column(self.project_torques(n)),
            Function::NullSpace => self.null_space()?,
            Function::CentreOfMass => column(self.centre_of_mass()),
            Function::CentreOfMassJacobian => self.centre_of_mass_jacobian(),
            Function::KineticEnergy => column(vec![self.kinetic_energy()]),
            Function::PotentialEnergy => column(vec![self.potential_energy()]),
            Function::InverseDynamicsByDisplacement(of) => {
                self.inverse_dynamics_by(of, Variable::Displacement)
            }
            Function::InverseDynamicsByTwist(of) => self.inverse_dynamics_by(of, Variable::Twist),
            Function::ForwardDynamicsByDisplacement(of) => {
                self.forward_dynamics_by(of, Variable::Displacement, n)
            }
            Function::ForwardDynamicsByTwist(of) => {
                self.forward_dynamics_by(of, Variable::Twist, n)
            }
            Function::Frame(of) => self.frame_rows(of)?,
        })
    }
}
