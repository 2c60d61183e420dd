//! Interface of robots, compiled or interpreted, for identification and simulation.

use crate::{Error, Function, SampleError, Sizes, StandardParameter};

/// One standard parameter: a column of the identification model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Parameter {
    /// Unique name, `zz_2_leg3`, `m_platform` or `m_payload`.
    pub name: &'static str,
    /// The standard parameter.
    pub symbol: StandardParameter,
    /// SI unit, for instance `kg m²`.
    pub unit: &'static str,
    /// The body.
    pub body: Body,
}

impl Parameter {
    /// A parameter of a leg's body or joint; see [`Body::Leg`].
    #[must_use]
    pub const fn of_leg(
        name: &'static str,
        symbol: StandardParameter,
        unit: &'static str,
        leg: u16,
        index: u16,
        shape: u16,
    ) -> Self {
        Self {
            name,
            symbol,
            unit,
            body: Body::Leg { leg, index, shape },
        }
    }

    /// A parameter of the platform.
    #[must_use]
    pub const fn of_platform(
        name: &'static str,
        symbol: StandardParameter,
        unit: &'static str,
    ) -> Self {
        Self {
            name,
            symbol,
            unit,
            body: Body::Platform,
        }
    }

    /// The coefficient of a spring between two points; see [`Body::Spring`].
    #[must_use]
    pub const fn of_spring(
        name: &'static str,
        symbol: StandardParameter,
        unit: &'static str,
        index: u16,
    ) -> Self {
        Self {
            name,
            symbol,
            unit,
            body: Body::Spring { index },
        }
    }

    /// A parameter of a motor that drives several joints; see [`Body::Motor`].
    #[must_use]
    pub const fn of_motor(
        name: &'static str,
        symbol: StandardParameter,
        unit: &'static str,
        index: u16,
    ) -> Self {
        Self {
            name,
            symbol,
            unit,
            body: Body::Motor { index },
        }
    }

    /// A parameter of the payload.
    #[must_use]
    pub const fn of_payload(
        name: &'static str,
        symbol: StandardParameter,
        unit: &'static str,
    ) -> Self {
        Self {
            name,
            symbol,
            unit,
            body: Body::Payload,
        }
    }
}

/// A base parameter: an independent column, and the standard parameters that are regrouped into it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BaseParameter {
    /// Name: that of the kept parameter, with the suffix `R` if others are regrouped into it.
    pub name: &'static str,
    /// The standard parameter whose column is kept.
    pub parameter: &'static str,
    /// Other standard parameters that are regrouped into it, with their coefficients.
    pub regrouped: &'static [(&'static str, f64)],
}

impl BaseParameter {
    /// A base parameter.
    #[must_use]
    pub const fn new(
        name: &'static str,
        parameter: &'static str,
        regrouped: &'static [(&'static str, f64)],
    ) -> Self {
        Self {
            name,
            parameter,
            regrouped,
        }
    }
}

/// Location of a body in the robot.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Body {
    /// The platform.
    Platform,
    /// The payload, fixed on the platform.
    Payload,
    /// A body of a leg. Bodies with the same `index` in legs of the same `shape` are a priori
    /// equal.
    Leg {
        /// Index of the leg.
        leg: u16,
        /// Index of the body in its leg, counted from 0.
        index: u16,
        /// Index of the leg's shape, equal for legs that are described once and placed several
        /// times.
        shape: u16,
    },
    /// A spring between points of two bodies.
    Spring {
        /// Index of the spring.
        index: u16,
    },
    /// A motor that drives a combination of joints of a robot with loops.
    Motor {
        /// Index of the motor.
        index: u16,
    },
}

