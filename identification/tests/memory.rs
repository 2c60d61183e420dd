//! Memory does not grow with the log: more samples take hardly more.
//!
//! The test is alone in its file, and so in its process, whose largest resident size it asks for.

mod common;
#[path = "common/dualv.rs"]
mod dualv;

use std::{
    cell::Cell,
    fs::{self, File},
    io::{BufWriter, Write},
    path::Path,
};

use dualv::{DualV, experiment, records, settings};
use overact::Model;
use overact_identification::{Experiment, Mapping, Progress, Settings, data::read_csv, identify};
use overact_simulation::Record;

/// The largest resident size of this process so far, MB; `None` where the system does not tell.
fn peak() -> Option<f64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kilobytes: f64 = line.split_whitespace().next()?.parse().ok()?;
    Some(kilobytes / 1024.0)
}

/// Writes a log that repeats a record of whole periods, line by line.
fn write(path: &Path, record: &Record, times: usize) {
    let mut file = BufWriter::new(File::create(path).expect("a file"));
    let names = |prefix: &str| -> String {
        let names = record.actuators.iter();
        names.map(|name| format!(",{prefix}_{name}")).collect()
    };
    writeln!(file, "time{}{}", names("q"), names("tau")).expect("written");
    let rows = record.positions.chunks_exact(4);
    let rows: Vec<String> = rows
        .zip(record.torques.chunks_exact(4))
        .map(|(q, tau)| {
            let cells = q.iter().chain(tau).map(|value| format!(",{value:.6}"));
            cells.collect()
        })
        .collect();
    for k in 0..times * rows.len() {
        let time = k as f64 / record.sampling_hz;
        writeln!(file, "{time:.3}{}", rows[k % rows.len()]).expect("written");
    }
}

/// Identifies from a log that repeats the record; progress is told all the way.
fn identified(robot: &DualV, folder: &Path, record: &Record, times: usize) {
    let path = folder.join("long.csv");
    write(&path, record, times);
    let log = read_csv(&path, &Mapping::for_robot(&robot.info()), false).expect("a log");
    assert!(!log.in_memory());
    let settings = Settings {
        // Few equations, so that what is kept of them to judge their residuals is small beside the log.
        decimation: 400,
        ..settings(robot)
    };
    let told = Cell::new(0);
    let result = identify(
        robot,
        &Experiment {
            runs: std::slice::from_ref(&log),
            validation: &[],
            true_values: None,
        },
        &settings,
        &|progress| {
            if let Progress::Run { done, samples, .. } = progress {
                assert!(done <= samples);
                told.set(told.get() + 1);
            }
        },
    )
    .expect("an identification");
    assert_eq!(result.runs[0].samples, times * record.time.len());
    // A block of some thousand samples at a time.
    assert!(told.get() > log.samples() / 5000, "{}", told.get());
}

#[test]
fn more_samples_take_hardly_more_memory() {
    if peak().is_none() {
        println!("skipped: this system does not tell the memory of a process");
        return;
    }
    let robot = DualV::new();
    let mut experiment = experiment(&robot, 1.0, 1);
    // Five periods of 1 Hz.
    experiment.duration_s = 5.0;
    experiment.runs.retain(|run| run.name == "unloaded 2");
    let record = records(&robot, &experiment).remove(0);
    let folder = tempfile::tempdir().expect("a folder");
    // The first time, threads and the allocator take what they keep.
    identified(&robot, folder.path(), &record, 27);
    identified(&robot, folder.path(), &record, 27);
    let short = peak().expect("a size");
    identified(&robot, folder.path(), &record, 67);
    let long = peak().expect("a size");
    // The numbers of the additional samples alone would take 12.8 MB.
    println!("largest resident size: {short:.1} MB, then {long:.1} MB");
    assert!(long < short + 5.0, "{short} MB, then {long} MB");
}
