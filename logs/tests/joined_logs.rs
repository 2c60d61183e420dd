//! Runs with columns in several files, and columns that are expressions of columns.

mod common;
#[path = "common/drive.rs"]
mod drive;

use std::{fs, path::Path};

use common::shared;
use overact_logs::{Log, Mapping, Time};
use overact_logs::{parts, read};

/// Reads the run `name` of these files, by names and contents.
fn run(name: &str, files: &[(&str, &str)], mapping: &Mapping) -> Result<Log, String> {
    let files = files.iter().map(|&(name, text)| (name, text.as_bytes()));
    drive::run(name, &files.collect::<Vec<_>>(), mapping)
}

/// A mapping of one drive.
fn mapping(time: Time, position: &str, torque: &str) -> Mapping {
    Mapping {
        time,
        ..drive::timed(position, torque)
    }
}

fn at(frequency: f64) -> Time {
    Time::Frequency(frequency)
}

fn column(name: &str) -> Time {
    Time::Column(name.to_owned())
}

fn numbers(log: Result<Log, String>) -> (Vec<f64>, Vec<f64>) {
    log.and_then(|log| log.load().map_err(|error| error.to_string()))
        .unwrap_or_else(|error| panic!("{error}"))
}

const POSITIONS: (&str, &str) = ("pos.csv", "a,b\n1,2\n3,4\n5,6\n");
const TORQUES: (&str, &str) = ("torque.csv", "a;c\n0,5;7\n1,5;8\n2,5;9\n");

#[test]
fn files_are_joined_sample_by_sample() {
    let files = [POSITIONS, TORQUES];
    let joined = |position: &str, torque: &str| {
        run(
            "pos.csv+torque.csv",
            &files,
            &mapping(at(10.0), position, torque),
        )
    };
    let expected = (vec![2.0, 4.0, 6.0], vec![7.0, 8.0, 9.0]);
    assert_eq!(numbers(joined("b", "c")), expected);
    assert_eq!(numbers(joined("$2", "$4")), expected);
    assert_eq!(numbers(joined("file1.b", "file2.c")), expected);
    assert_eq!(numbers(joined("file1.a", "file2.a")).1, [0.5, 1.5, 2.5]);
    assert_eq!(
        joined("a", "c").expect_err("both have it"),
        "pos.csv+torque.csv: several of the files have a column `a`\n  help: call it `file1.a` or `file2.a`, or by its number in all files"
    );
    assert_eq!(
        joined("file3.b", "$5").expect_err("missing"),
        "pos.csv+torque.csv: there are no columns `file3.b`, `$5`; the files have `file1.a`, `file1.b`, `file2.a`, `file2.c`\n  help: \
         `file3` is number 3 of the files of a run that are joined, `--data a.csv+b.csv`; this run has 2 files"
    );
    let missing = run("pos.csv+none.csv", &files, &mapping(at(10.0), "b", "c"));
    assert!(
        missing
            .expect_err("missing")
            .starts_with("none.csv: the file can't be read")
    );
}

#[test]
fn errors_in_joined_files_mention_their_file() {
    let output = |files: &[(&str, &str)], torque: &str| {
        let names: Vec<&str> = files.iter().map(|(name, _)| *name).collect();
        let mapping = mapping(at(10.0), "file1.b", torque);
        run(&names.join("+"), files, &mapping).expect_err("a slip")
    };
    let text = output(&[POSITIONS, TORQUES], "file2.C2");
    assert!(
        text.ends_with("help: did you mean `file2.c` for `file2.C2`?"),
        "{text}"
    );
    let text = output(&[POSITIONS], "file2.c");
    assert!(
        text.ends_with("`file2` is number 2 of the files of a run that are joined, `--data a.csv+b.csv`; this run has 1 file"),
        "{text}"
    );
    let text = output(
        &[POSITIONS, ("bare.csv", "0.5,7\n1.5,8\n2.5,9\n")],
        "file2.c",
    );
    assert!(
        text.contains(
            "bare.csv has no names: its columns have the numbers `$3` to `$4` in all files"
        ),
        "{text}"
    );
    let text = output(&[POSITIONS, ("colons.csv", "a:c\n1:2\n3:4\n")], "file2.c");
    assert!(
        text.contains("colons.csv has one column only, `a:c`: separate columns by commas, semicolons, tabs or blanks"),
        "{text}"
    );
    let text = output(&[POSITIONS, ("none.csv", "")], "file2.c");
    assert!(text.starts_with("none.csv: the file is empty\n"), "{text}");
    let text = output(&[POSITIONS, TORQUES], "file2.c Nm");
    assert!(
        text.contains("`file2.c Nm`: `file2.c` is followed by `Nm`"),
        "{text}"
    );
    let text = output(&[POSITIONS, TORQUES], "deg2rad(file2.c)");
    assert!(
        text.contains("there is no function `deg2rad`; there are sin, cos"),
        "{text}"
    );
    assert!(text.contains("write `* pi/180` after the column"), "{text}");
    // One file instead of two.
    let text = output(&[POSITIONS, POSITIONS], "file2.b");
    assert!(
        text.starts_with("pos.csv: the file is given twice in one run"),
        "{text}"
    );
    // An additional line in one file is reported alone, without its consequences.
    let text = output(
        &[POSITIONS, ("words.csv", "a;c\n1;7\na;c\n2;8\n3;9\n")],
        "file2.c",
    );
    assert_eq!(
        text.matches("error").count() + text.lines().count(),
        2,
        "{text}"
    );
}

