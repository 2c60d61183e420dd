//! A robot's description as a running robot: what a Rust user and the command line stand on.
//!
//! [`Robot`] is read from a file; it has a model, settings and a virtual experiment. [`Identifier`] finds
//! its parameters from logs, measured or virtual. All that is wrong comes back at once, each at its
//! place, in an [`Error`].
//!
//! ```
//! use overact_robot::{Identifier, Robot};
//!
//! # fn main() -> Result<(), overact_robot::Error> {
//! # let emps = concat!(env!("CARGO_MANIFEST_DIR"), "/../robots/emps.toml");
//! let robot = Robot::from_toml(emps)?; // "robots/emps.toml"
//! let runs = robot.experiment()?.runs(&robot.held_out(), &|_, _| {})?;
//! let result = Identifier::new(&robot).data(&runs).run()?;
//! let mass = &result.estimates[0].parameters[0];
//! assert_eq!(mass.name, "m_1R");
//! # Ok(())
//! # }
//! ```
//!
//! Modules, from the bottom up:
//!
//! - `counted`: numbers of things in sentences;
//! - [`drawing`]: a mechanism as SVG;
//! - `error`: what is wrong;
//! - `body`: where the bodies of standard parameters are;
//! - `interpreted`: a model served as [`overact::Model`] without a compiler at hand;
//! - `named`: functions called by their names;
//! - `compiled_file`: a description read and compiled with what is asked for;
//! - `robot`: the running robot; `settings`, `experiment`: its tables as inputs of identification and
//!   simulation; `runs`: logs and virtual runs;
//! - [`inspection`]: what a model consists of and what it costs;
//! - `check`: everything that is wrong with a description, found without its model;
//! - `import`: descriptions of other programs' files, checked;
//! - `excitation`: runs that determine the parameters best inside limits;
//! - `gravity`: the direction of gravity from runs, and the robot in another one;
//! - `variants`: the robot with other lengths, by which wrong ones are told;
//! - `instruments`: the motion of the simulated robot beside runs, by which errors of theirs are told;
//! - `tracking`: identified parameters tried in the virtual robot's controller;
//! - `motors`, `functions_base`: what was identified in front of gears, and as functions of the model take it;
//! - `kept`: kept actuators of case 2 by name;
//! - `partitions`, `identifier`: the identification, and case 2 for every choice of kept actuators;
//! - `factors`: runs as factor files, and the parameters from them; `fleet`: runs of many virtual robots.

/// The programs of the page that shows languages side by side.
#[cfg(doctest)]
#[doc = include_str!("../../docs/interfaces.md")]
mod interfaces {}

mod body;
mod calibration;
mod check;
mod compiled_file;
mod counted;
pub mod drawing;
mod error;
mod excitation;
mod experiment;
mod factors;
mod fleet;
mod functions_base;
mod gravity;
mod identifier;
mod import;
pub mod inspection;
mod instruments;
mod interpreted;
mod kept;
mod motors;
mod named;
mod parameters;
mod partitions;
mod physical;
mod prior;
mod robot;
mod runs;
mod scales;
mod settings;
mod tracking;
mod variants;

pub use check::{CheckedFile, check, check_text};
pub use compiled_file::CompiledFile;
pub use counted::counted;
pub use error::{Column, Error, Problem};
pub use excitation::{
    CaseOfRuns, Excitation, ExcitationEffort, JudgedRuns, Limit, LimitKind, Origin,
};
pub use experiment::VirtualExperiment;
pub use identifier::Identifier;
pub use import::{errors_of_files, import};
pub use inspection::Inspection;
pub use instruments::beside_simulated;
pub use interpreted::InterpretedRobot;
pub use kept::kept_actuators;
pub use named::{function_of_model, values};
pub use parameters::{GivenParameters, read_parameters};
pub use partitions::partitions;
pub use robot::Robot;
pub use runs::Runs;
pub use tracking::tracking;
pub use variants::Variants;
