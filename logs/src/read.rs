//! Reads runs from files, bytes or arrays.

use overact::Code;
use rayon::prelude::*;
use std::{
    path::Path,
    sync::{
        Arc,
        atomic::{AtomicU64, Ordering},
    },
};

use crate::{
    bytes::byte_source::ByteSource,
    error::{Error, Problem},
    formats::{
        arrays::{Array, Arrays},
        table::Table,
    },
    mapping::Mapping,
    problems::display_name,
    resampling::Irregularities,
    run::{
        gaps::{Gaps, LeftOut},
        log::Log,
        source::{Files, WrapSource},
        summary::Summary,
        time_range::TimeRange,
    },
    unwrapping::Wrap,
};

/// Splits a path into the files of a run, without a range of time.
///
/// `a.csv+b.csv` joins two files, sample by sample or by time, unless a file has this name.
/// `a.csv+b.csv[10:60]` is the same run, of which only some samples are used ([`time_range`]).
#[must_use]
pub fn parts(path: &Path) -> Vec<&Path> {
    joined(path_and_range(path).0)
}

/// Range of time of a path, `log.csv[10:60]`; `None` without one.
///
/// Samples with start ≤ t < end are used. The time t, in s, is that of the log's own time column.
/// It is counted from the first sample if there is no time column, or if the first time is an
/// absolute stamp, larger than 1e6 s. A file whose name really has brackets has no range.
///
/// # Errors
/// A reversed range, or bounds that are no numbers.
pub fn time_range(path: &Path) -> Result<Option<TimeRange>, Error> {
    let (run, text) = path_and_range(path);
    let parsed = text.map(|text| {
        let range = TimeRange::parse(text);
        range.map_err(|why| TimeRange::problem(&display_name(run), text, &why))
    });
    Ok(parsed.transpose()?)
}

/// Splits a path into a run and the text of its range.
fn path_and_range(path: &Path) -> (&Path, Option<&str>) {
    let bracketed = || {
        let (run, range) = path.to_str()?.strip_suffix(']')?.rsplit_once('[')?;
        let last = joined(path).pop()?;
        let is_range = range.contains(':') && !run.is_empty() && !last.exists();
        is_range.then(|| (Path::new(run), Some(range)))
    };
    bracketed().unwrap_or((path, None))
}

/// Splits a path without a range into the files of a run.
fn joined(path: &Path) -> Vec<&Path> {
    let text = path.to_str().filter(|_| !path.exists());
    let parts: Vec<&Path> = text
        .into_iter()
        .flat_map(|text| text.split('+'))
        .map(Path::new)
        .collect();
    if parts.iter().any(|part| part.exists()) {
        parts
    } else {
        vec![path]
    }
}

/// Number of samples that a run needs at a sampling frequency (Hz).
pub type NeededSamples<'a> = dyn Fn(f64) -> usize + Sync + 'a;

/// Reads a run from a file of any supported format, or from several joined files ([`parts`]).
///
/// With a range of time, `log.csv[10:60]`, only its samples are used ([`time_range`]).
///
/// # Errors
/// A file that cannot be read or of an unsupported format, missing columns, invalid expressions,
/// cells that are not finite numbers, a non-uniform time, files of different lengths or times, or
/// an invalid mapping. A log with gaps is an error, too: see [`read_runs`].
pub fn read(path: &Path, mapping: &Mapping, payload: bool) -> Result<Log, Error> {
    whole(opened(path, mapping)?, mapping, payload)
}

/// Opens the files of a path.
fn opened(path: &Path, mapping: &Mapping) -> Result<Files, Error> {
    let part = |path: &Path| (display_name(path), ByteSource::at(path));
    let files: Vec<_> = parts(path).into_iter().map(part).collect();
    let range = time_range(path)?;
    Files::new(display_name(path), &files, mapping, range)
}

