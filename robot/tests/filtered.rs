//! Logs with filtered signals, and faultless logs that resemble them.
//!
//! The latter have coarse encoders, whose errors act as accelerations, or a vibrating control loop.

use overact_identification::{Check, CheckKind, Grade, Identification, Log};
use overact_robot::{Identifier, Robot};

const ANKLE: &str = include_str!("../../robots/ankle.toml");
const DELTA: &str = include_str!("../../robots/delta.toml");
const FIVE_BAR: &str = include_str!("../../robots/five_bar.toml");
const DUALV: &str = include_str!("../../robots/dualv.toml");

/// Description with a replaced text.
fn with(text: &str, old: &str, new: &str) -> String {
    let changed = text.replace(old, new);
    assert_ne!(changed, text);
    changed
}

/// Identification from virtual runs whose positions and torques are changed, as rows of actuators.
fn identified(text: &str, change: impl Fn(&mut [f64], &mut [f64], usize)) -> Identification {
    identified_from(usize::MAX, text, change)
}

/// The same from at most `most` runs.
fn identified_from(
    most: usize,
    text: &str,
    change: impl Fn(&mut [f64], &mut [f64], usize),
) -> Identification {
    let robot = Robot::from_text("robot.toml", text).expect("a robot");
    let experiment = robot.experiment().expect("an experiment");
    let runs = experiment.runs(&[], &|_, _| {}).expect("runs");
    let changed = |log: &Log| {
        let (mut positions, mut torques) = log.load().expect("numbers");
        let n = log.actuators();
        change(&mut positions, &mut torques, n);
        let (name, frequency) = (log.name(), log.sampling_frequency());
        Log::new(name, frequency, n, positions, torques, log.payload()).expect("a log")
    };
    let logs = runs.identified.iter().take(most);
    let logs: Vec<Log> = logs.map(changed).collect();
    Identifier::new(&robot).runs(&logs).run().expect("a result")
}

/// First-order low-pass filter of rows; `part` is the step response after one sample.
fn lag(rows: &mut [f64], n: usize, part: f64) {
    for place in n..rows.len() {
        rows[place] = rows[place - n] + part * (rows[place] - rows[place - n]);
    }
}

/// Moving average of rows over `count` samples.
fn mean(rows: &mut [f64], n: usize, count: usize) {
    let (all, half) = (rows.to_vec(), count / 2);
    for place in half * n..rows.len() - half * n {
        let around = (0..=2 * half).map(|k| all[place + k * n - half * n]);
        rows[place] = around.sum::<f64>() / (2 * half + 1) as f64;
    }
}

/// Messages of the failed checks of a kind.
fn found(result: &Identification, kind: CheckKind) -> Vec<String> {
    let own = |one: &&Check| one.kind == kind && !one.passed;
    let own = result.checks.iter().filter(own);
    own.map(Check::located).collect()
}

#[test]
fn low_pass_filtered_delta_signals_are_not_trusted() {
    let lagged = identified(DELTA, |positions, torques, n| {
        // 5 ms at 1 kHz.
        let part = 1.0 - (-0.2_f64).exp();
        lag(positions, n, part);
        lag(torques, n, part);
    });
    assert_ne!(lagged.grade(), Grade::Use);
    assert_eq!(identified(DELTA, |_, _, _| ()).grade(), Grade::Use);
}

#[test]
fn residuals_far_above_noise_after_a_fault_are_unusable() {
    // Torques of one run of an ankle through a low-pass filter of 10 ms at 1 kHz; only the smoothed
    // friction is visible.
    let result = identified_from(1, ANKLE, |_, torques, n| {
        lag(torques, n, 1.0 - (-0.1_f64).exp());
    });
    let words = found(&result, CheckKind::RelativeError).join("; ");
    assert!(words.contains("the faults found explain"), "{words}");
    assert_eq!(result.grade(), Grade::DoNotUse);
}

#[test]
fn a_filter_of_all_signals_is_detected_by_varying_masses() {
    let smooth: Vec<String> = DELTA
        .lines()
        .map(|line| {
            if line.starts_with("fs_") {
                format!("# {line}")
            } else {
                line.to_owned()
            }
        })
        .collect();
    let result = identified(&smooth.join("\n"), |positions, torques, n| {
        mean(positions, n, 17);
        mean(torques, n, 17);
    });
    let words = found(&result, CheckKind::Reversals).join("\n");
    let named = ["16 ms", "17 ms", "18 ms"].map(|time| format!("of all signals over {time};"));
    assert!(
        named.iter().any(|one| words.contains(one.as_str())),
        "{words}"
    );
    assert_ne!(result.grade(), Grade::Use);
}

#[test]
fn coarse_encoders_are_not_reported_as_torque_filters() {
    let coarse = with(FIVE_BAR, "encoder = \"1e-5 rad\"", "encoder = \"1e-4 rad\"");
    let result = identified(&coarse, |_, _, _| ());
    assert_eq!(found(&result, CheckKind::Filters), Vec::<String>::new());
    assert_eq!(found(&result, CheckKind::Reversals), Vec::<String>::new());
    assert_eq!(result.grade(), Grade::Use);
    // A filter is also detected with such encoders: 20 ms at 2 kHz.
    let result = identified(&coarse, |_, torques, n| mean(torques, n, 40));
    let words = found(&result, CheckKind::Filters).join("\n");
    assert!(words.contains("the torques are smoother"), "{words}");
}

#[test]
fn oscillation_from_drive_delay_is_not_reported_as_closure_error() {
    let short = with(DUALV, "duration = \"10 s\"", "duration = \"3 s\"");
    let shaking = with(
        &short,
        "seed = 1\n",
        "seed = 1\ndrives = { delay = \"1 ms\" }\n",
    );
    let result = identified(&shaking, |_, _, _| ());
    assert_eq!(found(&result, CheckKind::Closure), Vec::<String>::new());
    // An encoder offset is still detected.
    let result = identified(&shaking, |positions, _, n| {
        positions.iter_mut().step_by(n).for_each(|q| *q += 3e-3);
    });
    assert!(!found(&result, CheckKind::Closure).is_empty());
}

/// At the edge of the workspace, where swapped positions are reachable but smoother ones are not.
#[test]
fn swapped_positions_are_reported_instead_of_rejected() {
    let short = with(FIVE_BAR, "duration = \"10 s\"", "duration = \"2.5 s\"");
    let result = identified(&short, |positions, _, n| {
        positions.chunks_exact_mut(n).for_each(|row| row.swap(0, 1));
    });
    let words = found(&result, CheckKind::SwappedColumns).join("\n");
    assert!(words.contains("look swapped"), "{words}");
}

#[test]
fn too_small_decimations_are_reported_with_a_larger_one() {
    // At 2 kHz and with a decimation by 2, torques keep 500 Hz; positions are filtered at 100 Hz.
    let text = with(FIVE_BAR, "decimation = 12", "decimation = 2");
    let text = with(&text, "duration = \"10 s\"", "duration = \"4 s\"");
    let result = identified_from(1, &text, |_, _, _| ());
    let filters = found(&result, CheckKind::Filters);
    assert!(
        filters
            .iter()
            .any(|words| words.contains("up to 500 Hz") && words.contains("`decimation = 10`")),
        "{filters:?}"
    );
}
