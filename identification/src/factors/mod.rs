//! Runs as the R factors of their equations: kilobytes in place of a log, from which runs of many days and many
//! robots are identified together without their logs.
//!
//! The factor of [R_1; R_2] is that of the equations of both runs, so what least squares need merges without
//! loss: estimates (44), their deviations under white residuals (46)-(47), weights of lines (48), the elimination
//! of parameters and its cross-validation within the data are those of one pass over all logs.
//!
//! Honest deviations need more. The residual at the merged estimate is known when all runs are together, and
//! its correlation is that of successive equations, of which a factor has lost the order:
//!
//! - A run keeps a factor for each of its parts, a fifth of the run. W_gᵀ ρ_g = R_gᵀ (R_g χ - ...) of a part g
//!   follows from its factor for any χ and any weights, so that deviations from the sums of parts
//!   (`estimation/intervals/parts.rs`) merge exactly. They take correlation within a part in, and miss what
//!   hangs together over more than a part.
//! - The deviations of one pass (`estimation/intervals/scores.rs`) take fourth powers and spectra of residuals;
//!   no fixed number of sums gives these for a χ that is not known yet. A file may keep the successive equations
//!   themselves, where logs are short; then all deviations are those of one pass.
//!
//! Only like with like merges: a run says by a hash of the description and of all settings that make its
//! equations what it is like. A hash of its numbers tells whether it has been counted already.
//!
//! - `run`: what is kept of a run; `packed`: numbers as bytes; `content`: their hash.
//! - `observe`: from a log.
//! - `record`: the equations of a line of a part as bytes that stand alone; `pool`, `pool_bytes`: those of many runs
//!   gathered in bounded memory, in any order and in several places, for a database; `pooled`: its estimate.
//! - `schema`, `write`, `read`: as Parquet, a row for each line of a part.
//! - `left_out`: what can't be used, and why; `gather`: files together, nothing twice, nothing unlike.
//! - `restore`, `estimate`: back to a system, and its estimates.

mod content;
mod estimate;
mod gather;
mod left_out;
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
pub use estimate::{Deviations, FromFactors, identify_factors};
pub use gather::{Gathered, gather};
pub use left_out::{LeftOut, Reason};
pub use observe::{Factory, Origin, factor_runs, likeness};
pub use pool::{Pool, PoolError};
pub use pooled::{Comparison, Pooled, PooledParameter, compare};
pub use read::{Damaged, ReadFactors, read_factors};
pub use record::{NoRecord, Record};
pub use run::{ModelFactors, RunFactors};
pub use write::write_factors;

#[cfg(test)]
mod tests;
