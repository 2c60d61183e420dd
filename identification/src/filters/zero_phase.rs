//! Filtering forwards and backwards, as MATLAB's `filtfilt` does.
//!
//! The signal is extended at both ends by its odd reflection 2 x_0 - x_k over three times the
//! filter's order, and each pass starts in the steady state of its first value, so that neither
//! end rings.
//!
//! A long signal passes block by block ([`ZeroPhase`]). The forward pass hands its state on and is
//! exact. The backward pass of a block starts a while behind the block's end, where the later
//! samples are not known yet; the transient of that wrong start has died before it reaches the
//! block (see [`settling`]). What fits into one block is filtered as a whole.

use super::{
    cascade::{Cascade, settling},
    design::LowPass,
};
use crate::error::{Error, Problem};

/// Part of a transient that is left where a block ends: below the rounding of the signals.
const TRANSIENT: f64 = 1e-15;

/// Rows that are finished at once, at least; twice the overlap where that is more, so that the
/// backward pass does no more than half its work twice.
const SMALLEST_HOP: usize = 8192;

/// Filters `signal` with zero phase and the squared magnitude of `filter`.
///
/// # Errors
/// A signal of no more than 3 x order samples.
pub fn filtfilt(filter: &LowPass, signal: &[f64]) -> Result<Vec<f64>, Error> {
    let mut stream = ZeroPhase::new(filter, 1, signal.len(), (0, 1))?;
    stream.hop = signal.len();
    let mut filtered = Vec::with_capacity(signal.len());
    stream.push(signal, &mut filtered);
    Ok(filtered)
}

/// Zero-phase filtering of several signals side by side, whose samples come in blocks of any size.
#[derive(Debug, Clone)]
pub struct ZeroPhase {
    filter: LowPass,
    /// Number of signals: values per row.
    width: usize,
    /// Rows that come in all, and rows that have come.
    samples: usize,
    taken: usize,
    /// The last raw rows, as many as the reflection needs.
    raw: Vec<f64>,
    /// The forward pass, once enough rows for its reflection are there.
    forward: Option<Cascade>,
    /// Rows that have passed forwards only, and the number of the first of them.
    pending: Vec<f64>,
    first_pending: usize,
    overlap: usize,
    hop: usize,
    /// The next row to give out, and the distance of those that are.
    next: usize,
    step: usize,
}

impl ZeroPhase {
    /// A filter for `samples` rows of `width` values. Of the filtered rows, number `first` and every
    /// `step`-th after it are given out: `(0, 1)` for all.
    ///
    /// # Errors
    /// No more than 3 x order samples.
    pub fn new(
        filter: &LowPass,
        width: usize,
        samples: usize,
        (first, step): (usize, usize),
    ) -> Result<Self, Error> {
        if samples <= filter.padding() {
            return Err(too_short(filter, samples));
        }
        let overlap = settling(filter, TRANSIENT);
        Ok(Self {
            filter: filter.clone(),
            width: width.max(1),
            samples,
            taken: 0,
            raw: Vec::new(),
            forward: None,
            pending: Vec::new(),
            first_pending: 0,
            overlap,
            hop: SMALLEST_HOP.max(2 * overlap),
            next: first,
            step: step.max(1),
        })
    }

    /// Takes rows and appends those that are finished to `filtered`. The rows that complete the
    /// number announced bring out all that is left; rows beyond it are ignored.
    pub fn push(&mut self, rows: &[f64], filtered: &mut Vec<f64>) {
        let left = (self.samples - self.taken) * self.width;
        let mut rows = rows.get(..left).unwrap_or(rows);
        if rows.is_empty() {
            return;
        }
        self.taken += rows.len() / self.width;
        let reach = (self.filter.padding() + 1) * self.width;
        if self.forward.is_none() {
            // Until the reflection at the start is known, rows only gather.
            self.raw.extend_from_slice(rows);
            if self.raw.len() < reach {
                return;
            }
            self.start();
            let gathered = std::mem::take(&mut self.raw);
            self.advance(&gathered, filtered);
            self.raw = gathered;
            rows = &[];
        }
        self.advance(rows, filtered);
        self.raw.extend_from_slice(rows);
        let excess = self.raw.len().saturating_sub(reach);
        self.raw.drain(..excess);
        if self.taken == self.samples {
            self.finish(filtered);
        }
    }

