//! Replay of runs through the online filter, against the batch estimate of the same rows.

use overact_identification::{
    Estimate, ForgettingRule, Identification, Log, OnlineEstimate, OnlineSettings, Stage,
};
use overact_robot::{Identifier, Robot};
use overact_tier::is_full;
use std::path::{Path, PathBuf};

/// A file in the folder of reference data: `OVERACT_SHARED`, or `shared` next to the repository.
fn shared(name: &str) -> Option<PathBuf> {
    let folder = std::env::var_os("OVERACT_SHARED").map_or_else(
        || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared"),
        PathBuf::from,
    );
    let file = folder.join("data").join(name);
    if file.exists() {
        return Some(file);
    }
    eprintln!("skipped: {name} is not here; set OVERACT_SHARED to the folder of reference data");
    None
}

/// A file of the repository as text.
fn text(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(name);
    std::fs::read_to_string(path).expect("a text")
}

fn library(name: &str) -> Robot {
    Robot::from_text("robot.toml", &text(&format!("robots/{name}.toml"))).expect("a robot")
}

/// An identification with a replay.
fn replayed(robot: &Robot, runs: &[Log], online: OnlineSettings) -> Identification {
    let mut settings = robot.settings(runs[0].sampling_frequency());
    settings.online = Some(online);
    let identifier = Identifier::new(robot).runs(runs).settings(settings);
    identifier.run().expect("a result")
}

fn base(result: &Identification) -> &Estimate {
    let base = &result.estimates[0];
    assert_eq!(base.stage, Stage::Base);
    base
}

/// Requires the last estimate to equal that of the batch.
fn check_last(result: &Identification) {
    let base = base(result);
    let last = result.online.last().expect("estimates over time");
    let mut largest = 0.0_f64;
    for (place, one) in base.parameters.iter().enumerate() {
        let value = last.values[place].expect("a determined parameter");
        let deviation = last.standard_deviations[place].expect("a deviation");
        let difference = (value - one.value).abs() / (one.value.abs() + one.standard_deviation);
        largest = largest.max(difference);
        assert!(difference < 1e-10, "{}: {value} {}", one.name, one.value);
        let ratio = deviation / one.correlated_standard_deviation;
        assert!((ratio - 1.0).abs() < 1e-7, "{}: {ratio}", one.name);
    }
    println!(
        "{}: {} parameters, largest relative difference {largest:.1e}, {} changes",
        result.robot,
        base.parameters.len(),
        changes(&result.online)
    );
}

fn changes(online: &[OnlineEstimate]) -> usize {
    online.iter().filter(|one| one.change.is_some()).count()
}

#[test]
fn emps_ends_with_the_batch_estimate() {
    let Some(file) = shared("emps/DATA_EMPS.mat") else {
        return;
    };
    let robot = library("emps");
    let runs = robot.read_logs(&[(&file, false)], &|_| {}).expect("a log");
    let result = replayed(&robot, &runs, OnlineSettings::default());
    check_last(&result);
    // Deviations decrease, and the times are those of the log.
    let deviations = result.online.iter().map(|one| one.standard_deviations[0]);
    let known: Vec<f64> = deviations.flatten().collect();
    assert!(
        known
            .windows(2)
            .all(|pair| pair[1] <= pair[0] * (1.0 + 1e-12))
    );
    let duration = runs[0].samples() as f64 / runs[0].sampling_frequency();
    let last = result.online.last().expect("an estimate");
    assert!((last.time - duration).abs() < 1e-9);
    assert!(result.online.len() > 300);
    // With forgetting, the last estimate is that of the last part of the log.
    for forgetting in [
        ForgettingRule::Exponential(0.99),
        ForgettingRule::Directional(0.99),
    ] {
        let online = OnlineSettings {
            forgetting,
            ..OnlineSettings::default()
        };
        let forgetful = replayed(&robot, &runs, online);
        let last = forgetful.online.last().expect("an estimate");
        let deviation = last.standard_deviations[0].expect("a deviation");
        let all = base(&forgetful).parameters[0].correlated_standard_deviation;
        assert!(deviation > 1.2 * all, "{deviation} {all}");
        let mass = last.values[0].expect("a value");
        assert!((mass - 95.1).abs() < 4.0 * deviation, "{mass} {deviation}");
    }
}

