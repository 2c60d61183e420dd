//! Values of the options `--from` and `--columns`, which select the form of a function.

use clap::ValueEnum;
use overact::Columns;
use overact_codegen::derivation::MotionInput;

/// What a function is evaluated from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Source {
    /// Platform motion
    Pose,
    /// Joint positions with the platform's twist
    Joints,
    /// Actuator motion; forward kinematics starts from `start`, the previous state or home
    Actuators,
}

/// Columns of an identification model, or parameters that a function takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum ColumnsOf {
    /// All standard parameters
    Standard,
    /// Base parameters only
    Base,
}

impl Source {
    pub(crate) const fn from(self) -> MotionInput {
        match self {
            Self::Pose => MotionInput::Pose,
            Self::Joints => MotionInput::Joints,
            Self::Actuators => MotionInput::Actuators,
        }
    }
}

impl ColumnsOf {
    pub(crate) const fn columns(self) -> Columns {
        match self {
            Self::Standard => Columns::Standard,
            Self::Base => Columns::Base,
        }
    }
}
