//! Parallel decimation, as MATLAB's `decimate` does: an order-8 Chebyshev type I low-pass with
//! 0.05 dB of ripple up to 0.8 f_m/(2 n_d), run forwards and backwards, then one sample in n_d.
//!
//! The last sample is always kept, so the first one kept is number (N - 1) mod n_d. MATLAB filters
//! with polynomials and lowers the order where these lose their digits; sections never need that.
//!
//! Of the filtered signal one sample in n_d is wanted, so neither pass is run sample by sample. A
//! group are the n_d samples from a kept one on. With the row x of the forward pass's states at its
//! start and its samples u, everything is linear: the states at its end, the states that the
//! backward pass gains in it, and the group's share of the kept value,
//!
//! ```text
//! [x', b, y] = [x, u] M,        [s, y'] = s' T,   s <- s + b,   kept value = y + y',
//! ```
//!
//! where s' are the backward pass's states behind the group. M and T come from the sections
//! themselves, by passing unit states and unit samples. This is a matrix product over all signals at
//! once, and what waits for the backward pass is n_d times shorter than the signal.
//!
//! Where all samples are kept, another low-pass can take the place of the decimation's, so that both sides
//! of the equations are filtered alike.

use overact::Code;
use std::sync::Arc;

use nalgebra::{DMatrix, DMatrixView};

use super::{
    cascade::{Cascade, reflected, settling, started},
    design::{LowPass, chebyshev1},
    zero_phase::{TRANSIENT, ZeroPhase, check_length},
};
use crate::error::{Error, Problem};

/// Order of the Chebyshev low-pass.
pub const DECIMATION_ORDER: usize = 8;

/// Samples that a signal must exceed to be decimated.
pub const DECIMATION_PADDING: usize = 3 * DECIMATION_ORDER;

/// Ripple of the Chebyshev low-pass in its pass band, dB.
const RIPPLE_DB: f64 = 0.05;

/// States of the low-pass: two for each section.
const STATES: usize = DECIMATION_ORDER;

/// Groups that are finished at once, at least; twice the overlap where that is more.
const SMALLEST_HOP: usize = 256;

/// A decimation by one factor, designed once for all signals.
#[derive(Debug, Clone, PartialEq)]
pub struct Decimator {
    factor: usize,
    filter: Option<Arc<GroupFilter>>,
    /// A low-pass that comes first.
    first: Option<LowPass>,
}

/// The low-pass with what it does to whole groups.
#[derive(Debug, PartialEq)]
struct GroupFilter {
    low_pass: LowPass,
    /// M, (states + n_d) x (2 states + 1), split by rows: states, samples.
    from_states: DMatrix<f64>,
    from_samples: DMatrix<f64>,
    /// T, states x (states + 1).
    backwards: DMatrix<f64>,
    /// Groups after which the backward pass has forgotten its start.
    overlap: usize,
}

impl GroupFilter {
    fn new(factor: usize) -> Result<Self, Error> {
        let low_pass = chebyshev1(DECIMATION_ORDER, RIPPLE_DB, 0.8 / factor as f64)?;
        // One signal for each unit state, then one for each sample of the group.
        let width = STATES + factor;
        let mut states = vec![0.0; STATES * width];
        for state in 0..STATES {
            states[state * width + state] = 1.0;
        }
        let mut rows = vec![0.0; factor * width];
        for sample in 0..factor {
            rows[sample * width + STATES + sample] = 1.0;
        }
        let mut forward = Cascade::with_states(&low_pass, width, states);
        forward.pass(&mut rows);
        let mut backward = Cascade::with_states(&low_pass, width, vec![0.0; STATES * width]);
        backward.pass_backwards(&mut rows);
        let columns = [
            forward.into_states(),
            backward.into_states(),
            rows[..width].to_vec(),
        ];
        let all = DMatrix::from_vec(width, 2 * STATES + 1, columns.concat());

        let mut unit = Cascade::with_states(
            &low_pass,
            STATES,
            DMatrix::<f64>::identity(STATES, STATES).as_slice().to_vec(),
        );
        let mut rows = vec![0.0; factor * STATES];
        unit.pass_backwards(&mut rows);
        let columns = [unit.into_states(), rows[..STATES].to_vec()];
        Ok(Self {
            from_states: all.rows(0, STATES).clone_owned(),
            from_samples: all.rows(STATES, factor).clone_owned(),
            backwards: DMatrix::from_vec(STATES, STATES + 1, columns.concat()),
            overlap: settling(&low_pass, TRANSIENT).div_ceil(factor),
            low_pass,
        })
    }
}

