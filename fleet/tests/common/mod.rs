//! A small fleet of five-bar robots: logs and factor files.
#![allow(dead_code)]

#[cfg(feature = "distributed")]
pub(crate) mod cluster;

use overact_identification::{
    Log,
    factors::{RunFactors, write_factors},
};
use overact_robot::Robot;
use overact_simulation::{Fleet, Member};
use std::{
    fs,
    path::{Path, PathBuf},
};

pub(crate) const ROBOTS: usize = 5;
pub(crate) const DAYS: usize = 8;

/// Microseconds of a day.
const DAY: i64 = 86_400_000_000;

/// 2026-03-02, a Monday.
const BEGIN: i64 = 20_514 * DAY;

/// The five-bar of the library with short runs at 200 Hz.
pub(crate) fn description() -> String {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../robots/five_bar.toml");
    let text = fs::read_to_string(file).expect("a robot of the library");
    [
        ("sampling = \"2 kHz\"", "sampling = \"200 Hz\""),
        ("duration = \"10 s\"", "duration = \"3 s\""),
        ("filter_cutoff = \"100 Hz\"", "filter_cutoff = \"20 Hz\""),
        ("decimation = 12", "decimation = 4"),
        ("bandwidth = \"30 Hz\"", "bandwidth = \"6 Hz\""),
        (
            "derivative_cutoff = \"100 Hz\"",
            "derivative_cutoff = \"40 Hz\"",
        ),
    ]
    .iter()
    .fold(text, |text, (from, to)| {
        assert!(text.contains(from), "{from}");
        text.replace(from, to)
    })
}

/// A fleet in its own folder.
pub(crate) struct Bench {
    pub(crate) folder: tempfile::TempDir,
    pub(crate) robot: Robot,
    pub(crate) logs: Vec<(Member, usize, Log)>,
    pub(crate) runs: Vec<RunFactors>,
}

impl Bench {
    pub(crate) fn new() -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("five_bar.toml");
        fs::write(&file, description()).expect("a file");
        let robot = Robot::from_toml(&file).expect("a description");
        let fleet = Fleet {
            days: DAYS,
            seed: 1,
            share: 0.0,
            friction_drift: 0.0,
            moment_drift: 0.0,
        };
        let (mut logs, mut runs) = (Vec::new(), Vec::new());
        let experiment = robot.experiment().expect("an experiment");
        let settings = robot.settings(200.0);
        let factory = robot.factory(&settings).expect("settings that fit");
        for (number, day) in (0..ROBOTS).flat_map(|number| (0..DAYS).map(move |day| (number, day)))
        {
            let member = experiment.member(&fleet, number);
            let record = experiment.day(&fleet, &member, day).expect("a run");
            let log = experiment.log_of(record).expect("a log");
            let time = BEGIN + day as i64 * DAY + DAY / 3;
            runs.push(
                factory
                    .run(&log, &serial(number), Some(time))
                    .expect("a factor"),
            );
            logs.push((member, day, log));
        }
        Self {
            folder,
            robot: Robot::from_toml(&file).expect("a description"),
            logs,
            runs,
        }
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Writes factor files, one for each day.
    pub(crate) fn factor_files(&self, folder: &str) -> PathBuf {
        let folder = self.path(folder);
        fs::create_dir_all(&folder).expect("a folder");
        for day in 0..DAYS {
            let own: Vec<RunFactors> = self.runs.iter().skip(day).step_by(DAYS).cloned().collect();
            let bytes = write_factors(&own).expect("factors");
            fs::write(folder.join(format!("day-{day}.parquet")), bytes).expect("a file");
        }
        folder
    }
}

pub(crate) fn serial(number: usize) -> String {
    format!("R{number:05}")
}
