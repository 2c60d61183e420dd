//! Logs as Parquet give the same numbers as text.
//!
//! They are written here with the library that reads them, stored from PyArrow, Polars and DuckDB
//! (`written/write.py`), and written by PyArrow and Polars if Python has them.

#[path = "common/drive.rs"]
mod drive;
#[path = "common/parquet_drive.rs"]
mod parquet_drive;
#[path = "common/parquet.rs"]
mod parquet_file;

use std::{path::Path, process::Command};

use drive::{numbers, run, timed, untimed};
use overact_logs::read;
use overact_logs::{Mapping, Time};
use parquet::{
    basic::Compression,
    file::properties::{WriterProperties, WriterVersion},
};
use parquet_drive::{SCHEMA, log, samples};
use parquet_file::{Cells, written, written_with};

/// The same samples as a text.
fn text([time, position, torque]: &[Vec<f64>; 3]) -> String {
    let rows = time.iter().zip(position).zip(torque);
    let rows = rows.map(|((t, q), tau)| format!("{t},{q},{tau}\n"));
    format!("t,q,tau\n{}", rows.collect::<String>())
}

#[test]
fn parquet_and_text_give_the_same_numbers() {
    let samples = samples();
    let mapping = timed("q", "tau");
    let text = text(&samples);
    let expected = numbers(run("a.csv", &[("a.csv", text.as_bytes())], &mapping));
    assert_eq!(expected.0.len(), 1000);
    let [time, position, torque] = &samples;
    let position: Vec<Option<f64>> = position.iter().copied().map(Some).collect();
    let columns = [
        Cells::Double(time),
        Cells::Optional(&position),
        Cells::Double(torque),
    ];
    for packed in [
        Compression::UNCOMPRESSED,
        Compression::SNAPPY,
        Compression::LZ4_RAW,
        Compression::LZ4,
    ] {
        for version in [WriterVersion::PARQUET_1_0, WriterVersion::PARQUET_2_0] {
            for (rows, has_dictionary) in [(1000, true), (1000, false), (300, true), (1, false)] {
                let properties = WriterProperties::builder()
                    .set_compression(packed)
                    .set_writer_version(version)
                    .set_dictionary_enabled(has_dictionary)
                    .set_data_page_row_count_limit(170);
                let file = written_with(properties.build(), SCHEMA, &columns, rows);
                assert!(
                    numbers(log(&file, &mapping)) == expected,
                    "{packed}, {version:?}, {rows} rows in a group"
                );
            }
        }
    }
    // The file name has no effect.
    let file = written(SCHEMA, &columns);
    let misnamed = run("a.csv", &[("a.csv", &file)], &mapping);
    assert_eq!(numbers(misnamed), expected);
    let numbered = Mapping {
        time: Time::Column(String::from("$1")),
        ..timed("2*$2", "$3 - tau")
    };
    let (positions, torques, _) = numbers(log(&file, &numbered));
    assert!(
        positions
            .iter()
            .zip(&expected.0)
            .all(|(a, b)| *a == 2.0 * b)
    );
    assert!(torques.iter().all(|torque| *torque == 0.0));
}

#[test]
fn gzip_and_zstandard_files_are_read() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/written");
    let all = 0..200_u32;
    let positions: Vec<f64> = all.clone().map(|k| f64::from(k * k) / 7.0).collect();
    let torques: Vec<f64> = all.map(|k| f64::from(k % 16) / 3.0).collect();
    for name in [
        // Pages of the first version and of the second.
        "pyarrow_gzip",
        "pyarrow_gzip_2",
        "pyarrow_zstd",
        "pyarrow_zstd_2",
        "polars_gzip",
        "polars_zstd",
        "duckdb_gzip",
        "duckdb_zstd",
    ] {
        let path = folder.join(name).with_extension("parquet");
        let log = read(&path, &timed("q", "tau"), false);
        let own = numbers(log.map_err(|error| error.to_string()));
        assert!(own.0 == positions, "{name}");
        assert!(own.1 == torques, "{name}");
    }
}

#[test]
fn all_numeric_types_are_read() {
    let file = written(
        "message log {
            required float float; required int32 int; required int64 long; required boolean flag;
            required int32 count (INTEGER(16, false)); required int64 cents (DECIMAL(9, 2));
            required int32 below (UINT_32); required int64 far (UINT_64); }",
        &[
            Cells::Float(&[0.5, -0.1]),
            Cells::Int(&[-7, 8]),
            Cells::Long(&[1 << 40, -5]),
            Cells::Flag(&[true, false]),
            Cells::Int(&[3, 65_535]),
            Cells::Long(&[1234, -5]),
            Cells::Int(&[-1, 1]),
            Cells::Long(&[-1, 1]),
        ],
    );
    for (name, expected) in [
        ("float", [0.5, f64::from(-0.1_f32)]),
        ("int", [-7.0, 8.0]),
        ("long", [1_099_511_627_776.0, -5.0]),
        ("flag", [1.0, 0.0]),
        ("count", [3.0, 65_535.0]),
        ("cents", [12.34, -0.05]),
        ("below", [4_294_967_295.0, 1.0]),
        ("far", [18_446_744_073_709_551_615.0, 1.0]),
    ] {
        assert_eq!(
            numbers(log(&file, &untimed(name, "int"))).0,
            expected,
            "{name}"
        );
    }
}

