//! Logs as Parquet: written here with the library that reads them, and by PyArrow and Polars themselves where
//! Python has them. The same numbers come from a Parquet file as from a text.

mod common;
#[path = "common/parquet.rs"]
mod parquet_file;

use std::{fs, path::Path, process::Command};

use common::EMPS;
use overact::Model;
use overact_identification::{Error, Gain, Log, Mapping, Time, data::read};
use overact_tier::by_tier;
use parquet::{
    basic::{Compression, GzipLevel, ZstdLevel},
    file::properties::{WriterProperties, WriterVersion},
};
use parquet_file::{Cells, written, written_with};

/// A mapping of one drive with its time in `t`.
fn timed(position: &str, torque: &str) -> Mapping {
    Mapping {
        time: Time::Column(String::from("t")),
        positions: vec![position.to_owned()],
        torques: vec![torque.to_owned()],
        ..Mapping::for_robot(&EMPS.info())
    }
}

/// The same at 10 Hz.
fn untimed(position: &str, torque: &str) -> Mapping {
    Mapping {
        time: Time::Frequency(10.0),
        ..timed(position, torque)
    }
}

/// Reads the run `name` of these files.
fn run(name: &str, files: &[(&str, &[u8])], mapping: &Mapping) -> Result<Log, String> {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, content) in files {
        fs::write(folder.path().join(name), content).expect("written");
    }
    let prefix = format!("{}/", folder.path().display());
    let path = name.split('+').map(|part| format!("{prefix}{part}"));
    let path = path.collect::<Vec<_>>().join("+");
    let log = read(Path::new(&path), mapping, false);
    log.map_err(|error: Error| error.to_string().replace(&prefix, ""))
}

fn log(content: &[u8], mapping: &Mapping) -> Result<Log, String> {
    run("a.parquet", &[("a.parquet", content)], mapping)
}

/// Positions, torques and the sampling frequency.
fn numbers(log: Result<Log, String>) -> (Vec<f64>, Vec<f64>, f64) {
    let log = log.unwrap_or_else(|error| panic!("{error}"));
    let (positions, torques) = log.load().unwrap_or_else(|error| panic!("{error}"));
    (positions, torques, log.sampling_frequency())
}

/// Samples at 100 Hz with numbers of all digits, some of which return.
fn samples() -> [Vec<f64>; 3] {
    let all = 0..1000_u32;
    [
        all.clone().map(|k| f64::from(k) / 100.0).collect(),
        all.clone().map(|k| (f64::from(k) / 7.0).sin()).collect(),
        all.map(|k| f64::from(k % 16) / 3.0).collect(),
    ]
}

/// The same samples as a text.
fn text([time, position, torque]: &[Vec<f64>; 3]) -> String {
    let rows = time.iter().zip(position).zip(torque);
    let rows = rows.map(|((t, q), tau)| format!("{t},{q},{tau}\n"));
    format!("t,q,tau\n{}", rows.collect::<String>())
}

const SCHEMA: &str = "message log { required double t; optional double q; required double tau; }";

#[test]
fn the_same_numbers_as_from_a_text() {
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
        Compression::ZSTD(ZstdLevel::default()),
        Compression::GZIP(GzipLevel::default()),
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
    // The name says nothing.
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
fn numbers_of_every_kind() {
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
    // 2023-11-14 22:13:20 and 5 kHz from 0.9 s later on, in which doubles of seconds since 1970 are too coarse.
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
        // Instants count from the whole second in which the file begins.
        let expected = if name == "day" { 0.0 } else { 0.9 };
        let differs = |offset: &f64| (offset - expected).abs() > 1e-12;
        assert!(!offset.iter().any(differs), "{name}: {}", offset[0]);
    }
}

/// What PyArrow 26 adds to a file with the columns `t` (duration in ns), `q_1`, `ts` (timestamp), `d` (duration in
/// µs), `l` (a list) and `s` (a structure with a duration's name in it).
const PYARROW: &str = "/////+ABAAAQAAAAAAAKAAwABgAFAAgACgAAAAABBAAMAAAACAAIAAAABAAIAAAABAAAAAYAAACEAQAASAEAABwBAADwAAAAlAAAAAQ\
    AAACk/v//AAABDRgAAAAcAAAABAAAAAIAAABAAAAAEAAAAAEAAABzAAAAeP///9D+//8AAAECEAAAABQAAAAEAAAAAAAAAAEAAABkAAAA1P///wAAAAFAAAAA/P\
    7//wAAAQIQAAAAHAAAAAQAAAAAAAAAAQAAAHgAAAAIAAwACAAHAAgAAAAAAAABQAAAADD///8AAAEMFAAAABwAAAAEAAAAAQAAABQAAAABAAAAbAAAAAQABAAEA\
    AAAXP///wAAAQMQAAAAGAAAAAQAAAAAAAAABAAAAGl0ZW0AAAAAUv///wAAAgCI////AAABEhAAAAAUAAAABAAAAAAAAAABAAAAZAAAAHr///8AAAIAsP///wAA\
    AQoQAAAAFAAAAAQAAAAAAAAAAgAAAHRzAACi////AAADANj///8AAAEDEAAAABQAAAAEAAAAAAAAAAMAAABxXzEAyv///wAAAgAQABQACAAGAAcADAAAABAAEAA\
    AAAAAARIQAAAAGAAAAAQAAAAAAAAAAQAAAHQABgAIAAYABgAAAAAAAwA=";

