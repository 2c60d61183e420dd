//! Unusual, wrong or broken HDF5 files are read, or refused with location and remedy.
#![cfg(feature = "hdf5")]

#[path = "common/drive.rs"]
mod drive;

use std::path::{Path, PathBuf};

use drive::{timed, untimed};
use overact_logs::read;
use overact_logs::{Log, Mapping, Time};
use overact_tier::by_tier;

fn written(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/written")
        .join(name)
}

fn log(position: &str, torque: &str) -> Result<Log, String> {
    read(&written("same.h5"), &untimed(position, torque), false).map_err(|error| error.to_string())
}

#[test]
fn non_numeric_datasets_are_rejected_by_name() {
    for (name, what) in [
        (
            "label",
            "`label` has texts or lists of variable length, not numbers",
        ),
        ("cube", "`cube` has more than two dimensions"),
        (
            "table",
            "`table` has structures (a table, or complex numbers), not single numbers",
        ),
        (
            "half",
            "`half` has floating-point numbers of other sizes than 32 and 64 bits",
        ),
        ("hole", "`hole`: sample 50 is not a finite number"),
        (
            "short",
            "`run/tau(:,2)` has 200 samples, but `short` has 199",
        ),
        ("run.q", "there is no dataset `run.q`; the file has"),
        (
            "run.q",
            "name the columns of a matrix one by one, `run.q(:,1)` is the first",
        ),
        ("run.q(:,3)", "there is no dataset `run.q(:,3)`"),
        ("lost", "there is no dataset `lost`"),
        ("elsewhere", "there is no dataset `elsewhere`"),
    ] {
        let output = log(name, "run/tau(:,2)").expect_err(name);
        assert!(output.contains(what), "{output}");
    }
    // Booleans count as numbers.
    let flags = log("flags", "run.tau(:,1)").unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(flags.load().expect("numbers").0[100..103], [0.0, 1.0, 1.0]);
    let output = read(
        &written("same_v73.mat"),
        &timed("q(:,1)", "tau(:,7)"),
        false,
    )
    .expect_err("no column");
    assert!(
        output
            .to_string()
            .contains("there is no dataset `tau(:,7)`"),
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
    let mut random = Random(1);
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.h5");
    let (mut good, mut refused) = (0, 0);
    let mapping = |time: &str, prefix: &str| Mapping {
        time: Time::Column(time.to_owned()),
        ..timed(&format!("{prefix}q(:,2)"), &format!("{prefix}tau(:,1)"))
    };
    for (name, time, prefix, counts) in [
        ("small.h5", "t", "run.", [1000, 10_000]),
        ("small_old.h5", "t", "run.", [1000, 10_000]),
        ("same.h5", "run.t", "run.", [0, 2000]),
        ("same_v73.mat", "t", "", [50, 5000]),
    ] {
        let bytes = std::fs::read(written(name)).expect("a file");
        let mapping = mapping(time, prefix);
        for k in 0..by_tier(counts) {
            let mut bytes = bytes.clone();
            match k % 4 {
                0 => bytes.truncate(random.below(bytes.len())),
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
            match read(&path, &mapping, false) {
                Ok(_) => good += 1,
                Err(error) => {
                    assert!(error.to_string().len() < 20_000, "{error}");
                    refused += 1;
                }
            }
        }
    }
    println!("{good} were read and {refused} refused");
    assert!(refused > 0 && good > 0);
}
