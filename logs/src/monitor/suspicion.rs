//! Implausible raw numbers of a run.

/// A finding in the raw numbers of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Suspicion {
    /// Kind of trouble.
    pub fault: DataFault,
    /// Name of the actuator, if it concerns one.
    pub actuator: Option<String>,
    /// Statistic, in `unit`.
    pub statistic: f64,
    /// Unit of the statistic and of its threshold.
    pub unit: &'static str,
    /// Threshold that the statistic exceeds.
    pub threshold: f64,
    /// Finding and remedy, in sentences.
    pub message: String,
}

/// Fault that raw numbers show.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DataFault {
    /// A torque stays at its extreme.
    Clipped,
    /// A position does not change while the robot moves.
    Stuck,
    /// A position jumps, or repeats while others change.
    Dropped,
    /// A position jumps although times are known: some are late or early.
    Late,
    /// The robot hardly moves.
    Standstill,
    /// Two columns are equal.
    Duplicate,
    /// A torque is zero throughout, or noise around zero.
    Zero,
    /// A torque does not change while its actuator moves.
    FrozenTorque,
}
