//! One column of the identification model, and its treatment of directions and reversals.
//!
//! **Asymmetric friction.** The columns fv, fs and off of a joint become fv_pos, fs_pos, fv_neg and
//! fs_neg. They equal the columns fv and fs for positive or negative joint velocity, and are zero
//! otherwise. The offset is then (fs_pos - fs_neg)/2 and has no column of its own.
//!
//! **Reversals.** The sign of a velocity changes between two samples. Torques and accelerations
//! represent means over the sampling intervals, so the columns fs can use the mean sign over the
//! interval. The sign at the sample itself is wrong by up to half an interval at every reversal.
//!
//! **Dead band.** Near standstill, the sign of a measured velocity is noise. Within a dead band the
//! columns fs can be zero.
//!
//! **Described asymmetric friction** is treated alike. If the velocity reverses within the interval,
//! its mean sign lies between -1 and 1. Both columns then get a share of their sum, which is the
//! column of the sign. Stribeck friction has its own mean over the interval.

use crate::{kinematics::gears::mean_sign, regression::friction::Rate, settings::Settings};
use overact::{Body, Info, Parameter, StandardParameter};
use overact_logs::Load;

/// Source of the numbers of a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Origin {
    /// A column of [`overact::Function::IdmRedPlatform`].
    Robot(usize),
    /// The sum of two of them, friction of both directions.
    Both([usize; 2]),
    /// A column of [`overact::Function::IdmRedPayload`].
    Payload(usize),
    /// A column of [`overact::Function::IdmRedPlatform`] that counts only in loaded runs.
    Carried(usize),
}

impl Origin {
    pub(super) const fn is_of_payload(self) -> bool {
        matches!(self, Self::Payload(_) | Self::Carried(_))
    }
}

/// Whether a parameter belongs to the payload of a robot without platform.
///
/// This is a body named `payload`, which the model has in all runs. If some runs are labelled as
/// loaded, its columns are zero in the others.
#[must_use]
pub fn is_carried(parameter: &Parameter) -> bool {
    let of_leg = matches!(parameter.body, Body::Leg { .. });
    let rest = parameter.name.strip_prefix(parameter.symbol.name());
    of_leg && parameter.symbol.is_inertial() && rest == Some("_payload")
}

/// Name of the payload that a parameter belongs to, if payloads have tables of their own.
///
/// Its parameters are named after it, `m_payload_tool`.
#[must_use]
pub fn load_of(parameter: &Parameter) -> Option<&'static str> {
    let rest = parameter.name.strip_prefix(parameter.symbol.name())?;
    let own = parameter.body == Body::Payload;
    rest.strip_prefix("_payload_").filter(|_| own)
}

/// Whether a robot can carry a payload.
pub(crate) fn has_payload(info: &Info<'_>) -> bool {
    !info.payload_parameters.is_empty() || info.parameters.iter().any(is_carried)
}

/// Direction of motion in which a friction parameter acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Direction {
    /// Positive joint velocity.
    Positive,
    /// Negative joint velocity.
    Negative,
}

/// One column of the identification model.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Column {
    /// Name of its parameter.
    pub name: String,
    /// Name of its standard parameter.
    pub standard: String,
    /// SI unit of the parameter.
    pub unit: &'static str,
    /// Symbol of its standard parameter.
    pub symbol: StandardParameter,
    /// Body of the parameter.
    pub body: Body,
    /// Direction of motion of a friction parameter, if split.
    pub direction: Option<Direction>,
    /// Rate of a joint, or of a combination of joints, that the column depends on.
    pub(super) rate: Option<Rate>,
    /// Treatment of reversals, for a Coulomb parameter.
    pub(super) reversal: Option<Reversal>,
    pub(super) origin: Origin,
    /// Name of its payload, if there are several.
    pub(crate) load: Option<String>,
}

/// Treatment of the sign of a velocity around reversals.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Reversal {
    /// Speed below which there is no sign.
    pub(super) band: f64,
    /// Whether it is the mean over the sampling interval.
    pub(super) averaged: bool,
}

