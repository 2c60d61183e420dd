//! Implausible raw numbers of a run.

/// A finding in the raw numbers of a run.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Suspicion {
    /// Kind of trouble.
    pub(crate) fault: DataFault,
    /// Name of the actuator, if it concerns one.
    pub(crate) actuator: Option<String>,
    /// Statistic, its unit, and the exceeded limit.
    pub(crate) statistic: f64,
    pub(crate) unit: &'static str,
    pub(crate) threshold: f64,
    /// Finding and remedy, in sentences.
    pub(crate) message: String,
}

/// Fault that raw numbers show.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum DataFault {
    /// A torque stays at its extreme.
    Clipped,
    /// A position does not change while the robot moves.
    Stuck,
    /// A position jumps, or repeats while others change.
    Dropped,
    /// The robot hardly moves.
    Standstill,
    /// Two columns are equal.
    Duplicate,
    /// A torque is zero throughout.
    Zero,
    /// A torque does not change while its actuator moves.
    FrozenTorque,
}
