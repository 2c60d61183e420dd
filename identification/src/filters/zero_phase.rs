//! Filtering forwards and backwards, equivalent to MATLAB's `filtfilt`.
//!
//! The signal is extended at both ends by its odd reflection 2 x_0 - x_k over three times the
//! filter's order. Each pass starts in the steady state of its first value, which avoids ringing.
//!
//! A long signal is filtered block by block ([`ZeroPhase`]). The forward pass keeps its state and
//! is exact. The backward pass starts some samples after the block's end with an unknown state.
//! That transient decays before the block. A signal that fits into one block is filtered as a
//! whole.

use super::{
    cascade::{Cascade, reflected, settling, started},
    design::LowPass,
};
use overact::Code;
use overact_logs::{Error, Problem};

/// Relative size of the transient at the block's end: below the signals' rounding.
pub(super) const TRANSIENT: f64 = 1e-15;

/// Fewest rows finished at once; at least twice the overlap, to limit repeated work.
const SMALLEST_HOP: usize = 8192;

/// Filters `signal` with zero phase and the squared magnitude of `filter`.
///
/// # Errors
/// A signal of at most 3 × order samples.
pub fn filtfilt(filter: &LowPass, signal: &[f64]) -> Result<Vec<f64>, Error> {
    let mut stream = ZeroPhase::new(filter, 1, signal.len())?;
    stream.hop = signal.len();
    let mut filtered = Vec::with_capacity(signal.len());
    stream.push(signal, &mut filtered);
    Ok(filtered)
}

/// Zero-phase filter for several interleaved signals in blocks of any size.
#[derive(Debug, Clone)]
pub struct ZeroPhase {
    filter: LowPass,
    /// Number of signals: values per row.
    width: usize,
    /// Total number of rows, and number of rows so far.
    samples: usize,
    taken: usize,
    /// Last raw rows, as many as the reflection needs.
    raw: Vec<f64>,
    /// Forward pass, once its initial reflection is known.
    forward: Option<Cascade>,
    /// Rows after the forward pass only.
    pending: Vec<f64>,
    overlap: usize,
    hop: usize,
}

impl ZeroPhase {
    /// A filter for `samples` rows of `width` values.
    ///
    /// # Errors
    /// At most 3 × order samples.
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

    /// Adds rows, and appends those that are finished to `filtered`.
    ///
    /// The rows that complete the announced number finish all others. Further rows are ignored.
    pub fn push(&mut self, rows: &[f64], filtered: &mut Vec<f64>) {
        let left = (self.samples - self.taken) * self.width;
        let rows = rows.get(..left).unwrap_or(rows);
        self.taken += rows.len() / self.width;
        let reach = (self.filter.padding() + 1) * self.width;
        let waiting = self.forward.is_none();
        self.raw.extend_from_slice(rows);
        if waiting {
            // Wait until the initial reflection is known.
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

    /// Runs rows forwards, and backwards whenever there are enough.
    fn advance(&mut self, mut rows: &[f64], filtered: &mut Vec<f64>) {
        let full = (self.hop + self.overlap) * self.width;
        while !rows.is_empty() {
            // The buffer is full and more rows follow: finish the first ones.
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

    /// Finishes all rows with the reflection after the last one.
    fn finish(&mut self, filtered: &mut Vec<f64>) {
        let finished = self.pending.len() / self.width;
        let reflection = reflected(self.raw.rchunks_exact(self.width), self.filter.padding());
        self.pass_forwards(&reflection);
        self.pass_backwards(finished, filtered);
        self.pending = Vec::new();
    }

    /// Runs backwards over all pending rows, and outputs and removes the first `finished` ones.
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
