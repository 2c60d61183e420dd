//! Runs as the R factors of their equations.
//!
//! Factors take kilobytes instead of a log. Runs of many days and robots can be identified together
//! without their logs. The factor of [R_1; R_2] is that of the equations of both runs, so least
//! squares merges without loss. Estimates (44), standard deviations for white residuals (46)-(47),
//! line weights (48), elimination and cross-validation equal those from all logs.
//!
//! Standard deviations for correlated residuals need more. The residual of the merged estimate is
//! only known when all runs are together. Its correlation is that of successive equations, whose
//! order a factor has lost:
//!
//! - A run keeps a factor for each of its parts, a fifth of the run. W_gᵀ ρ_g = R_gᵀ (R_g χ - …) of
//!   a part g follows from its factor for any χ and weights. Standard deviations from sums over
//!   parts (`estimation/intervals/parts.rs`) therefore merge exactly. They include correlation
//!   within parts only.
//! - Standard deviations from equations (`estimation/intervals/scores.rs`) need fourth powers and
//!   spectra of residuals. No fixed number of sums gives these for an unknown χ. For short logs, a
//!   file may store the successive equations, too; then all standard deviations are those from the
//!   logs.
//!
//! Only compatible runs merge: a hash of the description and of the relevant settings identifies
//! them. A hash of a run's numbers detects duplicates.
//!
//! - `run`: content of a run; `packed`: numbers as bytes; `content`: their hash.
//! - `observe`: from a log to factors.
//! - `record`: equations of a line of a part as self-contained bytes.
//! - `pool`, `pool_bytes`: records of many runs in bounded memory, in any order, for a database.
//! - `pooled`: estimate of a pool.
//! - `schema`, `write`, `read`: Parquet files, one row for each line of a part.
//! - `excluded_run`: unusable runs; `gather`: compatible runs of several files.
//! - `restore`, `estimate`: back to a system, and its estimates.

mod content;
mod estimate;
mod excluded_run;
mod gather;
mod observe;
mod packed;
mod pool;
mod pool_bytes;
mod pooled;
mod read;
mod record;
mod restore;
mod run;
mod schema;
mod write;

pub use crate::estimation::intervals::distributions::student_tail;
pub use estimate::{Deviations, FactorEstimation, identify_factors};
pub use excluded_run::{ExcludedRun, Reason};
pub use gather::{CollectedRuns, gather};
pub use observe::{Factory, Origin, settings_hash};
pub use pool::{Pool, PoolError};
pub use pooled::{Comparison, Pooled, PooledParameter, compare};
pub use read::{Damaged, ReadFactors, read_factors};
pub use record::{NoRecord, Record};
pub use run::{ModelFactors, RunFactors};
pub use write::write_factors;

#[cfg(test)]
mod tests;
