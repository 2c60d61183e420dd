//! Parquet files joined with others to one run, row by row or by time.

#[path = "common/drive.rs"]
mod drive;
#[path = "common/parquet.rs"]
mod parquet_file;

use std::{fs, path::Path};

use drive::{joined, loaded, numbers, run, timed, untimed};
use overact_logs::read;
use parquet_file::{Cells, written};

#[test]
fn parquet_and_text_files_are_joined() {
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

#[test]
fn parquet_and_text_files_are_interpolated_alike() {
    let row = |time: f64, value: f64| format!("{time},{value}\n");
    let positions = (0..1001).map(|k| f64::from(k) / 1000.0);
    let positions: String = positions.map(|t| row(t, t)).collect();
    let positions = format!("t,q\n{positions}");
    // 240 Hz from 0.0105 s to 0.9605 s.
    let time: Vec<f64> = (0..229).map(|k| 0.0105 + f64::from(k) / 240.0).collect();
    let torque: Vec<f64> = time.iter().map(|t| 3.0 * t - 1.0).collect();
    let text: String = time
        .iter()
        .zip(&torque)
        .map(|(t, tau)| row(*t, *tau))
        .collect();
    let text = format!("t,tau\n{text}");
    let schema = "message log { required double t; required double tau; }";
    let file = written(schema, &[Cells::Double(&time), Cells::Double(&torque)]);
    let with = |other: (&str, &[u8])| {
        loaded(
            &joined(("q.csv", positions.as_bytes()), other)
                .unwrap_or_else(|error| panic!("{error}")),
        )
    };
    assert_eq!(with(("i.parquet", &file)), with(("i.csv", text.as_bytes())));
}

#[test]
fn timestamps_of_joined_files_have_a_common_origin() {
    // The second file starts in another second, 20 ms later.
    let start = 1_700_000_000_990_000_i64;
    let first: Vec<i64> = (0..100).map(|k| start + 1000 * k).collect();
    let second: Vec<i64> = (0..100).map(|k| start + 20_000 + 500 * k).collect();
    let numbers =
        |times: &[i64]| -> Vec<f64> { times.iter().map(|time| (time - start) as f64).collect() };
    let schema = |name: &str| {
        format!(
            "message log {{ required int64 t (TIMESTAMP(MICROS, false)); required double {name}; }}"
        )
    };
    let file = |name: &str, times: &[i64]| {
        written(
            &schema(name),
            &[Cells::Long(times), Cells::Double(&numbers(times))],
        )
    };
    let log = joined(
        ("q.parquet", &file("q", &first)),
        ("i.parquet", &file("tau", &second)),
    );
    let (positions, torques) = loaded(&log.unwrap_or_else(|error| panic!("{error}")));
    // From 20 ms to 69 ms, without 13 samples at either end for the low-pass filter.
    assert_eq!((positions[0], positions.len()), (33_000.0, 24));
    let differs = |(q, tau): (&f64, &f64)| (q - tau).abs() > 1e-6;
    assert!(!positions.iter().zip(&torques).any(differs));
}

#[test]
fn large_files_are_joined_block_by_block() {
    let folder = tempfile::tempdir().expect("a folder");
    let samples = 600_000_u32;
    let times = |rate: f64, start: f64| -> Vec<f64> {
        let all = 0..samples;
        all.map(|k| start + f64::from(k) / rate).collect()
    };
    let (first, second) = (times(1000.0, 0.0), times(1010.0, 0.25));
    let torques: Vec<f64> = second.iter().map(|t| 3.0 * t - 1.0).collect();
    for (name, column, time, values) in [
        ("q.parquet", "q", &first, &first),
        ("i.parquet", "tau", &second, &torques),
    ] {
        let schema = format!("message log {{ required double t; required double {column}; }}");
        let file = written(&schema, &[Cells::Double(time), Cells::Double(values)]);
        fs::write(folder.path().join(name), file).expect("written");
    }
    let prefix = folder.path().display();
    let path = format!("{prefix}/q.parquet+{prefix}/i.parquet");
    let log = read(Path::new(&path), &timed("q", "tau"), false);
    let log = log.unwrap_or_else(|error| panic!("{error}"));
    assert!(!log.in_memory());
    // Up to 594.3 s.
    let (times, torques) = loaded(&log);
    assert_eq!((times.len(), times[0]), (log.samples(), 0.25));
    let off = |(time, torque): (&f64, &f64)| (torque - (3.0 * time - 1.0)).abs() > 1e-9;
    assert!(!times.iter().zip(&torques).any(off));
    assert!(log.samples() > 593_000);
}
