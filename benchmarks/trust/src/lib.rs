//! How often the 95 % intervals of an identification contain the truth, counted over many virtual
//! experiments of robots whose parameters are known.
//!
//! A draw is a virtual experiment with motions of its own ([`draw`]): the phases and the sizes of all
//! terms of the description's trajectories are random, within the reach of the original motion. Its
//! records are disturbed by noise of the description's size or a multiple of it ([`Noise`]) and
//! identified from; for each model and stage it is counted how many intervals contain the true value
//! ([`mod@measure`]). The parameters of a draw share its data, so a draw is one observation: the interval
//! of a coverage comes from the spread between draws ([`tally`]). [`table`] writes it down.
//!
//! `cargo run --release -p overact-trust -- --draws 30 robots/dualv.toml` prints the table.
//!
//! [`traps`] are data with one known fault each; `cargo run --release -p overact-trust --bin traps --
//! robots/dualv.toml` prints what identifications say of them, with `--clean 100` how often they accuse
//! faultless data. [`units`] are logs in other units; `--bin units` prints the matrix of robots and slips.

pub mod draw;
pub mod measure;
pub mod subject;
pub mod table;
pub mod tally;
pub mod traps;
pub mod units;

pub use draw::Noise;
pub use measure::{Counted, measure};
pub use subject::Subject;
pub use tally::{Cell, Tally};

/// What can go wrong, in words.
pub type Failure = Box<dyn std::error::Error + Send + Sync>;