#[test]
fn times_are_read_in_seconds() {
    // 2023-11-14 22:13:20.9 and 5 kHz, where doubles of seconds since 1970 are too coarse.
    let start = 1_700_000_000_900_000_000_i64;
    let steps: Vec<i64> = (0..6000).map(|k| 200_000 * k).collect();
    let at = |unit: i64| -> Vec<i64> { steps.iter().map(|step| (start + step) / unit).collect() };
    let since: Vec<i64> = steps.iter().map(|step| step / 1000).collect();
    let (nanos, micros) = (at(1), at(1000));
    let position: Vec<f64> = steps.iter().map(|step| *step as f64).collect();
    let file = written(
        "message log {
            required int64 nanos (TIMESTAMP(NANOS, true)); required int64 micros (TIMESTAMP_MICROS);
            required int96 old; required int64 day (TIME(MICROS, true)); required double q; }",
        &[
            Cells::Long(&nanos),
            Cells::Long(&micros),
            Cells::Old(&nanos),
            Cells::Long(&since),
            Cells::Double(&position),
        ],
    );
    for name in ["nanos", "micros", "old", "day"] {
        let mapping = Mapping {
            time: Time::Column(name.to_owned()),
            ..timed(&format!("{name} - q*1e-9"), "q")
        };
        let (offset, _, frequency) = numbers(log(&file, &mapping));
        assert!((frequency - 5000.0).abs() < 1e-6, "{name}: {frequency}");
        // Instants count from the whole second in which the file starts.
        let expected = if name == "day" { 0.0 } else { 0.9 };
        let differs = |offset: &f64| (offset - expected).abs() > 1e-12;
        assert!(!offset.iter().any(differs), "{name}: {}", offset[0]);
    }
}

/// Arrow schema that PyArrow 26 adds to a file with these columns.
///
/// `t` (duration in ns), `q_1`, `ts` (timestamp), `d` (duration in µs), `l` (a list) and `s` (a
/// structure with a duration's name in it).
const PYARROW: &str = "/////+ABAAAQAAAAAAAKAAwABgAFAAgACgAAAAABBAAMAAAACAAIAAAABAAIAAAABAAAAAYAAACEAQAASAEAABwBAADwAAAAlAAAAAQ\
    AAACk/v//AAABDRgAAAAcAAAABAAAAAIAAABAAAAAEAAAAAEAAABzAAAAeP///9D+//8AAAECEAAAABQAAAAEAAAAAAAAAAEAAABkAAAA1P///wAAAAFAAAAA/P\
    7//wAAAQIQAAAAHAAAAAQAAAAAAAAAAQAAAHgAAAAIAAwACAAHAAgAAAAAAAABQAAAADD///8AAAEMFAAAABwAAAAEAAAAAQAAABQAAAABAAAAbAAAAAQABAAEA\
    AAAXP///wAAAQMQAAAAGAAAAAQAAAAAAAAABAAAAGl0ZW0AAAAAUv///wAAAgCI////AAABEhAAAAAUAAAABAAAAAAAAAABAAAAZAAAAHr///8AAAIAsP///wAA\
    AQoQAAAAFAAAAAQAAAAAAAAAAgAAAHRzAACi////AAADANj///8AAAEDEAAAABQAAAAEAAAAAAAAAAMAAABxXzEAyv///wAAAgAQABQACAAGAAcADAAAABAAEAA\
    AAAAAARIQAAAAGAAAAAQAAAAAAAAAAQAAAHQABgAIAAYABgAAAAAAAwA=";

/// Arrow schema that Polars 2 adds for `t` (duration in µs), `q_1` and `ts` (timestamp).
const POLARS: &str = "/////8YAAAAEAAAA8v///xQAAAAEAAEAAAAKAAsACAAKAAQA+P///wwAAAAIAAgAAAAEAAMAAABcAAAAMAAAAAQAAACc////HAAAABAA\
    AAAIAAAAAQoAAAAAAACa////AgAAAAIAAAB0cwAAxP///xwAAAAQAAAACAAAAAEDAAAAAAAAwv///wIAAAADAAAAcV8xAOz///8wAAAAIAAAABgAAAABEgAAE\
    AASAAQAEAARAAgAAAAMAAAAAAD6////AgAGAAYABAABAAAAdAA=";

