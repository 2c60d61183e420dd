//! A run is gone through once before it is used, to check and count everything.

use super::{
    clock::Clock,
    mapping::Time,
    problems::{Collected, LARGEST_NUMBER_OF_PROBLEMS},
    rows::Rows,
    samples::Samples,
    source::{Files, WrapSource},
    spill::Spill,
    table::Table,
    turns::Wrap,
};
use crate::error::{Error, Problem};
use overact::Code;

/// Numbers of one run that are kept in memory (8 MB); arrays are in memory anyhow.
const LARGEST_IN_MEMORY: usize = 1 << 20;

/// Numbers of positions that are put into a temporary file at once (256 kB).
const SPILLED: usize = 1 << 15;

/// Bytes after which progress is told.
const STEP: u64 = 1 << 18;

/// What is known of a run that has been gone through.
pub(super) struct Summary {
    /// f_m, Hz.
    pub(super) frequency: f64,
    pub(super) count: usize,
    /// All samples, where they are few enough to be kept.
    pub(super) samples: Option<Samples>,
    /// All samples in a temporary file, where they are not kept and their files are slow to read.
    pub(super) spill: Option<Spill>,
    /// Samples of the first file at which another one, which is joined by time, has none.
    pub(super) left_out: usize,
    /// Columns and positions that were logged within one turn and have not been unwrapped.
    pub(super) wraps: Vec<(WrapSource, Wrap)>,
}

impl Files {
    /// Goes through the whole run; `advance` is told every now and then how many bytes more have been read.
    ///
    /// # Errors
    /// Cells that are not finite numbers, a time that is not uniform, fewer than two samples, files of
    /// different lengths or with different times.
    pub(super) fn look_through(
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
                    if let Some(time) = time.filter(|_| self.resample.is_none()) {
                        clock.push(time, rows.line());
                        problems.extend(last.and_then(|last| rows.other_time(time - last)));
                    }
                    last = time;
                }
                Ok(false) => break,
                Err(error) => {
                    // A line too many or too few makes files end apart; it has been told itself.
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
        let frequency = match (time, self.resample) {
            (Time::Column(_), None) => clock.frequency(&self.name)?,
            (Time::Frequency(rate), None) => *rate,
            (_, Some((rate, _))) => rate,
        };
        Clock::check_count(rows.samples, &self.name)?;
        Ok(Summary {
            frequency,
            count: rows.samples,
            samples: fits.then_some(samples),
            spill,
            left_out: rows.left_out,
            wraps: rows.wraps(),
        })
    }

    /// A temporary file for a run that is read from text.
    fn spilled(&self) -> Option<Spill> {
        let is_text = self.tables.iter().any(Table::is_text);
        let new = || Spill::new(self.actuators(), self.has_velocities());
        is_text.then(new).flatten()
    }
}
