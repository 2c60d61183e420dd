//! Rotor inertia and friction of motors that drive combinations of joints.
//!
//! With the rate θ̇ = T q̇ of a motor, the torque s of one of its parameters adds (T G)ᵀ s to Γ¹. A
//! robot with as many actuators as coordinates has this torque at the motor itself.

use super::actuated_joint_forces::ActuatedJointForces;
use super::friction::friction;
use crate::cas::Expr;
use crate::derivation::bodies::motion::RobotMotion;
use crate::derivation::linear_algebra::elimination::Rows;
use crate::derivation::linear_algebra::linear::add_to;
use crate::derivation::parameter::BodyParameter;
use crate::derivation::robot::Robot;
use overact_description::StandardParameter;

impl<'a> Robot<'a> {
    /// Torque per unit of a motor's parameter.
    pub(crate) fn motor_force(
        &self,
        motion: &RobotMotion<'a>,
        motor: usize,
        symbol: StandardParameter,
    ) -> Expr<'a> {
        let rate = || self.motor_value(motor, &motion.u);
        let stribeck = self.mechanism.motors[motor].stribeck;
        let load = || self.arena.zero();
        if let Some(force) = friction(self.arena, symbol, &rate, stribeck, &load) {
            return force;
        }
        match symbol {
            StandardParameter::Ia => self.motor_value(motor, &motion.u_dot),
            StandardParameter::Off => self.arena.one(),
            symbol => {
                debug_assert!(false, "a motor has no parameter {symbol:?}");
                self.arena.zero()
            }
        }
    }

    /// Γ¹ of all motors for given parameters, without the torques that go to `actuators`.
    pub(crate) fn motor_forces(
        &self,
        motion: &RobotMotion<'a>,
        values: &[(BodyParameter, Expr<'a>)],
        actuators: &mut ActuatedJointForces<'a>,
    ) -> Vec<Expr<'a>> {
        let mut total = vec![self.arena.zero(); self.mechanism.dof()];
        let legs: Vec<&Rows<'a>> = self.legs.iter().map(|state| &state.rows).collect();
        for (motor, own) in self.mechanism.motors.iter().enumerate() {
            let torques = values
                .iter()
                .filter_map(|(parameter, value)| match parameter {
                    BodyParameter::Motor { motor: of, symbol } if *of == motor => {
                        Some(self.motor_force(motion, motor, *symbol) * *value)
                    }
                    _ => None,
                });
            let torque = torques.fold(self.arena.zero(), |sum, torque| sum + torque);
            let torque = torque.named(&format!("tau_{}", own.name));
            if !actuators.add_at_motor(motor, torque) {
                let row = self.motor_row(motor, &legs).into_iter();
                add_to(&mut total, row.map(|entry| entry * torque).collect());
            }
        }
        total
    }

    /// Σ ia (T G)ᵀ T G of all motors, added to a mass matrix.
    pub(crate) fn add_rotors(&self, masses: &mut Rows<'a>, values: &[(BodyParameter, Expr<'a>)]) {
        let legs: Vec<&Rows<'a>> = self.legs.iter().map(|state| &state.rows).collect();
        for (motor, inertia) in rotors(values) {
            let row = self.motor_row(motor, &legs);
            for (a, line) in masses.iter_mut().enumerate() {
                for (b, entry) in line.iter_mut().enumerate() {
                    *entry = *entry + inertia * (row[a.min(b)] * row[a.max(b)]);
                }
            }
        }
    }

    /// Σ ia θ̇² of all motors.
    pub(crate) fn twice_motor_energy(
        &self,
        motion: &RobotMotion<'a>,
        values: &[(BodyParameter, Expr<'a>)],
    ) -> Expr<'a> {
        rotors(values).fold(self.arena.zero(), |sum, (motor, inertia)| {
            sum + self.motor_value(motor, &motion.u).squared() * inertia
        })
    }
}

/// Motors with their rotor inertias.
fn rotors<'v, 'a>(
    values: &'v [(BodyParameter, Expr<'a>)],
) -> impl Iterator<Item = (usize, Expr<'a>)> + 'v {
    values
        .iter()
        .filter_map(|(parameter, value)| match parameter {
            BodyParameter::Motor {
                motor,
                symbol: StandardParameter::Ia,
            } => Some((*motor, *value)),
            _ => None,
        })
}
