//! Text written by controllers, spreadsheets and scripts gives the same numbers.

#[path = "common/drive.rs"]
mod drive;

use std::{fs, path::Path};

use drive::info;
use overact_logs::read;
use overact_logs::{Error, Log, Mapping, Time};

/// Columns of the one-drive robot by their names.
fn named() -> Mapping {
    Mapping::for_robot(&info())
}

/// Positions in the second column and torques in the third one.
fn numbered(time: Time) -> Mapping {
    Mapping {
        time,
        positions: vec![String::from("$2")],
        torques: vec![String::from("$3")],
        ..named()
    }
}

fn log(content: &[u8], mapping: &Mapping) -> Result<Log, Error> {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("log.txt");
    fs::write(&path, content).expect("written");
    read(&path, mapping, false)
}

/// Message for a refused text, without the folder.
fn refused(content: &[u8], mapping: &Mapping) -> String {
    let text = log(content, mapping).expect_err("an error").to_string();
    let place = text.find("log.txt").expect("the file");
    text[place..].to_owned()
}

/// Fails unless a text has the three common samples of these tests, at 10 Hz.
fn same(content: &str, mapping: &Mapping) {
    let log = log(content.as_bytes(), mapping).unwrap_or_else(|error| panic!("{content}: {error}"));
    let (positions, torques) = log.load().expect("numbers");
    assert_eq!(positions, [1.5, -2.0, 0.025], "{content}");
    assert_eq!(torques, [3.0, 4.25, 1000.5], "{content}");
    assert!((log.sampling_frequency() - 10.0).abs() < 1e-9, "{content}");
}

#[test]
fn separators_and_decimal_commas_are_detected() {
    let point = "time,q_1,tau_1\n0,1.5,3\n0.1,-2,4.25\n0.2,2.5e-2,1000.5\n";
    same(point, &named());
    for separator in [";", "\t", "; ", " ", "   ", " \t ", "\t\t"] {
        let text = point.replace(',', separator);
        same(&text, &named());
        same(&text.replace('.', ","), &named());
        same(&text.replace('.', ",").replace('\n', "\r\n"), &named());
    }
    same(&point.replace(',', ", "), &named());
    same(&format!("\u{feff}{point}"), &named());
    same(&format!("\u{feff}{}", point.replace(',', " ")), &named());
    same(&format!("# by a controller\n#\n\n{point}"), &named());
    same(
        &format!("% {}", point.replace(',', " ").replacen('%', "", 1)),
        &named(),
    );
}

#[test]
fn cells_may_be_quoted() {
    let text = "\"time\",\"q_1\",\"a, b\",\"tau_1\"\n\"0\",\"1.5\",\"x\",\"3\"\n0.1,-2,\"y\n\",4.25\n0.2,\"0.025\",z,1000.5\n";
    same(text, &named());
    let text = "time,q_1,tau_1\n\"0,0\",\"1,5\",\"3,0\"\n\"0,1\",\"-2\",\"4,25\"\n\"0,2\",\"0,025\",\"1000,5\"\n";
    same(text, &named());
}

#[test]
fn unnamed_columns_are_selected_by_number() {
    let text = "0,1.5,3\n0.1,-2,4.25\n0.2,0.025,1000.5\n";
    let time = Time::Column(String::from("$1"));
    for text in [text, &format!("time,q,torque\n{text}")] {
        same(text, &numbered(time.clone()));
        same(text, &numbered(Time::Frequency(10.0)));
    }
    // As MATLAB's `save -ascii` writes.
    same(
        "   0.0000000e+00   1.5000000e+00   3.0000000e+00\n   1.0000000e-01  -2.0000000e+00   4.2500000e+00\n   2.0000000e-01   2.5000000e-02   1.0005000e+03\n",
        &numbered(time),
    );
}

#[test]
fn column_names_may_be_in_a_comment() {
    // As `numpy.savetxt` writes a header, after a title.
    let numbers = "0 1.5 3\n0.1 -2 4.25\n0.2 0.025 1000.5\n";
    same(
        &format!("# run of today\n# time q_1 tau_1\n{numbers}"),
        &named(),
    );
    same(&format!("# time, q_1, tau_1\n{numbers}"), &named());
    same(
        &format!("#time;q_1;tau_1\n{}", numbers.replace(' ', ";")),
        &named(),
    );
    same(&format!("% time q_1 tau_1\n{numbers}"), &named());
}

#[test]
fn large_text_files_stay_on_disk() {
    let mut text = String::from("time; q_1; tau_1\n");
    for k in 0..530_000_u32 {
        let value = f64::from(k);
        text.push_str(&format!("{}; {value}; {}\n", value / 8.0, value / 4.0));
    }
    let text = text.replace('.', ",");
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("long.txt");
    for text in [text.clone(), text.replace(';', "")] {
        fs::write(&path, text).expect("written");
        let log = read(&path, &named(), false).unwrap_or_else(|error| panic!("{error}"));
        assert!(!log.in_memory());
        assert_eq!((log.samples(), log.sampling_frequency()), (530_000, 8.0));
        let (positions, torques) = log.load().expect("numbers");
        assert_eq!(
            (positions[123_456], torques[123_457]),
            (123_456.0, 30_864.25)
        );
    }
}

