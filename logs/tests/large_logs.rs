//! Memory for large Parquet and MCAP logs, measured by a counting allocator.
//!
//! `OVERACT_LOG_MB=1000 cargo test --release -p overact-logs --features mcap --test large_logs -- --nocapture`
//! reads files of a gigabyte.

#[cfg(feature = "mcap")]
#[path = "common/mcap.rs"]
mod mcap_file;

use std::{fs::File, path::Path, sync::Arc, time::Instant};

use overact_logs::read;
use overact_logs::{Gain, Mapping, Time};
use overact_tier::by_tier;
use parquet::{
    data_type::DoubleType,
    file::{properties::WriterProperties, writer::SerializedFileWriter},
    schema::parser::parse_message_type,
};
use peak_alloc::PeakAlloc;

#[global_allocator]
static ALLOCATOR: PeakAlloc = PeakAlloc;

/// Six joints.
const JOINTS: usize = 6;

/// Samples written at a time.
const BLOCK: usize = 50_000;

/// Values of a sample: twelve that differ between samples.
fn sample(k: usize) -> [[f64; JOINTS]; 2] {
    let at = |joint: usize, scale: f64| ((k * (joint + 3)) % 100_003) as f64 / scale;
    [
        std::array::from_fn(|joint| at(joint, 64.0)),
        std::array::from_fn(|joint| at(joint + JOINTS, -7.0)),
    ]
}

/// Size of the files in megabytes.
fn size() -> u64 {
    let wanted = std::env::var("OVERACT_LOG_MB");
    let wanted = wanted.ok().and_then(|size| size.parse().ok());
    wanted.unwrap_or(by_tier([12, 60]))
}

/// Writes a Parquet file of the wanted size, and returns its number of samples.
fn write_parquet(path: &Path) -> usize {
    let names =
        (0..JOINTS).map(|joint| format!("required double q{joint}; required double tau{joint};"));
    let schema = format!(
        "message log {{ required double t; {} }}",
        names.collect::<String>()
    );
    let schema = Arc::new(parse_message_type(&schema).expect("a schema"));
    let properties = WriterProperties::builder()
        .set_dictionary_enabled(false)
        .build();
    let output = File::create(path).expect("a file");
    let mut writer =
        SerializedFileWriter::new(output, schema, Arc::new(properties)).expect("a writer");
    let mut count = 0;
    while (writer.bytes_written() as u64) < size() << 20 {
        let mut group = writer.next_row_group().expect("a group");
        let mut place = 0;
        while let Some(mut column) = group.next_column().expect("a column") {
            let value = |k: usize| match place {
                0 => k as f64 / 1000.0,
                _ => sample(k)[(place - 1) % 2][(place - 1) / 2],
            };
            let values: Vec<f64> = (count..count + BLOCK).map(value).collect();
            column
                .typed::<DoubleType>()
                .write_batch(&values, None, None)
                .expect("written");
            column.close().expect("closed");
            place += 1;
        }
        group.close().expect("closed");
        count += BLOCK;
    }
    writer.close().expect("closed");
    count
}

/// Writes an MCAP file with LZ4 compression of the wanted size, and returns its samples.
#[cfg(feature = "mcap")]
fn write_mcap(path: &Path) -> usize {
    use std::io::Write;

    use mcap_file::{JOINT_STATE, beginning, chunk, end, message, state, topic};

    let names = ["a", "b", "c", "d", "e", "f"];
    let mut output = File::create(path).expect("a file");
    let mut written = 0;
    let mut put = |bytes: &[u8]| {
        output.write_all(bytes).expect("written");
        written += bytes.len() as u64;
        written
    };
    put(&beginning());
    let channel = topic(1, "/joint_states", (JOINT_STATE, "cdr"));
    put(&channel);
    let (mut count, mut length) = (0, 0);
    while length < size() << 20 {
        let mut records = Vec::new();
        for k in count..count + BLOCK / 10 {
            let [positions, efforts] = sample(k);
            let nanos = k as u64 * 1_000_000;
            records.extend(message(
                1,
                nanos,
                &state(nanos, &names, [&positions, &[], &efforts]),
            ));
        }
        count += BLOCK / 10;
        let mut packing = lz4_flex::frame::FrameEncoder::new(Vec::new());
        packing.write_all(&records).expect("packed");
        let packed = packing.finish().expect("packed");
        let declared = (records.len() as u64, crc32fast::hash(&records));
        length = put(&chunk("lz4", &packed, declared));
    }
    put(&end(length, &channel));
    count
}

