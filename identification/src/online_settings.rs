//! Settings of a replay through the online filter.

use overact::online::Forgetting;
use serde::{Deserialize, Serialize};

/// Rule by which old equations lose weight.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ForgettingRule {
    /// All equations have the same weight.
    #[default]
    None,
    /// All information is multiplied by this factor at every decimated sample.
    Exponential(f64),
    /// Information along the direction of each equation is multiplied by this factor.
    Directional(f64),
}

impl ForgettingRule {
    /// The rule of the filter.
    #[must_use]
    pub const fn rule(self) -> Forgetting {
        match self {
            Self::None => Forgetting::None,
            Self::Exponential(factor) => Forgetting::Exponential(factor),
            Self::Directional(factor) => Forgetting::Directional(factor),
        }
    }
}

/// Settings of a replay of the runs through the online filter.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OnlineSettings {
    /// How old equations lose weight.
    pub forgetting: ForgettingRule,
    /// Shift of the innovations' mean that the change test detects, in standard deviations.
    pub shift: f64,
    /// Mean number of decimated samples between false alarms of one line.
    pub samples_per_false_alarm: f64,
    /// Number of reported times.
    pub points: usize,
}

impl Default for OnlineSettings {
    fn default() -> Self {
        Self {
            forgetting: ForgettingRule::None,
            shift: 1.0,
            samples_per_false_alarm: 1e6,
            points: 400,
        }
    }
}
