//! Context in which a function is derived: the robot, the inputs used, and the guards that arise.

use super::derivation_error::DerivationError;
use super::guard::{Guard, GuardKind};
use super::motion_input::MotionInput;
use super::parameter::BodyParameter;
use super::selection::{JointsBy, Selection};
use crate::cas::{Arena, Expr};
use crate::derivation::linear_algebra::elimination::Rows;
use crate::derivation::robot::Robot;
use crate::mechanism::Mechanism;
use overact_core::ActuatorGroup;

/// The bodies whose parameters have values in expressions that are linear in the parameters.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) enum Owner {
    /// All bodies of the robot.
    #[default]
    Robot,
    /// The bodies of this leg; all other parameters are zero.
    Leg(usize),
    /// The platform and the payload; all other parameters are zero.
    Platform,
}

impl Owner {
    /// Whether a parameter has its value.
    pub(super) fn has(self, parameter: BodyParameter) -> bool {
        match (self, parameter) {
            (Self::Robot, _) => true,
            (Self::Leg(own), BodyParameter::Leg { leg, .. }) => own == leg,
            (Self::Platform, BodyParameter::Leg { .. }) => false,
            (Self::Leg(_), _) => false,
            (Self::Platform, _) => true,
        }
    }
}

/// Context in which one function is derived.
pub(super) struct DerivationContext<'a, 's> {
    pub(super) robot: Robot<'a>,
    pub(super) selection: &'s Selection,
    pub(super) from: MotionInput,
    /// Independent velocities computed from those of the actuators.
    pub(super) twist: Vec<Expr<'a>>,
    pub(super) inputs: Vec<(&'static str, usize)>,
    /// The bodies whose parameters have values.
    pub(super) owner: Owner,
    pub(super) guards: Vec<Guard<'a>>,
}

impl<'a, 's> DerivationContext<'a, 's> {
    /// Derives the robot; `still` are pose coordinates that are known to be zero.
    ///
    /// # Errors
    /// See [`Robot::new`], [`Robot::check_formulas`], [`Robot::check_motors`] and
    /// [`Robot::check_point_springs`].
    pub(super) fn new(
        arena: &'a Arena,
        mechanism: &'a Mechanism,
        selection: &'s Selection,
        from: MotionInput,
        still: &[usize],
    ) -> Result<Self, DerivationError> {
        let configuration = match (from, selection.joints) {
            (MotionInput::Pose | MotionInput::Actuators, JointsBy::Rule) => MotionInput::Pose,
            _ => MotionInput::Joints,
        };
        let robot = Robot::new(
            arena,
            mechanism,
            configuration,
            &selection.formulation,
            still,
        )?;
        robot.check_formulas()?;
        robot.check_motors()?;
        robot.check_point_springs()?;
        Ok(Self {
            inputs: configuration_inputs(&robot, configuration),
            robot,
            selection,
            from,
            twist: Vec::new(),
            owner: Owner::default(),
            guards: Vec::new(),
        })
    }

    /// An input of the function.
    pub(super) fn input(&mut self, name: &'static str, count: usize) -> Vec<Expr<'a>> {
        if !self.inputs.contains(&(name, count)) {
            self.inputs.push((name, count));
        }
        self.robot.inputs(name, count)
    }

    /// A zero twist or acceleration.
    pub(super) fn zeros(&self) -> Vec<Expr<'a>> {
        vec![self.robot.arena.zero(); self.robot.mechanism.dof()]
    }

    /// Guards the determinants of the actuators' rows, which are zero if they do not determine the
    /// motion.
    pub(super) fn guard_platform(&mut self, values: &[Expr<'a>], actuators: ActuatorGroup) {
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
}

/// The inputs that determine sines and cosines of the configuration.
fn configuration_inputs(robot: &Robot<'_>, from: MotionInput) -> Vec<(&'static str, usize)> {
    let joints = ("joints", robot.mechanism.joints().len());
    let pose = ("pose", robot.mechanism.pose_len());
    match (robot.mechanism.is_tree(), from) {
        (true, _) => vec![joints],
        (false, MotionInput::Pose | MotionInput::Actuators) => vec![pose],
        (false, MotionInput::Joints) => vec![pose, joints],
    }
}

/// A vector as a matrix of one column.
pub(super) fn column(values: Vec<Expr<'_>>) -> Rows<'_> {
    values.into_iter().map(|v| vec![v]).collect()
}