fn mapping(time: &str, resample: Option<f64>, name: impl Fn(usize) -> [String; 2]) -> Mapping {
    Mapping {
        time: Time::Column(time.to_owned()),
        positions: (0..JOINTS).map(|joint| name(joint)[0].clone()).collect(),
        torques: (0..JOINTS).map(|joint| name(joint)[1].clone()).collect(),
        velocities: Vec::new(),
        position_scale: vec![1.0; JOINTS],
        position_offset: Vec::new(),
        torque_gain: vec![Gain::Value(1.0); JOINTS],
        resample,
        transmission: Vec::new(),
        rotating: Vec::new(),
    }
}

/// Reads a log twice, checks all numbers, and prints the memory used.
fn measured(path: &Path, mapping: &Mapping, count: usize) {
    ALLOCATOR.reset_peak_usage();
    let before = ALLOCATOR.current_usage_as_mb();
    let start = Instant::now();
    let log = read(path, mapping, false).unwrap_or_else(|error| panic!("{error}"));
    // At a lower rate a small file has few samples.
    assert!(mapping.resample.is_some() || !log.in_memory());
    let looked = start.elapsed();
    let mut reader = log.reader().expect("a reader");
    let mut k = 0;
    while let Some(block) = reader.next().expect("a block") {
        let rows = block
            .positions
            .chunks_exact(JOINTS)
            .zip(block.torques.chunks_exact(JOINTS));
        for (positions, torques) in rows {
            if mapping.resample.is_none() {
                assert_eq!(
                    [positions, torques],
                    sample(k).each_ref().map(|own| &own[..]),
                    "{k}"
                );
            }
            k += 1;
        }
    }
    let most = ALLOCATOR.peak_usage_as_mb() - before;
    let bytes = std::fs::metadata(path).expect("a file").len();
    println!(
        "{}: {:.0} MB, {count} samples of {} numbers: {k} are read, {most:.1} MB at most in memory, {:.1} s to open \
         and check, {:.1} s once more",
        path.extension().unwrap_or_default().display(),
        bytes as f64 / f64::from(1 << 20),
        2 * JOINTS + 1,
        looked.as_secs_f64(),
        (start.elapsed() - looked).as_secs_f64()
    );
    if mapping.resample.is_none() {
        assert_eq!(k, count);
    }
    // Eight megabytes is the limit for runs in memory.
    assert!(most < 26.0, "{most} MB");
}

#[test]
fn large_files_are_not_loaded_into_memory() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("large.parquet");
    let count = write_parquet(&path);
    let names = |joint| [format!("q{joint}"), format!("tau{joint}")];
    measured(&path, &mapping("t", None, names), count);
    measured(&path, &mapping("t", Some(300.0), names), count);
    std::fs::remove_file(&path).expect("removed");
    #[cfg(feature = "mcap")]
    {
        let path = folder.path().join("large.mcap");
        let count = write_mcap(&path);
        let letters = ["a", "b", "c", "d", "e", "f"];
        let names =
            |joint: usize| ["position", "effort"].map(|list| format!("{list}.{}", letters[joint]));
        measured(&path, &mapping("time", None, names), count);
        measured(&path, &mapping("time", Some(300.0), names), count);
    }
}