    /// Starts the forward pass on the reflection before the first row.
    fn start(&mut self) {
        let reflection = reflected(self.raw.chunks_exact(self.width), self.filter.padding());
        // The farthest row comes first.
        let mut rows = reflection.rchunks_exact(self.width);
        let mut row = vec![0.0; self.width];
        let mut forward = None;
        for reflected in &mut rows {
            row.copy_from_slice(reflected);
            forward
                .get_or_insert_with(|| Cascade::settled(&self.filter, &row))
                .pass(&mut row);
        }
        self.forward = forward;
    }

    /// Passes rows forwards, and backwards whenever enough of them are there.
    fn advance(&mut self, mut rows: &[f64], filtered: &mut Vec<f64>) {
        let full = (self.hop + self.overlap) * self.width;
        while !rows.is_empty() {
            // More rows are to come than there is room for: those far enough behind are done.
            if self.pending.len() == full {
                self.pass_backwards(self.hop, filtered);
            }
            let room = full - self.pending.len();
            let (now, later) = rows.split_at(room.min(rows.len()));
            self.pass_forwards(now);
            rows = later;
        }
    }

    /// Appends forward-filtered rows.
    fn pass_forwards(&mut self, rows: &[f64]) {
        let start = self.pending.len();
        self.pending.extend_from_slice(rows);
        if let Some(forward) = &mut self.forward {
            forward.pass(&mut self.pending[start..]);
        }
    }

    /// Gives out what the reflection behind the last row allows: all.
    fn finish(&mut self, filtered: &mut Vec<f64>) {
        let finished = self.pending.len() / self.width;
        let reflection = reflected(self.raw.rchunks_exact(self.width), self.filter.padding());
        self.pass_forwards(&reflection);
        self.pass_backwards(finished, filtered);
        self.pending = Vec::new();
    }

    /// Runs backwards over all pending rows and gives out, of the first `finished` ones, those that
    /// are wanted; they are pending no more.
    fn pass_backwards(&mut self, finished: usize, filtered: &mut Vec<f64>) {
        let (width, step) = (self.width, self.step);
        let Some(last) = self.pending.rchunks_exact(width).next() else {
            return;
        };
        let mut backward = Cascade::settled(&self.filter, last);
        let mut row = vec![0.0; width];
        let end = self.first_pending + finished;
        let wanted = end.saturating_sub(self.next).div_ceil(step);
        let start = filtered.len();
        filtered.resize(start + wanted * width, 0.0);
        for (index, forward) in self.pending.chunks_exact(width).enumerate().rev() {
            row.copy_from_slice(forward);
            backward.pass(&mut row);
            let sample = self.first_pending + index;
            if sample < end && sample >= self.next && (sample - self.next).is_multiple_of(step) {
                let place = start + (sample - self.next) / step * width;
                filtered[place..place + width].copy_from_slice(&row);
            }
        }
        self.pending.drain(..finished * width);
        self.first_pending = end;
        self.next += wanted * step;
    }
}

/// The odd reflection of rows about the first of them, nearest first: `count` rows.
fn reflected<'a>(mut rows: impl Iterator<Item = &'a [f64]>, count: usize) -> Vec<f64> {
    let Some(first) = rows.next() else {
        return Vec::new();
    };
    rows.take(count)
        .flat_map(|row| first.iter().zip(row).map(|(first, x)| 2.0 * first - x))
        .collect()
}

/// The error of a signal that the reflection does not fit into.
fn too_short(filter: &LowPass, found: usize) -> Error {
    Problem::new(format!(
        "a filter of order {} run forwards and backwards needs at least {} samples; there are {found}",
        filter.order(),
        filter.padding() + 1
    ))
    .help("record a longer run, or skip fewer samples")
    .into()
}