impl Decimator {
    /// Designs the low-pass for `factor`; a factor of 1 leaves signals as they are.
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

    /// The same behind a low-pass, run forwards and backwards.
    #[must_use]
    pub fn behind(self, low_pass: LowPass) -> Self {
        let first = Some(low_pass);
        Self { first, ..self }
    }

    /// The factor n_d.
    #[must_use]
    pub const fn factor(&self) -> usize {
        self.factor
    }

    /// Number of the first sample that is kept of `samples`.
    #[must_use]
    pub const fn first(&self, samples: usize) -> usize {
        samples.saturating_sub(1) % self.factor
    }

    /// Number of samples that are kept of `samples`.
    #[must_use]
    pub const fn kept(&self, samples: usize) -> usize {
        samples.div_ceil(self.factor)
    }

    /// The decimation of `samples` rows of `width` values that come block by block.
    ///
    /// # Errors
    /// No more than 24 samples, or than three times the order of the low-pass before it.
    pub fn stream(&self, width: usize, samples: usize) -> Result<Decimation, Error> {
        let first = self.first.as_ref();
        let first = first.map(|own| ZeroPhase::new(own, width, samples));
        Ok(Decimation {
            first: first.transpose()?,
            groups: self.groups(width, samples)?,
        })
    }

    /// What groups the samples, where not all of them are kept.
    fn groups(&self, width: usize, samples: usize) -> Result<Option<Groups>, Error> {
        let Some(filter) = &self.filter else {
            return Ok(None);
        };
        check_length(&filter.low_pass, samples)?;
        Ok(Some(Groups {
            filter: Arc::clone(filter),
            width: width.max(1),
            factor: self.factor,
            left: samples,
            skipped: self.first(samples),
            gathered: Vec::new(),
            states: None,
            pending: Vec::new(),
            hop: SMALLEST_HOP.max(2 * filter.overlap),
            last: Vec::new(),
        }))
    }

    /// Low-passes `signal` and keeps one sample in n_d.
    ///
    /// # Errors
    /// A signal of no more than 24 samples.
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
/// A factor of 0, or a signal of no more than 24 samples.
pub fn decimate(signal: &[f64], factor: usize) -> Result<Vec<f64>, Error> {
    Decimator::new(factor)?.apply(signal)
}

/// The decimation of several signals side by side whose samples come in blocks of any size.
#[derive(Debug, Clone)]
pub struct Decimation {
    first: Option<ZeroPhase>,
    groups: Option<Groups>,
}

impl Decimation {
    /// Takes rows and appends the kept ones that are finished to `kept`. The rows that complete the
    /// number announced bring out all that is left; rows beyond it are ignored.
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

/// A decimation that is under way.
#[derive(Debug, Clone)]
struct Groups {
    filter: Arc<GroupFilter>,
    width: usize,
    factor: usize,
    /// Samples that are still to come.
    left: usize,
    /// Samples before the first group that have not come yet.
    skipped: usize,
    /// Rows that make no whole group yet.
    gathered: Vec<f64>,
    /// The forward pass's states at the start of the gathered rows, width x states, once enough rows
    /// for its reflection have come.
    states: Option<DMatrix<f64>>,
    /// For each group that waits for the backward pass, [b, y] of all signals, width x (states + 1).
    pending: Vec<f64>,
    hop: usize,
    /// The last rows, for the reflection at the end.
    last: Vec<f64>,
}

impl Groups {
    fn push(&mut self, rows: &[f64], kept: &mut Vec<f64>) {
        let rows = rows.get(..self.left * self.width).unwrap_or(rows);
        if rows.is_empty() {
            return;
        }
        self.left -= rows.len() / self.width;
        let reach = (self.filter.low_pass.padding() + 1) * self.width;
        let tail = rows.len().saturating_sub(reach);
        self.last.extend_from_slice(&rows[tail..]);
        let excess = self.last.len().saturating_sub(reach);
        self.last.drain(..excess);

        self.gathered.extend_from_slice(rows);
        if self.states.is_none() && !self.start() {
            return;
        }
        self.take_groups(kept);
        if self.left == 0 {
            self.finish(kept);
        }
    }

