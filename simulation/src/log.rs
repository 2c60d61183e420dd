//! Writes a record as CSV, in the format that the identification reads.
//!
//! The header is `time,q_<actuator>,…,tau_<actuator>,…`; times in s, positions in rad or m, torques
//! in N m or N. Numbers have the fewest digits that read back as the same `f64`.

use std::{
    fmt::Write as _,
    io::{self, Write},
};

use crate::run::Record;

/// Writes a record.
///
/// # Errors
/// Errors of the writer.
pub fn write_csv(record: &Record, writer: impl Write) -> io::Result<()> {
    let n = record.actuators.len();
    let mut csv = csv::Writer::from_writer(writer);
    csv.write_field("time")?;
    for prefix in ["q", "tau"] {
        for actuator in &record.actuators {
            csv.write_field(format!("{prefix}_{actuator}"))?;
        }
    }
    csv.write_record(None::<&[u8]>)?;
    let mut digits = String::new();
    for (k, time) in record.time.iter().enumerate() {
        let positions = &record.positions[k * n..(k + 1) * n];
        let torques = &record.torques[k * n..(k + 1) * n];
        for value in std::iter::once(time).chain(positions).chain(torques) {
            digits.clear();
            // Writing to a string cannot fail.
            let _ = write!(digits, "{value}");
            csv.write_field(&digits)?;
        }
        csv.write_record(None::<&[u8]>)?;
    }
    csv.flush()
}
