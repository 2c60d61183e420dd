//! Catalogue of the readable files of a folder and of duplicate runs.
//!
//! A query over a folder fails at its first bad file and counts duplicates twice. Both are
//! therefore detected before it starts.

use arrow::array::AsArray;
use arrow::datatypes::{DataType, Int64Type};
use datafusion::{
    error::Result,
    prelude::{ParquetReadOptions, SessionContext, col},
};
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};

/// Supported version of factor files.
const VERSION: i64 = 2;

/// A file or runs that queries ignore.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct LeftOut {
    /// File.
    pub file: String,
    /// Ignored runs of the file; empty for all.
    pub runs: Vec<String>,
    /// Reason.
    pub why: String,
}

/// Catalogue of a folder.
#[derive(Debug, Clone, Default)]
pub struct Catalog {
    /// Files to read, in order.
    pub files: Vec<String>,
    /// For some files: hashes of runs that an earlier file already has.
    pub copies: BTreeMap<String, Vec<String>>,
    /// Ignored files and runs.
    pub left_out: Vec<LeftOut>,
}

impl Catalog {
    /// Catalogue of factor files.
    ///
    /// With `whole`, every page of each file is read, which detects any damage. Otherwise, only the
    /// columns that identify runs are read.
    ///
    /// # Errors
    /// Errors that are not those of a file.
    pub async fn of_factors(
        context: &SessionContext,
        files: &[String],
        whole: bool,
    ) -> Result<Self> {
        let mut own = Self::default();
        // First file of each run.
        let mut seen: BTreeMap<String, String> = BTreeMap::new();
        for file in files {
            match runs(context, file, whole).await {
                Ok(runs) => own.add(file, runs, &mut seen),
                Err(error) => own.leave_out(file, error),
            }
        }
        Ok(own)
    }

    /// Catalogue of logs: those with a readable footer, or with `whole` those with readable pages.
    ///
    /// # Errors
    /// Errors that are not those of a file.
    pub async fn of_logs(context: &SessionContext, files: &[String], whole: bool) -> Result<Self> {
        let mut own = Self::default();
        for file in files {
            let read = async {
                let table = context
                    .read_parquet(file, ParquetReadOptions::default())
                    .await?;
                if whole {
                    table.collect().await.map(drop)
                } else {
                    Ok(())
                }
            };
            match read.await {
                Ok(()) => own.files.push(file.clone()),
                Err(error) => own.leave_out(file, error.strip_backtrace()),
            }
        }
        Ok(own)
    }

    fn add(&mut self, file: &str, runs: BTreeSet<String>, seen: &mut BTreeMap<String, String>) {
        let mut copies = Vec::new();
        let mut of = BTreeSet::new();
        let count = runs.len();
        for run in runs {
            match seen.get(&run) {
                Some(first) => {
                    of.insert(first.clone());
                    copies.push(run);
                }
                None => {
                    seen.insert(run, file.to_owned());
                }
            }
        }
        let all = copies.len() == count;
        if !copies.is_empty() {
            let of: Vec<String> = of.into_iter().collect();
            self.left_out.push(LeftOut {
                file: file.to_owned(),
                runs: if all { Vec::new() } else { copies.clone() },
                why: format!("already in {}", of.join(", ")),
            });
        }
        if !all || count == 0 {
            self.files.push(file.to_owned());
            if !copies.is_empty() {
                self.copies.insert(file.to_owned(), copies);
            }
        }
    }

    fn leave_out(&mut self, file: &str, why: String) {
        self.left_out.push(LeftOut {
            file: file.to_owned(),
            runs: Vec::new(),
            why,
        });
    }
}

/// Runs of a factor file, by the hash of their numbers.
async fn runs(
    context: &SessionContext,
    file: &str,
    whole: bool,
) -> std::result::Result<BTreeSet<String>, String> {
    let told = |error: datafusion::error::DataFusionError| error.strip_backtrace();
    let table = context
        .read_parquet(file, ParquetReadOptions::default())
        .await
        .map_err(told)?;
    let has = |name: &str| table.schema().has_column_with_unqualified_name(name);
    for name in [
        "version", "content", "kind", "factor", "serial", "time", "model", "loaded",
    ] {
        if !has(name) {
            return Err(format!(
                "the file has no factors: there is no column `{name}`"
            ));
        }
    }
    if whole {
        table.clone().collect().await.map_err(told)?;
    }
    let names = table.select(vec![
        col("version"),
        datafusion::logical_expr::cast(col("content"), DataType::Utf8).alias("content"),
    ]);
    let names = names.map_err(told)?;
    let mut runs = BTreeSet::new();
    for batch in names.collect().await.map_err(told)? {
        let versions = batch.column(0).as_primitive_opt::<Int64Type>();
        let contents = batch.column(1).as_string_opt::<i32>();
        let (Some(versions), Some(contents)) = (versions, contents) else {
            return Err("the file has no factors: its columns have other types".to_owned());
        };
        if let Some(other) = versions.iter().flatten().find(|own| *own != VERSION) {
            return Err(format!(
                "the file has version {other} of the format, this program reads version {VERSION}"
            ));
        }
        runs.extend(contents.iter().flatten().map(str::to_owned));
    }
    Ok(runs)
}