/// What Polars 2 adds to a file with the columns `t` (duration in µs), `q_1` and `ts` (timestamp).
const POLARS: &str = "/////8YAAAAEAAAA8v///xQAAAAEAAEAAAAKAAsACAAKAAQA+P///wwAAAAIAAgAAAAEAAMAAABcAAAAMAAAAAQAAACc////HAAAABAA\
    AAAIAAAAAQoAAAAAAACa////AgAAAAIAAAB0cwAAxP///xwAAAAQAAAACAAAAAEDAAAAAAAAwv///wIAAAADAAAAcV8xAOz///8wAAAAIAAAABgAAAABEgAAE\
    AASAAQAEAARAAgAAAAMAAAAAAD6////AgAGAAYABAABAAAAdAA=";

#[test]
fn durations_are_told_from_the_schema_of_arrow() {
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
    // Whole numbers without a unit are numbers, and a broken schema says nothing.
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

#[test]
fn cells_without_numbers_are_located() {
    let file = written(
        "message log { required double t; optional double q; optional float tau; }",
        &[
            Cells::Double(&[0.0, 0.1, 0.2, 0.3]),
            Cells::Optional(&[Some(1.0), None, Some(f64::NAN), Some(4.0)]),
            Cells::Maybe(&[Some(1.0), None, Some(3.0), Some(f32::INFINITY)]),
        ],
    );
    assert_eq!(
        log(&file, &timed("q", "tau")).expect_err("nulls"),
        "a.parquet: `q`: sample 1 has no value (null)\n\
         a.parquet: `tau`: sample 1 has no value (null)\n\
         a.parquet: `q`: sample 2 is not a finite number\n\
         a.parquet: `tau`: sample 3 is not a finite number"
    );
    // A file without any value in a column, of which only the first cells are told.
    let nothing = vec![None; 5000];
    let file = written(
        "message log { optional double q; }",
        &[Cells::Optional(&nothing)],
    );
    let told = log(&file, &untimed("q", "q")).expect_err("nulls");
    assert_eq!(told.lines().count(), 20);
}

#[test]
fn columns_that_are_no_numbers_are_named() {
    let file = written(
        "message log {
            required double q; required binary note (STRING); required int32 on (DATE);
            required group pose { required double x; required double y; }
            required fixed_len_byte_array(2) half (FLOAT16); required double tau; }",
        &[
            Cells::Double(&[1.0, 2.0]),
            Cells::Text(&["a", "b"]),
            Cells::Int(&[0, 1]),
            Cells::Double(&[1.0, 2.0]),
            Cells::Double(&[1.0, 2.0]),
            Cells::Fixed(&["ab", "cd"]),
            Cells::Double(&[3.0, 4.0]),
        ],
    );
    // They may stand beside the columns that are read, and count.
    assert_eq!(numbers(log(&file, &untimed("q", "tau"))).1, [3.0, 4.0]);
    assert_eq!(numbers(log(&file, &untimed("q", "$6"))).1, [3.0, 4.0]);
    let way_out = "help: write a column of numbers (float64) for each signal and each actuator";
    for (name, what) in [
        ("note", "column `note` holds texts or bytes, not numbers"),
        ("$2", "column `note` holds texts or bytes, not numbers"),
        ("2*note", "column `note` holds texts or bytes, not numbers"),
        ("on", "column `on` holds days, not numbers"),
        ("pose", "column `pose` is nested (a list or a structure)"),
        (
            "half",
            "column `half` holds numbers of 16 bits, which are not read",
        ),
    ] {
        assert_eq!(
            log(&file, &untimed("q", name)).expect_err(name),
            format!("a.parquet: {what}\n  {way_out}")
        );
    }
    assert_eq!(
        log(&file, &untimed("q", "tua")).expect_err("missing"),
        "a.parquet: there is no column `tua`; the file has `q`, `note`, `on`, `pose`, `half`, `tau`\n  \
         help: did you mean `tau` for `tua`?"
    );
    let gain = Mapping {
        torque_gain: vec![Gain::Variable(String::from("gtau"))],
        ..untimed("q", "tau")
    };
    assert_eq!(
        log(&file, &gain).expect_err("no variable"),
        "a.parquet: the torque gain is the variable `gtau`, but a Parquet file has no variables\n  help: give the \
         gain as a number"
    );
    let twice = written(
        "message log { required double q; required double q; }",
        &[Cells::Double(&[1.0, 2.0]), Cells::Double(&[1.0, 2.0])],
    );
    assert!(
        log(&twice, &untimed("q", "$2"))
            .expect_err("twice")
            .starts_with("a.parquet: the file has 2 columns `q`\n  help: ")
    );
}

