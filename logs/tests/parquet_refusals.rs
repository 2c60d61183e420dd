//! Parquet files that are no logs, or broken in any byte, are refused with a remedy.

#[path = "common/drive.rs"]
mod drive;
#[path = "common/parquet_drive.rs"]
mod parquet_drive;
#[path = "common/parquet.rs"]
mod parquet_file;

use drive::{numbers, timed, untimed};
use overact_logs::{Gain, Mapping};
use overact_tier::by_tier;
use parquet::{
    basic::Compression,
    file::properties::{WriterProperties, WriterVersion},
};
use parquet_drive::{SCHEMA, log, samples};
use parquet_file::{Cells, written, written_with};

/// Checks that a message suits a terminal.
fn assert_legible(output: &str) {
    let is_control = |c: char| c.is_control() && c != '\n';
    assert!(!output.contains(is_control), "{output:?}");
}

#[test]
fn null_and_non_finite_cells_are_located() {
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
    // A column without any value, of which only the first cells are reported.
    let nulls = vec![None; 5000];
    let file = written(
        "message log { optional double q; }",
        &[Cells::Optional(&nulls)],
    );
    let output = log(&file, &untimed("q", "q")).expect_err("nulls");
    assert_eq!(output.lines().count(), 20);
}

#[test]
fn non_numeric_columns_are_rejected_by_name() {
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
    // They may occur with requested columns, and count.
    assert_eq!(numbers(log(&file, &untimed("q", "tau"))).1, [3.0, 4.0]);
    assert_eq!(numbers(log(&file, &untimed("q", "$6"))).1, [3.0, 4.0]);
    let remedy = "help: write a column of numbers (float64) for each signal and each actuator";
    for (name, what) in [
        ("note", "column `note` has texts or bytes, not numbers"),
        ("$2", "column `note` has texts or bytes, not numbers"),
        ("2*note", "column `note` has texts or bytes, not numbers"),
        ("on", "column `on` has days, not numbers"),
        ("pose", "column `pose` is nested (a list or a structure)"),
        (
            "half",
            "column `half` has 16-bit numbers, which are not supported",
        ),
    ] {
        assert_eq!(
            log(&file, &untimed("q", name)).expect_err(name),
            format!("a.parquet: {what}\n  {remedy}")
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
fn truncated_or_empty_files_are_rejected() {
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
        let output = log(&file[..length], &mapping).expect_err("truncated");
        assert!(
            output.starts_with("a.parquet: the file starts like Parquet, but can't be read: "),
            "{output}"
        );
        assert!(
            output.contains("\n  help: if it was copied or its writer was stopped, "),
            "{output}"
        );
        assert_legible(&output);
    }
    // The middle is missing: the pages are not where the file says.
    let half = [&file[..4], &file[file.len() / 2..]].concat();
    assert!(log(&half, &mapping).is_err());
    assert_eq!(
        log(&written(SCHEMA, &[]), &mapping).expect_err("no rows"),
        "a.parquet: the run is empty\n  help: give a log with the samples of a whole motion"
    );
    assert_eq!(
        log(&written("message log { }", &[]), &mapping).expect_err("no columns"),
        "a.parquet: there are no columns `t`, `q`, `tau`; the file has none\n  help: name the columns in the table [data]"
    );
    assert_eq!(
        log(b"PARE and more", &mapping).expect_err("encrypted"),
        "a.parquet: the file is encrypted Parquet, which is not supported\n  help: write it without encryption"
    );
}

#[test]
fn corrupted_files_are_read_or_rejected() {
    let [time, position, torque] = &samples().map(|all| all[..12].to_vec());
    let position: Vec<Option<f64>> = position.iter().copied().map(Some).collect();
    let columns = [
        Cells::Double(time),
        Cells::Optional(&position),
        Cells::Double(torque),
    ];
    let mapping = timed("q", "tau");
    let mut files: Vec<Vec<u8>> = vec![
        include_bytes!("written/small_gzip.parquet").to_vec(),
        include_bytes!("written/small_zstd.parquet").to_vec(),
    ];
    for (packed, version, has_dictionary) in [
        (Compression::SNAPPY, WriterVersion::PARQUET_1_0, true),
        (Compression::UNCOMPRESSED, WriterVersion::PARQUET_2_0, false),
    ] {
        let properties = WriterProperties::builder()
            .set_compression(packed)
            .set_writer_version(version)
            .set_dictionary_enabled(has_dictionary);
        files.push(written_with(properties.build(), SCHEMA, &columns, 12));
    }
    let (mut refused, mut all) = (0, 0);
    for file in files {
        assert!(log(&file, &mapping).is_ok());
        let flips = by_tier([&[0x80][..], &[0x01, 0x80, 0xff]]);
        let places = (4..file.len()).step_by(by_tier([4, 1]));
        for (place, flip) in places.flat_map(|place| flips.iter().map(move |flip| (place, flip))) {
            let mut broken = file.clone();
            broken[place] ^= flip;
            all += 1;
            if let Err(output) = log(&broken, &mapping) {
                refused += 1;
                assert!(output.starts_with("a.parquet: "), "{output}");
                assert_legible(&output);
            }
        }
    }
    println!("{refused} of {all} files are refused");
    assert!(refused > all / 3, "{refused} of {all}");
}
