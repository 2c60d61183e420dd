//! Kinematics of the whole robot: positions and rates of joints, and least-squares solutions from
//! the actuators.

use crate::cas::Expr;
use crate::derivation::context::DerivationContext;
use crate::derivation::linear_algebra::elimination::Rows;
use crate::derivation::motion_input::MotionInput;
use crate::derivation::names::coordinate_label;

impl<'a> DerivationContext<'a, '_> {
    /// The twist: an input, or the least-squares fit of the actuators' velocities.
    pub(crate) fn twist(&mut self) -> Vec<Expr<'a>> {
        let tree = self.robot.mechanism.is_tree();
        if self.from == MotionInput::Actuators {
            let rates = self.input("actuator_velocities", self.robot.mechanism.actuator_count());
            self.twist = self.least_squares(&rates);
            self.name_coordinates(&self.twist, "");
            return self.twist.clone();
        }
        self.input(
            if tree { "joint_velocities" } else { "twist" },
            self.robot.mechanism.dof(),
        )
    }

    /// The independent accelerations: an input, or the least-squares fit of the actuators'
    /// accelerations.
    pub(crate) fn acceleration(&mut self) -> Vec<Expr<'a>> {
        let tree = self.robot.mechanism.is_tree();
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

    /// Names independent velocities or accelerations that are not inputs.
    fn name_coordinates(&self, values: &[Expr<'a>], prefix: &str) {
        for (coordinate, value) in self.robot.twist.iter().zip(values) {
            let _ = value.named(&format!("{prefix}{}", coordinate_label(coordinate)));
        }
    }

    /// Positions of all joints, within half a turn of the home configuration.
    pub(crate) fn joint_positions(&mut self) -> Vec<Expr<'a>> {
        let robot = &self.robot;
        let position = |index| robot.joint_position(index);
        let count = robot.mechanism.joints().len();
        (0..count)
            .map(|index| position(index).unwrap_or_else(|| robot.arena.zero()))
            .collect()
    }

    /// Positions of the actuators.
    pub(crate) fn actuator_positions(&mut self) -> Vec<Expr<'a>> {
        let all = self.joint_positions();
        self.robot.of_actuators(&all)
    }

    /// (J_p^inv)⁺, which is J_p for as many actuators as coordinates.
    pub(crate) fn pseudo_inverse(&mut self) -> Rows<'a> {
        self.actuator_system().pseudo_inverse()
    }

    /// The v for which J_p^inv v fits the actuators' rates best.
    pub(crate) fn least_squares(&mut self, rates: &[Expr<'a>]) -> Vec<Expr<'a>> {
        self.actuator_system().velocities(rates)
    }

    /// v̇ by least squares: J_p^inv v̇ = q̈ - J̇_p^inv v, where the last term is q̈ at v̇ = 0.
    pub(crate) fn acceleration_of(&mut self, twist: &[Expr<'a>]) -> Vec<Expr<'a>> {
        let count = self.robot.mechanism.actuator_count();
        let measured = self.input("actuator_accelerations", count);
        let still = self.zeros();
        let bias = self.joint_motion(twist, &still).1;
        let bias = self.robot.of_actuators(&bias);
        let rest: Vec<Expr<'a>> = measured
            .iter()
            .zip(&bias)
            .map(|(measured, bias)| *measured - *bias)
            .collect();
        self.least_squares(&rest)
    }

    /// Velocities and accelerations of all joints.
    pub(crate) fn joint_motion(
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
}
