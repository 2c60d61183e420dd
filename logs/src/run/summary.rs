//! First pass over a run, which checks and counts everything.

use crate::{
    bytes::temporary_store::TemporaryStore,
    error::{Error, Problem},
    mapping::Time,
    problems::{Collected, LARGEST_NUMBER_OF_PROBLEMS},
    resampling::Irregularities,
    run::{
        block_ranges::BlockRanges,
        clock::Clock,
        gaps::Stretch,
        rows::Rows,
        source::{Files, Spill, WrapSource},
    },
    samples::Samples,
    unwrapping::Wrap,
};
use overact::Code;

/// Largest number of values of one run in memory (8 MB).
const LARGEST_IN_MEMORY: usize = 1 << 20;

/// Positions written to the temporary file at once (256 kB).
const SPILLED: usize = 1 << 15;

/// Bytes between reports of progress.
const STEP: u64 = 1 << 18;

/// Result of the first pass over a run.
pub(crate) struct Summary {
    /// Sampling frequency f_m, Hz.
    pub(crate) frequency: f64,
    pub(crate) count: usize,
    /// All samples, if they fit in memory.
    pub(crate) samples: Option<Samples>,
    /// All samples in a temporary file, if they do not fit and their files are slow to read.
    pub(crate) spill: Option<Spill>,
    /// Samples of the first file at which a file joined by time has no values.
    pub(crate) left_out: usize,
    /// Time of the first sample, s; `None` without a column of the time.
    pub(crate) first_time: Option<f64>,
    pub(crate) ranges: BlockRanges,
    /// Irregularities that resampling has removed.
    pub(crate) irregularities: Irregularities,
    /// Columns and positions that were logged within one turn and are not yet unwrapped.
    pub(crate) wraps: Vec<(WrapSource, Wrap)>,
}

/// Place of the samples of a run while it is read: memory, a temporary file, or nowhere.
struct Storage<'a> {
    files: &'a Files,
    /// Whether the samples of all stretches so far, or their files, are in memory.
    fits: bool,
    /// Number of values of earlier stretches in memory.
    kept: usize,
    /// Whether the run is read in stretches, whose files are slow to read from the middle.
    is_split: bool,
    store: Option<TemporaryStore>,
    /// Number of samples in the temporary file.
    written: usize,
}

impl<'a> Storage<'a> {
    const fn new(files: &'a Files, is_split: bool) -> Self {
        Self {
            files,
            fits: true,
            kept: 0,
            is_split,
            store: None,
            written: 0,
        }
    }

    /// Moves samples to the temporary file if they do not fit, and forgets them without one.
    fn relieve(&mut self, samples: &mut Samples) {
        let is_too_large = 2 * (self.kept + samples.positions.len()) > LARGEST_IN_MEMORY;
        if self.fits && is_too_large && !self.files.tables.iter().all(|table| table.in_memory()) {
            self.fits = false;
            self.store = self.files.temporary_store(self.is_split);
        }
        if !self.fits && samples.positions.len() >= SPILLED {
            self.write(samples);
        }
    }

    fn write(&mut self, samples: &mut Samples) {
        self.written += samples.positions.len() / self.files.actuators().max(1);
        self.store = self.store.take().filter(|own| own.write(samples));
        samples.clear();
    }
}

impl Files {
    /// Reads the whole run; `advance` gets the number of bytes read since its last call.
    ///
    /// # Errors
    /// Cells that are not finite numbers, a non-uniform time, fewer than two samples, files of
    /// different lengths or times.
    pub(crate) fn look_through(
        &self,
        time: &Time,
        advance: &dyn Fn(u64),
    ) -> Result<Summary, Error> {
        let mut rows = Rows::new(self)?;
        let mut storage = Storage::new(self, false);
        let summary = self.summary(&mut rows, time, &mut storage, advance)?;
        Clock::check_count(summary.count, &self.name)?;
        Ok(summary)
    }