#[test]
fn durations_are_recognised_from_the_arrow_schema() {
    let schema = "message log { required int64 t; required int64 d; required double q_1; }";
    let read_as = |arrow: &str| {
        let stored = parquet::file::metadata::KeyValue::new(
            String::from("ARROW:schema"),
            String::from(arrow),
        );
        let properties = WriterProperties::builder().set_key_value_metadata(Some(vec![stored]));
        let columns = [
            Cells::Long(&[0, 2_000_000, 4_000_000]),
            Cells::Long(&[1, 2, 3]),
            Cells::Double(&[5.0, 6.0, 7.0]),
        ];
        let file = written_with(properties.build(), schema, &columns, 3);
        numbers(log(&file, &timed("q_1", "d")))
    };
    let (_, of_d, frequency) = read_as(PYARROW);
    assert_eq!((of_d, frequency), (vec![1e-6, 2e-6, 3e-6], 500.0));
    let (_, of_d, frequency) = read_as(POLARS);
    assert_eq!((of_d, frequency), (vec![1.0, 2.0, 3.0], 0.5));
    // Integers without a unit are numbers, and a broken schema is ignored.
    for arrow in [
        "",
        "////",
        "/////+ABAAAQAAAAAAAKAAwA",
        "not base64!",
        &PYARROW[..300],
    ] {
        let (_, of_d, frequency) = read_as(arrow);
        assert_eq!((of_d, frequency), (vec![1.0, 2.0, 3.0], 5e-7), "{arrow}");
    }
}

/// Files that PyArrow and Polars write themselves, and a format that both refuse.
const SCRIPT: &str = "
import sys, datetime, numpy, pyarrow, pyarrow.parquet as pq
f = sys.argv[1] + '/'
k = numpy.arange(5000)
q, tau = numpy.sin(k / 7), (k % 16).astype('int16')
def table(t):
    return pyarrow.table({'t': t, 'q': q, 'tau': tau, 'name': ['x'] * 5000, 'list': [[1.0]] * 5000})
numpy.savetxt(f + 'text.csv', numpy.column_stack([k / 1000, q, tau]), delimiter=',', header='t,q,tau', comments='', fmt='%.17g')
t = pyarrow.array(k / 1000)
for codec in ['none', 'snappy', 'zstd', 'gzip', 'lz4', 'brotli']:
    pq.write_table(table(t), f + codec + '.parquet', compression=codec)
pq.write_table(table(t), f + 'groups.parquet', row_group_size=700, data_page_version='2.0', use_dictionary=False)
pq.write_table(table(t), f + 'split.parquet', use_dictionary=False, use_byte_stream_split=['q'], column_encoding={'tau': 'DELTA_BINARY_PACKED'})
pq.write_table(table(pyarrow.array(k * 1000000, pyarrow.duration('ns'))), f + 'duration.parquet')
pq.write_table(table(pyarrow.array(1700000000500000000 + k * 1000000, pyarrow.timestamp('ns', 'UTC'))), f + 'timestamp.parquet')
pq.write_table(table(pyarrow.array(1700000000500 + k, pyarrow.timestamp('ms'))), f + 'int96.parquet', use_deprecated_int96_timestamps=True)
try:
    import polars
    start = datetime.datetime(2024, 5, 6)
    step = [datetime.timedelta(milliseconds=int(i)) for i in k]
    polars.DataFrame({'t': step, 'q': q, 'tau': tau}).write_parquet(f + 'polars.parquet')
    polars.DataFrame({'t': [start + s for s in step], 'q': q, 'tau': tau}).write_parquet(f + 'polars2.parquet')
except ImportError:
    pass
";

#[test]
fn files_written_by_pyarrow_have_the_same_numbers() {
    let folder = tempfile::tempdir().expect("a folder");
    let python = Command::new("python3")
        .args(["-c", SCRIPT])
        .arg(folder.path())
        .output();
    if !python.is_ok_and(|output| output.status.success()) {
        eprintln!("skipped: there is no Python with PyArrow here");
        return;
    }
    let mapping = timed("q", "tau");
    let from = |name: &str| read(&folder.path().join(name), &mapping, false);
    let load = |name: &str| numbers(from(name).map_err(|error| error.to_string()));
    let (positions, torques, _) = load("text.csv");
    let names = [
        "none",
        "snappy",
        "zstd",
        "gzip",
        "lz4",
        "groups",
        "split",
        "duration",
        "timestamp",
        "int96",
        "polars",
        "polars2",
    ];
    let names = names.map(|name| format!("{name}.parquet"));
    let is_there = |name: &&String| {
        let is_there = folder.path().join(name).exists();
        if !is_there {
            eprintln!("skipped: {name}, there is no Polars here");
        }
        is_there
    };
    for name in names.iter().filter(is_there) {
        let (own_positions, own_torques, frequency) = load(name);
        assert!(own_positions == positions, "{name}");
        assert!(own_torques == torques, "{name}");
        assert!((frequency - 1000.0).abs() < 1e-6, "{name}: {frequency}");
    }
    let shown_output = from("brotli.parquet").expect_err("Brotli").to_string();
    assert!(
        shown_output.ends_with(
            "column `t` can't be read from sample 0 on: it is compressed by Brotli, which is not supported\n  help: write it \
             with the compression snappy, zstd, gzip or lz4, or none"
        ),
        "{shown_output}"
    );
}
