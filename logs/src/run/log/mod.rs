//! One run: uniformly sampled positions and torques of all actuators.
//!
//! It is in memory, or in a file that is read block by block.

mod part;
mod reader;

use overact::Code;
use std::sync::Arc;

use crate::{
    error::{Error, Problem},
    mapping::load::{Load, carried_payloads},
    period_sums::{MeanOfOtherPeriods, Periods},
    run::{block_ranges::BlockRanges, rows, source::Files, time_range},
    samples::Samples,
};

use reader::Rows;

pub use reader::Reader;

/// One measured or virtual run.
#[derive(Debug, Clone, PartialEq)]
pub struct Log {
    name: String,
    sampling_frequency: f64,
    actuators: usize,
    /// Number of samples of the source before the run.
    first: usize,
    samples: usize,
    source: Source,
    /// Offset subtracted from the position of each actuator of the source.
    offsets: Vec<f64>,
    /// Factor of the torque of each actuator of the source.
    torque_factors: Vec<f64>,
    payload: bool,
    /// Name of the payload, if there are several.
    payload_name: Option<Arc<str>>,
    /// Name of the recording session, if there are several.
    session: Option<Arc<str>>,
    instruments: Option<Box<Log>>,
    /// Note to the user on changes of the samples.
    note: Option<String>,
    /// Whether positions were logged within one turn and are unwrapped.
    is_unwrapped: bool,
    is_resampled: bool,
    /// Place in the recording, if that has gaps.
    stretch: Option<RecordingPart>,
    /// Ranges of the positions, if they are known from reading.
    ranges: Option<Arc<BlockRanges>>,
    /// Time of the first sample in ranges of time, s.
    first_time: f64,
}

/// Place of a run in a recording with gaps.
#[derive(Debug, Clone, PartialEq)]
struct RecordingPart {
    /// Range of time as in `log.csv[10:60]`.
    range: String,
    /// Time since the first sample of the recording, s.
    start: f64,
    /// Whether an earlier stretch of the recording is used, too.
    continues: bool,
}

/// Source of the samples.
#[derive(Debug, Clone, PartialEq)]
enum Source {
    /// Positions, torques and velocities, samples × n each; no velocities if not measured.
    Memory([Arc<[f64]>; 3]),
    /// Files that have been checked before.
    Files(Box<Files>),
    /// At each sample, the mean position of the other periods of a run.
    Others(Box<Log>, Arc<Periods>),
}

impl Log {
    /// Creates a run from positions (m, rad) and torques (N, N m), samples × n, row-major.
    ///
    /// It has `actuators` actuators and is sampled at `sampling_frequency` (Hz). `payload` says
    /// whether the platform carried the payload.
    ///
    /// # Errors
    /// An empty run, arrays of wrong lengths, values that are not finite, a frequency that is not
    /// positive.
    pub fn new(
        name: impl Into<String>,
        sampling_frequency: f64,
        actuators: usize,
        positions: Vec<f64>,
        torques: Vec<f64>,
        payload: bool,
    ) -> Result<Self, Error> {
        let name = name.into();
        let problem = |message: String| Problem::new(Code::LOG_SHAPE, message).file(name.as_str());
        let mut problems = Vec::new();
        if !(sampling_frequency.is_finite() && sampling_frequency > 0.0) {
            problems.push(problem(format!(
                "the sampling frequency is {sampling_frequency} Hz"
            )));
        }
        if positions.is_empty() || actuators == 0 {
            problems.push(problem(String::from("the run is empty")));
        } else if positions.len() != torques.len() || !positions.len().is_multiple_of(actuators) {
            problems.push(problem(format!(
                "{} positions and {} torques are not samples of {actuators} actuators",
                positions.len(),
                torques.len()
            )));
        }
        for (what, values) in [("position", &positions), ("torque", &torques)] {
            if let Some(index) = values.iter().position(|value| !value.is_finite()) {
                problems.push(problem(format!(
                    "sample {}: the {what} of actuator {} is not a finite number",
                    index / actuators.max(1),
                    index % actuators.max(1)
                )));
            }
        }
        Error::check(problems)?;
        let samples = positions.len() / actuators;
        let source = Source::Memory([positions.into(), torques.into(), Arc::default()]);
        let log = Self::plain(source, name, sampling_frequency, actuators);
        Ok(Self {
            samples,
            payload,
            ..log
        })
    }

    /// Adds measured velocities of the actuators (m/s, rad/s), samples × n, row-major.
    ///
    /// They replace differences of the positions. Only runs in memory accept them, and only as many
    /// as positions.
    #[must_use]
    pub fn with_velocities(mut self, velocities: Vec<f64>) -> Self {
        if let Source::Memory([positions, _, own]) = &mut self.source
            && positions.len() == velocities.len()
        {
            *own = velocities.into();
        }
        self
    }

