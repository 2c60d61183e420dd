//! Parallel decimation, equivalent to MATLAB's `decimate`.
//!
//! An order-8 Chebyshev type I low-pass with 0.05 dB of ripple up to 0.8 f_m/(2 n_d) runs forwards
//! and backwards; then every n_d-th sample is kept. The last sample is always kept, so the first
//! kept one is number (N - 1) mod n_d. MATLAB filters with polynomials and lowers the order if
//! these are inaccurate. Second-order sections never need that.
//!
//! Only one sample in n_d is needed, so neither pass runs sample by sample. A group is a kept
//! sample and those up to the next one. Its contribution to the [`modes`](super::modes) of the
//! low-pass is a product with fixed weights ([`groups`](super::groups)), for all signals at once.
//! The data between both passes are n_d times shorter than the signal. Both ends are filtered
//! sample by sample.
//!
//! If all samples are kept, another low-pass can replace that of the decimation, so that both sides
//! of the equations pass the same filter.

use overact::Code;
use std::sync::Arc;

use super::{
    cascade::{Cascade, reflected, settling, started},
    design::{LowPass, chebyshev1},
    groups::{Groups, PARTS},
    modes::{Mode, Modes},
    zero_phase::{TRANSIENT, ZeroPhase, check_length},
};
use overact_logs::{Error, Problem};

/// Order of the Chebyshev low-pass.
pub const DECIMATION_ORDER: usize = 8;

/// Number of samples that a signal must exceed.
pub const DECIMATION_PADDING: usize = 3 * DECIMATION_ORDER;

/// Ripple of the Chebyshev low-pass in its pass band, dB.
const RIPPLE_DB: f64 = 0.05;

/// Fewest groups finished at once; at least twice the overlap.
const SMALLEST_HOP: usize = 256;

/// A decimation by one factor, for any number of signals.
#[derive(Debug, Clone, PartialEq)]
pub struct Decimator {
    factor: usize,
    filter: Option<Arc<GroupFilter>>,
    /// A low-pass before the decimation.
    first: Option<LowPass>,
}

/// The low-pass with its weights for groups.
#[derive(Debug, PartialEq)]
struct GroupFilter {
    low_pass: LowPass,
    groups: Groups,
    /// Settling time of the backward pass in groups.
    overlap: usize,
}

impl GroupFilter {
    fn new(factor: usize) -> Result<Self, Error> {
        let low_pass = chebyshev1(DECIMATION_ORDER, RIPPLE_DB, 0.8 / factor as f64)?;
        Ok(Self {
            groups: Groups::new(Modes::new(&low_pass), factor),
            overlap: settling(&low_pass, TRANSIENT).div_ceil(factor),
            low_pass,
        })
    }
}

impl Decimator {
    /// Designs the low-pass for `factor`; a factor of 1 keeps signals unchanged.
    ///
    /// # Errors
    /// A factor of 0.
    pub fn new(factor: usize) -> Result<Self, Error> {
        if factor == 0 {
            return Err(
                Problem::new(Code::SETTINGS, "a decimation by 0 is not possible")
                    .help("choose 1 to keep every sample")
                    .into(),
            );
        }
        let filter = if factor == 1 {
            None
        } else {
            Some(Arc::new(GroupFilter::new(factor)?))
        };
        Ok(Self {
            factor,
            filter,
            first: None,
        })
    }

    /// Adds a low-pass before the decimation, run forwards and backwards.
    #[must_use]
    pub fn behind(self, low_pass: LowPass) -> Self {
        let first = Some(low_pass);
        Self { first, ..self }
    }

    /// Factor n_d.
    #[must_use]
    pub const fn factor(&self) -> usize {
        self.factor
    }

    /// Number of the first kept sample.
    #[must_use]
    pub const fn first(&self, samples: usize) -> usize {
        samples.saturating_sub(1) % self.factor
    }

    /// Number of kept samples.
    #[must_use]
    pub const fn kept(&self, samples: usize) -> usize {
        samples.div_ceil(self.factor)
    }

    /// Decimates `samples` rows of `width` values block by block.
    ///
    /// # Errors
    /// At most 24 samples, or at most three times the order of the first low-pass.
    pub fn stream(&self, width: usize, samples: usize) -> Result<Decimation, Error> {
        let first = self.first.as_ref();
        let first = first.map(|own| ZeroPhase::new(own, width, samples));
        Ok(Decimation {
            first: first.transpose()?,
            groups: self.groups(width, samples)?,
        })
    }

