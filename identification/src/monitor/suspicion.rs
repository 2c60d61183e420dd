//! What is suspicious in the raw numbers of a run.

/// Something suspicious in the raw numbers of a run.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Suspicion {
    /// Which kind of trouble it is.
    pub(crate) trouble: Trouble,
    /// Name of the actuator, where it is one's.
    pub(crate) actuator: Option<String>,
    /// What was measured, its unit and the limit that it exceeds.
    pub(crate) statistic: f64,
    pub(crate) unit: &'static str,
    pub(crate) threshold: f64,
    /// What is wrong and what to do, in sentences.
    pub(crate) message: String,
}

/// Trouble that raw numbers tell by themselves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Trouble {
    /// A torque stays at its extreme.
    Clipped,
    /// A position does not change while the robot moves.
    Stuck,
    /// A position jumps, or repeats while the others go on.
    Dropped,
    /// The robot hardly moves.
    Standstill,
    /// Two columns are one.
    Duplicate,
    /// A torque is zero throughout.
    Zero,
}
