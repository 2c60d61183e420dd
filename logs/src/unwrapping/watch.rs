//! Detects wrapped columns: jumps of one period between otherwise smooth samples.

use super::{Rotation, columns::COUNTERS};
use crate::{error::Problem, significant};
use overact::Code;

/// Relative excess of a wrapped column's range over its period, from noise added after wrapping.
const SLACK: f64 = 0.05;

/// Largest change of a step at a wrap, as a fraction of the period.
const LARGEST_CHANGE: f64 = 0.1;

/// Largest change of a step at a wrap, in mean changes elsewhere plus smallest steps.
const USUAL_CHANGES: f64 = 10.0;
const RESOLUTIONS: f64 = 2.0;

/// A step above this fraction of a turn, after one above the second, is ambiguous.
const AMBIGUOUS: f64 = 0.4;
const BEFORE_AMBIGUOUS: f64 = 0.3;

/// A wrapped column.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Wrap {
    pub(crate) name: String,
    /// Index of the column where it was watched.
    pub(crate) column: usize,
    pub(crate) period: f64,
    /// Number of wraps.
    count: usize,
    /// First sample of ambiguous direction, and the step there in turns.
    ambiguous: Option<(usize, f64)>,
}

impl Wrap {
    /// A note on the unwrapped column.
    pub(crate) fn note(&self) -> String {
        format!(
            "`{}` was logged within one turn and is unwrapped: it jumps by {} {} times",
            self.name,
            significant(self.period, 6),
            self.count
        )
    }

    /// The problem of a column with an ambiguous step.
    pub(crate) fn problem(&self, file: &str) -> Option<Problem> {
        let (sample, turns) = self.ambiguous?;
        let message = format!(
            "sample {sample}: `{}` was logged within one turn of {} and moves by {:.2} of it between two samples, so its direction is unknown",
            self.name,
            significant(self.period, 6),
            turns.abs()
        );
        let problem = Problem::new(Code::LOG_COLUMNS, message)
            .file(file)
            .column(self.name.as_str());
        Some(
            problem.help(
                "log more than three samples in each turn, or an angle that counts whole turns",
            ),
        )
    }
}

/// A step below this fraction of a turn contains no turn, also with rounding.
const CERTAIN: f64 = 0.49;

/// Statistics of a watched column.
#[derive(Debug)]
pub(super) struct Watch {
    samples: usize,
    /// The last value, if the next one follows it.
    last: Option<f64>,
    low: f64,
    high: f64,
    /// Smallest non-zero step.
    resolution: f64,
    /// Whether all values are integers, as those of counters.
    is_whole: bool,
    candidates: Vec<Candidate>,
}

/// Statistics for a possible period.
#[derive(Debug)]
struct Candidate {
    period: f64,
    /// Whether it is the turn of the joint, not that of a motor or a counter.
    is_joint: bool,
    /// Previous step.
    step: Option<f64>,
    wraps: Changes,
    others: Changes,
    ambiguous: Option<(usize, f64)>,
}

/// Changes between successive steps.
#[derive(Debug, Default)]
struct Changes {
    sum: f64,
    count: usize,
}

impl Changes {
    fn mean(&self) -> f64 {
        self.sum / self.count.max(1) as f64
    }
}

impl Watch {
    pub(super) fn new(periods: &[f64]) -> Self {
        let candidate = |(place, period): (usize, &f64)| Candidate {
            period: *period,
            is_joint: place == 0,
            step: None,
            wraps: Changes::default(),
            others: Changes::default(),
            ambiguous: None,
        };
        Self {
            samples: 0,
            last: None,
            low: f64::INFINITY,
            high: f64::NEG_INFINITY,
            resolution: f64::INFINITY,
            is_whole: true,
            candidates: periods.iter().enumerate().map(candidate).collect(),
        }
    }

    /// Adds the next value.
    pub(super) fn take(&mut self, value: f64) {
        if let Some(last) = self.last.replace(value) {
            let step = value - last;
            if step != 0.0 {
                self.resolution = self.resolution.min(step.abs());
            }
            for own in &mut self.candidates {
                own.take(step, self.samples);
            }
        }
        self.is_whole = self.is_whole && value.fract() == 0.0;
        self.low = self.low.min(value);
        self.high = self.high.max(value);
        self.samples += 1;
    }

    /// Forgets the last value, since the next one does not follow it.
    pub(super) fn interrupt(&mut self) {
        self.last = None;
        self.candidates.iter_mut().for_each(|own| own.step = None);
    }

    /// Period by which the column wraps, if it does: the one with the smoothest result.
    pub(super) fn wrap(&self, rotation: &Rotation) -> Option<Wrap> {
        let range = self.high - self.low;
        let fits = |own: &&Candidate| {
            let usual = USUAL_CHANGES * own.others.mean() + RESOLUTIONS * self.resolution;
            let most = (LARGEST_CHANGE * own.period).min(usual);
            own.wraps.count > 0
                && range <= (1.0 + SLACK) * own.period
                && own.wraps.mean() <= most
                && (self.is_whole || own.is_joint || !COUNTERS.contains(&own.period))
        };
        let fitting = self.candidates.iter().filter(fits);
        let best = fitting.min_by(|a, b| a.wraps.mean().total_cmp(&b.wraps.mean()))?;
        Some(Wrap {
            name: rotation.name.clone(),
            column: rotation.column,
            period: best.period,
            count: best.wraps.count,
            ambiguous: best.ambiguous,
        })
    }
}

impl Candidate {
    /// Adds the next step, which leads to sample number `sample`.
    fn take(&mut self, logged: f64, sample: usize) {
        let nearest = |step: f64| {
            // The usual case: no turn.
            if step.abs() < CERTAIN * self.period {
                return step;
            }
            step - self.period * (step / self.period).round()
        };
        let step = nearest(logged);
        let before = self.step.replace(step);
        // Steps near half a turn change little if their direction is taken wrongly.
        let change = nearest(step - before.unwrap_or(step)).abs();
        let changes = if logged.abs() > 0.5 * self.period {
            &mut self.wraps
        } else {
            &mut self.others
        };
        changes.sum += change;
        changes.count += 1;
        let is_large = |step: f64, part: f64| step.abs() > part * self.period;
        if is_large(step, AMBIGUOUS)
            && before.is_some_and(|before| is_large(before, BEFORE_AMBIGUOUS))
        {
            self.ambiguous.get_or_insert((sample, step / self.period));
        }
    }
}
