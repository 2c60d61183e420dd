//! What is suspicious in data or in a result, and the thresholds above which it is.

use serde::Serialize;

/// What is suspicious in the data.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Finding {
    /// Which kind of trouble it is.
    pub kind: FindingKind,
    /// Name of the run, unless it concerns all.
    pub run: Option<String>,
    /// Name of the actuator, where it is one's.
    pub actuator: Option<String>,
    /// What is wrong and what to do, in sentences.
    pub message: String,
}

/// The kinds of trouble that data have.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum FindingKind {
    /// A torque stays at its extreme: the drive or the measurement saturates.
    ClippedTorque,
    /// A position does not change while the robot moves.
    StuckEncoder,
    /// A position jumps, or repeats while the others go on: samples are lost.
    DroppedSamples,
    /// The robot hardly moves.
    Standstill,
    /// The positions contradict the closure of the loops.
    Closure,
    /// Two columns are swapped, as the closure or the torques tell.
    SwappedColumns,
    /// Positions look like degrees, not radians.
    Degrees,
    /// A drive's torque goes against the prediction.
    WrongSign,
    /// A drive's torque is far from its prediction by a factor.
    WrongGain,
    /// The payload contradicts how the runs are labelled.
    PayloadLabel,
    /// A parameter that can't be negative is.
    NegativeParameter,
}

/// The thresholds that verdicts and warnings use.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Thresholds {
    /// A partition whose condition exceeds this spoils case 2.
    pub partition_condition: f64,
    /// A relative error above this (percent) means that the model does not explain the data.
    pub relative_error_percent: f64,
    /// A miss of the loops' closure above this (m, rad) speaks of wrong geometry or offsets.
    pub closure_residual: f64,
    /// |χ|/σ above which a parameter is significant.
    pub significance: f64,
    /// Growth of the held-out error, in percent of the measured inputs' norm, above which a
    /// significant parameter is not cancelled: the root of the difference of the squares before and
    /// after, the part of the inputs that the parameter alone explains, whatever the noise.
    pub held_out_growth_percent: f64,
    /// Move of another parameter, percent of its value, above which a significant parameter is not
    /// cancelled, provided that the move's part of the inputs exceeds
    /// [`held_out_growth_percent`](Self::held_out_growth_percent).
    pub drift_percent: f64,
}

impl Default for Thresholds {
    fn default() -> Self {
        Self {
            partition_condition: 30.0,
            relative_error_percent: 50.0,
            closure_residual: 0.01,
            significance: 5.0,
            held_out_growth_percent: 2.0,
            drift_percent: 10.0,
        }
    }
}
