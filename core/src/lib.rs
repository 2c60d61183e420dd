//! What the generator, the interpreter, the generated code and those who call it agree on.
//!
//! [`function`] is the one table of a robot's functions: what each is called and means, what it takes
//! and which shape its output has. [`parameter`] are the fourteen standard parameters of the paper and the
//! coefficient of a spring, [`error`] is what can go wrong at a state, [`singular`] from where on a
//! configuration counts as singular and [`limits`] from where on other numbers are zero, [`trigonometry`] the
//! polynomials by which all backends compute sines and cosines, and [`text`] says which characters may not stand in what is written of a description.
//!
//! The crate is `no_std`, has no dependencies and allocates nothing.
#![no_std]

pub mod code;
pub mod columns;
pub mod error;
pub mod function;
pub mod limits;
pub mod parameter;
pub mod singular;
pub mod size;
pub mod text;
pub mod trigonometry;

pub use code::{Code, Explanation};
pub use columns::Columns;
pub use error::{ActuatorGroup, Actuators, Error, SampleError};
pub use function::{Condition, Function};
pub use limits::Limits;
pub use parameter::StandardParameter;
pub use singular::{CLOSED, SINGULAR};
pub use size::{Extent, Input, Sizes};

/// Version of the crate.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");
