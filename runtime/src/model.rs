//! The face that a robot shows to identification and simulation, compiled or interpreted.

use crate::{Error, Function, SampleError, Sizes, StandardParameter};

/// One standard parameter: a column of the identification model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Parameter {
    /// Unique name, `zz_2_leg3`, `m_platform` or `m_payload`.
    pub name: &'static str,
    /// Which of the standard parameters it is.
    pub symbol: StandardParameter,
    /// SI unit, for instance `kg m²`.
    pub unit: &'static str,
    /// Where the body is.
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
    /// Name: the kept parameter's, with the suffix `R` where others are regrouped into it.
    pub name: &'static str,
    /// The standard parameter whose column is kept.
    pub parameter: &'static str,
    /// Other standard parameters that it stands for, with their coefficients.
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

/// Where a body is in the robot.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Body {
    /// The platform.
    Platform,
    /// The payload, fixed on the platform.
    Payload,
    /// A body of a leg. Bodies of different legs with one `index` are a priori alike when their
    /// legs have one `shape`.
    Leg {
        /// Index of the leg.
        leg: u16,
        /// Index of the body in its leg, counted from 0.
        index: u16,
        /// Legs written once and placed several times share this number.
        shape: u16,
    },
}

/// What a model says about its robot, sizes aside.
#[derive(Debug, Clone, Copy)]
pub struct Info<'a> {
    /// Name of the robot.
    pub name: &'a str,
    /// Sizes of all inputs and outputs.
    pub sizes: Sizes,
    /// Names of the legs.
    pub legs: &'a [&'a str],
    /// Names of the actuated joints, in the order of q and τ.
    pub actuators: &'a [&'a str],
    /// Indices of the actuated joints among all joints.
    pub actuated_joints: &'a [usize],
    /// Whether each actuator is a revolute joint (rad, N m) and not a prismatic one (m, N).
    pub actuator_is_revolute: &'a [bool],
    /// Names of the independent coordinates, in the order of the twist: `x`, `y`, `z`, `rx`, `ry`, `rz` of a
    /// free platform, whose pose has seven numbers.
    pub coordinates: &'a [&'a str],
    /// Standard parameters whose column is not identically zero, in column order.
    pub parameters: &'a [Parameter],
    /// The payload's parameters, in column order.
    pub payload_parameters: &'a [Parameter],
    /// Pose of the home configuration, which fixes assembly and working modes.
    pub home_pose: &'a [f64],
    /// Joint positions of the home configuration.
    pub home_joints: &'a [f64],
    /// Kept actuators of case 2 as the description chooses them (indices among the actuators).
    pub kept_actuators: &'a [usize],
}

/// A robot whose functions can be evaluated at states.
///
/// Numbers lie in slices, sample after sample; matrices are row-major.
pub trait Model: Sync {
    /// Names and sizes.
    fn info(&self) -> Info<'_>;

    /// Evaluates `function` at `output.len() / (rows * columns)` samples. `inputs` are those of
    /// [`Function::inputs`], each holding one row of numbers per sample; an input of exactly one row, as
    /// parameters mostly are, serves all samples.
    ///
    /// # Errors
    /// [`Error::NotOffered`] for a function that [`Function::condition`] denies the robot; inputs or an
    /// output of other lengths than [`crate::block::samples`] wants; else the first sample at which the
    /// model has no value, and why; of several legs that fail there, one is named. The output is then
    /// undefined.
    fn evaluate(
        &self,
        function: Function,
        inputs: &[&[f64]],
        output: &mut [f64],
    ) -> Result<(), SampleError>;

    /// Forward kinematics: the pose that fits all measured actuator positions best in the sense of
    /// least squares, found from the start pose in `pose`, so that the assembly mode is that of the
    /// start.
    ///
    /// # Errors
    /// No convergence, or a singular or unreachable configuration on the way; `pose` is unchanged then.
    fn pose_from_actuators(&self, actuators: &[f64], pose: &mut [f64]) -> Result<(), Error>;

    /// Moves a pose by a small displacement `step` along the twist coordinates (r numbers); of a platform that
    /// moves aside also along the others, until the legs close.
    fn displace(&self, pose: &mut [f64], step: &[f64]) {
        crate::forward::displace(pose, step);
    }
}
