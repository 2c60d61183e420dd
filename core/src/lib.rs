//! Common definitions of the generator, the interpreter, generated code and its callers.
//!
//! - [`function`] is the table of a robot's functions: names, descriptions, inputs and output
//!   shapes; [`frame`] has the functions of frames that a description defines.
//! - [`parameter`] has the fourteen standard parameters of the paper, and those of springs and
//!   special friction.
//! - [`error`] has the errors at a state.
//! - [`singular`] and [`limits`] have the thresholds for singularity, for zero and for overflow.
//! - [`trigonometry`] has the polynomials by which all backends compute sines and cosines.
//! - [`text`] defines the characters that are removed from text of descriptions.
//!
//! The crate is `no_std`, has no dependencies and allocates nothing.
//!
//! ```
//! use overact_core::{Code, Columns, Function, StandardParameter};
//!
//! let regressor = Function::IdmRedPlatform(Columns::Standard);
//! assert_eq!(regressor.name(), "idm_red_platform");
//! assert_eq!(StandardParameter::from_name("fv").map(|one| one.unit(false)), Some("N m s/rad"));
//! let code = Code::named("OA102").ok_or("no such code")?;
//! assert!(!code.explanation().cure.is_empty());
//! # Ok::<(), &str>(())
//! ```
//!
//! Start at [`Function`], the list of everything that a robot can compute.
#![no_std]

pub mod code;
pub mod columns;
pub mod error;
pub mod frame;
pub mod function;
pub mod limits;
pub mod parameter;
pub mod singular;
pub mod size;
pub mod tension;
pub mod text;
pub mod trigonometry;

pub use code::{Code, Explanation};
pub use columns::Columns;
pub use error::{ActuatorGroup, Actuators, Error, SampleError};
pub use frame::{FrameFunction, FrameQuantity};
pub use function::{Condition, Function};
pub use limits::Limits;
pub use parameter::{Effect, StandardParameter};
pub use singular::{CLOSED, SINGULAR};
pub use size::{Extent, Input, Sizes};

/// Version of the crate.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");
