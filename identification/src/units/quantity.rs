//! A measured quantity with its bounds.

/// By which power of a factor in each signal a quantity grows.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Powers {
    pub(crate) time: i32,
    pub(crate) positions: i32,
    pub(crate) torques: i32,
}

/// Smallest and largest value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Range {
    pub(crate) low: f64,
    pub(crate) high: f64,
}

impl Range {
    pub(crate) const fn new(low: f64, high: f64) -> Self {
        Self { low, high }
    }

    /// By how many decades a value lies outside.
    fn decades(self, value: f64) -> f64 {
        (self.low / value).max(value / self.high).log10().max(0.0)
    }
}

/// A positive quantity of a log or of estimates.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Quantity {
    /// What it is, in words.
    pub(crate) name: String,
    pub(crate) value: f64,
    pub(crate) unit: &'static str,
    /// Values that a robot can have.
    pub(crate) possible: Range,
    /// Values that robots usually have.
    pub(crate) usual: Range,
    pub(crate) powers: Powers,
}

impl Quantity {
    /// Whether a robot can have it.
    pub(crate) fn is_possible(&self) -> bool {
        self.excess() == 0.0
    }

    /// By how many decades it lies outside of what is possible.
    pub(crate) fn excess(&self) -> f64 {
        self.possible.decades(self.value)
    }

    /// By how many decades a value in its place is unusual.
    pub(crate) fn unusual(&self, value: f64) -> f64 {
        self.usual.decades(value)
    }
}
