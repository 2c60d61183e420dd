//! TOML to [`Description`]: every field evaluated and with its place in the text.
//!
//! A description is a TOML file; `robots/README.md` documents its keys, frames and units. Reading
//! it goes down the tables: [`parse`] reads the root, which reads constants, platform, shapes (legs
//! written once) and placements (shapes evaluated with values of their own), and then the tables
//! about experiments, which name what came before. All errors are noted with their places and
//! reported together.
//!
//! Numbers are exact: decimals are fractions, angles are multiples of π and fractions of a radian.

mod actuator_names;
mod chain;
mod compound;
mod controller;
mod data;
mod dimension;
mod document;
mod doubt;
mod drives;
mod excitation;
mod experiment;
mod expression;
mod formula;
mod friction;
mod function;
mod geometry;
mod gravity;
mod inventory;
mod joint;
mod joint_shape;
mod known;
mod leg;
mod model;
mod motor;
mod parameter;
mod parameters;
mod parameters_file;
mod payloads;
mod per_actuator;
mod place;
mod platform;
mod prior;
mod reader;
mod robot;
mod scalar;
mod scope;
mod settings;
mod shape;
mod spring;
#[cfg(test)]
mod tests;
mod token;
mod transmission;
mod value;
mod word;

pub use actuator_names::ActuatorNames;
pub use controller::Controller;
pub use data::{Clock, Data, Factor};
pub use document::{BaseColumns, Description};
pub use drives::Drives;
pub use excitation::Excitation;
pub use experiment::{Experiment, Run, Term, TrueParameter};
pub use formula::{Formula, Spring};
pub use gravity::GAINS_AND_GRAVITY;
pub use inventory::{Body, independent_joints};
pub use known::{COUPLED_MOTORS, KNOWN_TORQUES};
pub(crate) use model::SIX;
pub use model::{
    BodyIndex, End, Joint, JointKind, Leg, Motion, Placement, Platform, PlatformHome, Spanned,
};
pub use overact_core::StandardParameter;
pub use parameters_file::parse_parameters;
pub use place::place;
pub use prior::Prior;
pub use settings::{Friction, Identification, Instruments, Normalisation, Reversals};

use crate::diagnostic::{Diagnostics, Source};

/// Reads a description.
///
/// # Errors
/// Everything that is wrong with it, in order of the text.
pub fn parse(source: &Source) -> Result<Description, Diagnostics> {
    robot::read(source)
}
