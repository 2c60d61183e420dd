//! Runs with non-uniform time, resampled at uniform times on request.

#[path = "common/drive.rs"]
mod drive;

use std::f64::consts::TAU;

use drive::{loaded, run, timed};
use overact_logs::{Log, Mapping, Time};

/// A text of times with two values each.
fn text(rows: impl Iterator<Item = (f64, [f64; 2])>) -> String {
    let rows = rows.map(|(time, [q, tau])| format!("{time},{q},{tau}\n"));
    format!("t,q,tau\n{}", rows.collect::<String>())
}

/// Times at a rate with reproducible errors of up to `part` of a step.
fn jitter(count: u32, rate: f64, part: f64) -> impl Iterator<Item = f64> {
    let off = |k: u32| f64::from(k.wrapping_mul(2_654_435_761) >> 8) / f64::from(1 << 23) - 1.0;
    (0..count).map(move |k| (f64::from(k) + part * off(k)) / rate)
}

fn at(rate: f64) -> Mapping {
    Mapping {
        resample: Some(rate),
        ..timed("q", "tau")
    }
}

fn resampled(rate: f64, rows: impl Iterator<Item = (f64, [f64; 2])>) -> Result<Log, String> {
    run("a.csv", &[("a.csv", text(rows).as_bytes())], &at(rate))
}

fn log(rate: f64, rows: impl Iterator<Item = (f64, [f64; 2])>) -> Log {
    resampled(rate, rows).unwrap_or_else(|error| panic!("{error}"))
}

/// Largest error of the positions from `expected` of the times, which are the torques.
fn error(log: &Log, expected: impl Fn(f64) -> f64) -> f64 {
    let (positions, times) = loaded(log);
    let errors = positions
        .iter()
        .zip(times)
        .map(|(own, t)| (own - expected(t)).abs());
    errors.fold(0.0, f64::max)
}

#[test]
fn the_interpolation_error_is_within_the_stated_bound() {
    for (frequency, part) in [(5.0, 0.3), (10.0, 0.3), (2.0, 0.1), (10.0, 0.0)] {
        let motion = |t: f64| (TAU * frequency * t).sin();
        let log = log(
            100.0,
            jitter(500, 100.0, part).map(|t| (t + 0.003, [motion(t + 0.003), t + 0.003])),
        );
        assert_eq!(log.sampling_frequency(), 100.0);
        assert!(log.samples() >= 498, "{}", log.samples());
        // The last digits differ, as polynomials have rounding errors.
        let (_, times) = loaded(&log);
        let first = times[0];
        for (k, time) in times.iter().enumerate() {
            assert!(
                (time - first - k as f64 / 100.0).abs() < 1e-9,
                "{k}: {time}"
            );
        }
        // Steps are at most (1 + 2 part) hundredths of a second; the bound is larger at the ends.
        let derivative = (TAU * frequency * (1.0 + 2.0 * part) / 100.0).powi(6);
        let own = error(&log, motion);
        assert!(
            own < 0.024 * derivative + 1e-12,
            "{frequency}, {part}: {own}"
        );
        let inside = Log::new(
            "inside",
            100.0,
            1,
            loaded(&log).0[3..490].to_vec(),
            times[3..490].to_vec(),
            false,
        );
        let inside = error(&inside.expect("a log"), motion);
        assert!(
            inside < 0.0049 * derivative + 1e-12,
            "{frequency}, {part}: {inside}"
        );
        println!(
            "{frequency} Hz at 100 Hz, {part} of a step: {own:.2e} at most, {inside:.2e} inside"
        );
    }
}

#[test]
fn uniform_samples_are_unchanged() {
    let rows = (0..300_u32).map(|k| (f64::from(k) / 64.0, [f64::from(k % 7), f64::from(k)]));
    let log = log(64.0, rows);
    let (positions, torques) = loaded(&log);
    assert_eq!(torques, (0..300).map(f64::from).collect::<Vec<_>>());
    assert_eq!(
        positions,
        (0..300_u32).map(|k| f64::from(k % 7)).collect::<Vec<_>>()
    );
    let note = log.note().expect("a note");
    assert!(
        note.ends_with("was resampled at 64 Hz from about 64 Hz, by polynomials of degree 5"),
        "{note}"
    );
}

