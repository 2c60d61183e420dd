//! A measured quantity with its plausible ranges.

/// Powers of a quantity in the unit factors of the signals.
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

    /// Distance of a value from the range, in decades.
    fn decades(self, value: f64) -> f64 {
        (self.low / value).max(value / self.high).log10().max(0.0)
    }
}

/// A positive quantity of a log or of estimates.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Quantity {
    /// Description in words.
    pub(crate) name: String,
    pub(crate) value: f64,
    pub(crate) unit: &'static str,
    /// Possible values for a robot.
    pub(crate) possible: Range,
    /// Usual values of robots.
    pub(crate) usual: Range,
    pub(crate) powers: Powers,
    /// Whether gravity may determine it, as masses in slow motion; it is independent of time then.
    pub(crate) is_by_weight: bool,
}

impl Quantity {
    /// Whether its value is possible.
    pub(crate) fn is_possible(&self) -> bool {
        self.excess() == 0.0
    }

    /// Whether another value is possible.
    pub(crate) fn may_be(&self, value: f64) -> bool {
        self.possible.decades(value) == 0.0
    }

    /// Distance from the possible range, in decades.
    pub(crate) fn excess(&self) -> f64 {
        self.possible.decades(self.value)
    }

    /// Distance of another value from the usual range, in decades.
    pub(crate) fn unusual(&self, value: f64) -> f64 {
        self.usual.decades(value)
    }
}