    /// State of the decimation; `None` if all samples are kept.
    fn groups(&self, width: usize, samples: usize) -> Result<Option<Grouped>, Error> {
        let Some(filter) = &self.filter else {
            return Ok(None);
        };
        check_length(&filter.low_pass, samples)?;
        let hop = SMALLEST_HOP.max(2 * filter.overlap);
        // Largest number of pending groups.
        let waiting = (samples / self.factor).min(hop + filter.overlap);
        Ok(Some(Grouped {
            filter: Arc::clone(filter),
            width: width.max(1),
            left: samples,
            skipped: self.first(samples),
            gathered: Vec::new(),
            before: None,
            pending: vec![0.0; waiting * (PARTS + 1) * width.max(1)],
            waiting: 0,
            hop,
            last: Vec::new(),
        }))
    }

    /// Filters `signal` and keeps every n_d-th sample.
    ///
    /// # Errors
    /// A signal of at most 24 samples.
    pub fn apply(&self, signal: &[f64]) -> Result<Vec<f64>, Error> {
        let mut stream = self.stream(1, signal.len())?;
        let mut kept = Vec::with_capacity(self.kept(signal.len()));
        stream.push(signal, &mut kept);
        Ok(kept)
    }
}

/// Decimates one signal by `factor`.
///
/// # Errors
/// A factor of 0, or a signal of at most 24 samples.
pub fn decimate(signal: &[f64], factor: usize) -> Result<Vec<f64>, Error> {
    Decimator::new(factor)?.apply(signal)
}

/// Decimation of several interleaved signals in blocks of any size.
#[derive(Debug, Clone)]
pub struct Decimation {
    first: Option<ZeroPhase>,
    groups: Option<Grouped>,
}

impl Decimation {
    /// Adds rows, and appends kept rows that are finished to `kept`.
    ///
    /// The rows that complete the announced number finish all others. Further rows are ignored.
    pub fn push(&mut self, rows: &[f64], kept: &mut Vec<f64>) {
        match (&mut self.first, &mut self.groups) {
            (None, None) => kept.extend_from_slice(rows),
            (None, Some(groups)) => groups.push(rows, kept),
            (Some(first), None) => first.push(rows, kept),
            (Some(first), Some(groups)) => {
                let mut filtered = Vec::new();
                first.push(rows, &mut filtered);
                groups.push(&filtered, kept);
            }
        }
    }
}

/// State of a decimation.
#[derive(Debug, Clone)]
struct Grouped {
    filter: Arc<GroupFilter>,
    width: usize,
    /// Samples still to come.
    left: usize,
    /// Samples before the first group still to come.
    skipped: usize,
    /// Rows of an incomplete group.
    gathered: Vec<f64>,
    /// X of all signals before the gathered rows, once the initial reflection is known.
    before: Option<Vec<f64>>,
    /// For each pending group, F and the partial kept values.
    ///
    /// It has space for the largest number of pending groups.
    pending: Vec<f64>,
    /// Number of pending groups.
    waiting: usize,
    hop: usize,
    /// Last rows, for the reflection at the end.
    last: Vec<f64>,
}

impl Grouped {
    fn push(&mut self, rows: &[f64], kept: &mut Vec<f64>) {
        let rows = rows.get(..self.left * self.width).unwrap_or(rows);
        if rows.is_empty() {
            return;
        }
        self.left -= rows.len() / self.width;
        // Keep new rows that are among the last of all.
        let reach = self.filter.low_pass.padding() + 1;
        let tail = reach.saturating_sub(self.left) * self.width;
        self.last
            .extend_from_slice(&rows[rows.len().saturating_sub(tail)..]);
        if self.before.is_some() {
            self.take(rows, kept);
        } else {
            self.gathered.extend_from_slice(rows);
            if !self.start() {
                return;
            }
            let gathered = std::mem::take(&mut self.gathered);
            self.take(&gathered, kept);
        }
        if self.left == 0 {
            self.finish(kept);
        }
    }

    /// Runs forwards to the first group, once there are enough rows.
    fn start(&mut self) -> bool {
        let needed = (self.filter.low_pass.padding() + 1).max(self.skipped);
        if self.gathered.len() < needed * self.width {
            return false;
        }
        let mut forward = started(&self.filter.low_pass, self.width, &self.gathered);
        let before = self.skipped * self.width;
        forward.pass(&mut self.gathered[..before]);
        self.gathered.drain(..before);
        let states = forward.into_states();
        let modes = &self.filter.groups.modes;
        let mut all = vec![0.0; PARTS * self.width];
        for signal in 0..self.width {
            let past = modes.past(&sections(&states, self.width, signal));
            put(&mut all, self.width, signal, &past);
        }
        self.before = Some(all);
        true
    }

