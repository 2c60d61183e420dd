//! Logs with gaps in their time, which are read in stretches.

#[path = "common/drive.rs"]
mod drive;

use drive::{loaded, run, timed};
use overact_logs::{Error, Log, Mapping, read, read_runs};
use std::{fmt::Write as _, fs, path::Path};

/// Rows `time,q,tau` with q = sin(3 t) and tau = 2 q, of times that `keep` accepts.
fn rows(times: impl Iterator<Item = f64>, keep: impl Fn(f64) -> bool) -> String {
    let mut text = String::from("t,q,tau\n");
    for time in times.filter(|time| keep(*time)) {
        let q = (3.0 * time).sin();
        writeln!(text, "{time},{q},{}", 2.0 * q).expect("a string");
    }
    text
}

/// Times of 100 Hz from 0 s to 60 s.
fn uniform() -> impl Iterator<Item = f64> {
    (0..6000).map(|k| f64::from(k) / 100.0)
}

/// The runs of `name`, of which each needs 50 samples.
fn runs(name: &str, files: &[(&str, &str)], mapping: &Mapping) -> Result<Vec<Log>, String> {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, content) in files {
        fs::write(folder.path().join(name), content).expect("written");
    }
    let prefix = format!("{}/", folder.path().display());
    let path = name.split('+').map(|part| format!("{prefix}{part}"));
    let path = path.collect::<Vec<_>>().join("+");
    let read = read_runs(&[(Path::new(&path), false)], mapping, &|_| 50, &|_| {});
    let read = read.into_iter().next().expect("one log");
    let own = |log: Log| {
        let name = log.name().replace(&prefix, "");
        // The bounds of a stretch are in its name already.
        let range = name.rfind('[').unwrap_or(name.len());
        log.with_name(&name[..range])
    };
    read.map(|runs| runs.into_iter().map(own).collect())
        .map_err(|error: Error| error.to_string().replace(&prefix, ""))
}

fn names(runs: &[Log]) -> Vec<&str> {
    runs.iter().map(Log::name).collect()
}

/// Checks that the positions of a run are those of its times, to `tolerance`.
fn check(run: &Log, start: f64, tolerance: f64) {
    let (positions, torques) = loaded(run);
    for (sample, (position, torque)) in positions.iter().zip(&torques).enumerate() {
        let time = start + sample as f64 / run.sampling_frequency();
        let error = (position - (3.0 * time).sin()).abs();
        assert!(error < tolerance, "{}: {time} s: {error}", run.name());
        assert!((torque - 2.0 * position).abs() < tolerance);
    }
}

#[test]
fn a_log_is_split_at_gaps() {
    let text = rows(uniform(), |time| {
        !(12.0..13.5).contains(&time) && !(31.0..31.2).contains(&time)
    });
    let runs = runs("a.csv", &[("a.csv", &text)], &timed("q", "tau")).expect("runs");
    assert_eq!(names(&runs), ["a.csv[:13]", "a.csv[13:31]", "a.csv[31:]"]);
    let samples: Vec<usize> = runs.iter().map(Log::samples).collect();
    assert_eq!(samples, [1200, 1750, 2880]);
    for (run, start) in runs.iter().zip([0.0, 13.5, 31.2]) {
        assert!((run.sampling_frequency() - 100.0).abs() < 1e-6);
        assert!((run.start() - start).abs() < 1e-9);
        check(run, start, 1e-9);
    }
    assert_eq!(
        runs[0].note(),
        Some(
            "the time has 2 gaps of up to 1.51 s, first after 11.99 s: the log was split there and read as 3 runs; 2.9 % of its duration is missing"
        )
    );
    assert!(runs[1..].iter().all(|run| run.note().is_none()));
    let continues: Vec<bool> = runs.iter().map(Log::continues).collect();
    assert_eq!(continues, [false, true, true]);
}

#[test]
fn the_name_of_a_stretch_selects_its_samples() {
    let text = rows(uniform(), |time| !(12.0..13.5).contains(&time));
    let mapping = timed("q", "tau");
    let runs = runs("a.csv", &[("a.csv", &text)], &mapping).expect("runs");
    for own in &runs {
        let again = run(own.name(), &[("a.csv", text.as_bytes())], &mapping).expect("a run");
        assert_eq!(loaded(own), loaded(&again));
    }
}

