//! Texts as recorders write them: preambles, units, dates, several topics.

#[path = "common/drive.rs"]
mod drive;

use drive::{info, numbers, run};
use overact_logs::Mapping;

/// Columns of the one-drive robot by their names.
fn named() -> Mapping {
    Mapping::for_robot(&info())
}

/// Fails unless a text has three samples at 10 Hz: positions 1.5, -2, 0.025, torques 3, 4.25, 1000.5.
fn same(content: &[u8], mapping: &Mapping) {
    let text = String::from_utf8_lossy(content);
    let log = run("log.txt", &[("log.txt", content)], mapping);
    let (positions, torques, frequency) = numbers(log);
    assert_eq!(positions, [1.5, -2.0, 0.025], "{text}");
    assert_eq!(torques, [3.0, 4.25, 1000.5], "{text}");
    assert!((frequency - 10.0).abs() < 1e-9, "{text}: {frequency}");
}

const SAMPLES: &str = "0;1.5;3\n0.1;-2;4.25\n0.2;2.5e-2;1000.5\n";

#[test]
fn a_separator_named_in_the_first_line_is_used() {
    let text = format!("sep=;\ntime;q_1;tau_1\n{SAMPLES}");
    same(text.as_bytes(), &named());
    let text = text.replace(';', "|");
    same(text.as_bytes(), &named());
    let text = text.replace('|', "\t").replace('\n', "\r\n");
    same(text.as_bytes(), &named());
}

#[test]
fn unit_lines_below_names_are_skipped() {
    for units in ["s;rad;Nm", "[s];[m];[N]", "(s);°;N m"] {
        let text = format!("time;q_1;tau_1\n{units}\n{SAMPLES}");
        same(text.as_bytes(), &named());
    }
}

#[test]
fn names_in_latin_1_are_read() {
    let mut mapping = named();
    mapping.positions = vec![String::from("Weg [µm]")];
    let text = format!("time;Weg [µm];tau_1\n{SAMPLES}");
    same(text.as_bytes(), &mapping);
    let latin: Vec<u8> = text.chars().map(|c| c as u8).collect();
    same(&latin, &mapping);
}

#[test]
fn recorder_preambles_are_skipped_and_noted() {
    let labview = "LabVIEW Measurement\t\nWriter_Version\t2\nSeparator\tTab\n***End_of_Header***\t\n\t\nChannels\t2\t\t\nSamples\t3\t3\t\nDate\t2026/03/01\t2026/03/01\t\nDelta_X\t0.1\t0.1\t\n***End_of_Header***\t\t\t\ntime\tq_1\ttau_1\tComment\n";
    let text = format!("{labview}{}", SAMPLES.replace(';', "\t"));
    same(text.as_bytes(), &named());
    let log = run("log.txt", &[("log.txt", text.as_bytes())], &named()).expect("a log");
    assert_eq!(log.note(), Some("the first 11 lines are not samples"));
    let bench = "Test bench 3\nOperator: N. N.\n\ntime;q_1;tau_1\ns;m;N\n";
    same(format!("{bench}{SAMPLES}").as_bytes(), &named());
}

#[test]
fn error_lines_count_the_preamble() {
    let text = "Test bench 3\nOperator: N. N.\ntime;q_1;tau_1\n0;1;2\n1;1;2\n2;x;2\n3;1;2\n4;1;2\n";
    let error = run("log.txt", &[("log.txt", text.as_bytes())], &named()).expect_err("a word");
    assert!(
        error.starts_with("log.txt:6: column `q_1`: `x` is not a number"),
        "{error}"
    );
}

