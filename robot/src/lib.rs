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
//! What to do first:
//!
//! - read measured logs with [`Robot::read_logs`] instead of simulating them;
//! - import a URDF or MJCF file with [`import()`];
//! - look at the verdict before the parameters: [how to read a result];
//! - evaluate the model with [`Robot::model`] and [`overact::Model::evaluate`].
//!
//! [how to read a result]: https://github.com/overact/overact/blob/main/docs/reading.md
//!
//! Modules, from the bottom up:
//!
//! - `counted`: counts with nouns;
//! - [`drawing`]: a mechanism as SVG;
//! - `error`: problems with locations;
//! - `names`: kept actuators and functions by name;
//! - `compiled_file`: a description read and compiled for a request;
//! - `parameters`: standard parameters: their bodies, values from files, physical consistency;
//! - `interpreted`: [`overact::Model`] by interpretation, without a compiler;
//! - `robot`: the robot;
//! - `configuration`: tables of the description as settings, prior and scales of an identification;
//! - `experiment`: the virtual experiment, also of many virtual robots;
//! - `check`: all errors of a description, found without its model;
//! - `import`: validated descriptions of other programs' files;
//! - `calibration`: lengths, offsets and gravity direction from runs; robots with changed lengths
//!   or gravity, to detect wrong ones;
//! - `excitation`: runs that determine the parameters best within limits;
//! - `identification`: logs and virtual runs, identification from runs or factor files and for
//!   every partition, and uses of its result: instruments, tracking, motor-side values, inputs of
//!   functions;
//! - `serial`: the skeleton as a serial robot with lumped inertia;
//! - [`inspection`]: composition and cost of a model.

/// Compiles the programs of the page on interfaces.
#[cfg(doctest)]
#[doc = include_str!("../../docs/interfaces.md")]
mod interfaces {}

/// Compiles the program of the package's page.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
mod readme {}

mod calibration;
mod check;
mod compiled_file;
mod configuration;
mod counted;
pub mod drawing;
mod error;
mod excitation;
mod experiment;
mod identification;
mod import;
pub mod inspection;
mod interpreted;
mod names;
mod parameters;
mod robot;
mod serial;

pub use calibration::variants::Variants;
pub use check::{CheckedFile, check, check_text};
pub use compiled_file::CompiledFile;
pub use counted::counted;
pub use error::{Column, Error, Problem, compiler_style, internal_problem};
pub use excitation::{
    CaseOfRuns, Excitation, ExcitationEffort, JudgedRuns, Limit, LimitKind, Origin,
};
pub use experiment::VirtualExperiment;
pub use identification::identifier::Identifier;
pub use identification::instruments::beside_simulated;
pub use identification::partitions::partitions;
pub use identification::runs::Runs;
pub use identification::tracking::tracking;
pub use import::{errors_of_files, import};
pub use inspection::Inspection;
pub use interpreted::InterpretedRobot;
pub use names::kept::kept_actuators;
pub use names::named::{function_of_model, values};
pub use parameters::given_parameters::{GivenParameters, read_parameters};
pub use robot::Robot;
pub use serial::{RangeOrigin, RelativeError, SerialModel, SerialSettings};
