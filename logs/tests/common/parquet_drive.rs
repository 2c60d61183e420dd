//! Runs of one drive as Parquet.
#![allow(dead_code, reason = "each test file uses its part")]

use overact_logs::{Log, Mapping};

use crate::drive::run;

/// The columns of [`samples`].
pub(crate) const SCHEMA: &str =
    "message log { required double t; optional double q; required double tau; }";

/// Reads one file.
pub(crate) fn log(content: &[u8], mapping: &Mapping) -> Result<Log, String> {
    run("a.parquet", &[("a.parquet", content)], mapping)
}

/// Samples at 100 Hz with full-precision values, some of them repeated.
pub(crate) fn samples() -> [Vec<f64>; 3] {
    let all = 0..1000_u32;
    [
        all.clone().map(|k| f64::from(k) / 100.0).collect(),
        all.clone().map(|k| (f64::from(k) / 7.0).sin()).collect(),
        all.map(|k| f64::from(k % 16) / 3.0).collect(),
    ]
}
