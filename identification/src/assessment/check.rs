//! One result of one check: what was measured, what it was held against, what it means.

use serde::Serialize;

use super::evidence::Evidence;
use crate::{called::titled, regression::projection::ModelKind, result::Stage};

/// One result of one check. A check that found nothing wrong is a result, too: it allows
/// [`Grade::Use`], and its words say what was seen.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Check {
    /// What was checked.
    pub kind: CheckKind,
    /// What the check is about.
    pub about: About,
    /// Name of the run, unless it concerns all.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub run: Option<String>,
    /// Name of the actuator, where it is one's.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub actuator: Option<String>,
    /// The models that it concerns; empty for all.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub models: Vec<ModelKind>,
    /// The stages that it concerns; empty for all.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub stages: Vec<Stage>,
    /// What was measured.
    pub statistic: f64,
    /// Unit of the statistic and its threshold; empty for a number.
    pub unit: &'static str,
    /// What the statistic was held against.
    pub threshold: f64,
    /// Where the threshold comes from: a false-alarm rate, a resolution, a published rule.
    pub origin: String,
    /// Whether nothing was found. What was found may be harmless: then the check allows use all the same.
    pub passed: bool,
    /// What this check alone allows.
    pub grade: Grade,
    /// What was seen, what it means, what to do: sentences.
    pub words: String,
    /// The signal that may be in another unit: `time`, `positions` or `torques`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub signal: Option<&'static str>,
    /// Its numbers by those in the unit of SI.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub factor: Option<f64>,
    /// The part of the residual's square that it would explain, of a fault that was looked for and found.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub explained: Option<f64>,
    /// Parameters that are not to be used, where only some are not.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub spoiled: Vec<String>,
    /// What these data would have shown of each fault that was looked for.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub detectable: Vec<Detectable>,
    /// The series that shows it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub evidence: Option<Evidence>,
}

/// How well these data tell the size of a fault that was looked for, be it there or not.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Detectable {
    /// The actuator or the length; empty for what concerns all.
    pub name: String,
    /// Unit of its size: `rad`, `m`, `s`, of a smoothing `s²`; empty for a part of one.
    pub unit: &'static str,
    /// Whether it is a length of the description.
    #[serde(skip)]
    pub is_length: bool,
    /// Standard deviation of its size.
    pub deviation: f64,
    /// The size that nine of ten such data would have shown, were it there; infinite where they would show none.
    pub size: f64,
    /// The parameter that a fault of this size moves most, of those that are estimated.
    pub parameter: String,
    /// By how many of the parameter's standard deviations it moves it: what may be hidden in data that show nothing.
    pub moves: f64,
}

impl Detectable {
    /// A part of one of an actuator's that no size of which these data would show.
    pub(crate) fn never(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            unit: "",
            is_length: false,
            deviation: f64::INFINITY,
            size: f64::INFINITY,
            parameter: String::new(),
            moves: f64::INFINITY,
        }
    }
}

/// What a check is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum About {
    /// The numbers of the logs by themselves.
    Data,
    /// What the estimates leave unexplained.
    Fit,
    /// Geometry, drives, labels and the columns of the model.
    Model,
    /// Data that the estimates were not made from, and motion that the data lack.
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

/// What may be done with a result. A worse grade is greater.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default, Serialize)]
pub enum Grade {
    /// Use it.
    #[default]
    #[serde(rename = "use")]
    Use,
    /// Use it for what is listed.
    #[serde(rename = "partly")]
    UseListed,
    /// Do not use it.
    #[serde(rename = "no")]
    DoNotUse,
}

impl Grade {
    /// The grade as an order.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::Use => "use it",
            Self::UseListed => "use it for what is listed",
            Self::DoNotUse => "do not use it",
        }
    }
}

/// What was checked.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum CheckKind {
    /// A torque stays at its extreme: the drive or the measurement saturates.
    ClippedTorque,
    /// A position does not change while the robot moves.
    StuckEncoder,
    /// A position jumps, or repeats while the others go on: samples are lost.
    DroppedSamples,
    /// The robot hardly moves.
    Standstill,
    /// Positions look like degrees, not radians, or like those of motors before their gears.
    Degrees,
    /// Samples of one run stand in another one, too.
    RepeatedSamples,
    /// Two columns of a log are one.
    DuplicateColumns,
    /// A torque is zero throughout.
    ZeroTorque,
    /// The positions contradict the closure of the loops.
    Closure,
    /// Two columns are swapped, as the closure or the torques tell.
    SwappedColumns,
    /// A drive's torque or an encoder goes the wrong way.
    WrongSign,
    /// A drive's torque is far from its prediction by a factor.
    WrongGain,
    /// The payload contradicts how the runs are labelled.
    PayloadLabel,
    /// Torques and motion are not of the same time.
    Delay,
    /// The sampling frequency contradicts gravity and friction.
    Clock,
    /// The torques speak of an offset or a play of an encoder.
    EncoderOffset,
    /// The torques speak of another length than the described one.
    Length,
    /// Time, positions or torques are in another unit than that of SI.
    Unit,
    /// No bodies with positive masses explain the data.
    Consistency,
    /// A few instants leave most unexplained.
    Outliers,
    /// The robot moves through too few periods.
    ShortMotion,
    /// The filters do not suit the motion.
    Filters,
    /// Dry friction around reversals.
    Reversals,
    /// The residual holds something that the model lacks.
    MissingParameter,
    /// A parameter that can't be negative is.
    NegativeParameter,
    /// The kept actuators of case 2 come too close to a singularity of their choice.
    Partition,
    /// How much of the inputs the estimate leaves unexplained.
    RelativeError,
    /// Residuals of the actuators hang together.
    ResidualCorrelation,
    /// How well data are predicted that were held out.
    HeldOut,
    /// Noise of the positions in the columns.
    RegressorErrors,
    /// The runs do not tell columns apart: a coordinate hardly moves.
    Excitation,
}

