//! The observation system of a model: columns, one pass over each run, and what is kept of it.
//!
//! - `columns`: the columns of the model: standard parameters, payload, split friction;
//! - `friction`, `states`: which joint a friction parameter belongs to, and states to find it out by;
//! - `gathering`: numbers of the model in rows;
//! - `chunk`, `observation`: successive samples as equations; the pass over a run;
//! - `instruments`: the same equations at the motion of the instruments, in step with the run;
//! - `sink`, `factor`: decimated equations as R factors, stretches and points of plots;
//! - `fold`: equations of a motion that returns, in the mean at each phase;
//! - `projection`: on what the inputs are projected;
//! - `points`: what is plotted of the motion;
//! - `shares`: what the uncertainty of quantities identified beforehand does to estimates;
//! - `system`: the system (39)-(41) of one projection;
//! - `elimination`: columns that depend on others;
//! - `turned`: rows of numbers as a matrix.

pub(crate) mod chunk;
pub(crate) mod columns;
pub(crate) mod elimination;
pub(crate) mod factor;
pub(crate) mod fold;
mod friction;
mod gathering;
mod instruments;
pub(crate) mod observation;
pub(crate) mod points;
pub(crate) mod projection;
pub(crate) mod shares;
pub(crate) mod sink;
pub(crate) mod states;
pub(crate) mod system;
mod turned;
mod update;

pub(crate) use chunk::Chunk;
