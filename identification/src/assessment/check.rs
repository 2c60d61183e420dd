//! Result of one check: statistic, threshold and consequence.

use serde::Serialize;

use super::{detectable::Detectable, evidence::Evidence};
use crate::{regression::projection::ModelKind, result::Stage};
use overact_logs::{called, titled};

/// Result of one check.
///
/// A passed check is a result, too: it allows [`Grade::Use`], and `words` states the finding.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Check {
    /// Kind of the check.
    pub kind: CheckKind,
    /// Subject of the check.
    pub about: About,
    /// Name of the run; `None` for all runs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub run: Option<String>,
    /// Name of the actuator, if the check concerns one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub actuator: Option<String>,
    /// Models that the check concerns; empty for all.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub models: Vec<ModelKind>,
    /// Stages that the check concerns; empty for all.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub stages: Vec<Stage>,
    /// Test statistic.
    pub statistic: f64,
    /// Unit of the statistic and its threshold; empty for a plain number.
    pub unit: &'static str,
    /// Threshold of the statistic.
    pub threshold: f64,
    /// Origin of the threshold: a false-alarm rate, a resolution or a published rule.
    pub origin: String,
    /// Whether the check passed. A failed check can be harmless and still allow [`Grade::Use`].
    pub passed: bool,
    /// Best grade that this check allows.
    pub grade: Grade,
    /// Finding, meaning and remedy, in sentences.
    pub words: String,
    /// Signal that may be in a wrong unit: `time`, `positions` or `torques`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub signal: Option<&'static str>,
    /// Logged numbers divided by those in the SI unit.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub factor: Option<f64>,
    /// Fraction of the squared residual that the detected fault explains.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub explained: Option<f64>,
    /// Unusable parameters, if only some are unusable.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub spoiled: Vec<String>,
    /// Detection limit of each fault that was tested.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub detectable: Vec<Detectable>,
    /// Series that shows the result.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub evidence: Option<Evidence>,
}

/// Subject of a check.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum About {
    /// Raw numbers of the logs.
    Data,
    /// Residuals of the estimates.
    Fit,
    /// Geometry, drives, labels and columns of the model.
    Model,
    /// Validation data, and motion that the runs lack.
    Extrapolation,
}

impl About {
    /// `data`, `fit`, `model` or `extrapolation`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Data => "data",
            Self::Fit => "fit",
            Self::Model => "model",
            Self::Extrapolation => "extrapolation",
        }
    }
}

/// How far a result may be used, from best to worst.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default, Serialize)]
pub enum Grade {
    /// Usable.
    #[default]
    #[serde(rename = "use")]
    Use,
    /// Usable for the listed parameters only.
    #[serde(rename = "partly")]
    UseListed,
    /// Not usable.
    #[serde(rename = "no")]
    DoNotUse,
}

impl Grade {
    /// The grade as an instruction.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::Use => "use it",
            Self::UseListed => "use it for what is listed",
            Self::DoNotUse => "do not use it",
        }
    }
}

