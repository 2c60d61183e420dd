//! Estimates at regular times and at changes.

use overact::online::SliceFilter;

use super::{OnlineChange, OnlineEstimate};

/// Largest number of changes at which estimates are reported.
const CHANGES: usize = 200;

/// Estimates over time.
pub(super) struct Timeline {
    /// Time between two estimates, s.
    step: f64,
    /// Time of the next estimate, s.
    next: f64,
    /// Number of changes so far.
    changes: usize,
    /// Ratio of correlated to white standard deviation of each parameter.
    ratios: Vec<f64>,
    estimates: Vec<OnlineEstimate>,
}

impl Timeline {
    /// A timeline with a time between estimates (s).
    pub(super) const fn new(step: f64, ratios: Vec<f64>) -> Self {
        Self {
            step,
            next: 0.0,
            changes: 0,
            ratios,
            estimates: Vec::new(),
        }
    }

    /// Adds an estimate if it is due, or at a change.
    pub(super) fn advance(
        &mut self,
        filter: &mut SliceFilter<'_>,
        run: &str,
        time: f64,
        change: Option<OnlineChange>,
    ) {
        let is_due = time >= self.next;
        let is_change = change.is_some() && self.changes < CHANGES;
        if is_due {
            self.next = time + self.step;
        }
        self.changes += usize::from(is_change);
        if is_due || is_change {
            self.add(filter, run, time, change);
        }
    }

    /// Adds an estimate.
    pub(super) fn add(
        &mut self,
        filter: &mut SliceFilter<'_>,
        run: &str,
        time: f64,
        change: Option<OnlineChange>,
    ) {
        let count = self.ratios.len();
        let (mut values, mut deviations) = (vec![f64::NAN; count], vec![f64::NAN; count]);
        // If the lengths differed, all numbers would stay undetermined.
        let _ = filter.determined(&mut values, &mut deviations);
        let deviations = deviations.into_iter().zip(&self.ratios);
        self.estimates.push(OnlineEstimate {
            run: run.to_owned(),
            time,
            values: values.into_iter().map(known).collect(),
            standard_deviations: deviations.map(|(own, ratio)| known(own * ratio)).collect(),
            change,
        });
    }

    /// All estimates.
    pub(super) fn into_estimates(self) -> Vec<OnlineEstimate> {
        self.estimates
    }
}

/// A number that is finite.
fn known(number: f64) -> Option<f64> {
    number.is_finite().then_some(number)
}
