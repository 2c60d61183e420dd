//! Filtering forwards and backwards, as MATLAB's `filtfilt` does.
//!
//! The signal is extended at both ends by its odd reflection 2 x_0 - x_k over three times the
//! filter's order, and each pass starts in the steady state of its first value, so that neither
//! end rings.
//!
//! A long signal passes block by block ([`ZeroPhase`]). The forward pass hands its state on and is
//! exact. The backward pass of a block starts a while behind the block's end, where the later
//! samples are not known yet; the transient of that wrong start has died before it reaches the
//! block. What fits into one block is filtered as a whole.

use super::{
    cascade::{Cascade, reflected, settling, started},
    design::LowPass,
};
use crate::error::{Error, Problem};
use overact::Code;

/// Part of a transient that is left where a block ends: below the rounding of the signals.
pub(super) const TRANSIENT: f64 = 1e-15;

/// Rows that are finished at once, at least; twice the overlap where that is more, so that the
/// backward pass does no more than half its work twice.
const SMALLEST_HOP: usize = 8192;

/// Filters `signal` with zero phase and the squared magnitude of `filter`.
///
/// # Errors
/// A signal of no more than 3 x order samples.
pub fn filtfilt(filter: &LowPass, signal: &[f64]) -> Result<Vec<f64>, Error> {
    let mut stream = ZeroPhase::new(filter, 1, signal.len())?;
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
    /// Rows that have passed forwards only.
    pending: Vec<f64>,
    overlap: usize,
    hop: usize,
}

impl ZeroPhase {
    /// A filter for `samples` rows of `width` values.
    ///
    /// # Errors
    /// No more than 3 x order samples.
    pub fn new(filter: &LowPass, width: usize, samples: usize) -> Result<Self, Error> {
        check_length(filter, samples)?;
        let overlap = settling(filter, TRANSIENT);
        Ok(Self {
            filter: filter.clone(),
            width: width.max(1),
            samples,
            taken: 0,
            raw: Vec::new(),
            forward: None,
            pending: Vec::new(),
            overlap,
            hop: SMALLEST_HOP.max(2 * overlap),
        })
    }

    /// Takes rows and appends those that are finished to `filtered`. The rows that complete the
    /// number announced bring out all that is left; rows beyond it are ignored.
    pub fn push(&mut self, rows: &[f64], filtered: &mut Vec<f64>) {
        let left = (self.samples - self.taken) * self.width;
        let rows = rows.get(..left).unwrap_or(rows);
        self.taken += rows.len() / self.width;
        let reach = (self.filter.padding() + 1) * self.width;
        let waiting = self.forward.is_none();
        self.raw.extend_from_slice(rows);
        if waiting {
            // Until the reflection at the start is known, rows only gather.
            if self.raw.len() < reach {
                return;
            }
            self.forward = Some(started(&self.filter, self.width, &self.raw));
            let gathered = std::mem::take(&mut self.raw);
            self.advance(&gathered, filtered);
            self.raw = gathered;
        } else {
            self.advance(rows, filtered);
        }
        let excess = self.raw.len() - reach;
        self.raw.drain(..excess);
        if self.taken == self.samples && !rows.is_empty() {
            self.finish(filtered);
        }
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

    /// Runs backwards over all pending rows and gives out the first `finished` ones, which are
    /// pending no more.
    fn pass_backwards(&mut self, finished: usize, filtered: &mut Vec<f64>) {
        let done = finished * self.width;
        let Some(last) = self.pending.rchunks_exact(self.width).next() else {
            return;
        };
        let mut backward = Cascade::settled(&self.filter, last);
        let mut behind = self.pending[done..].to_vec();
        backward.pass_backwards(&mut behind);
        let start = filtered.len();
        filtered.extend_from_slice(&self.pending[..done]);
        backward.pass_backwards(&mut filtered[start..]);
        self.pending.drain(..done);
    }
}

/// Checks that the reflection fits into a signal.
pub(super) fn check_length(filter: &LowPass, found: usize) -> Result<(), Error> {
    if found > filter.padding() {
        return Ok(());
    }
    Err(Problem::new(Code::LOG_TOO_SHORT, format!(
        "a filter of order {} run forwards and backwards needs at least {} samples; there are {found}",
        filter.order(),
        filter.padding() + 1
    ))
    .help("record a longer run, or lower `skip_start`, `skip_end` or `decimation` of [identification]")
    .into())
}
