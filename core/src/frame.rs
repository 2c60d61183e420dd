//! Functions of a frame on a body of the robot, such as its tool.

/// A function of one of the frames that a description defines.
///
/// Its name in generated code is that of the frame, followed by [`FrameQuantity::name`]:
/// `tool_pose`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct FrameFunction {
    /// Index of the frame in the description.
    pub frame: usize,
    /// What the function computes.
    pub quantity: FrameQuantity,
}

/// A quantity of a frame; the summary of its function describes each.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[expect(missing_docs, reason = "the summary of its function says what each is")]
pub enum FrameQuantity {
    Pose,
    Jacobian,
    Velocity,
    AccelerationBias,
    Torques,
}

impl FrameQuantity {
    /// All.
    pub const ALL: [Self; 5] = [
        Self::Pose,
        Self::Jacobian,
        Self::Velocity,
        Self::AccelerationBias,
        Self::Torques,
    ];

    /// The part of a function's name that follows the frame's name and an underscore.
    ///
    /// ```
    /// use overact_core::FrameQuantity;
    ///
    /// assert_eq!(FrameQuantity::AccelerationBias.name(), "acceleration_bias");
    /// ```
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Pose => "pose",
            Self::Jacobian => "jacobian",
            Self::Velocity => "velocity",
            Self::AccelerationBias => "acceleration_bias",
            Self::Torques => "torques",
        }
    }

    /// The frame's name and the quantity in the name of a function.
    ///
    /// ```
    /// use overact_core::FrameQuantity;
    ///
    /// let found = FrameQuantity::in_name("tool_acceleration_bias");
    /// assert_eq!(found, Some(("tool", FrameQuantity::AccelerationBias)));
    /// ```
    #[must_use]
    pub fn in_name(function: &str) -> Option<(&str, Self)> {
        Self::ALL.into_iter().find_map(|quantity| {
            let frame = function.strip_suffix(quantity.name())?.strip_suffix('_')?;
            (!frame.is_empty()).then_some((frame, quantity))
        })
    }
}