#[test]
fn malformed_lines_among_samples_are_not_skipped() {
    for broken in ["0.05;x;1", "fault;fault;fault", "0.05;;"] {
        let text = format!("time;q_1;tau_1\n-0.1;1;2\n{broken}\n{SAMPLES}");
        let error = run("log.txt", &[("log.txt", text.as_bytes())], &named()).expect_err("broken");
        assert!(error.contains("log.txt:3"), "{error}");
        // Below the names, a line of words is passed as one of units would be, and this is noted.
        let text = format!("time;q_1;tau_1\n{broken}\n{SAMPLES}");
        let log = run("log.txt", &[("log.txt", text.as_bytes())], &named());
        if broken.starts_with("fault") {
            let log = log.expect("a log");
            assert_eq!(log.note(), Some("the first 2 lines are not samples"));
        } else {
            assert!(log.is_err(), "{broken}");
        }
    }
}

#[test]
fn dates_and_times_of_day_are_read() {
    let forms = [
        [
            "2026-03-01T23:59:59.9Z",
            "2026-03-02T00:00:00.0Z",
            "2026-03-02T00:00:00.1Z",
        ],
        [
            "2026-03-01 10:00:00",
            "2026-03-01 10:00:00.1",
            "2026-03-01 10:00:00.200",
        ],
        [
            "01.03.2026 10:00:00,0",
            "01.03.2026 10:00:00,1",
            "01.03.2026 10:00:00,2",
        ],
        ["23:59:59.95", "00:00:00.05", "00:00:00.15"],
    ];
    for times in forms {
        let mut lines = SAMPLES
            .lines()
            .map(|line| line.split_once(';').expect("cells").1);
        let rows: String = times
            .iter()
            .map(|time| format!("{time};{}\n", lines.next().expect("a line")))
            .collect();
        same(format!("time;q_1;tau_1\n{rows}").as_bytes(), &named());
    }
}

#[test]
fn files_with_dates_are_joined_by_absolute_time() {
    let positions = "time;q_1\n2026-03-01T23:59:59.9Z;1\n2026-03-02T00:00:00.0Z;2\n2026-03-02T00:00:00.1Z;3\n2026-03-02T00:00:00.2Z;4\n";
    let torques = "time;tau_1\n2026-03-02T00:00:00.0Z;20\n2026-03-02T00:00:00.1Z;30\n2026-03-02T00:00:00.2Z;40\n2026-03-02T00:00:00.3Z;50\n";
    let files = [
        ("a.csv", positions.as_bytes()),
        ("b.csv", torques.as_bytes()),
    ];
    let (positions, torques, _) = numbers(run("a.csv+b.csv", &files, &named()));
    assert_eq!(positions, [2.0, 3.0, 4.0]);
    for (torque, expected) in torques.iter().zip([20.0, 30.0, 40.0]) {
        assert!((torque - expected).abs() < 1e-6, "{torques:?}");
    }
}

#[test]
fn topics_with_separate_rows_are_joined_by_time() {
    // Torques are 0.4 of a step late, and linear in time.
    let rows: String = (0..50)
        .map(|k| {
            let time = 0.1 * f64::from(k);
            let late = time + 0.04;
            format!(
                "{time:.3},{:.4},\n{late:.3},,{:.4}\n",
                2.0 * time,
                10.0 + late
            )
        })
        .collect();
    let text = format!("time,q_1,tau_1\n{rows}");
    let (positions, torques, frequency) =
        numbers(run("log.txt", &[("log.txt", text.as_bytes())], &named()));
    assert!((frequency - 10.0).abs() < 1e-6, "{frequency}");
    for (position, torque) in positions.iter().zip(&torques) {
        assert!(
            (torque - 10.0 - position / 2.0).abs() < 1e-3,
            "{position} {torque}"
        );
    }
    assert!(positions.len() >= 47, "{}", positions.len());
}

#[test]
fn a_missing_cell_is_an_error() {
    let text = "time,q_1,tau_1\n0,1,2\n0.1,,3\n0.2,3,4\n0.3,4,5\n";
    let error = run("log.txt", &[("log.txt", text.as_bytes())], &named()).expect_err("a gap");
    assert!(error.contains("the cell is empty"), "{error}");
}