#[test]
fn other_ways_to_join_file_names_are_rejected_with_help() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).display().to_string();
    for (name, text) in [POSITIONS, TORQUES] {
        fs::write(folder.path().join(name), text).expect("written");
    }
    let mapping = mapping(at(10.0), "b", "c");
    for between in [" + ", ",", " "] {
        let both = format!("{}{between}{}", path("pos.csv"), path("torque.csv"));
        let text = read(Path::new(&both), &mapping, false)
            .expect_err("no file")
            .to_string();
        let joined = format!("`{}+{}`", path("pos.csv"), path("torque.csv"));
        assert!(
            text.contains("joined by `+` without blanks") && text.contains(&joined),
            "{text}"
        );
    }
    let with_input = format!("{}+-", path("pos.csv"));
    let text = read(Path::new(&with_input), &mapping, false)
        .expect_err("no file")
        .to_string();
    assert!(
        text.contains("standard input can't be joined with files"),
        "{text}"
    );
}

#[test]
fn files_of_different_lengths_are_rejected() {
    let short = ("torque.csv", "c\n7\n8\n");
    let mapping = mapping(at(10.0), "b", "c");
    for (name, files) in [
        ("pos.csv+torque.csv", [POSITIONS, short]),
        ("torque.csv+pos.csv", [short, POSITIONS]),
    ] {
        assert_eq!(
            run(name, &files, &mapping).expect_err("too short"),
            "torque.csv: the file ends after 2 samples, while pos.csv goes on\n  help: files are joined sample by \
             sample: cut them to the same samples, or check that they are of one run"
        );
    }
}

#[test]
fn files_whose_times_differ_are_joined_by_time() {
    let positions = ("p.csv", "t,q\n0,1\n0.1,2\n0.2,3\n0.3,4\n");
    let same = ("f.csv", "t,f\n0.001,1\n0.101,2\n0.201,3\n0.301,4\n");
    let timed = mapping(column("t"), "q", "f");
    let log = run("p.csv+f.csv", &[positions, same], &timed).expect("a log");
    assert!((log.sampling_frequency() - 10.0).abs() < 1e-9);
    let late = ("f.csv", "t,f\n0,1\n0.1,2\n0.3,4\n0.4,5\n");
    let joined = run("p.csv+f.csv", &[positions, late], &timed).expect("a log");
    assert!(joined.note().is_some());
    let (_, torques) = numbers(Ok(joined));
    let expected = [1.0, 2.0, 3.0, 4.0];
    let off = |(own, expected): (&f64, &f64)| (own - expected).abs() > 1e-12;
    assert!(!torques.iter().zip(&expected).any(off), "{torques:?}");
    let first = mapping(column("file1.t"), "q", "f");
    assert_eq!(
        numbers(run("p.csv+f.csv", &[positions, late], &first)).1,
        [1.0, 2.0, 4.0, 5.0]
    );
}

#[test]
fn a_file_may_have_a_plus_in_its_name() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a+b.csv");
    fs::write(&path, "b,c\n1,2\n3,4\n").expect("written");
    assert_eq!(parts(&path), [path.as_path()]);
    assert_eq!(
        parts(Path::new("no such+file")),
        [Path::new("no such+file")]
    );
    read(&path, &mapping(at(1.0), "b", "c"), false).expect("a log");
}

