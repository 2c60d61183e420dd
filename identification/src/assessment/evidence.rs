//! The series behind a check, enough to plot it.

use serde::Serialize;

/// Most points of one curve of an evidence.
pub(crate) const LARGEST_CURVE: usize = 200;

/// What shows the result of a check.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Evidence {
    /// What is shown.
    pub title: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// Curves that are drawn as lines.
    pub lines: Vec<Curve>,
    /// Curves that are drawn as points.
    pub points: Vec<Curve>,
    /// Values of y beyond which the check fails.
    pub limits: Vec<f64>,
}

/// What is shown along an axis.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize)]
pub struct Axis {
    /// What it is.
    pub label: String,
    /// Its unit; empty for a number.
    pub unit: String,
}

/// A named curve.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Curve {
    /// What it is; empty where there is but one.
    pub name: String,
    /// Along the horizontal axis.
    pub x: Vec<f64>,
    /// Along the vertical axis.
    pub y: Vec<f64>,
}

impl Axis {
    /// An axis with a label and a unit.
    #[must_use]
    pub fn new(label: &str, unit: &str) -> Self {
        Self {
            label: label.to_owned(),
            unit: unit.to_owned(),
        }
    }
}

impl Curve {
    /// A curve of so many points at most: where there are more, one in so many is kept.
    #[must_use]
    pub fn new(name: &str, x: &[f64], y: &[f64]) -> Self {
        let stride = x.len().div_ceil(LARGEST_CURVE).max(1);
        let kept = |values: &[f64]| values.iter().step_by(stride).copied().collect();
        Self {
            name: name.to_owned(),
            x: kept(x),
            y: kept(y),
        }
    }
}