#[test]
fn dualv_ends_with_the_batch_estimate_and_its_payload() {
    let robot = library("dualv");
    let mut experiment = robot.experiment().expect("an experiment");
    experiment.plan_mut().duration_s = 3.0;
    let runs = experiment.runs(&robot.held_out(), &|_, _| {});
    let runs = runs.expect("runs").identified;
    let result = replayed(&robot, &runs, OnlineSettings::default());
    check_last(&result);
    let places = base(&result).parameters.iter();
    let payload = { places }
        .position(|one| one.name == "m_payload")
        .expect("a payload");
    for point in &result.online {
        let is_loaded = point.run.starts_with("loaded");
        // Robot parameters are known before the payload is seen.
        if point.run == "unloaded 2" {
            assert!(point.values[0].is_some());
        }
        assert!(is_loaded || point.values[payload].is_none(), "{point:?}");
    }
}

/// Full tier only: it is the longest measured log.
#[test]
fn tx40_ends_with_the_batch_estimate() {
    let files = ["pos_read_data.csv", "curr_data.csv"].map(|file| shared(&format!("tx40/{file}")));
    let [Some(positions), Some(currents)] = files else {
        return;
    };
    if !is_full() {
        return;
    }
    let robot = library("tx40");
    let log = PathBuf::from(format!("{}+{}", positions.display(), currents.display()));
    let runs = robot.read_logs(&[(&log, false)], &|_| {}).expect("a log");
    check_last(&replayed(&robot, &runs, OnlineSettings::default()));
}

/// The UR10e of the tutorial, with gains multiplied by factors.
fn ur10e(factors: &[f64], identification: &str) -> Robot {
    let page = text("docs/tutorial-serial.md");
    let start = page.find("name = \"Ur10e\"").expect("the description");
    let end = page[start..].find("```").expect("its end");
    let mut text = page[start..start + end].to_owned();
    let gains = [14.87, 13.26, 11.13, 10.62, 11.03, 11.47];
    for (gain, factor) in gains.iter().zip(factors) {
        text = text.replace(
            &format!("{gain} N m/A"),
            &format!("{} N m/A", gain * factor),
        );
    }
    Robot::from_text("ur10e.toml", &(text + identification)).expect("a robot")
}

/// Full tier only: it identifies gains and parameters of two pairs of logs.
#[test]
fn payload_of_the_ur10e_is_known_soon_after_pick_up() {
    const MASS: f64 = 2.805;
    let names = [
        "15harm_unloaded",
        "15harm_loaded",
        "14harm_unloaded",
        "14harm_loaded",
    ];
    let files = names.map(|name| shared(&format!("ur10e/{name}.csv")));
    let [Some(a), Some(b), Some(c), Some(d)] = &files else {
        return;
    };
    if !is_full() {
        return;
    }
    for (gains_from, identified) in [([a, b], [c, d]), ([c, d], [a, b])] {
        let known = format!("gains = true\n\n[identification.known]\nm_payload = \"{MASS} kg\"\n");
        let robot = ur10e(&[1.0; 6], &known);
        let read = |robot: &Robot, [empty, loaded]: [&PathBuf; 2]| {
            let logs = [(empty.as_path(), false), (loaded.as_path(), true)];
            robot.read_logs(&logs, &|_| {}).expect("logs")
        };
        let result = Identifier::new(&robot)
            .runs(&read(&robot, gains_from))
            .run();
        let factors = result.expect("gains").gains;
        let factors: Vec<f64> = factors.iter().map(|one| one.factor).collect();
        let robot = ur10e(&factors, "");
        let runs = read(&robot, identified);
        let result = replayed(&robot, &runs, OnlineSettings::default());
        check_last(&result);
        let start = runs[0].samples() as f64 / runs[0].sampling_frequency();
        let place = base(&result).parameters.iter();
        let place = { place }
            .position(|one| one.name == "m_payload")
            .expect("a mass");
        let mass = &base(&result).parameters[place];
        let is_good = |point: &&OnlineEstimate| {
            let value = point.values[place];
            let (Some(value), Some(deviation)) = (value, point.standard_deviations[place]) else {
                return false;
            };
            let half = 1.96 * deviation;
            (value - MASS).abs() <= half && half <= 0.05 * value
        };
        let found = result.online.iter().find(is_good).expect("a good interval");
        println!(
            "gains {factors:.3?}: m_payload {:.3} ± {:.3} kg at the end; interval good {:.1} s after the start of the loaded run: {:.3} ± {:.3} kg",
            mass.value,
            1.96 * mass.correlated_standard_deviation,
            found.time - start,
            found.values[place].expect("a value"),
            1.96 * found.standard_deviations[place].expect("a deviation"),
        );
        for point in result.online.iter().filter(|one| one.change.is_some()) {
            println!(
                "change at {:.1} s in {}: {:?}",
                point.time, point.run, point.change
            );
        }
        assert!(found.time - start < 50.0);
    }
}
