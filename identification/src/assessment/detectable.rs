//! Detection limit of one fault: its size, and what it shifts.

use serde::Serialize;

use super::hypotheses::{FaultHypothesis, Misreading, Shape};
use overact_logs::significant;

/// A fault that shifts a parameter by more than this many standard deviations is harmful.
pub(super) const HARMFUL: f64 = 3.0;

/// s of a moving average over T is T² divided by this.
pub(super) const OF_MEAN: f64 = 24.0;

/// Unit of s, the size of a smoothing.
pub(super) const UNIT_OF_SMOOTHING: &str = "s²";

/// Relative sizes above 100 % are reported as 100 %.
const WHOLE: f64 = 1.0;

/// Detection limit of one fault, present or not.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Detectable {
    /// Kind of the fault.
    pub fault: FaultKind,
    /// Dependence of a missing torque on the motion, such as `position`; `None` for other faults.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shape: Option<&'static str>,
    /// Name of the actuator or length; empty for a fault of the whole robot.
    pub name: String,
    /// Unit of the size: `rad`, `m`, `s`, or `s²` for smoothing; empty for a relative size.
    pub unit: &'static str,
    /// The hypothesis.
    #[serde(skip)]
    pub(super) hypothesis: FaultHypothesis,
    /// Standard deviation of the size.
    pub deviation: f64,
    /// Size that is detected with 90 % probability; infinite if no size is detectable.
    pub size: f64,
    /// Estimated parameter that a fault of this size shifts most.
    pub parameter: String,
    /// Shift of that parameter by an undetected fault, in standard deviations.
    #[serde(rename = "moves")]
    pub shift_deviations: f64,
    /// All other parameters that the fault shifts by more than three standard deviations.
    #[serde(rename = "also", skip_serializing_if = "Vec::is_empty")]
    pub others: Vec<DetectableShift>,
}

/// Shift of a parameter by a fault of the size that is just detectable.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DetectableShift {
    /// Name of the parameter.
    pub parameter: String,
    /// Shift in standard deviations of the parameter.
    #[serde(rename = "moves")]
    pub deviations: f64,
}

/// Kind of a fault that has a detection limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum FaultKind {
    /// Zero of an encoder.
    EncoderOffset,
    /// Scale of the position of one actuator, or of all.
    EncoderScale,
    /// Error of an encoder with the sine or cosine of its position, as of a disc out of centre.
    Eccentricity,
    /// Half of the play of an encoder.
    Play,
    /// Ratio of a gear: positions and torques of its drive.
    GearRatio,
    /// A described length.
    Length,
    /// Gain of one drive.
    Gain,
    /// Delay of all torques.
    Delay,
    /// Delay of the torque of one drive.
    DriveDelay,
    /// Smoothing of the torques.
    Smoothing,
    /// Equal smoothing of all signals.
    CommonFilter,
    /// Sampling frequency.
    Clock,
    /// Part of a neighbour's torque in the torque of one drive.
    Crosstalk,
    /// Torque or force that the model lacks.
    MissingTorque,
}

impl FaultKind {
    /// All kinds, in the order of a report.
    pub(super) const ALL: [Self; 14] = [
        Self::EncoderOffset,
        Self::EncoderScale,
        Self::Eccentricity,
        Self::Play,
        Self::GearRatio,
        Self::Length,
        Self::Gain,
        Self::Delay,
        Self::DriveDelay,
        Self::Smoothing,
        Self::CommonFilter,
        Self::Clock,
        Self::Crosstalk,
        Self::MissingTorque,
    ];

    const fn of(hypothesis: FaultHypothesis) -> Self {
        match hypothesis {
            FaultHypothesis::Offset(_) => Self::EncoderOffset,
            FaultHypothesis::Eccentric(..) => Self::Eccentricity,
            FaultHypothesis::Play(_) => Self::Play,
            FaultHypothesis::Scale(_) | FaultHypothesis::Scales => Self::EncoderScale,
            FaultHypothesis::Gear(_) => Self::GearRatio,
            FaultHypothesis::Length(_) => Self::Length,
            FaultHypothesis::Gain(_) => Self::Gain,
            FaultHypothesis::Delay => Self::Delay,
            FaultHypothesis::DriveDelay(_) => Self::DriveDelay,
            FaultHypothesis::Smoothing
            | FaultHypothesis::SmoothingWithFriction
            | FaultHypothesis::FrictionSmoothing => Self::Smoothing,
            FaultHypothesis::CommonFilter => Self::CommonFilter,
            FaultHypothesis::Clock => Self::Clock,
            FaultHypothesis::Crosstalk { .. } | FaultHypothesis::AllCrosstalk => Self::Crosstalk,
            FaultHypothesis::Torque(..)
            | FaultHypothesis::Force(..)
            | FaultHypothesis::AllTorques(_)
            | FaultHypothesis::Potential(_)
            | FaultHypothesis::PotentialTerm(_) => Self::MissingTorque,
        }
    }

    /// Name in a sentence.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::EncoderOffset => "zero of an encoder",
            Self::EncoderScale => "scale of an encoder",
            Self::Eccentricity => "eccentricity of an encoder",
            Self::Play => "half of the play of an encoder",
            Self::GearRatio => "ratio of a gear, with positions and torques of its drive",
            Self::Length => "length",
            Self::Gain => "gain of one drive",
            Self::Delay => "delay of all torques",
            Self::DriveDelay => "delay of the torque of one drive",
            Self::Smoothing => "smoothing of the torques",
            Self::CommonFilter => "equal smoothing of all signals",
            Self::Clock => "sampling frequency",
            Self::Crosstalk => "part of a neighbour's torque in the torque of one drive",
            Self::MissingTorque => "torque or force that the model lacks",
        }
    }
}