#[test]
fn short_stretches_are_left_out() {
    let text = rows(uniform(), |time| {
        !(12.0..13.0).contains(&time) && !(13.3..14.0).contains(&time)
    });
    let files = [("a.csv", text.as_str())];
    let own = runs("a.csv", &files, &timed("q", "tau")).expect("runs");
    assert_eq!(names(&own), ["a.csv[:12]", "a.csv[14:]"]);
    let note = own[0].note().expect("a note");
    assert!(
        note.ends_with("read as 2 runs; 2.9 % of its duration is missing, and 0.48 % in 1 stretch of less than 50 samples is left out as too short to filter"),
        "{note}"
    );
    // Nothing is left.
    let text = rows(uniform(), |time| (100.0 * time).round() as i64 % 100 < 40);
    let message = runs("a.csv", &[("a.csv", &text)], &timed("q", "tau")).expect_err("too short");
    assert!(
        message.starts_with("a.csv: the time has 59 gaps, and the longest stretch without a gap has 40 samples: the filters need at least 50"),
        "{message}"
    );
}

/// Times of about 100 Hz with jitter.
fn jittered() -> impl Iterator<Item = f64> {
    (0..6000).map(|k| f64::from(k) / 100.0 + 0.002 * (f64::from(k) * 1.7).sin())
}

#[test]
fn stretches_are_resampled_separately() {
    let text = rows(jittered(), |time| !(12.0..13.5).contains(&time));
    let mapping = Mapping {
        resample: Some(100.0),
        ..timed("q", "tau")
    };
    let own = runs("a.csv", &[("a.csv", &text)], &mapping).expect("runs");
    assert_eq!(names(&own), ["a.csv[:13]", "a.csv[13:]"]);
    let first: Vec<f64> = jittered().filter(|time| *time >= 13.5).collect();
    check(&own[0], 0.0, 1e-6);
    check(&own[1], first[0], 1e-6);
    let note = own[0].note().expect("a note");
    assert!(
        note.contains("split there and read as 2 runs")
            && note.contains("the run was resampled at 100 Hz"),
        "{note}"
    );
    // Short gaps are interpolated still.
    let text = rows(jittered(), |time| !(12.0..12.02).contains(&time));
    let own = runs("a.csv", &[("a.csv", &text)], &mapping).expect("a run");
    assert_eq!(names(&own), ["a.csv"]);
    assert!(!own[0].note().expect("a note").contains("gap"));
}

#[test]
fn a_gap_of_one_file_splits_joined_files() {
    let all = rows(uniform().map(|time| time + 0.003), |time| {
        !(20.0..21.0).contains(&time)
    });
    let torques = all.replace("t,q,tau", "t,other,tau");
    let positions = rows(uniform(), |time| !(40.0..42.0).contains(&time)).replace("tau", "none");
    let files = [("a.csv", positions.as_str()), ("b.csv", torques.as_str())];
    let own = runs("a.csv+b.csv", &files, &timed("q", "tau")).expect("runs");
    assert_eq!(
        names(&own),
        ["a.csv+b.csv[:20]", "a.csv+b.csv[20:41]", "a.csv+b.csv[41:]"]
    );
    for run in &own {
        let (positions, torques) = loaded(run);
        assert!(positions.len() > 1700);
        for (position, torque) in positions.iter().zip(&torques) {
            assert!(
                (torque - 2.0 * position).abs() < 1e-5,
                "{position} {torque}"
            );
        }
    }
}

