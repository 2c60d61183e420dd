//! Unusual, wrong or broken MCAP files are read, or refused with location and remedy.
#![cfg(feature = "mcap")]

#[path = "common/drive.rs"]
mod drive;
#[path = "common/mcap.rs"]
mod mcap_file;

use std::path::Path;

use drive::{loaded, numbers, run, timed};
use mcap_file::{JOINT_STATE, chunk, end, file, message, record, stamped, state, topic};
use overact_logs::{Log, Mapping, Time};
use overact_tier::by_tier;

const CDR: (&str, &str) = (JOINT_STATE, "cdr");
const STEP: u64 = 10_000_000;

fn mapping(position: &str, torque: &str) -> Mapping {
    Mapping {
        time: Time::Column(String::from("time")),
        ..timed(position, torque)
    }
}

fn log(bytes: &[u8]) -> Result<Log, String> {
    run(
        "a.mcap",
        &[("a.mcap", bytes)],
        &mapping("position.a", "effort.a"),
    )
}

fn refused(bytes: &[u8]) -> String {
    log(bytes).expect_err("an error")
}

/// Messages of one joint on one topic, each created by `state`.
fn messages(state: impl Fn(u64) -> Vec<u8>) -> Vec<Vec<u8>> {
    let mut records = vec![topic(1, "/joint_states", CDR)];
    records.extend((0..50).map(|k| message(1, k * STEP, &state(k))));
    records
}

fn usual(k: u64) -> Vec<u8> {
    state(k * STEP, &["a"], [&[k as f64], &[], &[-2.0 * k as f64]])
}

#[test]
fn mcap_chunking_compression_and_encoding_give_the_same_numbers() {
    let records = messages(usual);
    let expected = numbers(log(&file(&records)));
    assert_eq!(expected.0, (0..50).map(f64::from).collect::<Vec<_>>());
    assert_eq!(expected.1[7], -14.0);
    assert!((expected.2 - 100.0).abs() < 1e-6);
    // Chunks with and without checksum, unknown records, a summary, other topics with long
    // messages.
    let mut other = vec![topic(2, "/camera", ("sensor_msgs/msg/Image", "cdr"))];
    other.push(record(200, &[7; 100]));
    other.push(message(2, 0, &vec![1; 5_000_000]));
    let all = [other.concat(), records.concat()].concat();
    let sum = crc32fast::hash(&all);
    let packed = chunk("", &all, (all.len() as u64, sum));
    assert_eq!(numbers(log(&file(std::slice::from_ref(&packed)))), expected);
    let mut bytes = file(&[]);
    bytes.truncate(mcap_file::beginning().len());
    bytes.extend(packed);
    bytes.extend(end(
        bytes.len() as u64,
        &[
            topic(1, "/joint_states", CDR),
            topic(2, "/camera", ("sensor_msgs/msg/Image", "cdr")),
        ]
        .concat(),
    ));
    assert_eq!(numbers(log(&bytes)), expected);
    // Joints without names are numbered.
    let nameless = messages(|k| state(k * STEP, &[], [&[0.0, k as f64], &[], &[-2.0 * k as f64]]));
    let numbered = run(
        "a.mcap",
        &[("a.mcap", &file(&nameless))],
        &mapping("position.2", "effort.1"),
    );
    assert_eq!(numbers(numbered), expected);
}

#[test]
fn topics_with_different_clocks_are_joined_by_time() {
    let mut records = vec![
        topic(1, "/fast", CDR),
        topic(2, "/slow", CDR),
        topic(3, "/none", CDR),
    ];
    for k in 0..400_u64 {
        let seconds = k as f64 / 100.0;
        records.push(message(
            1,
            k * STEP,
            &state(k * STEP, &["a"], [&[seconds], &[], &[]]),
        ));
        if k % 2 == 0 {
            let nanos = k * STEP + 3_000_000;
            records.push(message(
                2,
                nanos,
                &state(nanos, &["a"], [&[0.0], &[], &[3.0 * seconds + 0.009]]),
            ));
        }
    }
    let bytes = file(&records);
    let output = log(&bytes).expect_err("two of a name");
    assert!(
        output.ends_with(
            "several of the topics of the file have a column `position.a`\n  help: call it `/fast.position.a` or \
             `/slow.position.a`"
        ),
        "{output}"
    );
    let mapping = mapping("/fast.position.a", "effort.a");
    let own =
        run("a.mcap", &[("a.mcap", &bytes)], &mapping).unwrap_or_else(|error| panic!("{error}"));
    let (positions, torques) = loaded(&own);
    assert_eq!(positions[0], 0.01);
    for (position, torque) in positions.iter().zip(&torques) {
        assert!(
            (torque - 3.0 * position).abs() < 1e-9,
            "{torque} at {position}"
        );
    }
    let note = own.note().expect("a note");
    assert!(
        note.contains("/slow of ") && note.contains("interpolated onto the times of /fast of "),
        "{note}"
    );
    // Joined with a text whose times count from the same second.
    let text = "time,tau\n".to_owned()
        + &(0..400)
            .map(|k| format!("{},{k}\n", f64::from(k) / 100.0))
            .collect::<String>();
    let files: [(&str, &[u8]); 2] = [("a.mcap", &bytes), ("b.csv", text.as_bytes())];
    let own = run(
        "a.mcap+b.csv",
        &files,
        &self::mapping("/fast.position.a", "file2.tau"),
    );
    let (positions, torques, _) = numbers(own);
    assert_eq!((positions[7], torques[7]), (0.07, 7.0));
}