#[test]
fn columns_may_be_expressions() {
    let log = (
        "log.csv",
        "t,q5,q6,motor 1 [deg],i\n0,1,2,90,0.5\n1,3,-4,180,-1\n2,0.5,0.25,0,2\n",
    );
    let value = |position: &str, torque: &str| {
        numbers(run(
            "log.csv",
            &[log],
            &mapping(column("t/1000"), position, torque),
        ))
    };
    let (sums, torques) = value("q5 + q6", "2*i - poly(q5, 1, 0, 0.5)");
    assert_eq!(sums, [3.0, -1.0, 0.75]);
    assert_eq!(torques, [-0.5, -7.5, 2.875]);
    let (turned, sines) = value("'motor 1 [deg]' * pi/180", "$5 * sin($4 * pi/180)^2");
    assert!((turned[1] - std::f64::consts::PI).abs() < 1e-15);
    assert!((sines[0] - 0.5).abs() < 1e-15 && sines[2] == 0.0);
    let milliseconds = mapping(column("t/1000"), "q5", "i");
    let log = run("log.csv", &[log], &milliseconds).expect("a log");
    assert!((log.sampling_frequency() - 1000.0).abs() < 1e-9);
}

#[test]
fn invalid_expressions_are_rejected_with_the_reason() {
    let log = ("log.csv", "t,q5,q6,i\n0,1,2,0.5\n1,3,0,-1\n2,0,0.25,2\n");
    let refused = |position: &str, torque: &str| {
        run("log.csv", &[log], &mapping(column("t"), position, torque)).expect_err("an error")
    };
    assert_eq!(
        refused("q5 + q7", "(i"),
        "log.csv: there is no column `q7`; the file has `t`, `q5`, `q6`, `i`\n  help: did you mean `q6` for `q7`?\n\
         log.csv: `(i` is neither a column nor an expression of columns: `)` is missing at the end\n  help: put names with blanks or signs in single quotation marks: `'motor 1' / 50`"
    );
    let log_with_units = ("log.csv", "t,q5,cur [A]\n0,1,2\n1,3,0\n2,0,0.25\n");
    assert_eq!(
        run(
            "log.csv",
            &[log_with_units],
            &mapping(column("t"), "q5", "2*cur [A]")
        )
        .expect_err("an error"),
        "log.csv: `2*cur [A]` is neither a column nor an expression of columns: there is no function `cur`; there are sin, cos, tan, asin, acos, atan, atan2, sqrt, abs, exp, sign, poly\n  help: put its name in single quotation marks: `2*'cur [A]'`"
    );
    assert_eq!(
        refused("q5/q6", "i"),
        "log.csv:3: sample 1: `q5/q6` is not a finite number"
    );
}

#[test]
fn large_joined_runs_stay_on_disk() {
    let folder = tempfile::tempdir().expect("a folder");
    let (mut positions, mut torques) = (String::from("q\n"), String::from("i\n"));
    for k in 0..530_000_u32 {
        positions.push_str(&format!("{}\n", f64::from(k) / 4.0));
        torques.push_str(&format!("{}\n", f64::from(k) / 8.0));
    }
    let names = ["q.csv", "i.csv"].map(|name| folder.path().join(name).display().to_string());
    fs::write(&names[0], positions).expect("written");
    fs::write(&names[1], torques).expect("written");
    let mapping = mapping(at(1000.0), "2*q", "i - q/2");
    let log = read(Path::new(&names.join("+")), &mapping, false).expect("a log");
    assert!(!log.in_memory());
    let (positions, torques) = log.load().expect("numbers");
    assert_eq!(positions.len(), 530_000);
    assert!(torques.iter().all(|torque| *torque == 0.0));
    assert_eq!(positions[1001], 500.5);
}

#[test]
fn tx40_motor_columns_become_joint_columns() {
    let (Some(positions), Some(torques)) = (
        shared("data/tx40/pos_read_data.csv"),
        shared("data/tx40/curr_data.csv"),
    ) else {
        return;
    };
    let name = format!("{}+{}", positions.display(), torques.display());
    // Motor 6 drives q5 + q6.
    let mapping = Mapping {
        positions: vec![
            String::from("$5/45"),
            String::from("$6/32 - file1.Joint_5/45"),
        ],
        torques: vec![
            String::from("45*$11 + 32*$12"),
            String::from("32*file2.Joint_6"),
        ],
        position_scale: vec![1.0; 2],
        torque_gain: vec![overact_logs::Gain::Value(1.0); 2],
        ..mapping(at(5000.0), "", "")
    };
    let log = read(Path::new(&name), &mapping, false).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!((log.samples(), log.sampling_frequency()), (45_000, 5000.0));
    let (positions, torques) = log.load().expect("numbers");
    assert_eq!(positions[..2], [0.0, -0.00028762 / 32.0]);
    let fifth = 45.0 * -0.0036467 + 32.0 * 0.016623;
    assert_eq!(torques[..2], [fifth, 32.0 * 0.016623]);
}
