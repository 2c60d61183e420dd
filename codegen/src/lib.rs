//! From a robot's description to its symbolic identification model and to specialised Rust.

pub mod base;
pub mod cas;
pub mod compile;
pub mod derivation;
pub mod description;
pub mod diagnostic;
pub mod emission;
pub mod evaluation;
pub mod lowering;
pub mod mechanism;
pub mod model;
pub mod states;

pub use compile::compile;
pub use diagnostic::{Diagnostics, Source};
pub use model::{Function, RobotModel};