#[test]
fn ambiguous_decimal_commas_are_rejected() {
    assert_eq!(
        refused(b"time,q_1,tau_1\n0,0,1,5,3,0\n0,1,-2,0,4,25\n", &named()),
        "log.txt:2: the line has 6 columns, but the header names 3\n  help: if commas are decimal marks, separate the columns by semicolons or tabs; otherwise name every column"
    );
    assert_eq!(
        refused(b"time;q_1;tau_1\n0;1,5;3\n0.1;1;1\n", &named()),
        "log.txt:2: `1,5` has a comma where `0.1` has a decimal point\n  help: use decimal points or decimal commas throughout, and no mark between thousands"
    );
    assert_eq!(
        refused(b"time q 1 tau 1\n0 0 0\n0.1 0 0\n", &named()),
        "log.txt: there are no columns `q_1`, `tau_1`; the file has `time`, `q`, `1`, `tau`, `1`\n  help: \
         did you mean `q` for `q_1`, `tau` for `tau_1`?"
    );
    assert_eq!(
        refused(b"time,q_1 [deg],tau_1\n0,0,0\n0.1,0,0\n", &named()),
        "log.txt: there is no column `q_1`; the file has `time`, `q_1 [deg]`, `tau_1`\n  help: \
         did you mean `q_1 [deg]` for `q_1`?"
    );
}

#[test]
fn a_simulated_log_next_to_other_columns_in_data_is_explained() {
    let other = Mapping {
        positions: vec![String::from("encoder")],
        torques: vec![String::from("current")],
        ..named()
    };
    let error = refused(b"time,q_1,tau_1\n0,0,0\n0.1,0,0\n", &other);
    assert!(error.contains("as `overact simulate` writes it"), "{error}");
}

#[test]
fn missing_columns_of_unnamed_files_are_reported() {
    assert_eq!(
        refused(b"0 0 0\n0.1 0 0\n", &named()),
        "log.txt: there are no columns `time`, `q_1`, `tau_1`; the file has 3 columns, without names\n  help: \
         name the columns in the table [data] by their numbers: `$1` is the first one, `$2` the next"
    );
    assert_eq!(
        refused(b"0 0\n0.1 0\n", &numbered(Time::Frequency(10.0))),
        "log.txt: there is no column `$3`; the file has 2 columns, without names\n  help: \
         columns have the numbers `$1` to `$2`; if others are in another file of this run, join both files, `a.csv+b.csv`"
    );
    assert_eq!(
        refused(
            b"0;0;0\n0,1;0;0\n0,2;a,b;0\n",
            &numbered(Time::Frequency(10.0))
        ),
        "log.txt:3: column `$2`: `a,b` is not a number\n  help: cut the log before or after this line, or fill the gap"
    );
}

#[test]
fn runs_with_fewer_than_two_samples_are_rejected() {
    let mapping = numbered(Time::Frequency(10.0));
    assert_eq!(
        refused(b"1,2,3\n", &mapping),
        "log.txt: the run has a single sample\n  help: give a log with the samples of a whole motion"
    );
    assert_eq!(
        refused(b"a,b,c\n", &mapping),
        "log.txt: the run is empty\n  help: give a log with the samples of a whole motion"
    );
    let bad = numbered(Time::Frequency(0.0));
    let error = read(Path::new("none"), &bad, false).expect_err("an error");
    assert_eq!(error.to_string(), "the sampling frequency is 0 Hz");
}

#[test]
fn binary_files_are_identified_and_never_printed() {
    let cases: [(&[u8], &str); 10] = [
        (b"\x89HDF\r\n\x1a\n", "HDF5"),
        (b"\x89MCAP0\r\n", "MCAP"),
        (b"PARE\x15", "Parquet"),
        (b"PAR1\x15", "Parquet"),
        (b"\x93NUMPY\x01\x00", "NumPy's, but it is truncated"),
        (
            b"PK\x03\x04\x14\x00",
            "the zip archive can't be read: it is truncated",
        ),
        (b"\x1f\x8b\x08\x00", "compressed file is damaged"),
        (b"\xff\xfet\x00i\x00", "UTF-16"),
        (b"SQLite format 3\0", "SQLite"),
        (b"\x7fELF\x02\x01\x01\x00\x00", "neither text nor"),
    ];
    for (content, word) in cases {
        let text = refused(content, &named());
        assert!(text.contains(word), "{text}");
        assert!(text.chars().all(|c| !c.is_control() || c == '\n'), "{text}");
    }
}

#[test]
fn printed_cells_are_shortened_without_control_characters() {
    let long = "x".repeat(5000);
    let text = refused(
        format!("time,q_1,tau_1\n0,{long},0\n0.1,\u{9b}2J,0\n").as_bytes(),
        &named(),
    );
    assert!(text.contains("xxx…` is not a number"), "{text}");
    assert!(text.contains("`\u{fffd}2J` is not a number"), "{text}");
    assert!(text.len() < 400, "{text}");
}
