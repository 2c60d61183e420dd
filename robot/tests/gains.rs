//! Drive gains identified from virtual experiments with a payload of known mass.

use overact::Model;
use overact_identification::{
    CheckKind, Gains, Grade, Identification, Log, Settings, Stage, drive_gains,
};
use overact_robot::{Identifier, Robot, Runs};
use overact_tier::{by_tier, drawn};
use std::{collections::BTreeMap, f64::consts::TAU, path::Path};

fn text(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(path.join("../robots").join(name)).expect("a description")
}

fn robot(text: &str) -> Robot {
    Robot::from_text("robot.toml", text).expect("a robot")
}

/// The DualV with these settings.
fn dualv(identification: &str) -> String {
    let text = text("dualv.toml");
    assert_eq!(text.matches("[identification]\n").count(), 1);
    text.replace(
        "[identification]\n",
        &format!("[identification]\n{identification}\n"),
    )
}

/// The DualV, sampled less often than in the paper.
fn coarse(identification: &str) -> String {
    let text = dualv(identification).replace("sampling = \"5 kHz\"", "sampling = \"1 kHz\"");
    let coarse = text.replace("decimation = 50", "decimation = 10");
    assert_ne!(coarse, text);
    coarse
}

const KNOWN_PAYLOAD: &str = "gains = true\nknown = { m_payload = \"5.42 kg\" }";

/// True gains of the DualV's drives.
const TRUE_GAINS: [f64; 4] = [1.12, 0.83, 1.33, 0.72];

/// Gaussian noise.
struct Noise(u64);

impl Noise {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.0;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed ^ (mixed >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.uniform()).ln()).sqrt();
        radius * (TAU * self.uniform()).cos()
    }
}

/// Runs of the virtual experiment without noise, with a duration (s).
fn exact(robot: &Robot, duration: f64) -> Runs {
    let mut experiment = robot.experiment().expect("an experiment");
    let plan = experiment.plan_mut();
    plan.duration_s = duration;
    plan.torque_noise = Vec::new();
    plan.encoder_resolution = Vec::new();
    let held_out = robot.held_out();
    experiment.runs(&held_out, &|_, _| {}).expect("runs")
}

/// Runs as logged with such gains: torques with noise of standard deviations (N m), divided by the
/// gains.
fn logged(runs: &[Log], gains: &[f64], deviations: &[f64], seed: u64) -> Vec<Log> {
    let mut noise = Noise(seed.wrapping_mul(0xd134_2543_de82_ef95));
    let log = |log: &Log| {
        let (positions, mut torques) = log.load().expect("a run");
        for row in torques.chunks_exact_mut(gains.len()) {
            for ((torque, gain), deviation) in row.iter_mut().zip(gains).zip(deviations) {
                *torque = (*torque + deviation * noise.normal()) / gain;
            }
        }
        let (frequency, n) = (log.sampling_frequency(), gains.len());
        Log::new(log.name(), frequency, n, positions, torques, log.payload()).expect("a log")
    };
    runs.iter().map(log).collect()
}

fn found(robot: &Robot, runs: &[Log], settings: &Settings) -> Gains {
    drive_gains(robot.model(), runs, settings, &|_, _, _| {}).expect("gains")
}

/// Error of each gain in standard deviations.
fn misses(found: &Gains, truth: &[f64]) -> Vec<f64> {
    let each = found.drives.iter().zip(truth);
    each.map(|(own, truth)| (own.factor - truth) / own.deviation)
        .collect()
}

/// Message if no gains are identified.
fn refused(robot: &Robot, runs: &[Log]) -> String {
    let identifier = Identifier::new(robot).runs(runs).gains(true);
    let error = identifier.run().expect_err("no gains");
    error.render(false)
}

/// Asserts that jointly estimated parameters are within three standard deviations.
fn check_joint(result: &Identification) {
    let truth: BTreeMap<&str, Option<f64>> = result
        .base_parameters
        .iter()
        .map(|one| (one.name.as_str(), one.true_value))
        .collect();
    for name in [
        "m_platform",
        "zz_payload",
        "mx_payload",
        "zz_1_leg1",
        "zz_1_leg4",
    ] {
        let mut all = result.gain_parameters.iter();
        let own = all.find(|one| one.name.trim_end_matches('R') == name);
        let own = own.expect(name);
        let truth = truth[own.name.as_str()].expect("a true value");
        let miss = (own.value - truth) / own.deviation;
        println!("{}: {} ± {}, {truth}", own.name, own.value, own.deviation);
        assert!(miss.abs() < 3.0, "{own:?}, {truth}");
    }
}