#[test]
fn inconsistent_messages_are_located() {
    let output = |state: &dyn Fn(u64) -> Vec<u8>| refused(&file(&messages(state)));
    let at_7 = |other: Vec<u8>| output(&|k| if k == 7 { other.clone() } else { usual(k) });
    let two = |k: u64, names: &[&str; 2]| state(k * STEP, names, [&[1.0, 2.0], &[], &[1.0, 2.0]]);
    let order = output(&|k| two(k, if k < 9 { &["a", "b"] } else { &["b", "a"] }));
    assert!(
        order.starts_with(
            "a.mcap: message 9 of `/joint_states` has the joints of the first message in another order: b, a, and not a, b"
        ) && order.contains("several publishers seem to share this topic"),
        "{order}"
    );
    let joints = at_7(two(7, &["a", "b"]));
    assert!(
        joints.contains(
            "message 7 of `/joint_states` has other joints than the first message: a, b, and not a"
        ),
        "{joints}"
    );
    let short = at_7(state(7 * STEP, &["a"], [&[], &[], &[1.0]]));
    assert!(short.contains("message 7 of `/joint_states` has 0 numbers of the kind `position`, too few for `position.a`"), "{short}");
    let hole = at_7(state(7 * STEP, &["a"], [&[1.0], &[], &[f64::NAN]]));
    assert!(
        hole.contains("message 7 of `/joint_states` has no finite number in `effort.a`"),
        "{hole}"
    );
    let back = at_7(state(3 * STEP, &["a"], [&[1.0], &[], &[1.0]]));
    assert!(
        back.contains("message 7 of `/joint_states` has the time 0.03 s, which is not later than the previous message, 0.06 s"),
        "{back}"
    );
    let cut = at_7(usual(7)[..40].to_vec());
    assert!(
        cut.contains("message 7 of `/joint_states` is truncated, or not a JointState"),
        "{cut}"
    );
    let other = at_7([&[0, 7, 0, 0][..], &usual(7)[4..]].concat());
    assert!(
        other.contains("has the representation 0x00 0x07 instead of plain CDR"),
        "{other}"
    );
    let unstamped = output(&|k| stamped((0, 0), &["a"], [&[k as f64], &[], &[0.0]]));
    assert!(
        unstamped.contains("has no stamp: it is zero") && unstamped.contains("log_time"),
        "{unstamped}"
    );
    let unstamped = file(&messages(|k| {
        stamped((0, 0), &["a"], [&[k as f64], &[], &[0.0]])
    }));
    let recorded = Mapping {
        time: Time::Column(String::from("log_time")),
        ..mapping("position.a", "effort.a")
    };
    let (_, _, frequency) = numbers(run("a.mcap", &[("a.mcap", &unstamped)], &recorded));
    assert!((frequency - 100.0).abs() < 1e-6);
    // Drive clocks jitter: refused, and resampled on request.
    let jitter = |k: u64| {
        state(
            k * STEP + k % 3 * 1_000_000,
            &["a"],
            [&[k as f64], &[], &[0.0]],
        )
    };
    let uneven = file(&messages(jitter));
    assert!(refused(&uneven).contains("`resample = \"91 Hz\"` in [data]"));
    let resampled = Mapping {
        resample: Some(100.0),
        ..mapping("position.a", "effort.a")
    };
    let (_, _, frequency) = numbers(run("a.mcap", &[("a.mcap", &uneven)], &resampled));
    assert_eq!(frequency, 100.0);
    let missing = run(
        "a.mcap",
        &[("a.mcap", &file(&messages(usual)))],
        &mapping("position.b", "$1"),
    );
    let missing = missing.expect_err("missing");
    assert!(
        missing.contains("there are no columns `position.b`, `$1`; the file has `/joint_states.time`, `/joint_states.log_time`, `/joint_states.position.a`"),
        "{missing}"
    );
}