    /// Passes forwards up to the first group, once enough rows for that are there.
    fn start(&mut self) -> bool {
        let needed = (self.filter.low_pass.padding() + 1).max(self.skipped);
        if self.gathered.len() < needed * self.width {
            return false;
        }
        let mut forward = started(&self.filter.low_pass, self.width, &self.gathered);
        let before = self.skipped * self.width;
        forward.pass(&mut self.gathered[..before]);
        self.gathered.drain(..before);
        self.states = Some(DMatrix::from_vec(self.width, STATES, forward.into_states()));
        true
    }

    /// Passes whole groups forwards. The last sample is a kept one that begins no whole group: it
    /// stays gathered.
    fn take_groups(&mut self, kept: &mut Vec<f64>) {
        let Some(mut states) = self.states.take() else {
            return;
        };
        let filter = Arc::clone(&self.filter);
        let size = self.factor * self.width;
        let full = (self.hop + filter.overlap) * (STATES + 1) * self.width;
        let mut result = DMatrix::zeros(self.width, 2 * STATES + 1);
        let gathered = std::mem::take(&mut self.gathered);
        let mut groups = gathered.chunks_exact(size);
        for group in &mut groups {
            if self.pending.len() == full {
                self.pass_backwards(self.hop, None, kept);
            }
            let samples = DMatrixView::from_slice(group, self.width, self.factor);
            result.gemm(1.0, &samples, &filter.from_samples, 0.0);
            result.gemm(1.0, &states, &filter.from_states, 1.0);
            states.copy_from(&result.columns(0, STATES));
            self.pending
                .extend_from_slice(&result.as_slice()[STATES * self.width..]);
        }
        self.gathered = groups.remainder().to_vec();
        self.states = Some(states);
    }

    /// Gives out what the reflection behind the last row allows: all.
    fn finish(&mut self, kept: &mut Vec<f64>) {
        let Some(states) = self.states.take() else {
            return;
        };
        let low_pass = &self.filter.low_pass;
        let reflection = reflected(self.last.rchunks_exact(self.width), low_pass.padding());
        // The last sample and the reflection behind it.
        let mut rows = [std::mem::take(&mut self.gathered), reflection].concat();
        Cascade::with_states(low_pass, self.width, states.as_slice().to_vec()).pass(&mut rows);
        let end = &rows[rows.len() - self.width..];
        let mut backward = Cascade::settled(low_pass, end);
        backward.pass_backwards(&mut rows);
        let behind = DMatrix::from_vec(self.width, STATES, backward.into_states());
        let groups = self.pending.len() / ((STATES + 1) * self.width);
        self.pass_backwards(groups, Some(behind), kept);
        kept.extend_from_slice(&rows[..self.width]);
    }

    /// Runs backwards over all pending groups from the states `behind` the last of them, and gives out
    /// the kept samples of the first `finished` ones, which are pending no more.
    fn pass_backwards(
        &mut self,
        finished: usize,
        behind: Option<DMatrix<f64>>,
        kept: &mut Vec<f64>,
    ) {
        let width = self.width;
        let size = (STATES + 1) * width;
        let mut states = behind.unwrap_or_else(|| DMatrix::zeros(width, STATES));
        let start = kept.len();
        kept.resize(start + finished * width, 0.0);
        // A copy: groups behind the finished ones are passed again, from a better start.
        let mut group = DMatrix::zeros(width, STATES + 1);
        for (index, waiting) in self.pending.chunks_exact(size).enumerate().rev() {
            group.copy_from_slice(waiting);
            group.gemm(1.0, &states, &self.filter.backwards, 1.0);
            states.copy_from(&group.columns(0, STATES));
            if index < finished {
                let place = start + index * width;
                kept[place..place + width].copy_from_slice(&group.as_slice()[STATES * width..]);
            }
        }
        self.pending.drain(..finished * size);
    }
}