#[test]
fn a_weighed_payload_determines_gains_and_masses_of_a_dualv() {
    let robot = robot(&by_tier([coarse(KNOWN_PAYLOAD), dualv(KNOWN_PAYLOAD)]));
    let exact = exact(&robot, by_tier([1.0, 4.0]));
    let truth = exact.true_values.clone().expect("true values");
    for seed in 1..=by_tier([1, 3]) {
        let runs = Runs {
            identified: logged(&exact.identified, &TRUE_GAINS, &[0.5; 4], seed),
            validation: logged(&exact.validation, &TRUE_GAINS, &[0.5; 4], seed + 100),
            true_values: exact.true_values.clone(),
        };
        let result = Identifier::new(&robot).data(&runs).run();
        let result = result.expect("an identification");
        for (own, truth) in result.gains.iter().zip(TRUE_GAINS) {
            let miss = (own.factor - truth) / own.deviation;
            println!(
                "{}: {} ± {}, {truth}, by TLS {:?}",
                own.actuator, own.factor, own.deviation, own.total_least_squares
            );
            assert!(miss.abs() < 3.0, "{own:?}, {truth}");
            assert!(own.deviation < 0.05 * truth, "{own:?}");
        }
        check_joint(&result);
        // Estimates with the corrected torques have these masses as well.
        let all = result
            .by_least_squares()
            .find(|one| one.stage == Stage::Base);
        let all = &all.expect("an estimate").parameters;
        let mass = all
            .iter()
            .find(|one| one.name == "m_payload")
            .expect("the mass");
        assert!(
            (mass.value / truth["m_payload"] - 1.0).abs() < 0.02,
            "{mass:?}"
        );
        let warned = result
            .warnings
            .iter()
            .filter(|one| one.contains("torque_gain"));
        assert_eq!(warned.count(), 4, "{:?}", result.warnings);
        let worst = result
            .cross_validation
            .iter()
            .map(|one| one.relative_error_percent);
        assert!(worst.fold(0.0, f64::max) < 20.0, "{:?}", result.warnings);
    }
}

/// Each known value of the payload determines the scale; the other one tests it.
#[test]
fn known_values_that_contradict_each_other_are_reported() {
    let known = |mass: &str| {
        format!("gains = true\nknown = {{ m_payload = \"{mass}\", mx_payload = -0.127 }}")
    };
    let true_robot = robot(&coarse(&known("5.42 kg")));
    let exact = exact(&true_robot, 1.0);
    let runs = logged(&exact.identified, &TRUE_GAINS, &[0.5; 4], 1);
    let check = |mass: &str| {
        let robot = robot(&coarse(&known(mass)));
        let result = Identifier::new(&robot).runs(&runs).gains(true).run();
        let checks = result.expect("an identification").checks;
        let mut known = checks.into_iter();
        known
            .find(|one| one.kind == CheckKind::KnownValues)
            .expect("a check of the known values")
    };
    let right = check("5.42 kg");
    assert!(right.passed, "{right:?}");
    let wrong = check("6.2 kg");
    assert_eq!(wrong.grade, Grade::DoNotUse, "{wrong:?}");
    for part in [
        "contradict",
        "`m_payload` is known to be 6.2 kg",
        "`mx_payload`",
    ] {
        assert!(wrong.words.contains(part), "{part}: {}", wrong.words);
    }
}

/// Errors have zero mean and the stated standard deviations if the drives' noise differs and is
/// large.
#[test]
fn standard_deviations_of_gains_match_their_errors() {
    let robot = robot(&coarse(KNOWN_PAYLOAD));
    let exact = exact(&robot, by_tier([1.0, 4.0]));
    let settings = robot.settings(1000.0);
    let draws = drawn([4, 100, 100]);
    let noise = [0.5, 1.0, 2.0, 1.0];
    let (mut squares, mut sums) = ([0.0; 4], [0.0; 4]);
    let mut plain = [0.0; 4];
    for draw in 0..draws {
        let runs = logged(&exact.identified, &TRUE_GAINS, &noise, 1 + draw);
        let found = found(&robot, &runs, &settings);
        for (j, miss) in misses(&found, &TRUE_GAINS).into_iter().enumerate() {
            squares[j] += miss * miss;
            sums[j] += miss;
            plain[j] += found.drives[j].total_least_squares.unwrap_or(f64::NAN) / TRUE_GAINS[j];
        }
    }
    let count = draws as f64;
    let sizes = squares.map(|sum: f64| (sum / count).sqrt());
    let means = sums.map(|sum| sum / count);
    println!(
        "errors in deviations {sizes:?}, their means {means:?}, plain total least squares by the truth {:?}",
        plain.map(|sum| sum / count)
    );
    let [least, largest] = by_tier([[0.2, 2.5], [0.8, 1.2]]);
    assert!(
        sizes.iter().all(|size| (least..largest).contains(size)),
        "{sizes:?}"
    );
    let bias = 4.0 / count.sqrt();
    assert!(means.iter().all(|mean| mean.abs() < bias), "{means:?}");
}