    /// Whether velocities were measured.
    #[must_use]
    pub fn has_velocities(&self) -> bool {
        match &self.source {
            Source::Memory([_, _, velocities]) => !velocities.is_empty(),
            Source::Files(files) => files.has_velocities(),
            Source::Others(..) => false,
        }
    }

    /// Sets the note on changes of the samples.
    pub(crate) fn with_note(mut self, note: Option<String>) -> Self {
        self.note = note;
        self
    }

    /// The same run with one more sentence in its note.
    #[must_use]
    pub fn with_more_notes(mut self, more: &str) -> Self {
        self.note = Some(match self.note {
            Some(own) => format!("{own}; {more}"),
            None => more.to_owned(),
        });
        self
    }

    /// The same run without a note.
    #[must_use]
    pub fn without_note(mut self) -> Self {
        self.note = None;
        self
    }

    /// Note on changes of the samples.
    ///
    /// For files with separate clocks, it names those that were interpolated. It also says if only a
    /// range of time was read.
    #[must_use]
    pub fn note(&self) -> Option<&str> {
        self.note.as_deref()
    }

    /// Adds the motion of the simulated robot, for instrumental variables.
    ///
    /// It corresponds sample by sample to this run but has no position errors. Its torques are not
    /// used.
    #[must_use]
    pub fn with_instruments(mut self, instruments: Self) -> Self {
        self.instruments = Some(Box::new(instruments));
        self
    }

    /// The simulated motion of the run.
    #[must_use]
    pub fn instruments(&self) -> Option<&Self> {
        self.instruments.as_deref()
    }

    /// The run with the mean positions of the other periods at the same phase.
    ///
    /// Its torques are those of this run.
    #[must_use]
    pub fn others(&self, periods: Periods) -> Self {
        Self {
            source: Source::Others(Box::new(self.clone()), Arc::new(periods)),
            first: 0,
            // The other periods belong to this run, so offsets and torque factors are already
            // applied.
            offsets: vec![0.0; self.actuators],
            torque_factors: vec![1.0; self.actuators],
            ..self.clone()
        }
    }

    /// A run without samples, payload and notes.
    fn plain(source: Source, name: String, sampling_frequency: f64, actuators: usize) -> Self {
        Self {
            name,
            sampling_frequency,
            actuators,
            first: 0,
            samples: 0,
            source,
            offsets: vec![0.0; actuators],
            torque_factors: vec![1.0; actuators],
            payload: false,
            payload_name: None,
            session: None,
            instruments: None,
            note: None,
            is_unwrapped: false,
            is_resampled: false,
            stretch: None,
            ranges: None,
            first_time: 0.0,
        }
    }

    /// A run that stays in its files.
    pub(crate) fn in_files(
        files: Files,
        sampling_frequency: f64,
        samples: usize,
        payload: bool,
    ) -> Self {
        let (name, actuators) = (files.name().to_owned(), files.actuators());
        let source = Source::Files(Box::new(files));
        let log = Self::plain(source, name, sampling_frequency, actuators);
        Self {
            samples,
            payload,
            ..log
        }
    }

    /// Sets whether the run was resampled from irregular times.
    pub(crate) fn with_resampled(mut self, is_resampled: bool) -> Self {
        self.is_resampled = is_resampled;
        self
    }

    /// Whether the run was resampled from irregular times.
    #[must_use]
    pub const fn is_resampled(&self) -> bool {
        self.is_resampled
    }

    /// Sets whether positions were logged within one turn and are unwrapped.
    pub(crate) fn with_unwrapped(mut self, is_unwrapped: bool) -> Self {
        self.is_unwrapped = is_unwrapped;
        self
    }

    /// Whether positions were logged within one turn and are unwrapped.
    #[must_use]
    pub const fn is_unwrapped(&self) -> bool {
        self.is_unwrapped
    }

    /// Name of the run: its file as the caller named it.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Sampling frequency f_m, Hz.
    #[must_use]
    pub const fn sampling_frequency(&self) -> f64 {
        self.sampling_frequency
    }

    /// Number of samples.
    #[must_use]
    pub const fn samples(&self) -> usize {
        self.samples
    }

    /// Number of actuators, n.
    #[must_use]
    pub const fn actuators(&self) -> usize {
        self.actuators
    }

    /// Whether the platform carried the payload.
    #[must_use]
    pub const fn payload(&self) -> bool {
        self.payload
    }

    /// Whether the samples are in memory, not in a file.
    #[must_use]
    pub const fn in_memory(&self) -> bool {
        matches!(self.source, Source::Memory(..))
    }

    /// Name of the payload that the robot carried, if there are several; `A+B` if it carried two.
    #[must_use]
    pub fn payload_name(&self) -> Option<&str> {
        self.payload_name.as_deref().filter(|_| self.payload)
    }

