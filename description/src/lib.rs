//! Reads a TOML file into a [`Description`]: every field evaluated, with its location in the text.
//!
//! A description is a TOML file; `robots/README.md` documents its keys, frames and units. [`parse`]
//! reads the root, then constants, platform, shapes (legs described once) and placements (shapes
//! evaluated with values of their own). Tables about experiments follow, which refer to the former
//! by name. All errors are collected with their locations and reported together.
//!
//! ```
//! use overact_description::{Source, parse};
//!
//! let text = r#"
//! name = "Pendulum"
//! gravity = [0, 0, "-9.81 m/s^2"]
//!
//! [[leg.arm.joint]]
//! type = "revolute"
//! alpha = "90 deg"
//! actuated = true
//!
//! [[place]]
//! name = "arm"
//! shape = "arm"
//! "#;
//! let robot = parse(&Source::new("pendulum.toml", text)).expect("a correct description");
//! assert_eq!(robot.name.value, "Pendulum");
//!
//! let source = Source::new("pendulum.toml", text.replace("90 deg", "90 dag"));
//! let errors = parse(&source).expect_err("an unknown unit");
//! println!("{}", errors.render_plain(&source)); // with line, cause and remedy
//! ```
//!
//! Numbers are exact: decimals are fractions, angles are multiples of π plus fractions of a radian.

pub mod diagnostic;
mod document;
mod effort;
mod experiments;
mod expressions;
mod parameters_file;
mod robot;
mod root;
#[cfg(test)]
mod tests;
mod toml_text;

pub use diagnostic::{Diagnostics, Source};
pub use document::{BaseColumns, Description};
pub use effort::Effort;
pub use experiments::controller::Controller;
pub use experiments::data::{Clock, Data, Factor};
pub use experiments::drives::Drives;
pub use experiments::excitation::Excitation;
pub use experiments::experiment::{Experiment, Run, Term, TrueParameter};
pub use experiments::gears::{GEARS_ALONE, GEARS_OF_COUPLED_MOTORS};
pub use experiments::gravity::GAINS_AND_GRAVITY;
pub use experiments::held::HELD_AND_CORRECTIONS;
pub use experiments::known::{COUPLED_MOTORS, KNOWN_TORQUES};
pub use experiments::prior::Prior;
pub use experiments::settings::{Friction, Identification, Instruments, Normalisation, Reversals};
pub use experiments::stribeck::{NO_STRIBECK, STRIBECK_ALONE};
pub use expressions::formula::{Formula, Spring};
pub use overact_core::StandardParameter;
pub use parameters_file::parse_parameters;
pub use robot::actuator_names::ActuatorNames;
pub use robot::inventory::{Body, independent_joints};
pub use robot::model::{
    BodyIndex, Cable, End, Frame, FrameBody, Joint, JointKind, Leg, Motion, Motor, MotorTerm,
    Payload, Placement, Platform, PlatformHome, SIX, Spanned,
};
pub use robot::motion::TwistCoordinate;
pub use robot::point_spring::{PointSpring, SpringBody, SpringEnd};
pub use toml_text::place::place;

/// Reads a description.
///
/// # Errors
/// All errors, in order of the text.
pub fn parse(source: &Source) -> Result<Description, Diagnostics> {
    root::read(source)
}