impl Detectable {
    /// A fault of this size, which shifts nothing yet.
    pub(super) fn new(hypothesis: FaultHypothesis, unit: &'static str, size: f64) -> Self {
        Self {
            fault: FaultKind::of(hypothesis),
            shape: hypothesis.shape().map(Shape::key),
            name: String::new(),
            unit,
            hypothesis,
            deviation: 0.0,
            size,
            parameter: String::new(),
            shift_deviations: 0.0,
            others: Vec::new(),
        }
    }

    /// A wrong gain of the actuator with this number and `name`, which these data cannot detect at
    /// any size.
    pub(super) fn undetectable_gain(actuator: usize, name: &str) -> Self {
        Self {
            name: name.to_owned(),
            deviation: f64::INFINITY,
            shift_deviations: f64::INFINITY,
            ..Self::new(FaultHypothesis::Gain(actuator), "", f64::INFINITY)
        }
    }

    /// With the shifts of parameters, largest first. The first one of a parameter counts.
    pub(super) fn shifting(self, shifts: impl Iterator<Item = DetectableShift>) -> Self {
        let mut all: Vec<DetectableShift> = Vec::new();
        for shift in shifts {
            let is_new = all.iter().all(|one| one.parameter != shift.parameter);
            if all.is_empty() || is_new && shift.deviations > HARMFUL {
                all.push(shift);
            }
        }
        let others = all.split_off(all.len().min(1));
        match all.pop() {
            Some(most) => Self {
                parameter: most.parameter,
                shift_deviations: most.deviations,
                others,
                ..self
            },
            None => self,
        }
    }

    /// Whether a fault of this size shifts a parameter by more than three standard deviations.
    #[must_use]
    pub fn is_harmful(&self) -> bool {
        self.shift_deviations > HARMFUL
    }

    /// All parameters that the fault shifts by more than three standard deviations, most first.
    pub fn parameters(&self) -> impl Iterator<Item = &str> {
        let others = self.others.iter().map(|other| other.parameter.as_str());
        std::iter::once(self.parameter.as_str()).chain(others)
    }

    /// Whether the gain of a drive is so uncertain that no error of it is detectable.
    pub(super) fn is_hidden_gain(&self) -> bool {
        self.fault == FaultKind::Gain && self.size >= WHOLE
    }

    /// Factor of the shifts: a relative size above 100 % has no meaning.
    fn limited(&self) -> f64 {
        let most = if self.unit.is_empty() {
            WHOLE
        } else {
            f64::INFINITY
        };
        (most / self.size).min(1.0)
    }

    /// Size with its unit and place, as in ``2 % of `left` ``.
    #[must_use]
    pub fn size_words(&self) -> String {
        let of = match (self.name.as_str(), self.hypothesis) {
            (_, FaultHypothesis::PotentialTerm(_)) => {
                String::from(" of a potential, as of a constant force on a body")
            }
            (_, FaultHypothesis::Scales) => String::from(" of all drives"),
            ("", _) => String::new(),
            (name, FaultHypothesis::Crosstalk { .. }) => format!(" in `{name}`"),
            (name, FaultHypothesis::Eccentric(_, Misreading::Sine)) => {
                format!(" of `{name}` with the sine of its position")
            }
            (name, FaultHypothesis::Eccentric(_, Misreading::Cosine)) => {
                format!(" of `{name}` with the cosine of its position")
            }
            (name, hypothesis) => match hypothesis.shape() {
                Some(shape) => format!(" at `{name}` with {}", shape.words()),
                None => format!(" of `{name}`"),
            },
        };
        let size = self.size * self.limited();
        let size = match self.unit {
            "" => format!("{} %", significant(100.0 * size, 2)),
            "s" => format!("{} ms", significant(1e3 * size, 2)),
            UNIT_OF_SMOOTHING => format!(
                "a mean over {} ms",
                significant(1e3 * (OF_MEAN * size).sqrt(), 2)
            ),
            unit => format!("{} {unit}", significant(size, 2)),
        };
        format!("{size}{of}")
    }

    /// Parameters that the fault shifts, as in `` `zz_1` by 8 σ, `mx_2` by 4 σ``, most first.
    #[must_use]
    pub fn shift_words(&self) -> String {
        let most = (self.parameter.as_str(), self.shift_deviations);
        let others = self.others.iter();
        let others = others.map(|other| (other.parameter.as_str(), other.deviations));
        let words = |(name, deviations): (&str, f64)| {
            format!("`{name}` by {:.0} σ", deviations * self.limited())
        };
        let all: Vec<String> = std::iter::once(most).chain(others).map(words).collect();
        all.join(", ")
    }

    /// The limit with the most shifted parameter, as in ``2 % of `left` (`zz_1` by 8 σ, and 2 more)``.
    pub(super) fn words(&self) -> String {
        let more = match self.others.len() {
            0 => String::new(),
            count => format!(", and {count} more"),
        };
        format!(
            "{} (`{}` by {:.0} σ{more})",
            self.size_words(),
            self.parameter,
            self.shift_deviations * self.limited()
        )
    }
}
