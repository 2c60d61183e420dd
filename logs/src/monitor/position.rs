//! Statistics of an actuator's positions: range, steps and their changes, speed, rests.

use super::statistics::Histogram;

/// Fewest equal values in a row for a rest.
const REST_SAMPLES: usize = 20;

/// Samples over which the speed before a rest is computed.
pub(super) const SPEED_SAMPLES: usize = 10;

/// Statistics of an actuator's positions.
#[derive(Debug, Clone, Default)]
pub(super) struct Position {
    pub(super) low: f64,
    pub(super) high: f64,
    pub(super) first: f64,
    pub(super) last: f64,
    /// Sum of squared steps between samples.
    pub(super) steps: f64,
    /// Sizes of steps and of their changes.
    pub(super) sizes: Histogram,
    pub(super) changes: Histogram,
    /// Smallest non-zero step: the resolution, if there is one.
    pub(super) smallest: Option<f64>,
    /// Largest changes of steps, with their samples.
    pub(super) jumps: Vec<(f64, usize)>,
    /// Largest |q_k - q_(k-10)|.
    pub(super) speed: f64,
    /// Sample of the last change of the value.
    ///
    /// Then the bounds of all positions since then, if the value has repeated.
    since: usize,
    bounds: Vec<(f64, f64)>,
    /// |q_k - q_(k-10)| at the start of the rest.
    pub(super) speed_before: f64,
    /// The rest in which another actuator moved most.
    pub(super) rest: Option<Rest>,
}

/// Equal positions in a row.
#[derive(Debug, Clone)]
pub(super) struct Rest {
    pub(super) first: usize,
    pub(super) samples: usize,
    /// Motion of each actuator.
    pub(super) moved: Vec<f64>,
    pub(super) speed_before: f64,
    /// Size of the step that ends it; zero at the end of the run.
    pub(super) step_after: f64,
}

impl Position {
    /// Adds the actuator's position at sample `sample`, the last of the successive positions `own`.
    ///
    /// `rows` are those of all actuators at the same samples.
    pub(super) fn take(&mut self, own: &[f64], sample: usize, rows: &[f64]) {
        let before = own.len() - 1;
        let position = own[before];
        let known = before.min(SPEED_SAMPLES + 1);
        let back = |rows: usize| own[before - rows];
        self.last = position;
        if known == 0 {
            self.first = position;
            (self.low, self.high) = (position, position);
            return;
        }
        self.low = self.low.min(position);
        self.high = self.high.max(position);
        let step = position - back(1);
        self.steps += step * step;
        self.sizes.take(step.abs());
        if step != 0.0 {
            let smallest = self.smallest.unwrap_or(f64::INFINITY);
            self.smallest = Some(smallest.min(step.abs()));
        }
        if known > 1 {
            let change = (step - (back(1) - back(2))).abs();
            self.changes.take(change);
            self.note_jump(change, sample);
        }
        let is_long = known > SPEED_SAMPLES;
        if is_long {
            self.speed = self.speed.max((position - back(known)).abs());
        }
        if step != 0.0 {
            self.end_rest(sample, step.abs());
            self.since = sample;
            return;
        }
        let n = rows.len() / own.len();
        let (rows, row) = rows.split_at(before * n);
        if self.since + 1 == sample {
            self.bounds.clear();
            let before = rows[(before - 1) * n..].iter();
            self.bounds.extend(before.map(|q| (*q, *q)));
            // The first equal value: store the speed before it.
            self.speed_before = if is_long {
                (position - back(known)).abs()
            } else {
                0.0
            };
        }
        for ((low, high), q) in self.bounds.iter_mut().zip(row) {
            (*low, *high) = (low.min(*q), high.max(*q));
        }
    }

    /// Keeps the largest changes.
    fn note_jump(&mut self, size: f64, sample: usize) {
        const KEPT: usize = 16;
        if self.jumps.len() == KEPT && self.jumps[KEPT - 1].0 >= size {
            return;
        }
        let place = self.jumps.partition_point(|(other, _)| *other >= size);
        if place < KEPT {
            self.jumps.insert(place, (size, sample));
            self.jumps.truncate(KEPT);
        }
    }

    /// Ends a rest before sample `end` by a step of this size.
    pub(super) fn end_rest(&mut self, end: usize, step_after: f64) {
        let samples = end - self.since;
        if samples < REST_SAMPLES {
            return;
        }
        let moved: Vec<f64> = self.bounds.iter().map(|(low, high)| high - low).collect();
        let most = |moved: &[f64]| moved.iter().copied().fold(0.0, f64::max);
        let rest = Rest {
            first: self.since,
            samples,
            speed_before: self.speed_before,
            step_after,
            moved,
        };
        let is_worse = self.rest.as_ref().is_none_or(|known| {
            (most(&rest.moved), rest.samples) > (most(&known.moved), known.samples)
        });
        if is_worse {
            self.rest = Some(rest);
        }
    }
}