/// The RX90 with a payload on its last body, of known mass and centre of mass.
fn rx90(known: &str) -> String {
    let text = text("rx90.toml");
    let payload = "[[leg.arm.joint]]\nname = \"payload\"\ntype = \"fixed\"\n\n[[place]]";
    let values = "[experiment.parameters]\nm_payload = 5\nmx_payload = 0.25\nmy_payload = -0.1\nmz_payload = 0.9\n\
                  xx_payload = 0.18\nyy_payload = 0.2\nzz_payload = 0.03\n";
    let start = text.find("[[experiment.run]]").expect("a run");
    let end = start
        + 1
        + text[start + 1..]
            .find("[[experiment.run]]")
            .expect("two runs");
    let loaded = text[start..end].replace("\"identification\"", "\"loaded\"\npayload = true");
    let text = text
        .replacen("[[place]]", payload, 1)
        .replacen("[experiment.parameters]\n", values, 1)
        .replacen(
            "decimation = 10",
            &format!("decimation = 10\ngains = true\n{known}"),
            1,
        );
    text + "\n" + &loaded
}

#[test]
fn a_known_payload_determines_gains_of_a_serial_robot() {
    let wrong = [0.88, 1.2, 0.75, 1.33, 1.15, 0.8];
    let robot = robot(&rx90(
        "known = { m_payload = 5, mx_payload = 0.25, my_payload = -0.1, mz_payload = 0.9 }",
    ));
    let exact = exact(&robot, by_tier([2.5, 20.0]));
    let all = [exact.identified, exact.validation].concat();
    let settings = robot.settings(1000.0);
    for seed in 1..=by_tier([1, 5]) {
        let runs = logged(&all, &wrong, &[1.0, 1.0, 0.5, 0.2, 0.2, 0.1], seed);
        let found = found(&robot, &runs, &settings);
        for (own, truth) in found.drives.iter().zip(wrong) {
            println!(
                "{}: {} ± {}, {truth}, by TLS {:?}",
                own.actuator, own.factor, own.deviation, own.total_least_squares
            );
            assert!(own.deviation < 0.1 * truth, "{own:?}");
        }
        assert!(
            misses(&found, &wrong).iter().all(|miss| miss.abs() < 3.5),
            "{found:?}"
        );
    }
}

/// Only the payload's mass is known; its first moments and inertias are not.
///
/// In the default tier, the runs are too short to determine all gains, and those are reported.
#[test]
fn a_payload_mass_alone_determines_gains_of_a_serial_robot() {
    let wrong = [0.88, 1.2, 0.75, 1.33, 1.15, 0.8];
    let robot = robot(&rx90("known = { m_payload = 5 }"));
    let exact = exact(&robot, by_tier([2.5, 20.0]));
    let all = [exact.identified, exact.validation].concat();
    let settings = robot.settings(1000.0);
    for seed in 1..=by_tier([1, 3]) {
        let runs = logged(&all, &wrong, &[1.0, 1.0, 0.5, 0.2, 0.2, 0.1], seed);
        let found = match drive_gains(robot.model(), &runs, &settings, &|_, _, _| {}) {
            Ok(found) => found,
            Err(error) => {
                println!("{error}");
                assert!(!overact_tier::is_full(), "{error}");
                assert!(error.to_string().contains("standard deviation"), "{error}");
                continue;
            }
        };
        for (own, truth) in found.drives.iter().zip(wrong) {
            println!(
                "{}: {} ± {}, {truth}",
                own.actuator, own.factor, own.deviation
            );
        }
        let misses = misses(&found, &wrong);
        assert!(misses.iter().all(|miss| miss.abs() < 3.5), "{misses:?}");
    }
}

