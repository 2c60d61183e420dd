//! Coverage of the 95 % intervals of an identification, from many virtual experiments.
//!
//! A draw is a virtual experiment with random motions ([`draw`]): phases and amplitudes of the
//! description's trajectories are random, within the original range. Its records are disturbed by
//! noise of the described size or a multiple of it ([`Noise`]). For each model and stage, the
//! intervals that contain the true value are counted ([`mod@measure`]). The parameters of a draw
//! share its data, so a draw is one observation, and the interval of a coverage comes from the
//! spread between draws ([`tally`]). [`table`] writes the results.
//!
//! `cargo run --release -p overact-trust -- --draws 30 robots/dualv.toml` prints the table.
//!
//! [`traps`] are data with one known fault each. `cargo run --release -p overact-trust --bin traps
//! -- robots/dualv.toml` prints the results of identifications; with `--clean 100` it counts false
//! alarms on faultless data. [`mod@faults`] repeats each fault over draws of the noise; `--bin faults`
//! prints the table. [`units`] are logs in other units; `--bin units` prints the matrix of
//! robots and unit errors.

pub mod draw;
pub mod faults;
pub mod measure;
pub mod subject;
pub mod table;
pub mod tally;
pub mod traps;
pub mod units;

pub use draw::Noise;
pub use measure::{DrawIntervals, measure};
pub use subject::Subject;
pub use tally::{Cell, Tally};

/// Any error.
pub type Failure = Box<dyn std::error::Error + Send + Sync>;