    /// The payload that the platform carried.
    #[must_use]
    pub fn carried(&self) -> Load<'_> {
        Load::new(self.payload, self.payload_name())
    }

    /// The same run with a payload of this name; different names are different bodies.
    ///
    /// The name of several payloads is `A+B`, in any order
    /// ([`carried_payloads`](crate::carried_payloads)).
    #[must_use]
    pub fn with_payload_name(mut self, name: &str) -> Self {
        let mut names: Vec<&str> = carried_payloads(name).collect();
        names.sort_unstable();
        self.payload = true;
        self.payload_name = Some(names.join("+").into());
        self
    }

    /// Name of the recording session, such as a day, if there are several.
    #[must_use]
    pub fn session(&self) -> Option<&str> {
        self.session.as_deref()
    }

    /// The same run as a recording of a session of this name.
    ///
    /// The intervals of parameters then contain the changes of the robot between sessions.
    #[must_use]
    pub fn with_session(mut self, name: &str) -> Self {
        self.session = Some(name.into());
        self
    }

    /// The same run under another name.
    ///
    /// If it is a stretch of a recording with gaps, its range of time follows.
    #[must_use]
    pub fn with_name(mut self, name: impl Into<String>) -> Self {
        self.name = name.into();
        if let Some(stretch) = &self.stretch {
            self.name += &stretch.range;
        }
        self
    }

    /// The same run with another payload label.
    #[must_use]
    pub fn with_payload(mut self, payload: bool) -> Self {
        self.payload = payload;
        self
    }

    /// The same run with encoder offsets (rad, m) subtracted, one for each actuator.
    #[must_use]
    pub fn without_offsets(mut self, offsets: &[f64]) -> Self {
        for (own, more) in self.offsets.iter_mut().zip(offsets) {
            *own += more;
        }
        self
    }

    /// The same run with its torques multiplied by a factor for each actuator.
    #[must_use]
    pub fn with_torque_factors(mut self, factors: &[f64]) -> Self {
        for (own, more) in self.torque_factors.iter_mut().zip(factors) {
            *own *= more;
        }
        self
    }

    /// The first `samples` of the run, in memory.
    ///
    /// # Errors
    /// As [`Log::reader`] and [`Reader::next`].
    pub fn beginning(&self, samples: usize) -> Result<Self, Error> {
        let own = self.first_samples(samples)?;
        let beginning = Self::new(
            self.name.as_str(),
            self.sampling_frequency,
            self.actuators,
            own.positions,
            own.torques,
            self.payload,
        )?;
        let beginning = beginning.with_velocities(own.velocities);
        Ok(match self.payload_name() {
            Some(name) => beginning.with_payload_name(name),
            None => beginning,
        })
    }

    /// The first `count` samples, or all if there are fewer.
    pub(crate) fn first_samples(&self, count: usize) -> Result<Samples, Error> {
        let values = count.min(self.samples) * self.actuators;
        let mut samples = Samples::default();
        let mut reader = self.reader()?;
        while samples.positions.len() < values
            && let Some(block) = reader.next()?
        {
            samples.positions.extend(block.positions);
            samples.torques.extend(block.torques);
            samples.velocities.extend(block.velocities);
        }
        samples.positions.truncate(values);
        samples.torques.truncate(values);
        samples.velocities.truncate(values);
        Ok(samples)
    }

    /// A reader of the run from its first sample.
    ///
    /// # Errors
    /// A file that cannot be opened any more.
    pub fn reader(&self) -> Result<Reader<'_>, Error> {
        let rows = match &self.source {
            Source::Memory(all) => Rows::Memory(all.each_ref().map(|own| &**own)),
            Source::Files(files) => match &files.spill {
                Some(spill) => Rows::Spilled(&spill.store, spill.first),
                None => Rows::Files(Box::new(rows::Rows::new(files)?)),
            },
            Source::Others(log, periods) => {
                Rows::Others(Box::new(log.reader()?), MeanOfOtherPeriods::new(periods))
            }
        };
        let mut reader = Reader {
            rows,
            name: &self.name,
            offsets: &self.offsets,
            torque_factors: &self.torque_factors,
            left: self.samples,
        };
        reader.skip(self.first)?;
        Ok(reader)
    }

    /// Adds what is known from reading: ranges of the positions, and the time of the first sample.
    ///
    /// The first sample is `start` (s) after that of its recording.
    pub(crate) fn with_ranges(
        mut self,
        ranges: BlockRanges,
        first_time: Option<f64>,
        start: f64,
    ) -> Self {
        self.ranges = Some(Arc::new(ranges));
        let own = first_time.filter(|time| !time_range::is_absolute(*time));
        self.first_time = own.unwrap_or(start);
        self
    }

    /// All positions (m, rad) and torques (N, N m), samples × n each, row-major.
    ///
    /// # Errors
    /// As [`Log::reader`] and [`Reader::next`].
    pub fn load(&self) -> Result<(Vec<f64>, Vec<f64>), Error> {
        let Samples {
            positions, torques, ..
        } = self.first_samples(self.samples)?;
        Ok((positions, torques))
    }
}
