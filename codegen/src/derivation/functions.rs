//! The functions that every robot has, as named inputs and output expressions.

use super::configuration::angle_near;
use super::elimination::Rows;
use super::forward_kinematics::closed_form;
use super::guard::{Guard, GuardKind};
use super::linear::{Factored, apply, null_space, product, pseudo_inverse, transposed};
use super::motion_input::MotionInput;
use super::names::coordinate_label;
use super::parameter::BodyParameter;
use super::regressor::Projection;
use super::robot::Robot;
use super::selection::{JointsBy, Selection};
use super::underivable::Underivable;
use crate::cas::{Arena, Expr};
use crate::mechanism::{JointKind, Mechanism};
use overact_core::{Columns, Function};

/// A function as expressions.
#[derive(Debug)]
pub struct Derived<'a> {
    /// Names and lengths of the inputs.
    pub inputs: Vec<(&'static str, usize)>,
    /// Rows and columns of the output; one column for a vector.
    pub shape: (usize, usize),
    /// The output, row-major.
    pub entries: Vec<Expr<'a>>,
    /// Conditions for the output to have a value.
    pub guards: Vec<Guard<'a>>,
}

impl Derived<'_> {
    /// The columns that are not identically zero.
    #[must_use]
    pub fn present_columns(&self) -> Vec<usize> {
        let (rows, columns) = self.shape;
        let is_present = |&c: &usize| (0..rows).any(|r| !self.entries[r * columns + c].is_zero());
        (0..columns).filter(is_present).collect()
    }

    /// Leaves out all columns but some.
    pub fn keep_columns(&mut self, kept: &[usize]) {
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
/// See [`Underivable`].
pub fn derive<'a>(
    arena: &'a Arena,
    mechanism: &'a Mechanism,
    selection: &Selection,
    function: Function,
    from: MotionInput,
) -> Result<Derived<'a>, Underivable> {
    if function == Function::PoseInClosedForm {
        return pose_in_closed_form(arena, mechanism);
    }
    let configuration = match (from, selection.joints) {
        (MotionInput::Pose | MotionInput::Actuators, JointsBy::Rule) => MotionInput::Pose,
        _ => MotionInput::Joints,
    };
    let robot = Robot::new(arena, mechanism, configuration, &selection.formulation)?;
    let mut sheet = Sheet {
        inputs: robot.configuration_inputs(configuration),
        robot,
        selection,
        from,
        twist: Vec::new(),
        guards: Vec::new(),
    };
    let rows = sheet.rows(function)?;
    sheet.robot.give_names();
    let shape = (rows.len(), rows.first().map_or(0, Vec::len));
    let mut guards = sheet.robot.guards.clone();
    guards.extend(sheet.guards);
    Ok(Derived {
        inputs: sheet.inputs,
        shape,
        entries: rows.concat(),
        guards,
    })
}

/// Forward kinematics by rule.
fn pose_in_closed_form<'a>(
    arena: &'a Arena,
    mechanism: &'a Mechanism,
) -> Result<Derived<'a>, Underivable> {
    let found = closed_form(arena, mechanism).ok_or(Underivable::ForwardKinematics)?;
    let guards = found.reach.into_iter().map(|(reach, leg)| Guard {
        value: reach.radicand,
        kind: GuardKind::Reach,
        leg,
    });
    Ok(Derived {
        inputs: vec![("actuators", mechanism.actuated().len())],
        shape: (found.pose.len(), 1),
        entries: found.pose,
        guards: guards.collect(),
    })
}

/// A function being derived.
pub(super) struct Sheet<'a, 's> {
    pub(super) robot: Robot<'a>,
    selection: &'s Selection,
    from: MotionInput,
    twist: Vec<Expr<'a>>,
    inputs: Vec<(&'static str, usize)>,
    guards: Vec<Guard<'a>>,
}

impl<'a> Robot<'a> {
    fn configuration_inputs(&self, from: MotionInput) -> Vec<(&'static str, usize)> {
        let joints = ("joints", self.mechanism.joints().len());
        match (&self.platform, from) {
            (None, _) => vec![joints],
            (Some(_), MotionInput::Pose | MotionInput::Actuators) => {
                vec![("pose", self.mechanism.pose_len())]
            }
            (Some(_), MotionInput::Joints) => vec![("pose", self.mechanism.pose_len()), joints],
        }
    }
}

impl<'a> Sheet<'a, '_> {
    fn input(&mut self, name: &'static str, count: usize) -> Vec<Expr<'a>> {
        self.inputs.push((name, count));
        self.robot.inputs(name, count)
    }

    /// Twist and acceleration under the names that the robot's kind calls for; from actuators, those
    /// that fit the actuators' rates best.
    fn twist(&mut self) -> Vec<Expr<'a>> {
        let tree = self.robot.platform.is_none();
        if self.from == MotionInput::Actuators {
            let rates = self.input("actuator_velocities", self.robot.mechanism.actuated().len());
            self.twist = self.least_squares(&rates);
            self.name_coordinates(&self.twist, "");
            return self.twist.clone();
        }
        self.input(
            if tree { "joint_velocities" } else { "twist" },
            self.robot.mechanism.dof(),
        )
    }

