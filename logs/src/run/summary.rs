//! First pass over a run, which checks and counts everything.

use crate::{
    bytes::temporary_store::TemporaryStore,
    error::{Error, Problem},
    formats::table::Table,
    mapping::Time,
    problems::{Collected, LARGEST_NUMBER_OF_PROBLEMS},
    resampling::Irregularities,
    run::{
        clock::Clock,
        rows::Rows,
        source::{Files, WrapSource},
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
    pub(crate) spill: Option<TemporaryStore>,
    /// Samples of the first file at which a file joined by time has no values.
    pub(crate) left_out: usize,
    /// Irregularities that resampling has removed.
    pub(crate) irregularities: Irregularities,
    /// Columns and positions that were logged within one turn and are not yet unwrapped.
    pub(crate) wraps: Vec<(WrapSource, Wrap)>,
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
        let mut clock = Clock::default();
        let mut samples = Samples::default();
        let mut problems = Collected::default();
        let (mut fits, mut spill, mut told, mut last) = (true, None, 0, None);
        let in_memory = self.tables.iter().all(Table::in_memory);
        loop {
            let bytes = rows.bytes();
            if bytes - told >= STEP {
                advance(bytes - told);
                told = bytes;
            }
            match rows.next(&mut samples) {
                Ok(true) => {
                    let time = self.signals.times(&rows.values).next();
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
            if fits && !in_memory && 2 * samples.positions.len() > LARGEST_IN_MEMORY {
                fits = false;
                spill = self.spilled();
            }
            if !fits && samples.positions.len() >= SPILLED {
                spill = spill.filter(|own| own.write(&samples));
                samples.clear();
            }
        }
        spill = spill.filter(|own| own.write(&samples));
        if problems.is_empty() {
            problems.extend(rows.apart());
        }
        Error::check(problems.told())?;
        let frequency = match (time, self.resampling) {
            (Time::Column(_), None) => clock.frequency(&self.name)?,
            (Time::Frequency(rate), None) => *rate,
            (_, Some(own)) => own.rate,
        };
        Clock::check_count(rows.samples, &self.name)?;
        Ok(Summary {
            frequency,
            count: rows.samples,
            samples: fits.then_some(samples),
            spill,
            left_out: rows.left_out,
            irregularities: rows.irregularities(),
            wraps: rows.wraps(),
        })
    }

    /// A temporary file for a run that is read from text.
    fn spilled(&self) -> Option<TemporaryStore> {
        let is_text = self.tables.iter().any(Table::is_text);
        let new = || TemporaryStore::new(self.actuators(), self.has_velocities());
        is_text.then(new).flatten()
    }
}