impl CheckKind {
    /// The name of the kind, as it is serialised, in words.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::ClippedTorque => "clipped torque",
            Self::StuckEncoder => "stuck encoder",
            Self::DroppedSamples => "dropped samples",
            Self::Standstill => "standstill",
            Self::Degrees => "degrees",
            Self::RepeatedSamples => "repeated samples",
            Self::DuplicateColumns => "duplicate columns",
            Self::ZeroTorque => "zero torque",
            Self::Closure => "closure",
            Self::SwappedColumns => "swapped columns",
            Self::WrongSign => "wrong sign",
            Self::WrongGain => "wrong gain",
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
    /// Whether the data tell it beyond doubt when they do, whatever the model.
    pub(crate) const fn is_certain(self) -> bool {
        matches!(
            self,
            Self::DuplicateColumns
                | Self::ZeroTorque
                | Self::WrongSign
                | Self::SwappedColumns
                | Self::Degrees
                | Self::StuckEncoder
                | Self::Unit
        )
    }
}

impl Check {
    /// A check that was passed, with `words` on what was seen.
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

    /// With what was measured, in a unit.
    #[must_use]
    pub fn measured(mut self, statistic: f64, unit: &'static str) -> Self {
        (self.statistic, self.unit) = (statistic, unit);
        self
    }

    /// With what the statistic was held against, and where that comes from.
    #[must_use]
    pub fn against(mut self, threshold: f64, origin: impl Into<String>) -> Self {
        (self.threshold, self.origin) = (threshold, origin.into());
        self
    }

    /// With the grade that it allows. Any but the best means that something was found.
    #[must_use]
    pub fn allowing(mut self, grade: Grade) -> Self {
        self.grade = grade;
        self.passed &= grade == Grade::Use;
        self
    }

    /// With something found that is worth a word, whatever the grade.
    #[must_use]
    pub fn found(mut self) -> Self {
        self.passed = false;
        self
    }

    /// Of one run.
    #[must_use]
    pub fn in_run(mut self, run: &str) -> Self {
        self.run = Some(run.to_owned());
        self
    }

    /// Of one actuator.
    #[must_use]
    pub fn of_actuator(mut self, actuator: &str) -> Self {
        self.actuator = Some(actuator.to_owned());
        self
    }

    /// Of one model.
    #[must_use]
    pub fn of_model(mut self, model: ModelKind) -> Self {
        self.models = vec![model];
        self
    }

    /// Of one stage.
    #[must_use]
    pub fn of_stage(mut self, stage: Stage) -> Self {
        self.stages = vec![stage];
        self
    }

    /// With the signal that may be in another unit, and its numbers by those in the unit of SI.
    #[must_use]
    pub const fn in_unit(mut self, signal: &'static str, factor: f64) -> Self {
        self.signal = Some(signal);
        self.factor = Some(factor);
        self
    }

    /// With the parameters that are not to be used.
    #[must_use]
    pub fn spoiling(mut self, parameters: Vec<String>) -> Self {
        self.spoiled = parameters;
        self
    }

    /// With what these data would have shown.
    #[must_use]
    pub fn detecting(mut self, detectable: Vec<Detectable>) -> Self {
        self.detectable = detectable;
        self
    }

    /// With the series that shows it.
    #[must_use]
    pub fn shown_by(mut self, evidence: Evidence) -> Self {
        self.evidence = Some(evidence);
        self
    }

    /// Whether it concerns an estimate.
    #[must_use]
    pub fn concerns(&self, model: ModelKind, stage: Stage) -> bool {
        (self.models.is_empty() || self.models.contains(&model))
            && (self.stages.is_empty() || self.stages.contains(&stage))
    }

    /// Its words behind the run and the actuator that they are about.
    #[must_use]
    pub fn located(&self) -> String {
        let actuator = self.actuator.iter().map(|name| titled(name));
        // A joint that is but a number is called a joint, once.
        let actuator = actuator.filter(|name| !self.words.contains(name) || !name.contains(' '));
        let place = self.run.iter().cloned().chain(actuator);
        let mut text: String = place.map(|part| format!("{part}: ")).collect();
        text.push_str(&self.words);
        text
    }
}