#[test]
fn downsampling_does_not_alias() {
    // At 100 Hz, 180 Hz would look like 20 Hz.
    let slow = |t: f64| (TAU * 3.0 * t).sin() + 0.5 * (TAU * 30.0 * t).cos();
    let motion = |t: f64| slow(t) + (TAU * 180.0 * t).sin();
    let rows = jitter(4000, 1000.0, 0.2).map(|t| (t, [motion(t), t]));
    let own = log(100.0, rows);
    let worst = error(&own, slow);
    println!("{worst:.2e} of a sine of 180 Hz is left at 100 Hz");
    assert!(worst < 1e-3, "{worst}");
    // The kernel's length is excluded at both ends, 0.13 s each.
    assert!((373..=375).contains(&own.samples()), "{}", own.samples());
    let note = own.note().expect("a note");
    assert!(
        note.contains("was resampled at 100 Hz from about")
            && note.ends_with("after a low-pass filter at 40 Hz"),
        "{note}"
    );
    // Noise that changes from sample to sample nearly vanishes.
    let rows =
        jitter(4000, 1000.0, 0.0).map(|t| (t, [((1000.0 * t).round() % 2.0) * 2.0 - 1.0, t]));
    let worst = error(&log(100.0, rows), |_| 0.0);
    assert!(worst < 1e-3, "{worst}");
}

#[test]
fn nearly_coincident_samples_do_not_amplify_noise() {
    // Every second sample is a microsecond after the previous one, with noise of size 1.
    let rows = (0..2000_u32).map(|k| {
        let time = f64::from(k / 2) / 100.0 + f64::from(k % 2) * 1e-6 + f64::from(k / 2 % 3) * 1e-3;
        (time, [if k % 2 == 0 { 1.0 } else { -1.0 }, time])
    });
    let log = log(80.0, rows.filter(|(t, _)| *t > 0.0));
    assert!(loaded(&log).0.iter().all(|value| value.abs() < 3.0));
}

#[test]
fn time_columns_may_be_expressions_in_several_files() {
    let motion = |t: f64| (TAU * 2.0 * t).sin();
    let times: Vec<f64> = jitter(1000, 200.0, 0.2).map(|t| t + 1.0).collect();
    let rows = times
        .iter()
        .map(|t| format!("{},{},{t}\n", 1000.0 * t, motion(*t)));
    let file = format!("ms,q,tau\n{}", rows.collect::<String>());
    let mapping = Mapping {
        time: Time::Column(String::from("ms/1000")),
        ..at(100.0)
    };
    let own = run("a.csv", &[("a.csv", file.as_bytes())], &mapping);
    let own = own.unwrap_or_else(|error| panic!("{error}"));
    assert!(error(&own, motion) < 1e-4);
    // Positions at 200 Hz from 1 s on; torques, which are the times, at 500 Hz from 1.5 s on.
    let positions = times.iter().map(|t| format!("{t},{}\n", motion(*t)));
    let positions = format!("t,q\n{}", positions.collect::<String>());
    let torques = jitter(2000, 500.0, 0.2).map(|t| format!("{0},{0}\n", t + 1.5));
    let torques = format!("t,tau\n{}", torques.collect::<String>());
    let files = [
        ("a.csv", positions.as_bytes()),
        ("b.csv", torques.as_bytes()),
    ];
    let own = run("a.csv+b.csv", &files, &at(100.0)).unwrap_or_else(|error| panic!("{error}"));
    let (_, all) = loaded(&own);
    assert!(all[0] > 1.62 && all[0] < 1.65, "{}", all[0]);
    assert!(all[all.len() - 1] > 5.33, "{}", all[all.len() - 1]);
    assert!(error(&own, motion) < 1e-4);
    let note = own.note().expect("a note");
    assert!(
        note.contains("b.csv was resampled at 100 Hz onto common times"),
        "{note}"
    );
    // Times without overlap.
    let late = torques.replace("\n", "\n1");
    let files = [("a.csv", positions.as_bytes()), ("b.csv", late.as_bytes())];
    let output = run("a.csv+b.csv", &files, &at(100.0)).expect_err("apart");
    assert!(output.contains("when a.csv has ended at"), "{output}");
}

