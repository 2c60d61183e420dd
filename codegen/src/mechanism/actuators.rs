//! Actuators of a robot: actuated joints, then motors that drive combinations of joints.

use super::{Actuator, ActuatorNames, JointIndex, JointKind, Mechanism, Motor, Ratio};
use nalgebra::DMatrix;
use overact_description::StandardParameter;

impl Mechanism {
    /// The actuators in the order of q and τ: actuated joints, then motors.
    #[must_use]
    pub fn actuators(&self) -> Vec<Actuator> {
        let joints = self.actuated().into_iter().map(Actuator::Joint);
        joints
            .chain((0..self.motors.len()).map(Actuator::Motor))
            .collect()
    }

    /// n, the number of actuators.
    #[must_use]
    pub fn actuator_count(&self) -> usize {
        self.actuated().len() + self.motors.len()
    }

    /// Joints that an actuator drives, as positions among [`Self::joints`] with factors.
    #[must_use]
    pub fn actuator_terms(&self, actuator: Actuator) -> Vec<(usize, Ratio)> {
        match actuator {
            Actuator::Joint(joint) => vec![(joint, Ratio::ONE)],
            Actuator::Motor(motor) => self.motors[motor].terms.clone(),
        }
    }

    /// Whether each actuator's position is an angle and not a length.
    #[must_use]
    pub fn actuator_is_revolute(&self) -> Vec<bool> {
        let joints = self.joints();
        let kind = |actuator: Actuator| match actuator {
            Actuator::Joint(joint) => self.joint(joints[joint]).kind,
            Actuator::Motor(motor) => self.motors[motor].kind,
        };
        let actuators = self.actuators().into_iter();
        actuators
            .map(|actuator| kind(actuator) == JointKind::Revolute)
            .collect()
    }

    /// What the actuators are called together: joints, if no motor drives several.
    #[must_use]
    pub const fn kind_of_actuators(&self) -> &'static str {
        if self.motors.is_empty() {
            "actuated joints"
        } else {
            "actuators"
        }
    }

    /// Position among [`Self::joints`] of each actuator's joint; of a motor its first.
    #[must_use]
    pub fn first_joints(&self) -> Vec<usize> {
        let actuators = self.actuators().into_iter();
        let first = |actuator| {
            self.actuator_terms(actuator)
                .first()
                .map(|(joint, _)| *joint)
        };
        actuators.filter_map(first).collect()
    }

    /// Positions of the actuators for those of all joints.
    #[must_use]
    pub fn actuator_positions(&self, joints: &[f64]) -> Vec<f64> {
        let position = |actuator| {
            let terms = self.actuator_terms(actuator);
            match terms[..] {
                [(joint, Ratio::ONE)] => joints[joint],
                _ => {
                    let terms = terms.iter();
                    terms
                        .map(|(joint, factor)| factor.value() * joints[*joint])
                        .sum()
                }
            }
        };
        self.actuators().into_iter().map(position).collect()
    }

    /// Rows of the actuators for those of all joints, such as their rates per coordinate.
    #[must_use]
    pub fn actuator_rows(&self, joints: &DMatrix<f64>) -> DMatrix<f64> {
        let columns = joints.column_iter().map(|column| {
            let column: Vec<f64> = column.iter().copied().collect();
            nalgebra::DVector::from_vec(self.actuator_positions(&column))
        });
        let columns: Vec<_> = columns.collect();
        if columns.is_empty() {
            return DMatrix::zeros(self.actuator_count(), 0);
        }
        DMatrix::from_columns(&columns)
    }

    /// Names of the actuators, in all spellings.
    #[must_use]
    pub fn named_actuators(&self) -> ActuatorNames {
        let joints = self.joints();
        let name = |&at: &usize| {
            let index: JointIndex = joints[at];
            let leg = self.legs[index.leg].name.as_str();
            (leg, self.joint(index).name.as_str())
        };
        let single = self.platform.is_none() && self.legs.len() == 1;
        let motors = self.motors.iter().map(|motor| {
            let leg = motor.leg.map(|leg| self.legs[leg].name.as_str());
            (leg, motor.name.as_str())
        });
        ActuatorNames::with_motors(single, self.actuated().iter().map(name), motors)
    }

    /// Preferred names of the actuators.
    #[must_use]
    pub fn actuator_names(&self) -> Vec<String> {
        self.named_actuators().usual().map(str::to_owned).collect()
    }

    /// Name of a motor's parameter: `fv_wrist`, or `fv_m1_left` of a leg's motor.
    #[must_use]
    pub fn motor_parameter_name(&self, symbol: StandardParameter, motor: usize) -> String {
        let Motor { name, leg, .. } = &self.motors[motor];
        match leg {
            Some(leg) => format!("{}_{name}_{}", symbol.name(), self.legs[*leg].name),
            None => format!("{}_{name}", symbol.name()),
        }
    }
}