    /// Reads stretches of the run, in order, in one pass.
    ///
    /// The last summary has the wrapped columns of all stretches.
    ///
    /// # Errors
    /// As [`look_through`](Self::look_through), but stretches may have fewer than two samples.
    pub(crate) fn look_through_stretches(
        &self,
        stretches: &[Stretch],
        time: &Time,
        advance: &dyn Fn(u64),
    ) -> Result<Vec<Summary>, Error> {
        let mut rows = Rows::new(self)?;
        let mut storage = Storage::new(self, true);
        let (mut summaries, mut problems) = (Vec::new(), Vec::new());
        for stretch in stretches {
            rows.enter(&stretch.tables);
            match self.summary(&mut rows, time, &mut storage, advance) {
                Ok(summary) => summaries.push(summary),
                Err(error) => problems.extend(error.problems),
            }
            if problems.len() >= LARGEST_NUMBER_OF_PROBLEMS {
                break;
            }
        }
        Error::check(problems)?;
        Ok(summaries)
    }

    /// Reads the remaining rows of a run or stretch.
    fn summary(
        &self,
        rows: &mut Rows<'_>,
        time: &Time,
        storage: &mut Storage<'_>,
        advance: &dyn Fn(u64),
    ) -> Result<Summary, Error> {
        let mut clock = Clock::default();
        let mut samples = Samples::default();
        let mut problems = Collected::default();
        let (mut told, mut last) = (rows.bytes(), None);
        let first = storage.written;
        let mut ranges = BlockRanges::new(self.actuators().max(1));
        let mut first_time = None;
        loop {
            let bytes = rows.bytes();
            if bytes - told >= STEP {
                advance(bytes - told);
                told = bytes;
            }
            match rows.next(&mut samples) {
                Ok(true) => {
                    let row = samples.positions.len() - self.actuators();
                    ranges.take(&samples.positions[row..]);
                    let time = self.signals.times(&rows.values).next();
                    first_time = first_time.or(rows.uniform_time()).or(time);
                    if let Some(time) = time.filter(|_| self.resampling.is_none()) {
                        clock.push(time, rows.line());
                        problems.extend(last.and_then(|last| rows.other_time(time - last)));
                    }
                    last = time;
                }
                Ok(false) => break,
                Err(error) => {
                    // A missing or additional line makes file lengths differ; it has its own
                    // message.
                    let follows =
                        |one: &Problem| !problems.is_empty() && one.code == Code::LOG_FILES;
                    let own: Vec<Problem> = error
                        .problems
                        .into_iter()
                        .filter(|one| !follows(one))
                        .collect();
                    problems.extend(own);
                }
            }
            if rows.has_ended() || problems.len() >= LARGEST_NUMBER_OF_PROBLEMS {
                break;
            }
            storage.relieve(&mut samples);
        }
        if !storage.fits {
            storage.write(&mut samples);
        }
        storage.kept += samples.positions.len();
        if problems.is_empty() {
            problems.extend(rows.apart());
        }
        Error::check(problems.told())?;
        let frequency = match (time, self.resampling) {
            (Time::Column(_), None) => clock.frequency(&self.name)?,
            (Time::Frequency(rate), None) => *rate,
            (_, Some(own)) => own.rate,
        };
        let spill = |store: &TemporaryStore| Spill {
            store: store.clone(),
            first,
        };
        Ok(Summary {
            frequency,
            count: rows.samples,
            samples: storage.fits.then_some(samples),
            spill: storage.store.as_ref().map(spill),
            left_out: rows.left_out,
            first_time,
            ranges,
            irregularities: rows.irregularities(),
            wraps: rows.wraps(),
        })
    }

    /// A temporary file for a run that is read from text, or in stretches.
    fn temporary_store(&self, is_split: bool) -> Option<TemporaryStore> {
        let is_slow = is_split || self.tables.iter().any(|table| table.is_slow());
        let new = || TemporaryStore::new(self.actuators(), self.has_velocities());
        is_slow.then(new).flatten()
    }
}
