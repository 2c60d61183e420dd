//! Memory for large Parquet files, measured by a counting allocator.

#[path = "common/parquet.rs"]
mod parquet_file;

use std::fs::File;

use overact_logs::read;
use overact_logs::{Gain, Mapping, Time};
use overact_tier::by_tier;
use parquet::file::properties::WriterProperties;
use parquet_file::{Cells, write_into};
use peak_alloc::PeakAlloc;

#[global_allocator]
static ALLOCATOR: PeakAlloc = PeakAlloc;

/// More than are kept in memory.
const SAMPLES: u32 = 700_000;

#[test]
fn a_large_file_is_not_loaded_into_memory() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("large.parquet");
    let schema = "message log { required double t; required double q; required float tau; }";
    {
        let numbers = |scale: f64| -> Vec<f64> {
            let all = 0..SAMPLES;
            all.map(|k| f64::from(k) / scale).collect()
        };
        let torques: Vec<f32> = (0..SAMPLES).map(|k| (k % 1000) as f32 / 8.0).collect();
        let columns = [
            Cells::Double(&numbers(1000.0)),
            Cells::Double(&numbers(64.0)),
            Cells::Float(&torques),
        ];
        let output = File::create(&path).expect("a file");
        let properties = WriterProperties::builder().set_dictionary_enabled(false);
        // All rows are in one group, as writers do for up to a million rows.
        write_into(output, properties.build(), schema, &columns, usize::MAX);
    }
    let mapping = Mapping {
        time: Time::Column(String::from("t")),
        positions: vec![String::from("q")],
        torques: vec![String::from("tau")],
        velocities: Vec::new(),
        position_scale: vec![1.0],
        position_offset: Vec::new(),
        torque_gain: vec![Gain::Value(1.0)],
        resample: None,
        transmission: Vec::new(),
        rotating: Vec::new(),
    };
    let log = read(&path, &mapping, false).unwrap_or_else(|error| panic!("{error}"));
    assert!(!log.in_memory());
    ALLOCATOR.reset_peak_usage();
    let before = ALLOCATOR.current_usage_as_mb();
    // Repeatedly, as filters and checks read a run.
    for _ in 0..by_tier([1, 3]) {
        let mut reader = log.reader().expect("a reader");
        let mut sample = 0_u32;
        while let Some(block) = reader.next().expect("a block") {
            for (position, torque) in block.positions.iter().zip(&block.torques) {
                assert_eq!(*position, f64::from(sample) / 64.0);
                assert_eq!(*torque, f64::from(sample % 1000) / 8.0);
                sample += 1;
            }
        }
        assert_eq!(sample, SAMPLES);
    }
    let most = ALLOCATOR.peak_usage_as_mb() - before;
    println!("at most {most:.1} MB more than before were in memory at a time");
    // All values of the file take 14 MB.
    assert!(most < 4.0, "{most} MB");
}