/// Reads a run from arrays in memory, like arrays of a file; `name` is for messages.
///
/// # Errors
/// As [`read`].
pub fn read_arrays(
    name: &str,
    arrays: &[Array<'_>],
    mapping: &Mapping,
    payload: bool,
) -> Result<Log, Error> {
    whole(of_arrays(name, arrays, mapping)?, mapping, payload)
}

/// Reads the runs of arrays in memory: several if the time has gaps, as [`read_runs`].
///
/// # Errors
/// As [`read_runs`].
pub fn runs_of_arrays(
    name: &str,
    arrays: &[Array<'_>],
    mapping: &Mapping,
    payload: bool,
    needed: &NeededSamples<'_>,
) -> Result<Vec<Log>, Error> {
    let files = of_arrays(name, arrays, mapping)?;
    runs(files, mapping, payload, needed, &|_| {})
}

/// Opens arrays in memory.
fn of_arrays(name: &str, arrays: &[Array<'_>], mapping: &Mapping) -> Result<Files, Error> {
    let mut table = Arrays::new(name.to_owned());
    for array in arrays {
        let (rows, columns) = array.shape;
        table.push(array.name, rows, columns, array.values);
    }
    let tables = vec![Table::new(table)];
    Files::of_tables(name.to_owned(), tables, vec![1], mapping, None)
}

/// Reads a run from the bytes of a file of any supported format; `name` is for messages.
///
/// # Errors
/// As [`read`].
pub fn read_bytes(
    name: &str,
    bytes: &Arc<[u8]>,
    mapping: &Mapping,
    payload: bool,
) -> Result<Log, Error> {
    whole(of_bytes(name, bytes, mapping)?, mapping, payload)
}

/// Reads the runs of a file's bytes: several if the time has gaps, as [`read_runs`].
///
/// # Errors
/// As [`read_runs`].
pub fn runs_of_bytes(
    name: &str,
    bytes: &Arc<[u8]>,
    mapping: &Mapping,
    payload: bool,
    needed: &NeededSamples<'_>,
) -> Result<Vec<Log>, Error> {
    let files = of_bytes(name, bytes, mapping)?;
    runs(files, mapping, payload, needed, &|_| {})
}

/// Opens the bytes of a file.
fn of_bytes(name: &str, bytes: &Arc<[u8]>, mapping: &Mapping) -> Result<Files, Error> {
    let files = [(name.to_owned(), ByteSource::Memory(Arc::clone(bytes)))];
    Files::new(name.to_owned(), &files, mapping, None)
}

/// Reads several logs in parallel, each with its payload label, as one run or several.
///
/// A log is split at gaps of its time that are too long to be interpolated: steps longer than
/// 3.5 usual ones, 20 ms and 25 usual ones at most. Each stretch between gaps is a run of its own,
/// with its range of time in the name, `log.csv[12:31]`. Stretches of fewer samples than `needed`
/// are left out. The first run of a log has a note on both.
///
/// `progress` gets the fraction of all bytes read, from 0 to 1.
///
/// ```
/// use overact_logs::{Gain, Mapping, Time, runs_of_bytes};
///
/// let mapping = Mapping {
///     time: Time::Column("t".into()),
///     positions: vec!["q".into()],
///     torques: vec!["tau".into()],
///     velocities: Vec::new(),
///     position_scale: vec![1.0],
///     position_offset: Vec::new(),
///     torque_gain: vec![Gain::Value(1.0)],
///     resample: None,
///     transmission: Vec::new(),
///     rotating: Vec::new(),
/// };
/// let text = b"t,q,tau\n0,0.1,1\n0.1,0.2,2\n0.2,0.3,3\n9.0,0.3,3\n9.1,0.2,2\n".as_slice();
/// let runs = runs_of_bytes("log.csv", &text.into(), &mapping, false, &|_| 2)?;
/// let names: Vec<&str> = runs.iter().map(|run| run.name()).collect();
/// assert_eq!(names, ["log.csv[:5]", "log.csv[5:]"]);
/// # Ok::<(), overact_logs::Error>(())
/// ```
#[must_use]
pub fn read_runs(
    files: &[(&Path, bool)],
    mapping: &Mapping,
    needed: &NeededSamples<'_>,
    progress: &(dyn Fn(f64) + Sync),
) -> Vec<Result<Vec<Log>, Error>> {
    // A file without a readable size fails later, with a message.
    let size = |path: &Path| std::fs::metadata(path).map_or(0, |file| file.len());
    let parts = files.iter().flat_map(|(path, _)| parts(path));
    let total: u64 = parts.map(size).sum();
    let done = AtomicU64::new(0);
    let advance = |bytes: u64| {
        let now = bytes + done.fetch_add(bytes, Ordering::Relaxed);
        // A compressed file has more bytes than its size.
        progress((now as f64 / total.max(1) as f64).min(1.0));
    };
    let read = |&(path, payload): &(&Path, bool)| {
        runs(opened(path, mapping)?, mapping, payload, needed, &advance)
    };
    files.par_iter().map(read).collect()
}

/// Reads open files as one run.
fn whole(files: Files, mapping: &Mapping, payload: bool) -> Result<Log, Error> {
    let summary = files.look_through(&mapping.time, &|_| {})?;
    one_run(files, summary, mapping, payload)
}

/// Reads open files as one run, or as several if the time has gaps.
fn runs(
    files: Files,
    mapping: &Mapping,
    payload: bool,
    needed: &NeededSamples<'_>,
    advance: &dyn Fn(u64),
) -> Result<Vec<Log>, Error> {
    let error = match files.look_through(&mapping.time, advance) {
        Ok(summary) => return Ok(vec![one_run(files, summary, mapping, payload)?]),
        Err(error) => error,
    };
    let is_of_time = |problem: &Problem| problem.code == Code::LOG_TIME;
    let gaps = if error.problems.iter().any(is_of_time) {
        files.gaps()?
    } else {
        None
    };
    match gaps {
        Some(gaps) => split(files, &gaps, mapping, payload, needed),
        None => Err(error),
    }
}

/// The run of open files after the first pass.
fn one_run(
    mut files: Files,
    mut summary: Summary,
    mapping: &Mapping,
    payload: bool,
) -> Result<Log, Error> {
    let wraps = std::mem::take(&mut summary.wraps);
    if !wraps.is_empty() {
        files.unwrap(&wraps)?;
        summary = files.look_through(&mapping.time, &|_| {})?;
    }
    let notes = Notes {
        gaps: None,
        resampled: files.note(summary.count, summary.left_out),
        irregularities: summary.irregularities,
        wraps: &wraps,
    };
    let note = notes.joined(&files);
    let log = log(files, summary, mapping, payload, 0.0)?;
    let log = log.with_unwrapped(!wraps.is_empty());
    Ok(log.with_note(note))
}

/// The stretches between gaps as runs; those that are too short are left out.
fn split(
    mut files: Files,
    gaps: &Gaps,
    mapping: &Mapping,
    payload: bool,
    needed: &NeededSamples<'_>,
) -> Result<Vec<Log>, Error> {
    let look =
        |files: &Files| files.look_through_stretches(&gaps.stretches, &mapping.time, &|_| {});
    let mut summaries = look(&files)?;
    let last = summaries.last_mut();
    let wraps = last.map_or_else(Vec::new, |last| std::mem::take(&mut last.wraps));
    if !wraps.is_empty() {
        files.unwrap(&wraps)?;
        summaries = look(&files)?;
    }
    let irregularities = { summaries.iter().map(|own| own.irregularities) }
        .fold(Irregularities::default(), Irregularities::and);
    let (mut used, mut left_out) = (Vec::new(), LeftOut::default());
    for (stretch, summary) in gaps.stretches.iter().zip(summaries) {
        let fewest = needed(summary.frequency).max(2);
        if summary.count >= fewest {
            used.push((stretch, summary));
        } else {
            left_out.count += 1;
            left_out.duration += stretch.duration;
            left_out.longest = left_out.longest.max(summary.count);
            left_out.needed = left_out.needed.max(fewest);
        }
    }
    if used.is_empty() {
        let message = gaps.without_stretches(left_out);
        let problem = Problem::new(Code::LOG_TOO_SHORT, message).file(files.name());
        return Err(problem
            .help("record without gaps, or lower `skip_start`, `skip_end` or `decimation` of [identification]")
            .into());
    }
    let counts = used.iter().map(|(_, own)| [own.count, own.left_out]);
    let [count, outside] = counts.fold([0, 0], |[a, b], [c, d]| [a + c, b + d]);
    let notes = Notes {
        gaps: Some(gaps.note(left_out)),
        resampled: files.note(count, outside),
        irregularities,
        wraps: &wraps,
    };
    let mut note = notes.joined(&files);
    let runs = used
        .into_iter()
        .enumerate()
        .map(|(place, (stretch, summary))| {
            let mut own = files.clone();
            own.enter(stretch);
            let log = log(own, summary, mapping, payload, stretch.start)?;
            let log = log.with_unwrapped(!wraps.is_empty());
            Ok(log.into_stretch(stretch, place > 0).with_note(note.take()))
        });
    runs.collect()
}

/// Notes to the user on a log.
struct Notes<'a> {
    gaps: Option<String>,
    resampled: Option<String>,
    irregularities: Irregularities,
    wraps: &'a [(WrapSource, Wrap)],
}

impl Notes<'_> {
    /// All notes in one; `None` without any.
    fn joined(self, files: &Files) -> Option<String> {
        let range = files.range.as_ref().map(|range| range.note.clone());
        let of_files = files.tables.first().and_then(|table| table.note());
        let notes: Vec<String> = { range.into_iter().chain(of_files) }
            .chain(self.gaps)
            .chain(self.resampled)
            .chain(self.irregularities.note())
            .chain(self.wraps.iter().map(|(_, wrap)| wrap.note()))
            .collect();
        (!notes.is_empty()).then(|| notes.join("; "))
    }
}

/// A run whose samples are in memory, a temporary file, or its own files.
///
/// Its first sample is `start` (s) after that of its recording.
fn log(
    mut files: Files,
    summary: Summary,
    mapping: &Mapping,
    payload: bool,
    start: f64,
) -> Result<Log, Error> {
    let (frequency, count) = (summary.frequency, summary.count);
    let (ranges, first_time) = (summary.ranges, summary.first_time);
    let log = match summary.samples {
        Some(samples) => {
            let (positions, torques) = (samples.positions, samples.torques);
            let (name, actuators) = (files.name(), files.actuators());
            Log::new(name, frequency, actuators, positions, torques, payload)?
                .with_velocities(samples.velocities)
        }
        None => {
            files.spill = summary.spill;
            Log::in_files(files, frequency, count, payload)
        }
    };
    Ok(log
        .with_resampled(mapping.resample.is_some())
        .with_ranges(ranges, first_time, start)
        .without_offsets(&mapping.position_offset))
}