/// Intervals of parameters estimated after gains contain the truth, because they include the gains'
/// uncertainty.
#[test]
fn intervals_include_the_uncertainty_of_gains() {
    let robot = robot(&coarse(KNOWN_PAYLOAD));
    let exact = exact(&robot, by_tier([1.0, 4.0]));
    let draws = drawn([1, 10, 20]);
    // Consider parameters that are well known compared to the gains, for which the gains matter.
    let (mut all, mut within, mut narrow) = (0, 0, 0);
    for seed in 1..=draws {
        let runs = Runs {
            identified: logged(&exact.identified, &TRUE_GAINS, &[0.5; 4], seed),
            true_values: exact.true_values.clone(),
            ..Runs::default()
        };
        let result = Identifier::new(&robot).data(&runs).run().expect("a result");
        for estimate in result.by_least_squares() {
            if estimate.stage != Stage::Base {
                continue;
            }
            for own in &estimate.parameters {
                // The known mass is estimated again, with a wide interval.
                let Some(truth) = own.true_value.filter(|_| own.name != "m_payload") else {
                    continue;
                };
                let [low, high] = own.interval_95;
                all += 1;
                within += usize::from((low..=high).contains(&truth));
                let plain = 1.96 * own.standard_deviation;
                narrow += usize::from((own.value - truth).abs() < plain);
            }
        }
    }
    let rates = [within, narrow].map(|count| f64::from(count as u32) / f64::from(all as u32));
    println!("{all} intervals: {rates:.3?} with the gains' part and without");
    assert!(rates[0] > by_tier([0.85, 0.925]), "{rates:?}");
    let gained = by_tier([0.0, 0.02]);
    assert!(rates[0] >= rates[1] + gained, "{rates:?}");
}

/// Torque noise as of a measured arm, relative to the largest torque of each joint.
const ARM_NOISE: f64 = 0.015;

/// An unknown payload on a serial robot with measured noise levels.
#[test]
fn an_unknown_payload_of_a_serial_robot_is_identified() {
    // Only a base parameter is tested, so nothing is eliminated.
    let text = rx90("").replacen("gains = true\n", "essential = false\n", 1);
    assert!(text.contains("essential = false"));
    let robot = robot(&text);
    let exact = exact(&robot, by_tier([5.0, 20.0]));
    let runs = [exact.identified, exact.validation].concat();
    let n = robot.model().info().sizes.actuators;
    let mut peaks = vec![0.0_f64; n];
    for log in &runs {
        let (_, torques) = log.load().expect("a run");
        for row in torques.chunks_exact(n) {
            let each = peaks.iter_mut().zip(row);
            each.for_each(|(peak, own)| *peak = peak.max(own.abs()));
        }
    }
    let noise: Vec<f64> = peaks.iter().map(|peak| ARM_NOISE * peak).collect();
    for seed in 1..=by_tier([1, 5]) {
        let runs = Runs {
            identified: logged(&runs, &vec![1.0; n], &noise, seed),
            true_values: exact.true_values.clone(),
            ..Runs::default()
        };
        let result = Identifier::new(&robot).data(&runs).run().expect("a result");
        let base = result
            .by_least_squares()
            .find(|one| one.stage == Stage::Base);
        let mut all = base.expect("an estimate").parameters.iter();
        let mass = all.find(|one| one.name.starts_with("m_payload"));
        let mass = mass.expect("the payload's mass");
        let truth = mass.true_value.expect("a true value");
        println!(
            "{}: {} in {:?}, {truth}",
            mass.name, mass.value, mass.interval_95
        );
        assert!((mass.value / truth - 1.0).abs() < 0.02, "{mass:?}");
        assert_eq!(mass.name, "m_payload");
    }
}

#[test]
fn undetermined_gains_are_rejected_with_the_reason() {
    let undetermined = robot(&coarse(""));
    let runs = exact(&undetermined, 0.5).identified;
    let output = refused(&undetermined, &runs);
    assert!(output.contains("without a known parameter"), "{output}");
    let payload = robot(&coarse(KNOWN_PAYLOAD));
    let (loaded, unloaded): (Vec<Log>, Vec<Log>) = runs.iter().cloned().partition(Log::payload);
    let output = refused(&payload, &unloaded);
    assert!(
        output.contains("`m_payload` is known, but no run carries the payload"),
        "{output}"
    );
    let output = refused(&payload, &loaded);
    assert!(
        output.contains("combination of those of `m_platform`, which are not"),
        "{output}"
    );
    assert!(output.contains("record some without it"), "{output}");
    let regrouped = robot(&coarse("known = { m_2_leg1 = 1 }"));
    let output = refused(&regrouped, &runs);
    assert!(
        output.contains("`m_2_leg1` is known, but its column is a combination"),
        "{output}"
    );
    let zero = robot(&coarse("known = { mx_payload = 0 }"));
    let output = refused(&zero, &runs);
    assert!(
        output.contains("`mx_payload` is known to be zero"),
        "{output}"
    );
}

#[test]
fn gains_of_coupled_motors_are_not_identified() {
    let coupled = robot(&text("tx40.toml"));
    let output = refused(&coupled, &[]);
    assert!(
        output.contains("motors of this robot turn several"),
        "{output}"
    );
}