#[test]
fn files_without_joint_states_are_rejected_with_their_topics() {
    let output = refused(&file(&[
        topic(1, "/tf", ("tf2_msgs/msg/TFMessage", "cdr")),
        topic(2, "/js", (JOINT_STATE, "json")),
    ]));
    assert!(
        output.starts_with(
            "a.mcap: the MCAP file has no messages of the type sensor_msgs/msg/JointState in CDR; it has /tf \
             (tf2_msgs/msg/TFMessage, cdr), /js (sensor_msgs/msg/JointState, json)"
        ),
        "{output}"
    );
    let output = refused(&file(&[]));
    assert!(output.contains("it has no topic"), "{output}");
    // A topic without messages.
    let output = refused(&file(&[topic(1, "/joint_states", CDR)]));
    assert!(
        output.contains("it has /joint_states (sensor_msgs/msg/JointState, cdr)"),
        "{output}"
    );
}

#[test]
fn truncated_or_damaged_files_are_rejected() {
    let records = messages(usual);
    let whole = file(&records);
    for end in [8, 9, 30, 200, 1000, whole.len() - 1] {
        let output = refused(&whole[..end]);
        assert!(
            output.contains("it is truncated: its end is missing")
                && output.contains("mcap recover"),
            "{output}"
        );
    }
    let all = records.concat();
    let size = all.len() as u64;
    let place = mcap_file::beginning().len();
    let broken = |packing: &str, packed: &[u8], declared: (u64, u32), why: &str| {
        let output = refused(&file(&[chunk(packing, packed, declared)]));
        let expected = format!("the chunk at byte {place} is broken: {why}");
        assert!(output.contains(&expected), "{output}");
    };
    broken(
        "",
        &all,
        (size, 1),
        "its checksum does not match: some bytes were changed",
    );
    broken(
        "",
        &all,
        (size + 1000, 0),
        "it has fewer bytes than declared",
    );
    broken("", &all, (size - 3, 0), "a record ends after its end");
    broken(
        "brotli",
        &all,
        (size, 0),
        "it is compressed by `brotli`, which is not supported",
    );
    broken("zstd", &all, (size, 0), "it can't be unpacked");
    broken("lz4", &all, (size, 0), "it can't be unpacked");
    broken("", &all, (u64::MAX, 0), "it has fewer bytes than declared");
    // Impossible lengths.
    for length in [u64::MAX, 1 << 40, 1 << 63] {
        let mut record = record(5, &[0; 30]);
        record[1..9].copy_from_slice(&length.to_le_bytes());
        let output = refused(&file(&[record.clone()]));
        assert!(
            output.contains("ends after the end of the file"),
            "{output}"
        );
        let output = refused(&file(&[chunk("", &record, (record.len() as u64, 0))]));
        assert!(output.contains("a record ends after its end"), "{output}");
    }
    let long = message(1, 0, &vec![0; 5_000_000]);
    let output = refused(&file(&[topic(1, "/joint_states", CDR), long]));
    assert!(
        output.contains("a record has 5000000 bytes, more than"),
        "{output}"
    );
}

/// A reproducible random generator.
struct Random(u64);

impl Random {
    fn below(&mut self, count: usize) -> usize {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % count
    }
}

#[test]
fn corrupted_files_are_read_or_rejected() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/written");
    let mut random = Random(1);
    let other = tempfile::tempdir().expect("a folder");
    let path = other.path().join("a.mcap");
    let mapping = mapping("position.elbow", "effort.elbow");
    let (mut read, mut refused) = (0, 0);
    for (name, counts) in [
        ("small_lz4.mcap", [600, 10_000]),
        ("small_zstd.mcap", [600, 10_000]),
        ("small_plain.mcap", [600, 10_000]),
        ("same_rosbags.mcap", [50, 5000]),
    ] {
        let bytes = std::fs::read(folder.join(name)).expect("a file");
        for k in 0..by_tier(counts) {
            let mut bytes = bytes.clone();
            match k % 4 {
                0 => bytes.truncate(random.below(bytes.len())),
                // The end is intact: a piece in the middle is missing.
                1 => {
                    let start = random.below(bytes.len() - 50);
                    let count = 1 + random.below(40);
                    bytes.drain(start..start + count);
                }
                _ => {
                    for _ in 0..1 + k % 3 {
                        let place = random.below(bytes.len());
                        bytes[place] ^= 1 << random.below(8);
                    }
                }
            }
            std::fs::write(&path, &bytes).expect("written");
            match overact_logs::read(&path, &mapping, false) {
                Ok(_) => read += 1,
                Err(error) => {
                    assert!(error.to_string().len() < 20_000, "{error}");
                    refused += 1;
                }
            }
        }
    }
    println!("{read} were read and {refused} refused");
    assert!(refused > read && read > 0);
}