/// Kind of a check.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum CheckKind {
    /// A torque stays at its extreme: the drive or the measurement saturates.
    ClippedTorque,
    /// A position does not change while the robot moves.
    StuckEncoder,
    /// A position jumps, or repeats while others change: samples are lost.
    DroppedSamples,
    /// The robot hardly moves.
    Standstill,
    /// The tension of a cable falls to zero.
    SlackCable,
    /// Positions look like degrees instead of radians, or like motor-side angles.
    Degrees,
    /// Samples of one run are also in another one.
    RepeatedSamples,
    /// Two columns of a log are equal.
    DuplicateColumns,
    /// A torque is zero throughout, or noise around zero.
    ZeroTorque,
    /// A torque does not change while its actuator moves.
    FrozenTorque,
    /// The positions violate the loop closure.
    Closure,
    /// Two columns are swapped, according to the closure or the torques.
    SwappedColumns,
    /// A torque or an encoder has the wrong sign.
    WrongSign,
    /// A drive's torque is wrong by a factor.
    WrongGain,
    /// Known values contradict each other.
    KnownValues,
    /// The payload contradicts the label of a run.
    PayloadLabel,
    /// Torques and motion are shifted in time.
    Delay,
    /// The sampling frequency contradicts gravity and friction.
    Clock,
    /// The torques indicate an offset, scale, eccentricity or play of an encoder.
    EncoderOffset,
    /// The torques indicate a length other than the described one.
    Length,
    /// Time, positions or torques are not in SI units.
    Unit,
    /// No bodies with positive masses explain the data.
    Consistency,
    /// A few samples hold most of the squared residual.
    Outliers,
    /// The motion covers too few periods.
    ShortMotion,
    /// The filters distort the motion.
    Filters,
    /// Dry friction around reversals differs from the model.
    Reversals,
    /// The residual contains an effect that the model lacks.
    MissingParameter,
    /// A parameter that cannot be negative is estimated negative.
    NegativeParameter,
    /// The kept actuators of the actuator projection approach a singularity.
    Partition,
    /// Relative residual of an estimate.
    RelativeError,
    /// Residuals of two actuators are correlated.
    ResidualCorrelation,
    /// Prediction error on validation data.
    HeldOut,
    /// Position noise in the regressor biases the estimate.
    RegressorErrors,
    /// The runs do not separate parameters, because a coordinate hardly moves.
    Excitation,
}

impl CheckKind {
    /// Name of the kind in words, as serialised.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::ClippedTorque => "clipped torque",
            Self::StuckEncoder => "stuck encoder",
            Self::DroppedSamples => "dropped samples",
            Self::Standstill => "standstill",
            Self::SlackCable => "slack cable",
            Self::Degrees => "degrees",
            Self::RepeatedSamples => "repeated samples",
            Self::DuplicateColumns => "duplicate columns",
            Self::ZeroTorque => "zero torque",
            Self::FrozenTorque => "frozen torque",
            Self::Closure => "closure",
            Self::SwappedColumns => "swapped columns",
            Self::WrongSign => "wrong sign",
            Self::WrongGain => "wrong gain",
            Self::KnownValues => "known values",
            Self::PayloadLabel => "payload label",
            Self::Delay => "delay",
            Self::Clock => "clock",
            Self::EncoderOffset => "encoder offset",
            Self::Length => "length",
            Self::Unit => "unit",
            Self::Consistency => "physical consistency",
            Self::Outliers => "outliers",
            Self::ShortMotion => "short motion",
            Self::Filters => "filters",
            Self::Reversals => "friction at reversals",
            Self::MissingParameter => "missing parameter",
            Self::NegativeParameter => "negative parameter",
            Self::Partition => "partition",
            Self::RelativeError => "relative error",
            Self::ResidualCorrelation => "residual correlation",
            Self::HeldOut => "held out",
            Self::RegressorErrors => "regressor errors",
            Self::Excitation => "excitation",
        }
    }
}

impl CheckKind {
    /// Whether a failure of this check is the effect of a fault, and does not name the fault.
    pub(crate) const fn is_consequence(self) -> bool {
        matches!(
            self,
            Self::Consistency
                | Self::Outliers
                | Self::NegativeParameter
                | Self::RelativeError
                | Self::ResidualCorrelation
                | Self::HeldOut
                | Self::RegressorErrors
        )
    }

    /// Whether a failure of this check is certain, whatever the model.
    pub(crate) const fn is_certain(self) -> bool {
        matches!(
            self,
            Self::DuplicateColumns
                | Self::ZeroTorque
                | Self::FrozenTorque
                | Self::WrongSign
                | Self::SwappedColumns
                | Self::Degrees
                | Self::StuckEncoder
                | Self::Unit
        )
    }
}

impl Check {
    /// A passed check with its finding in `words`.
    #[must_use]
    pub fn new(kind: CheckKind, about: About, words: impl Into<String>) -> Self {
        Self {
            kind,
            about,
            run: None,
            actuator: None,
            models: Vec::new(),
            stages: Vec::new(),
            statistic: f64::NAN,
            unit: "",
            threshold: f64::NAN,
            origin: String::new(),
            passed: true,
            grade: Grade::Use,
            words: words.into(),
            signal: None,
            factor: None,
            explained: None,
            spoiled: Vec::new(),
            detectable: Vec::new(),
            evidence: None,
        }
    }

