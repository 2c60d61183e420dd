//! Series behind a check, sufficient to plot it.

use serde::Serialize;

/// Largest number of points of a curve.
pub(crate) const LARGEST_CURVE: usize = 200;

/// Plot that shows the result of a check.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Evidence {
    /// Title.
    pub title: String,
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// Curves drawn as lines.
    pub lines: Vec<Curve>,
    /// Curves drawn as points.
    pub points: Vec<Curve>,
    /// Values of y beyond which the check fails.
    pub limits: Vec<f64>,
}

/// Label and unit of an axis.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize)]
pub struct Axis {
    /// Label.
    pub label: String,
    /// Unit; empty for a plain number.
    pub unit: String,
}

/// A named curve.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Curve {
    /// Name; empty if there is only one curve.
    pub name: String,
    /// Horizontal coordinates.
    pub x: Vec<f64>,
    /// Vertical coordinates.
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
    /// A curve, thinned evenly to at most `LARGEST_CURVE` points.
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
