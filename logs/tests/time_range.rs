//! Runs of which only a range of time is used, `log.csv[10:60]`.

#[path = "common/drive.rs"]
mod drive;

use drive::{loaded, run, timed, untimed};
use overact_logs::{Log, Mapping};

/// A second of samples at 10 Hz from a time on: position k, torque 10 k.
fn log(start: f64, count: usize) -> String {
    let rows = (0..count).map(|k| format!("{},{k},{}\n", start + k as f64 / 10.0, 10 * k));
    format!("t,q,tau\n{}", rows.collect::<String>())
}

fn part(range: &str, text: &str, mapping: &Mapping) -> Result<Log, String> {
    run(
        &format!("a.csv{range}"),
        &[("a.csv", text.as_bytes())],
        mapping,
    )
}

/// Positions of a part.
fn positions(range: &str, text: &str, mapping: &Mapping) -> Vec<f64> {
    let log = part(range, text, mapping).unwrap_or_else(|error| panic!("{error}"));
    // Absolute stamps of 64 bits are rounded to about 2e-7 s.
    assert!((log.sampling_frequency() - 10.0).abs() < 1e-3);
    loaded(&log).0
}

#[test]
fn only_samples_of_the_range_are_used() {
    let mapping = timed("q", "tau");
    let text = log(0.0, 10);
    assert_eq!(positions("[0.2:0.5]", &text, &mapping), [2.0, 3.0, 4.0]);
    assert_eq!(positions("[0.7:]", &text, &mapping), [7.0, 8.0, 9.0]);
    assert_eq!(positions("[:0.2]", &text, &mapping), [0.0, 1.0]);
    assert_eq!(positions("[0.8:1000]", &text, &mapping), [8.0, 9.0]);
    // Times are those of the log, absolute ones count from the first sample.
    assert_eq!(
        positions("[20.2:20.4]", &log(20.0, 10), &mapping),
        [2.0, 3.0]
    );
    assert_eq!(
        positions("[0.2:0.4]", &log(1.7e9, 10), &mapping),
        [2.0, 3.0]
    );
    // Without times, from the first sample.
    assert_eq!(
        positions("[0.2:0.4]", &text, &untimed("q", "tau")),
        [2.0, 3.0]
    );
}

#[test]
fn the_note_states_the_time_range_that_was_read() {
    let note = |range: &str, start: f64, mapping: &Mapping| {
        let log = part(range, &log(start, 10), mapping).expect("a log");
        log.note().expect("a note").to_owned()
    };
    let mapping = timed("q", "tau");
    assert_eq!(
        note("[0.2:0.5]", 0.0, &mapping),
        "the log was read in part, from 0.2 s to 0.4 s of its own time"
    );
    assert_eq!(
        note("[:0.2]", 0.0, &untimed("q", "tau")),
        "the log was read in part, from 0 s to 0.1 s since its first sample"
    );
    assert_eq!(
        part("", &log(0.0, 10), &mapping).expect("a log").note(),
        None
    );
}

#[test]
fn errors_outside_the_range_are_ignored() {
    let mapping = timed("q", "tau");
    let text = log(0.0, 20)
        .replace("0.2,2,20", "0.2,,20")
        .replace("1.6,16", "1.65,16");
    assert_eq!(positions("[0.3:0.6]", &text, &mapping), [3.0, 4.0, 5.0]);
    let message = part("[0.1:0.6]", &text, &mapping).expect_err("an empty cell");
    assert!(message.starts_with("a.csv:4: "), "{message}");
    let message = part("[0.3:1.9]", &text, &mapping).expect_err("a late sample");
    assert!(
        message.contains(":18: the time is not uniform"),
        "{message}"
    );
}

#[test]
fn invalid_ranges_are_rejected() {
    let message = |range: &str, start: f64| {
        part(range, &log(start, 10), &timed("q", "tau")).expect_err("refused")
    };
    let reversed = message("[0.5:0.2]", 0.0);
    assert!(
        reversed
            .starts_with("a.csv: the range of time `[0.5:0.2]` can't be used: it ends at 0.2 s"),
        "{reversed}"
    );
    assert!(message("[x:1]", 0.0).contains("`x` is not a number of seconds"));
    assert_eq!(
        message("[5:6]", 0.0),
        "a.csv[5:6]: the log has no sample in the range of time `[5:6]`: its times go from 0 s to 0.9 s\n  help: give a range within these times, in s"
    );
    let stamps = message("[:-1]", 1.7e9);
    assert!(
        stamps.contains("from 0 s to 0.9") && stamps.contains("counted from its first sample at 1"),
        "{stamps}"
    );
    assert!(message("[0.55:0.58]", 0.0).contains("no sample in the range"));
    assert!(message("[0.5:0.6]", 0.0).contains("the run has a single sample"));
}

#[test]
fn time_ranges_apply_to_joined_files() {
    let mapping = timed("q", "tau");
    let first = "t,q\n0,0\n0.1,1\n0.2,2\n0.3,3\n0.4,4\n";
    let second = "tau\n0\n10\n20\n30\n40\n";
    let files = [("a.csv", first.as_bytes()), ("b.csv", second.as_bytes())];
    let own = run("a.csv+b.csv[0.1:0.4]", &files, &mapping).expect("joined");
    assert_eq!(loaded(&own), (vec![1.0, 2.0, 3.0], vec![10.0, 20.0, 30.0]));
    let message = run("a.csv[0.1:0.4]+b.csv", &files, &mapping).expect_err("misplaced");
    assert!(
        message.contains("a range of time, in s, follows the last file of a run"),
        "{message}"
    );
    // By time, with another start.
    let rows = (0..20).map(|k| {
        let time = f64::from(k) / 10.0 - 0.31;
        format!("{time},{}\n", 100.0 * time)
    });
    let second = format!("t,tau\n{}", rows.collect::<String>());
    let first = log(0.0, 12).replace("tau", "other");
    let files = [("a.csv", first.as_bytes()), ("b.csv", second.as_bytes())];
    let own = run("a.csv+b.csv[0.2:0.9]", &files, &mapping).expect("joined by time");
    let (positions, torques) = loaded(&own);
    assert!(
        own.note()
            .expect("a note")
            .starts_with("the log was read in part, from 0.2 s to 0.8 s")
    );
    assert!(positions.len() >= 4 && positions.iter().all(|q| (2.0..9.0).contains(q)));
    for (position, torque) in positions.iter().zip(&torques) {
        assert!(
            (10.0 * position - torque).abs() < 1e-6,
            "{position} {torque}"
        );
    }
}

#[test]
fn time_ranges_apply_to_resampled_logs() {
    let mapping = Mapping {
        resample: Some(20.0),
        ..timed("q", "tau")
    };
    let own = part("[1:2]", &log(0.0, 100), &mapping).expect("resampled");
    let (positions, _) = loaded(&own);
    assert_eq!((own.sampling_frequency(), positions[0]), (20.0, 10.0));
    assert!(
        positions.iter().all(|q| (10.0..20.0).contains(q)),
        "{positions:?}"
    );
}

#[test]
fn existing_files_with_brackets_take_precedence_over_ranges() {
    let (whole, named) = (log(0.0, 10), log(0.0, 4));
    let files = [
        ("a.csv", whole.as_bytes()),
        ("a.csv[0.2:0.5]", named.as_bytes()),
    ];
    let own = run("a.csv[0.2:0.5]", &files, &timed("q", "tau")).expect("a log");
    assert_eq!((own.samples(), own.note()), (4, None));
}