#[test]
fn invalid_resampling_is_rejected() {
    let uneven = || jitter(1000, 100.0, 0.3).map(|t| (t, [t, t]));
    let output = run(
        "a.csv",
        &[("a.csv", text(uneven()).as_bytes())],
        &timed("q", "tau"),
    );
    let output = output.expect_err("not uniform");
    assert!(
        output.contains("the time is not uniform") && output.contains(" Hz\"` in [data]"),
        "{output}"
    );
    let output = |rate: f64| resampled(rate, uneven()).expect_err("a rate");
    assert!(
        output(2000.0).contains("which is more than ten times its"),
        "{}",
        output(2000.0)
    );
    assert!(
        output(0.01).contains("which is less than a thousandth of its"),
        "{}",
        output(0.01)
    );
    assert!(
        output(f64::NAN).contains("can't be resampled at NaN Hz"),
        "{}",
        output(f64::NAN)
    );
    assert!(
        output(-1.0).contains("can't be resampled at -1 Hz"),
        "{}",
        output(-1.0)
    );
    let gap = resampled(100.0, uneven().filter(|(t, _)| *t < 5.0 || *t > 5.1)).expect_err("a gap");
    assert!(
        gap.contains("the time steps from 4.99") && gap.contains("cut the run there"),
        "{gap}"
    );
    let back = resampled(
        100.0,
        uneven().map(|(t, own)| (if t > 5.0 { t - 1.0 } else { t }, own)),
    );
    let back = back.expect_err("back");
    assert!(back.contains("the time steps from 4.99"), "{back}");
    let constant = resampled(100.0, uneven().map(|(_, own)| (1.0, own))).expect_err("stands");
    assert!(
        constant.contains("the time steps from 1 s to 1 s"),
        "{constant}"
    );
    let short = resampled(10.0, uneven().take(40)).expect_err("short");
    assert!(short.contains("the run is empty"), "{short}");
    let mapping = Mapping {
        time: Time::Frequency(100.0),
        ..at(10.0)
    };
    let output =
        run("a.csv", &[("a.csv", text(uneven()).as_bytes())], &mapping).expect_err("no time");
    assert!(
        output.contains("uniform and can't be resampled"),
        "{output}"
    );
    let broken = text(uneven()).replace("\n0.5", "\nx0.5");
    let output = run("a.csv", &[("a.csv", broken.as_bytes())], &at(100.0)).expect_err("a cell");
    assert!(output.contains("is not a number"), "{output}");
}

/// Position of the tests below: slow against 1 kHz.
fn slow(t: f64) -> f64 {
    (TAU * 2.0 * t).sin()
}

#[test]
fn repeated_bus_rows_are_left_out_and_noted() {
    // Every 16th row repeats the numbers of the one before, at its own time.
    let rows = jitter(4000, 1000.0, 0.2).scan(0.0, |last, t| {
        let is_repeat = (t * 1000.0).round() as u32 % 16 == 5;
        *last = if is_repeat { *last } else { t };
        Some((t, [slow(*last), *last]))
    });
    let log = log(1000.0, rows);
    assert!(error(&log, slow) < 1e-6);
    let note = log.note().expect("a note");
    assert!(
        note.contains("250 rows that repeat the one before left out"),
        "{note}"
    );
}

#[test]
fn standstill_rows_are_not_left_out_as_repeats() {
    let rows = (0..4000).map(|k| {
        let t = f64::from(k) / 1000.0;
        let moved = (t.min(1.0), (t - 2.0).max(0.0));
        (t, [slow(moved.0) + moved.1, 1.0])
    });
    let log = log(1000.0, rows);
    let (positions, _) = loaded(&log);
    assert_eq!(log.samples(), 4000);
    assert!(
        (positions[1500] - slow(1.0)).abs() < 1e-3,
        "{}",
        positions[1500]
    );
    assert!(
        (positions[3000] - slow(1.0) - 1.0).abs() < 1e-3,
        "{}",
        positions[1500]
    );
    assert!(
        !log.note().expect("a note").contains("repeat"),
        "{:?}",
        log.note()
    );
}

#[test]
fn short_gaps_are_interpolated_and_long_ones_rejected() {
    let rows = |gap: f64| {
        let times = (0..4000).map(|k| f64::from(k) / 1000.0);
        let kept = times.filter(move |t| !(*t > 2.0 && *t < 2.0 + gap - 1e-9));
        kept.map(|t| (t, [slow(t), t]))
    };
    let short = log(1000.0, rows(0.0085));
    assert!(error(&short, slow) < 1e-5, "{}", error(&short, slow));
    let note = short.note().expect("a note");
    assert!(
        note.contains("1 gap of up to 9.0 ms interpolated"),
        "{note}"
    );
    let long = resampled(1000.0, rows(0.05)).expect_err("a long gap");
    assert!(long.contains("the time steps from 2 s to 2.05 s"), "{long}");
    // At 10 Hz, three and a half steps are more.
    let slow_rows = |k: u32| (f64::from(k) / 10.0, [f64::from(k), 1.0]);
    assert!(resampled(10.0, (0..50).filter(|k| *k != 20).map(slow_rows)).is_ok());
}
