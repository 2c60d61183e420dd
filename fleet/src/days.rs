//! Excludes days of robots with an unreadable file, as a query condition.
//!
//! The engine does not open files whose names violate the condition.

use crate::catalog::LeftOut;
use datafusion::logical_expr::{Expr, col, lit};
use std::collections::BTreeSet;

/// Remaining logs.
pub(crate) struct Days {
    /// Files to read.
    pub(crate) files: Vec<String>,
    /// Condition on their rows.
    pub(crate) filter: Expr,
    /// Readable files on excluded days.
    pub(crate) left_out: Vec<LeftOut>,
}

/// `serial` and `day` from the folder names of a file; empty if absent.
fn of(file: &str) -> (String, String) {
    let value = |name: &str| {
        let mut folders = file.split('/');
        let own = folders.find_map(|folder| folder.strip_prefix(name)?.strip_prefix('='));
        own.unwrap_or_default().to_owned()
    };
    (value("serial"), value("day"))
}

impl Days {
    /// Excludes all days on which some files are not good.
    pub(crate) fn without(files: &[String], good: &[String]) -> Self {
        let good: BTreeSet<&String> = good.iter().collect();
        let bad: BTreeSet<(String, String)> = { files.iter() }
            .filter(|file| !good.contains(file))
            .map(|file| of(file))
            .collect();
        let condition = bad.iter().map(|(serial, day)| {
            let other = col("serial").not_eq(lit(serial.as_str()));
            other.or(col("day").not_eq(lit(day.as_str())))
        });
        let (lost, files): (Vec<&String>, Vec<&String>) =
            good.into_iter().partition(|file| bad.contains(&of(file)));
        Self {
            filter: condition.reduce(Expr::and).unwrap_or_else(|| lit(true)),
            files: files.into_iter().cloned().collect(),
            left_out: lost
                .into_iter()
                .map(|file| LeftOut {
                    file: file.clone(),
                    runs: Vec::new(),
                    why: "another file of its day can't be read".to_owned(),
                })
                .collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn days_with_a_bad_file_are_excluded_entirely() {
        let name = |serial: u32, day: u32, file: &str| {
            format!("s3://b/logs/serial=R{serial}/day={day}/{file}.parquet")
        };
        let bad = name(1, 2, "bad");
        let good = [name(1, 2, "good"), name(1, 3, "run"), name(2, 2, "run")];
        let files = [good.as_slice(), std::slice::from_ref(&bad)].concat();
        let days = Days::without(&files, &good);
        assert_eq!(days.files, good[1..]);
        assert_eq!(days.left_out.len(), 1);
        assert_eq!(days.left_out[0].file, good[0]);
        let filter = days.filter.to_string();
        assert!(filter.contains("R1") && !filter.contains("R2"), "{filter}");
    }
}
