//! Robots from descriptions: models, simulation and identification for Rust users and the command
//! line.
//!
//! [`Robot`] is read from a file; it has a model, settings and a virtual experiment. [`Identifier`]
//! estimates its parameters from measured or simulated logs. An [`Error`] contains all problems at
//! once, each with its location.
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
//! - `counted`: counts with nouns;
//! - [`drawing`]: a mechanism as SVG;
//! - `error`: problems with locations;
//! - `body`: bodies of standard parameters;
//! - `interpreted`: [`overact::Model`] by interpretation, without a compiler;
//! - `named`: functions called by name;
//! - `compiled_file`: a description read and compiled for a request;
//! - `robot`: the robot; `settings`, `experiment`: its tables as inputs of identification and
//!   simulation; `runs`: logs and virtual runs;
//! - [`inspection`]: composition and cost of a model;
//! - `check`: all errors of a description, found without its model;
//! - `import`: validated descriptions of other programs' files;
//! - `excitation`: runs that determine the parameters best within limits;
//! - `gravity`: gravity direction from runs, and robots with another gravity;
//! - `variants`: robots with changed lengths, to detect wrong lengths;
//! - `instruments`: simulated motions as instruments, to detect errors in the measured motion;
//! - `tracking`: identified parameters in the virtual robot's controller;
//! - `motors`, `functions_base`: identified parameters on the motor side, and as inputs of
//!   functions;
//! - `kept`: kept actuators of the actuator projection by name;
//! - `partitions`, `identifier`: identification, also for every partition;
//! - `factors`: runs as factor files, and identification from them; `fleet`: runs of many virtual
//!   robots.

/// Compiles the programs of the page on interfaces.
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
