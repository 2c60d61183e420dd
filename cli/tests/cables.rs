//! Cable robots on the command line: virtual experiment, identification, refusals.

mod common;

use common::{Bench, robot};
use serde_json::Value;

#[test]
fn a_virtual_cable_robot_is_identified() {
    let bench = Bench::new();
    let file = &robot("cable_planar.toml");
    bench.good(&["simulate", file, "-o", "log.csv"]);
    // No cable pushes.
    let log = bench.read("log_identification.csv");
    let mut lines = log.lines();
    let names: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
    let tensions = names
        .iter()
        .enumerate()
        .filter(|(_, name)| name.starts_with("tau_"));
    let places: Vec<usize> = tensions.map(|(at, _)| at).collect();
    assert_eq!(places.len(), 4, "{names:?}");
    for line in lines {
        let cells: Vec<&str> = line.split(',').collect();
        for &at in &places {
            let tension: f64 = cells[at].parse().expect("a number");
            assert!(tension > 2.0, "{tension} N");
        }
    }
    let outcome = bench.run(&["identify", file, "--json"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.err);
    let document: Value = serde_json::from_str(&outcome.out).expect("JSON");
    let estimates = document["estimates"].as_array().expect("estimates");
    let mut seen = 0;
    for estimate in estimates.iter().filter(|one| one["stage"] == "recommended") {
        for parameter in estimate["parameters"].as_array().expect("parameters") {
            let [low, high] = [0, 1].map(|at| parameter["interval_95"][at].as_f64());
            let (low, high) = (low.expect("a bound"), high.expect("a bound"));
            let truth = parameter["true_value"].as_f64().expect("a true value");
            let reach = 2.0 * (high - low);
            assert!(truth > low - reach && truth < high + reach, "{parameter}");
            seen += 1;
        }
    }
    assert!(seen > 10, "{seen} parameters");
}

#[test]
fn exciting_runs_of_cable_robots_are_refused() {
    let bench = Bench::new();
    let file = &robot("cable_planar.toml");
    let outcome = bench.run(&["excite", file, "-o", "new.toml"]);
    assert_ne!(outcome.code, Some(0));
    let words = "exciting runs of robots with cables are not supported";
    assert!(outcome.err.contains(words), "{}", outcome.err);
}
