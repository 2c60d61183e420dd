//! A function of the function table and the motion from which it is evaluated.

use super::motion_input::MotionInput;
use overact_core::Function;

/// A function of the function table and the motion from which it is evaluated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct FunctionForm {
    /// The function.
    pub function: Function,
    /// The input that determines the configuration.
    pub from: MotionInput,
}

impl FunctionForm {
    /// A function evaluated from a motion.
    #[must_use]
    pub const fn new(function: Function, from: MotionInput) -> Self {
        Self { function, from }
    }
}
