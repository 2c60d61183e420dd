//! Memory is nearly independent of the log's length.
//!
//! The test is alone in its file and process, whose allocator counts allocations. The process's
//! resident size is less exact: it depends on threads and chance.

mod common;
#[path = "common/dualv.rs"]
mod dualv;

use std::{
    cell::Cell,
    fs::File,
    io::{BufWriter, Write},
    path::Path,
};

use dualv::{DualV, experiment, records, settings};
use overact::Model;
use overact_identification::{Dataset, Instruments, Mapping, Progress, Settings, identify};
use overact_logs::read;
use overact_simulation::Record;
use overact_tier::by_tiers;
use peak_alloc::PeakAlloc;

#[global_allocator]
static ALLOCATOR: PeakAlloc = PeakAlloc;

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

/// Identifies from a log that repeats the record, and returns the peak of allocated memory, MB.
///
/// It also checks that progress is reported throughout.
fn identified(
    robot: &DualV,
    folder: &Path,
    record: &Record,
    (times, instruments): (usize, Instruments),
) -> f64 {
    let path = folder.join("long.csv");
    write(&path, record, times);
    ALLOCATOR.reset_peak_usage();
    let log = read(&path, &Mapping::for_robot(&robot.info()), false).expect("a log");
    assert!(times < 27 || !log.in_memory());
    let settings = Settings {
        // Few equations, so that stored ones are small compared with the log.
        decimation: 400,
        instruments,
        ..settings(robot)
    };
    let output = Cell::new(0);
    let result = identify(
        robot,
        &Dataset {
            runs: std::slice::from_ref(&log),
            validation: &[],
            true_values: None,
            variants: &[],
            scales: None,
        },
        &settings,
        &|progress| {
            if let Progress::Run { done, samples, .. } = progress {
                assert!(done <= samples);
                output.set(output.get() + 1);
            }
        },
    )
    .expect("an identification");
    assert_eq!(result.runs[0].samples, times * record.time.len());
    // A block of some thousand samples at a time.
    assert!(output.get() > log.samples() / 5000, "{}", output.get());
    f64::from(ALLOCATOR.peak_usage_as_mb())
}

/// Repetitions of the record, additional ones, instruments, and allowed additional memory (MB).
///
/// The decimation's buffers are full only after about half a million samples, or more with
/// instruments. Until then they grow.
type Case = (usize, usize, Instruments, f64);

const QUICK: &[Case] = &[(27, 8, Instruments::None, 2.0)];
const THOROUGH: &[Case] = &[
    (107, 40, Instruments::None, 8.0),
    (160, 40, Instruments::Periods, 8.0),
];

#[test]
fn memory_hardly_grows_with_the_number_of_samples() {
    let robot = DualV::new();
    let mut experiment = experiment(&robot, 1.0, 1);
    // Five periods of 1 Hz.
    experiment.duration_s = 5.0;
    experiment.runs.retain(|run| run.name == "unloaded 2");
    let record = records(&robot, &experiment).remove(0);
    let folder = tempfile::tempdir().expect("a folder");
    for &(times, more, instruments, allowed) in by_tiers([QUICK, &THOROUGH[..1], THOROUGH]) {
        let most = |times| identified(&robot, folder.path(), &record, (times, instruments));
        // The first call starts threads and creates tables that stay.
        most(1);
        let (short, long) = (most(times), most(times + more));
        // The samples of twenty additional records alone would take 6.4 MB, those of eight 2.6.
        println!("{instruments:?}: at most {short:.1} MB at a time, then {long:.1} MB");
        assert!(long < short + allowed, "{short} MB, then {long} MB");
    }
}
