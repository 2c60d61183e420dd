//! Observation system of a model: columns, one pass over each run, and the stored equations.
//!
//! - `columns`: columns of the model: standard parameters, payload, split friction;
//! - `friction`, `states`: joint of each friction parameter, and random states to find it;
//! - `collect_rows`: numbers of the model in rows;
//! - `chunk`, `observer`, `observation`: successive samples as equations; options of the pass over a
//!   run; the pass;
//! - `pass`: the pass over a run for equations of other kinds;
//! - `instruments`: equations at the motion of the instruments, in step with the run;
//! - `sink`, `factor`: decimated equations as R factors, stretches and points of plots;
//! - `phase_sums`: mean equations of a periodic motion at each phase;
//! - `projection`: projections of the inputs;
//! - `points`: motion data for plots;
//! - `uncertainty_propagation`: effect of the uncertainty of previous identifications on estimates;
//! - `torque_uncertainty`: the same for corrections of the measured torques;
//! - `score_batches`: sums of scores over batches of successive samples;
//! - `system`: the system (39)-(41) of one projection;
//! - `elimination`: linearly dependent columns;
//! - `transpose`: rows of numbers as a matrix.

pub(crate) mod chunk;
mod collect_rows;
pub(crate) mod columns;
pub(crate) mod elimination;
pub(crate) mod factor;
pub(crate) mod friction;
mod instruments;
pub(crate) mod observation;
pub(crate) mod observer;
pub(crate) mod pass;
pub(crate) mod phase_sums;
pub(crate) mod points;
pub(crate) mod projection;
pub(crate) mod score_batches;
pub(crate) mod sink;
pub(crate) mod states;
pub(crate) mod system;
pub(crate) mod torque_uncertainty;
mod transpose;
pub(crate) mod uncertainty_propagation;

pub(crate) use chunk::Chunk;