#[test]
fn angles_are_unwrapped_within_stretches() {
    let mut text = String::from("t,q,tau\n");
    for time in uniform().filter(|time| !(12.0..13.5).contains(time)) {
        let turns = 0.7 * time;
        let wrapped = (turns - turns.round()) * std::f64::consts::TAU;
        writeln!(text, "{time},{wrapped},1").expect("a string");
    }
    let mapping = Mapping {
        rotating: vec![true],
        ..timed("q", "tau")
    };
    let own = runs("a.csv", &[("a.csv", &text)], &mapping).expect("runs");
    assert_eq!(own.len(), 2);
    assert!(
        own[0]
            .note()
            .expect("a note")
            .contains("`q` was logged within one turn")
    );
    for run in &own {
        assert!(run.is_unwrapped());
        let (positions, _) = loaded(run);
        let step = 0.007 * std::f64::consts::TAU;
        for pair in positions.windows(2) {
            assert!((pair[1] - pair[0] - step).abs() < 1e-9, "{pair:?}");
        }
    }
}

#[test]
fn a_restarting_clock_is_rejected() {
    let one = rows(uniform(), |time| time < 20.0);
    let two = format!("{one}{}", &one["t,q,tau\n".len()..]);
    let message =
        |mapping: &Mapping| runs("a.csv", &[("a.csv", &two)], mapping).expect_err("refused");
    let reason =
        "the clock starts anew there, or a stamp is wrong: write each recording to its own file";
    let plain = message(&timed("q", "tau"));
    assert!(
        plain.starts_with(
            "a.csv:2002: the time runs backwards after sample 1999, from 19.99 s to 0 s"
        ) && plain.contains(reason),
        "{plain}"
    );
    let resampled = message(&Mapping {
        resample: Some(100.0),
        ..timed("q", "tau")
    });
    assert!(resampled.contains("the time steps from 19.99 s to 0 s") && resampled.contains(reason));
    // Two samples that are exchanged are another defect.
    let swapped = one.replace("0.05,", "0.065,");
    let mapping = Mapping {
        resample: Some(100.0),
        ..timed("q", "tau")
    };
    let message = runs("a.csv", &[("a.csv", &swapped)], &mapping).expect_err("refused");
    assert!(message.contains("sort the samples"), "{message}");
}

#[test]
fn nonuniform_time_within_a_stretch_is_reported() {
    let text = rows(uniform(), |time| {
        !(12.0..13.5).contains(&time) && time != 40.0
    });
    let message =
        runs("a.csv", &[("a.csv", &text)], &timed("q", "tau")).expect_err("a lost sample");
    assert!(
        message.contains("the time is not uniform") && message.contains("set `resample"),
        "{message}"
    );
}

#[test]
fn time_ranges_may_contain_gaps() {
    let text = rows(uniform(), |time| !(12.0..13.5).contains(&time));
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.csv");
    fs::write(&path, &text).expect("written");
    let path = format!("{}[5:20]", path.display());
    let mapping = timed("q", "tau");
    let own = read_runs(&[(Path::new(&path), false)], &mapping, &|_| 50, &|_| {});
    let own = own.into_iter().next().expect("one log").expect("runs");
    let ends: Vec<&str> = own
        .iter()
        .map(|run| &run.name()[run.name().len() - 7..])
        .collect();
    assert_eq!(ends, ["v[5:13]", "[13:20]"]);
    check(&own[1], 13.5, 1e-9);
    assert_eq!(own[1].samples(), 650);
}

#[test]
fn large_logs_are_split_in_bounded_memory() {
    // It writes and parses 30 MB.
    if !overact_tier::is_full() {
        return;
    }
    let times = || (0..700_000).map(|k| f64::from(k) / 100.0);
    let text = rows(times(), |time| {
        !(1000.0..1001.0).contains(&time) && !(6000.0..6002.0).contains(&time)
    });
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.csv");
    fs::write(&path, &text).expect("written");
    let mapping = timed("q", "tau");
    let own = read_runs(&[(&path, false)], &mapping, &|_| 50, &|_| {});
    let own = own.into_iter().next().expect("one log").expect("runs");
    let memory: Vec<bool> = own.iter().map(Log::in_memory).collect();
    assert_eq!(memory, [true, false, false]);
    for (run, start) in own.iter().zip([0.0, 1001.0, 6002.0]) {
        check(run, start, 1e-6);
    }
    let samples: usize = own.iter().map(Log::samples).sum();
    assert_eq!(samples, 699_700);
    assert!(read(&path, &mapping, false).is_err());
}