    fn acceleration(&mut self) -> Vec<Expr<'a>> {
        let tree = self.robot.platform.is_none();
        if self.from == MotionInput::Actuators {
            let twist = self.twist.clone();
            let acceleration = self.acceleration_of(&twist);
            self.name_coordinates(&acceleration, "d");
            return acceleration;
        }
        self.input(
            if tree {
                "joint_accelerations"
            } else {
                "acceleration"
            },
            self.robot.mechanism.dof(),
        )
    }

    fn rows(&mut self, function: Function) -> Result<Rows<'a>, Underivable> {
        let n = self.robot.mechanism.actuated().len();
        Ok(match function {
            Function::PoseInClosedForm => return Err(Underivable::ForwardKinematics),
            Function::Joints => column(self.joint_positions()),
            Function::ActuatorPositions => {
                let all = self.joint_positions();
                column(
                    self.robot
                        .mechanism
                        .actuated()
                        .iter()
                        .map(|&i| all[i])
                        .collect(),
                )
            }
            Function::InverseJacobian => self.robot.inverse_jacobian(),
            Function::Jacobian => self.pseudo_inverse(),
            Function::ClosurePlatformJacobian => self.closure_matrices().0,
            Function::ClosureActuatorJacobian => self.closure_matrices().1,
            Function::LegsJacobian => self.leg_matrices().0,
            Function::LegsPlatformJacobian => self.leg_matrices().1,
            Function::ClosureError => self.closure_error(),
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
            Function::IdmRedPlatform(columns) => {
                let projection = self.robot.project_on_platform();
                self.columns(&projection, &self.chosen(columns))
            }
            Function::IdmRedActuators(columns) => {
                let projection = self.on_actuators()?;
                self.columns(&projection, &self.chosen(columns))
            }
            Function::IdmRedPayload => {
                let projection = self.robot.project_on_platform();
                self.columns(&projection, &self.selection.payload.clone())
            }
            Function::IdmRedPayloadActuators => {
                let projection = self.on_actuators()?;
                self.columns(&projection, &self.selection.payload.clone())
            }
            Function::ProjectPlatform => {
                let torques = self.input("torques", n);
                column(self.robot.projected_torques(&torques))
            }
            Function::ProjectActuators => self.project_actuators(n)?,
            Function::InverseDynamics => column(self.least_norm_torques()),
            Function::InverseDynamicsPreloaded => self.preloaded_torques(n),
            Function::MassMatrix => self.mass_matrix(),
            Function::Bias => {
                let twist = self.twist();
                let still = self.zeros();
                column(self.projected_dynamics(&twist, &still))
            }
            Function::ProjectTorques => {
                let torques = self.input("torques", n);
                if n == self.robot.mechanism.dof() {
                    return Ok(column(torques));
                }
                let jacobian = self.robot.inverse_jacobian();
                let inner = apply(&transposed(&jacobian), &torques);
                let solved = self.factored(&jacobian).solve(&inner);
                column(apply(&jacobian, &solved))
            }
            Function::NullSpace => self.null_space(),
        })
    }

    /// Names independent velocities or accelerations that are no inputs.
    fn name_coordinates(&self, values: &[Expr<'a>], prefix: &str) {
        for (coordinate, value) in self.robot.twist.iter().zip(values) {
            let _ = value.named(&format!("{prefix}{}", coordinate_label(coordinate)));
        }
    }

    fn zeros(&self) -> Vec<Expr<'a>> {
        vec![self.robot.arena.zero(); self.robot.mechanism.dof()]
    }

    /// Positions of all joints, within half a turn of the home configuration.
    fn joint_positions(&mut self) -> Vec<Expr<'a>> {
        let (arena, mechanism) = (self.robot.arena, self.robot.mechanism);
        let configuration = &self.robot.configuration;
        let position = |(index, of): (usize, &crate::mechanism::JointIndex)| {
            if mechanism.platform.is_none() || configuration.from() == MotionInput::Joints {
                return arena.input("joints", index);
            }
            if mechanism.joint(*of).kind == JointKind::Prismatic {
                return configuration
                    .joint_position(index)
                    .unwrap_or_else(|| arena.zero());
            }
            let home = mechanism.home.joints[index];
            match configuration.unit(&configuration.joint_angle(index)) {
                Some(unit) => angle_near(arena, unit, home),
                None => arena.zero(),
            }
        };
        mechanism
            .joints()
            .iter()
            .enumerate()
            .map(position)
            .collect()
    }

    fn factored(&mut self, jacobian: &Rows<'a>) -> Factored<'a> {
        let factored = Factored::normal(jacobian);
        self.guard_platform(&factored.pivots.clone(), "actuators");
        factored
    }

    fn pseudo_inverse(&mut self) -> Rows<'a> {
        let (inverse, pivots) = pseudo_inverse(&self.robot.inverse_jacobian());
        self.guard_platform(&pivots, "actuators");
        inverse
    }

    fn guard_platform(&mut self, values: &[Expr<'a>], actuators: &'static str) {
        for value in values {
            let (_, base) = value.factor_and_base();
            if base.as_number().is_none() {
                let kind = GuardKind::Platform {
                    home: self.robot.at_home(base).abs(),
                    actuators,
                };
                self.guards.push(Guard {
                    value: base,
                    kind,
                    leg: String::new(),
                });
            }
        }
    }

    fn least_squares(&mut self, rates: &[Expr<'a>]) -> Vec<Expr<'a>> {
        let jacobian = self.robot.inverse_jacobian();
        let inner = apply(&transposed(&jacobian), rates);
        self.factored(&jacobian).solve(&inner)
    }

    /// v̇ of least squares: J_p^inv v̇ = q̈ - J̇_p^inv v, where the last term is q̈ at v̇ = 0.
    fn acceleration_of(&mut self, twist: &[Expr<'a>]) -> Vec<Expr<'a>> {
        let actuated = self.robot.mechanism.actuated();
        let measured = self.input("actuator_accelerations", actuated.len());
        let still = self.zeros();
        let bias = self.joint_motion(twist, &still).1;
        let rest: Vec<Expr<'a>> = measured
            .iter()
            .zip(&actuated)
            .map(|(m, &i)| *m - bias[i])
            .collect();
        self.least_squares(&rest)
    }

    fn joint_motion(
        &mut self,
        twist: &[Expr<'a>],
        acceleration: &[Expr<'a>],
    ) -> (Vec<Expr<'a>>, Vec<Expr<'a>>) {
        match self.robot.motion(twist, acceleration) {
            Some(motion) => (
                self.robot.joint_values(&motion.u),
                self.robot.joint_values(&motion.u_dot),
            ),
            None => (Vec::new(), Vec::new()),
        }
    }

    fn chosen(&self, columns: Columns) -> Vec<BodyParameter> {
        match columns {
            Columns::Standard => self.selection.standard.clone(),
            Columns::Base => self.selection.base.clone(),
        }
    }

    fn on_actuators(&mut self) -> Result<Projection<'a>, Underivable> {
        let projection = self
            .robot
            .project_on_actuators(&self.selection.kept_actuators)?;
        self.guard_platform(&projection.determinants, "kept actuators");
        Ok(projection)
    }

    fn columns(&mut self, projection: &Projection<'a>, of: &[BodyParameter]) -> Rows<'a> {
        let (twist, acceleration) = (self.twist(), self.acceleration());
        let Some(motion) = self.robot.motion(&twist, &acceleration) else {
            return Vec::new();
        };
        let selection = self.selection;
        let combination = |p: BodyParameter| {
            let found = selection.combined.iter().find(|c| c.parameter == p)?;
            found
                .of
                .iter()
                .all(|(q, _)| of.contains(q))
                .then_some(found)
        };
        let direct = |p: BodyParameter| self.robot.column(&motion, projection, p);
        let own: Vec<Option<Vec<Expr<'a>>>> = of
            .iter()
            .map(|&p| combination(p).is_none().then(|| direct(p)))
            .collect();
        let column_of =
            |p: BodyParameter| of.iter().position(|q| *q == p).and_then(|i| own[i].clone());
        let columns: Rows<'a> = of
            .iter()
            .zip(&own)
            .map(|(&p, own)| match (own, combination(p)) {
                (None, Some(combination)) => self
                    .robot
                    .combined(combination, &column_of)
                    .unwrap_or_else(|| direct(p)),
                (Some(own), _) => own.clone(),
                (None, None) => direct(p),
            })
            .collect();
        if columns.is_empty() {
            return vec![Vec::new(); self.robot.mechanism.dof()];
        }
        transposed(&columns)
    }

    fn project_actuators(&mut self, n: usize) -> Result<Rows<'a>, Underivable> {
        let torques = self.input("torques", n);
        let projection = self
            .robot
            .project_on_actuators(&self.selection.kept_actuators)?;
        self.guard_platform(&projection.determinants, "kept actuators");
        let kept = &self.selection.kept_actuators;
        let jacobian = self.robot.inverse_jacobian();
        // Γ² = τ_a + J_a^-T J_bᵀ τ_b
        let others: Vec<usize> = (0..n).filter(|i| !kept.contains(i)).collect();
        let rows: Rows<'a> = others.iter().map(|&i| jacobian[i].clone()).collect();
        let moved = product(&rows, projection.platform_rows());
        let entry = |k: usize| {
            others
                .iter()
                .zip(&moved)
                .fold(torques[kept[k]], |sum, (&i, row)| sum + row[k] * torques[i])
        };
        Ok(column((0..kept.len()).map(entry).collect()))
    }

    fn parameter_values(&mut self) -> Vec<(BodyParameter, Expr<'a>)> {
        let all: Vec<BodyParameter> = self
            .selection
            .standard
            .iter()
            .chain(&self.selection.payload)
            .copied()
            .collect();
        let values = self.input("parameters", all.len());
        all.into_iter().zip(values).collect()
    }

    fn projected_dynamics(
        &mut self,
        twist: &[Expr<'a>],
        acceleration: &[Expr<'a>],
    ) -> Vec<Expr<'a>> {
        let values = self.parameter_values();
        let projection = self.robot.project_on_platform();
        match self.robot.motion(twist, acceleration) {
            Some(motion) => self.robot.generalised_forces(&motion, &projection, &values),
            None => Vec::new(),
        }
    }

    /// τ = J (JᵀJ)⁻¹ Γ¹, the torque of least norm.
    fn least_norm_torques(&mut self) -> Vec<Expr<'a>> {
        let (twist, acceleration) = (self.twist(), self.acceleration());
        let forces = self.projected_dynamics(&twist, &acceleration);
        let jacobian = self.robot.inverse_jacobian();
        let solved = self.factored(&jacobian).solve(&forces);
        apply(&jacobian, &solved)
    }

    fn preloaded_torques(&mut self, n: usize) -> Rows<'a> {
        let torques = self.least_norm_torques();
        let preload = self.input("preload", n - self.robot.mechanism.dof());
        let basis = self.null_space();
        let entry = |i: usize| {
            basis[i]
                .iter()
                .zip(&preload)
                .fold(torques[i], |sum, (b, c)| sum + *b * *c)
        };
        column((0..n).map(entry).collect())
    }

    fn null_space(&mut self) -> Rows<'a> {
        let jacobian = self.robot.inverse_jacobian();
        let kept = &self.selection.kept_actuators;
        let seeds: Vec<usize> = (0..jacobian.len()).filter(|i| !kept.contains(i)).collect();
        let pivots = Factored::normal(&jacobian).pivots;
        self.guard_platform(&pivots, "actuators");
        null_space(&jacobian, &seeds)
    }

    /// M = ∂Γ¹/∂v̇ at v = 0: Γ¹ is linear in v̇.
    fn mass_matrix(&mut self) -> Rows<'a> {
        let (arena, dof) = (self.robot.arena, self.robot.mechanism.dof());
        let acceleration = self.robot.inputs("acceleration", dof);
        let twist = self.zeros();
        let forces = self.projected_dynamics(&twist, &acceleration);
        let derivative =
            |force: &Expr<'a>, i: usize| force.derivative(arena.input_symbol("acceleration", i));
        forces
            .iter()
            .map(|f| (0..dof).map(|i| derivative(f, i)).collect())
            .collect()
    }
}

pub(super) fn column(values: Vec<Expr<'_>>) -> Rows<'_> {
    values.into_iter().map(|v| vec![v]).collect()
}