impl Reversal {
    /// From the settings.
    pub(crate) fn new(settings: &Settings) -> Self {
        Self {
            band: settings.velocity_dead_band,
            averaged: settings.averaged_reversals,
        }
    }

    /// Sign of a velocity that changes by `step` in a sampling interval; `None` in the dead band.
    pub(crate) fn sign(self, velocity: f64, step: f64) -> Option<f64> {
        (velocity.abs() >= self.band).then(|| mean_sign(velocity, self.step(step)))
    }

    /// Whether the velocity has one sign in the whole interval, outside the dead band.
    const fn is_steady(self, velocity: f64, step: f64) -> bool {
        let speed = velocity.abs();
        speed > 0.0 && speed >= self.band && 2.0 * speed >= self.step(step).abs()
    }

    /// Effective change of the velocity in the interval.
    const fn step(self, step: f64) -> f64 {
        if self.averaged { step } else { 0.0 }
    }
}

impl Column {
    /// The unsplit column of a standard parameter.
    pub(super) fn new(parameter: &Parameter, origin: Origin) -> Self {
        Self {
            name: parameter.name.to_owned(),
            standard: parameter.name.to_owned(),
            unit: parameter.unit,
            symbol: parameter.symbol,
            body: parameter.body,
            direction: None,
            rate: None,
            reversal: None,
            origin,
            load: None,
        }
    }

    /// Index among the robot's parameters, if it is a column of the robot without payload.
    pub(super) const fn index(&self) -> Option<usize> {
        match self.origin {
            Origin::Robot(index) => Some(index),
            _ => None,
        }
    }

    /// Whether it belongs to the payload.
    pub(crate) const fn is_of_payload(&self) -> bool {
        self.origin.is_of_payload()
    }

    /// Whether the column counts with this payload.
    pub(crate) fn counts(&self, carried: Load<'_>) -> bool {
        !self.origin.is_of_payload()
            || match &self.load {
                Some(own) => carried.contains(own),
                None => carried.is_some(),
            }
    }

    /// The payload's column for the payload with this name.
    pub(super) fn named(&self, load: &str) -> Self {
        Self {
            name: format!("{}_{load}", self.name),
            standard: format!("{}_{load}", self.standard),
            load: Some(load.to_owned()),
            ..self.clone()
        }
    }

    /// Sets the Stribeck velocity, if it has a rate.
    pub(super) fn set_stribeck(&mut self, velocity: f64) {
        self.rate = self.rate.as_ref().map(|rate| rate.with_stribeck(velocity));
    }

    /// Factor of the model's column at a velocity of its coordinate.
    ///
    /// The velocity changes by `step` in a sampling interval.
    pub(super) fn factor(&self, velocity: f64, step: f64) -> f64 {
        if let (Some(rate), Some(own)) = (&self.rate, self.reversal)
            && let Some(factor) = rate.mean_factor(velocity, own.step(step))
        {
            return if velocity.abs() < own.band {
                0.0
            } else {
                factor
            };
        }
        let sign = match self.reversal {
            // The usual case: one sign throughout the interval.
            Some(own) if self.direction.is_none() && own.is_steady(velocity, step) => return 1.0,
            Some(reversal) => reversal.sign(velocity, step),
            None => Some(mean_sign(velocity, 0.0)),
        };
        let Some(sign) = sign else {
            return 0.0;
        };
        // The model's column has the sign of the velocity, or for fv the velocity itself.
        match self.direction {
            None => sign * velocity.signum(),
            Some(Direction::Positive) => 0.5 * (1.0 + sign) * velocity.signum(),
            Some(Direction::Negative) => 0.5 * (1.0 - sign) * -velocity.signum(),
        }
    }

    /// Splits the column of a friction parameter by the direction of its rate.
    pub(super) fn split(self, rate: &Rate) -> [Self; 2] {
        let symbol = self.symbol.name();
        [(Direction::Positive, "pos"), (Direction::Negative, "neg")].map(|(direction, suffix)| {
            let rest = self.standard.strip_prefix(symbol).unwrap_or(&self.standard);
            Self {
                name: format!("{symbol}_{suffix}{rest}"),
                direction: Some(direction),
                rate: Some(rate.clone()),
                ..self.clone()
            }
        })
    }
}