    /// Sets the statistic and its unit.
    #[must_use]
    pub fn measured(mut self, statistic: f64, unit: &'static str) -> Self {
        (self.statistic, self.unit) = (statistic, unit);
        self
    }

    /// Sets the threshold and its origin.
    #[must_use]
    pub fn against(mut self, threshold: f64, origin: impl Into<String>) -> Self {
        (self.threshold, self.origin) = (threshold, origin.into());
        self
    }

    /// Sets the grade. Any grade below [`Grade::Use`] marks the check as failed.
    #[must_use]
    pub fn with_grade(mut self, grade: Grade) -> Self {
        self.grade = grade;
        self.passed &= grade == Grade::Use;
        self
    }

    /// Marks the check as failed without changing the grade.
    #[must_use]
    pub fn found(mut self) -> Self {
        self.passed = false;
        self
    }

    /// Restricts the check to one run.
    #[must_use]
    pub fn in_run(mut self, run: &str) -> Self {
        self.run = Some(run.to_owned());
        self
    }

    /// Restricts the check to one actuator.
    #[must_use]
    pub fn of_actuator(mut self, actuator: &str) -> Self {
        self.actuator = Some(actuator.to_owned());
        self
    }

    /// Restricts the check to one model.
    #[must_use]
    pub fn of_model(mut self, model: ModelKind) -> Self {
        self.models = vec![model];
        self
    }

    /// Restricts the check to one stage.
    #[must_use]
    pub fn of_stage(mut self, stage: Stage) -> Self {
        self.stages = vec![stage];
        self
    }

    /// Sets the signal in a wrong unit, and its numbers divided by those in the SI unit.
    #[must_use]
    pub const fn in_unit(mut self, signal: &'static str, factor: f64) -> Self {
        self.signal = Some(signal);
        self.factor = Some(factor);
        self
    }

    /// Sets the unusable parameters.
    #[must_use]
    pub fn with_unusable_parameters(mut self, parameters: Vec<String>) -> Self {
        self.spoiled = parameters;
        self
    }

    /// Sets the detection limits.
    #[must_use]
    pub fn detecting(mut self, detectable: Vec<Detectable>) -> Self {
        self.detectable = detectable;
        self
    }

    /// Sets the series that shows the result.
    #[must_use]
    pub fn shown_by(mut self, evidence: Evidence) -> Self {
        self.evidence = Some(evidence);
        self
    }

    /// Whether the check concerns the estimate of a model and stage.
    #[must_use]
    pub fn concerns(&self, model: ModelKind, stage: Stage) -> bool {
        (self.models.is_empty() || self.models.contains(&model))
            && (self.stages.is_empty() || self.stages.contains(&stage))
    }

    /// The words, prefixed by the run and by the actuator unless the words name it.
    #[must_use]
    pub fn located(&self) -> String {
        let actuator = self.actuator.as_deref();
        let actuator = actuator.filter(|name| !names(&self.words, &called(name)));
        let place = self.run.iter().cloned().chain(actuator.map(titled));
        let mut text: String = place.map(|part| format!("{part}: ")).collect();
        text.push_str(&self.words);
        text
    }
}

/// Whether words contain a name, not followed by a letter or digit.
fn names(words: &str, name: &str) -> bool {
    let mut places = words.match_indices(name);
    places.any(|(place, _)| {
        let next = words[place + name.len()..].chars().next();
        !next.is_some_and(char::is_alphanumeric)
    })
}

#[cfg(test)]
mod tests {
    use super::{About, Check, CheckKind};

    #[test]
    fn a_message_mentions_its_drive_once() {
        let located = |name: &str, words: &str| {
            let check = Check::new(CheckKind::StuckEncoder, About::Data, words);
            check.of_actuator(name).located()
        };
        let still = "the position of `c` does not change";
        assert_eq!(located("c", still), still);
        assert_eq!(located("d", still), format!("d: {still}"));
        assert_eq!(
            located("1", "joint 12 is still"),
            "joint 1: joint 12 is still"
        );
        assert_eq!(located("12", "joint 12 is still"), "joint 12 is still");
    }
}