    /// Runs whole groups forwards.
    ///
    /// The last sample is kept but starts no whole group: it stays in `gathered`.
    fn take(&mut self, mut rows: &[f64], kept: &mut Vec<f64>) {
        let size = self.filter.groups.length * self.width;
        if !self.gathered.is_empty() {
            let room = (size - self.gathered.len()).min(rows.len());
            let (now, later) = rows.split_at(room);
            self.gathered.extend_from_slice(now);
            rows = later;
            if self.gathered.len() < size {
                return;
            }
            let mut gathered = std::mem::take(&mut self.gathered);
            self.take_groups(&gathered, kept);
            gathered.clear();
            self.gathered = gathered;
        }
        let whole = rows.len() / size * size;
        self.take_groups(&rows[..whole], kept);
        self.gathered.extend_from_slice(&rows[whole..]);
    }

    /// Runs groups forwards.
    fn take_groups(&mut self, rows: &[f64], kept: &mut Vec<f64>) {
        let Some(mut before) = self.before.take() else {
            return;
        };
        let filter = Arc::clone(&self.filter);
        let size = (PARTS + 1) * self.width;
        let full = self.hop + filter.overlap;
        let mut after = vec![0.0; before.len()];
        for group in rows.chunks_exact(filter.groups.length * self.width) {
            if self.waiting == full {
                self.pass_backwards(self.hop, None, kept);
            }
            let group_output = &mut self.pending[self.waiting * size..][..size];
            self.waiting += 1;
            filter.groups.pass(group, &before, &mut after, group_output);
            std::mem::swap(&mut before, &mut after);
        }
        self.before = Some(before);
    }

    /// Finishes all groups with the reflection after the last row.
    fn finish(&mut self, kept: &mut Vec<f64>) {
        let Some(before) = self.before.take() else {
            return;
        };
        let (filter, width) = (Arc::clone(&self.filter), self.width);
        let modes = &filter.groups.modes;
        let padding = filter.low_pass.padding();
        let reflection = reflected(self.last.rchunks_exact(width), padding);
        // The last sample and the reflection after it.
        let mut rows = [std::mem::take(&mut self.gathered), reflection].concat();
        for signal in 0..width {
            let own = rows[signal..].iter().step_by(width);
            let mut own: Vec<f64> = own.copied().collect();
            modes.pass(&get(&before, width, signal), &mut own);
            let places = rows[signal..].iter_mut().step_by(width);
            places.zip(own).for_each(|(to, from)| *to = from);
        }
        let end = &rows[rows.len() - width..];
        let mut backward = Cascade::settled(&filter.low_pass, end);
        backward.pass_backwards(&mut rows);
        let states = backward.into_states();
        let mut behind = vec![0.0; before.len()];
        for signal in 0..width {
            let past = get(&before, width, signal);
            let future = modes.future(&sections(&states, width, signal), &past);
            put(&mut behind, width, signal, &future);
        }
        self.pass_backwards(self.waiting, Some(behind), kept);
        kept.extend_from_slice(&rows[..width]);
    }

    /// Runs backwards over all pending groups, starting with B after the last one.
    ///
    /// It outputs the kept samples of the first `finished` groups and removes these.
    fn pass_backwards(&mut self, finished: usize, behind: Option<Vec<f64>>, kept: &mut Vec<f64>) {
        let width = self.width;
        let size = (PARTS + 1) * width;
        let mut behind = behind.unwrap_or_else(|| vec![0.0; PARTS * width]);
        let start = kept.len();
        kept.resize(start + finished * width, 0.0);
        let pending = self.pending[..self.waiting * size].chunks_exact(size);
        for (index, waiting) in pending.enumerate().rev() {
            // Later groups are run again with a better start.
            let place = start + index * width;
            let own = (index < finished).then(|| &mut kept[place..place + width]);
            self.filter.groups.pass_backwards(waiting, &mut behind, own);
        }
        let rest = finished * size..self.waiting * size;
        self.pending.copy_within(rest, 0);
        self.waiting -= finished;
    }
}

/// States of one signal.
fn sections(states: &[f64], width: usize, signal: usize) -> Vec<[f64; 2]> {
    let all = states.chunks_exact(2 * width);
    all.map(|own| [own[signal], own[width + signal]]).collect()
}

/// Modes of one signal.
fn get(all: &[f64], width: usize, signal: usize) -> Vec<Mode> {
    let modes = all.chunks_exact(2 * width);
    modes
        .map(|own| Mode::new(own[signal], own[width + signal]))
        .collect()
}

/// Stores the modes of one signal.
fn put(all: &mut [f64], width: usize, signal: usize, own: &[Mode]) {
    for (place, mode) in all.chunks_exact_mut(2 * width).zip(own) {
        (place[signal], place[width + signal]) = (mode.re, mode.im);
    }
}