/// Description of a model's robot.
#[derive(Debug, Clone, Copy)]
pub struct Info<'a> {
    /// Name of the robot.
    pub name: &'a str,
    /// Sizes of all inputs and outputs.
    pub sizes: Sizes,
    /// Names of the legs.
    pub legs: &'a [&'a str],
    /// Names of the actuators, in the order of q and τ: actuated joints, then motors.
    pub actuators: &'a [&'a str],
    /// Index of each actuator's joint among all joints; of a motor that drives several joints the
    /// first, see [`Model::actuator_terms`].
    pub actuated_joints: &'a [usize],
    /// Whether each actuator turns (rad, N m) and does not slide (m, N).
    pub actuator_is_revolute: &'a [bool],
    /// Names of the independent coordinates, in the order of the twist.
    ///
    /// They are `x`, `y`, `z`, `rx`, `ry`, `rz` for a free platform, whose pose has seven numbers.
    pub coordinates: &'a [&'a str],
    /// Standard parameters whose column is not identically zero, in column order.
    pub parameters: &'a [Parameter],
    /// The payload's parameters, in column order.
    pub payload_parameters: &'a [Parameter],
    /// Pose of the home configuration, which fixes assembly and working modes.
    pub home_pose: &'a [f64],
    /// Joint positions of the home configuration.
    pub home_joints: &'a [f64],
    /// Kept actuators of the actuator projection in the description (indices among the actuators).
    pub kept_actuators: &'a [usize],
}

/// A robot whose functions can be evaluated at states.
///
/// Arrays are slices, sample by sample; matrices are row-major.
pub trait Model: Sync {
    /// Names and sizes.
    fn info(&self) -> Info<'_>;

    /// Names of the standard parameters that the functions of base parameters keep.
    ///
    /// An identification keeps the same ones, so that one name means one sum of standard
    /// parameters. Empty if unknown; the identification then chooses.
    fn base_columns(&self) -> &[&'static str] {
        &[]
    }

    /// Names of the frames that the description defines, in the order of
    /// [`FrameFunction::frame`](crate::FrameFunction).
    fn frames(&self) -> &[&'static str] {
        &[]
    }

    /// Whether each actuator is a cable, whose torque is its tension, positive if it pulls.
    ///
    /// The force on a cable's length, in the direction of growing length, is the negative tension.
    /// Empty if no actuator is a cable.
    fn pulls(&self) -> &[bool] {
        &[]
    }

    /// Joints that an actuator drives, as indices among all joints with factors.
    ///
    /// Its position, velocity and acceleration are the sums of theirs. Empty for an actuator that
    /// drives the one joint of [`Info::actuated_joints`].
    fn actuator_terms(&self, actuator: usize) -> &[(usize, f64)] {
        let _ = actuator;
        &[]
    }

    /// Position, velocity or acceleration of an actuator from those of all joints.
    ///
    /// Zero for an actuator that the robot does not have.
    fn of_actuator(&self, actuator: usize, joints: &[f64]) -> f64 {
        let value = |joint: usize| joints.get(joint).copied().unwrap_or(0.0);
        match self.actuator_terms(actuator) {
            [] => {
                let joint = self.info().actuated_joints.get(actuator).copied();
                joint.map_or(0.0, value)
            }
            terms => terms
                .iter()
                .map(|(joint, factor)| factor * value(*joint))
                .sum(),
        }
    }

    /// Evaluates `function` at `output.len() / (rows * columns)` samples.
    ///
    /// `inputs` are those of [`Function::inputs`], each with one row of numbers per sample. An
    /// input with exactly one row, as is usual for parameters, is shared by all samples.
    ///
    /// # Errors
    /// [`Error::NotOffered`] if [`Function::condition`] excludes the function for this robot. An
    /// error of [`crate::block::samples`] for inputs or an output of wrong lengths. Otherwise the
    /// error of the first sample without value; if several legs fail there, one is named. The
    /// output is then undefined.
    fn evaluate(
        &self,
        function: Function,
        inputs: &[&[f64]],
        output: &mut [f64],
    ) -> Result<(), SampleError>;

    /// Forward kinematics: the least-squares pose of all measured actuator positions.
    ///
    /// It starts from the pose in `pose`, which determines the assembly mode.
    ///
    /// # Errors
    /// No convergence, or a singular or unreachable configuration during the iteration; `pose` is
    /// then unchanged.
    fn pose_from_actuators(&self, actuators: &[f64], pose: &mut [f64]) -> Result<(), Error>;

    /// Displaces a pose by a small `step` along the twist coordinates (r numbers).
    ///
    /// With parasitic motion the dependent coordinates are corrected, too, until the legs close.
    fn displace(&self, pose: &mut [f64], step: &[f64]) {
        crate::forward::displace(pose, step);
    }
}