#[test]
fn files_that_are_cut_off_or_empty_are_refused() {
    let [time, position, torque] = &samples().map(|all| all[..50].to_vec());
    let position: Vec<Option<f64>> = position.iter().copied().map(Some).collect();
    let columns = [
        Cells::Double(time),
        Cells::Optional(&position),
        Cells::Double(torque),
    ];
    let packed = WriterProperties::builder().set_compression(Compression::SNAPPY);
    let file = written_with(packed.build(), SCHEMA, &columns, 20);
    let mapping = timed("q", "tau");
    for length in 4..file.len() {
        let told = log(&file[..length], &mapping).expect_err("cut off");
        assert!(
            told.starts_with("a.parquet: the file starts as Parquet does, but can't be read: "),
            "{told}"
        );
        assert!(
            told.contains("\n  help: if it was copied or its writer was stopped, "),
            "{told}"
        );
        assert!(
            !told.contains(|c: char| c.is_control() && c != '\n'),
            "{told:?}"
        );
    }
    // A middle that is lost: the pages are somewhere else than the file says.
    let half = [&file[..4], &file[file.len() / 2..]].concat();
    assert!(log(&half, &mapping).is_err());
    assert_eq!(
        log(&written(SCHEMA, &[]), &mapping).expect_err("no rows"),
        "a.parquet: the run is empty"
    );
    assert_eq!(
        log(&written("message log { }", &[]), &mapping).expect_err("no columns"),
        "a.parquet: there are no columns `t`, `q`, `tau`; the file has none\n  help: name the columns in the mapping"
    );
    assert_eq!(
        log(b"PARE and more", &mapping).expect_err("encrypted"),
        "a.parquet: the file is encrypted Parquet, which is not read\n  help: write it without encryption"
    );
}

#[test]
fn files_with_any_wrong_byte_are_read_or_refused() {
    let [time, position, torque] = &samples().map(|all| all[..12].to_vec());
    let position: Vec<Option<f64>> = position.iter().copied().map(Some).collect();
    let columns = [
        Cells::Double(time),
        Cells::Optional(&position),
        Cells::Double(torque),
    ];
    let mapping = timed("q", "tau");
    let (mut refused, mut all) = (0, 0);
    for (packed, version, has_dictionary) in [
        (Compression::SNAPPY, WriterVersion::PARQUET_1_0, true),
        (Compression::UNCOMPRESSED, WriterVersion::PARQUET_2_0, false),
        (
            Compression::ZSTD(ZstdLevel::default()),
            WriterVersion::PARQUET_2_0,
            true,
        ),
    ] {
        let properties = WriterProperties::builder()
            .set_compression(packed)
            .set_writer_version(version)
            .set_dictionary_enabled(has_dictionary);
        let file = written_with(properties.build(), SCHEMA, &columns, 12);
        let flips = by_tier([&[0x80][..], &[0x01, 0x80, 0xff]]);
        let places = 4..file.len();
        for (place, flip) in places.flat_map(|place| flips.iter().map(move |flip| (place, flip))) {
            let mut broken = file.clone();
            broken[place] ^= flip;
            all += 1;
            if let Err(told) = log(&broken, &mapping) {
                refused += 1;
                assert!(told.starts_with("a.parquet: "), "{told}");
                assert!(
                    !told.contains(|c: char| c.is_control() && c != '\n'),
                    "{told:?}"
                );
            }
        }
    }
    println!("{refused} of {all} files are refused");
    assert!(refused > all / 3, "{refused} of {all}");
}

#[test]
fn files_of_both_kinds_are_joined() {
    let positions = written(
        "message log { required double b; required double a; }",
        &[
            Cells::Double(&[2.0, 4.0, 6.0]),
            Cells::Double(&[1.0, 3.0, 5.0]),
        ],
    );
    let torques = b"a;c\n0,5;7\n1,5;8\n2,5;9\n";
    let files: [(&str, &[u8]); 2] = [("pos.parquet", &positions), ("torque.csv", torques)];
    let name = "pos.parquet+torque.csv";
    let joined = |position: &str, torque: &str| run(name, &files, &untimed(position, torque));
    let (positions, torques, _) = numbers(joined("b", "c"));
    assert_eq!(
        (positions, torques),
        (vec![2.0, 4.0, 6.0], vec![7.0, 8.0, 9.0])
    );
    assert_eq!(numbers(joined("$2", "file2.a")).1, [0.5, 1.5, 2.5]);
    assert!(
        joined("a", "c")
            .expect_err("both have it")
            .contains("call it `file1.a` or `file2.a`")
    );
}

/// Files that PyArrow and Polars themselves write, and what both refuse to be.
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
fn the_files_of_pyarrow_have_the_same_numbers() {
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
    let told = from("brotli.parquet").expect_err("Brotli").to_string();
    assert!(
        told.ends_with(
            "column `t` can't be read from sample 0 on: it is packed by Brotli, which is not read\n  help: write it \
             with the compression snappy, zstd, gzip or lz4, or none"
        ),
        "{told}"
    );
}
