//! Reads runs from files, bytes or arrays.

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
    error::Error,
    formats::{
        arrays::{Array, Arrays},
        table::Table,
    },
    mapping::Mapping,
    problems::display_name,
    run::{log::Log, source::Files, time_range::TimeRange},
};

/// Splits a path into the files of a run, without a range of time.
///
/// `a.csv+b.csv` joins two files, sample by sample or by time, unless a file has this name.
/// `a.csv+b.csv[10:60]` is the same run, of which only some samples are used ([`time_range`]).
#[must_use]
pub fn parts(path: &Path) -> Vec<&Path> {
    joined(split(path).0)
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
    let (run, text) = split(path);
    let parsed = text.map(|text| {
        let range = TimeRange::parse(text);
        range.map_err(|why| TimeRange::problem(&display_name(run), text, &why))
    });
    Ok(parsed.transpose()?)
}

/// Splits a path into a run and the text of its range.
fn split(path: &Path) -> (&Path, Option<&str>) {
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

/// Reads a run from a file of any supported format, or from several joined files ([`parts`]).
///
/// With a range of time, `log.csv[10:60]`, only its samples are used ([`time_range`]).
///
/// # Errors
/// A file that cannot be read or of an unsupported format, missing columns, invalid expressions,
/// cells that are not finite numbers, a non-uniform time, files of different lengths or times, or
/// an invalid mapping.
pub fn read(path: &Path, mapping: &Mapping, payload: bool) -> Result<Log, Error> {
    read_with_progress(path, mapping, payload, &|_| {})
}

/// Reads a run; `advance` gets the number of bytes read since its last call.
fn read_with_progress(
    path: &Path,
    mapping: &Mapping,
    payload: bool,
    advance: &dyn Fn(u64),
) -> Result<Log, Error> {
    let part = |path: &Path| (display_name(path), ByteSource::at(path));
    let files: Vec<_> = parts(path).into_iter().map(part).collect();
    let range = time_range(path)?;
    let files = Files::new(display_name(path), &files, mapping, range)?;
    first_pass(files, mapping, payload, advance)
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
    let mut table = Arrays::new(name.to_owned());
    for array in arrays {
        let (rows, columns) = array.shape;
        table.push(array.name, rows, columns, array.values);
    }
    let tables = vec![Table::Arrays(table)];
    let files = Files::of_tables(name.to_owned(), tables, vec![1], mapping, None)?;
    first_pass(files, mapping, payload, &|_| {})
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
    let files = [(name.to_owned(), ByteSource::Memory(Arc::clone(bytes)))];
    let files = Files::new(name.to_owned(), &files, mapping, None)?;
    first_pass(files, mapping, payload, &|_| {})
}

/// Reads the run of open files once to check it.
fn first_pass(
    mut files: Files,
    mapping: &Mapping,
    payload: bool,
    advance: &dyn Fn(u64),
) -> Result<Log, Error> {
    let mut summary = files.look_through(&mapping.time, advance)?;
    let wraps = std::mem::take(&mut summary.wraps);
    if !wraps.is_empty() {
        files.unwrap(&wraps)?;
        summary = files.look_through(&mapping.time, &|_| {})?;
    }
    let (frequency, count) = (summary.frequency, summary.count);
    let resampled = files.note(count, summary.left_out);
    let of_files = files.tables.first().and_then(Table::note);
    let range = files.range.as_ref().map(|range| range.note.clone());
    let notes: Vec<String> = { range.into_iter().chain(of_files) }
        .chain(resampled)
        .chain(summary.irregularities.note())
        .chain(wraps.iter().map(|(_, wrap)| wrap.note()))
        .collect();
    let note = (!notes.is_empty()).then(|| notes.join("; "));
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
        .with_note(note)
        .with_unwrapped(!wraps.is_empty())
        .with_resampled(mapping.resample.is_some())
        .without_offsets(&mapping.position_offset))
}

/// Reads several runs in parallel, each with its payload label.
///
/// `progress` gets the fraction of all bytes read, from 0 to 1.
#[must_use]
pub fn read_all(
    files: &[(&Path, bool)],
    mapping: &Mapping,
    progress: &(dyn Fn(f64) + Sync),
) -> Vec<Result<Log, Error>> {
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
    let read =
        |&(path, payload): &(&Path, bool)| read_with_progress(path, mapping, payload, &advance);
    files.par_iter().map(read).collect()
}
