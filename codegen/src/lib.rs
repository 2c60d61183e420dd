//! Derives a robot's symbolic identification model from its description, and generates code.
//!
//! A parallel robot is cut at its platform into legs, which are trees, and a free body. The legs'
//! bodies move with quasi-velocities u, absolute rates along parallel axes. The closure of each leg
//! gives u = (∂u/∂v) v for the platform's twist coordinates v. By virtual power, the column of
//! standard parameter p in the platform projection is Σ (∂u_i/∂v)ᵀ s_i, with s_i the generalised
//! force on u_i of the wrench of p alone: Γ¹ = (J_p^inv)ᵀ τ = IDM_red χ, eq. (30) of Briot, Krut,
//! Gautier 2015. All is linear in the parameters, and the only divisors are the leg determinants.
//!
//! ```
//! use overact_codegen::{Source, backends, compile};
//!
//! let text = r#"
//! name = "Pendulum"
//! gravity = [0, 0, "-9.81 m/s^2"]
//!
//! [[leg.arm.joint]]
//! type = "revolute"
//! alpha = "90 deg"
//! actuated = true
//! parameters = ["zz", "mx", "fv"]
//!
//! [[place]]
//! name = "arm"
//! shape = "arm"
//! "#;
//! let robot = compile(&Source::new("pendulum.toml", text)).expect("a correct description");
//! let rust = backends::rust::file(&robot.model, "pendulum.toml");
//! assert!(rust.contains("pub fn inverse_dynamics"));
//! assert_eq!(robot.model.base.len(), 3);
//! ```
//!
//! [`compile_with`] generates a choice of functions ([`Request`]). A build script is in [generated
//! Rust].
//!
//! [generated Rust]: https://github.com/overact/overact/blob/main/docs/rust.md#build-script
//!
//! The stages, in the order of [`compile`](fn@compile), each a folder or file with its theory:
//!
//! | stage | from | to |
//! |---|---|---|
//! | [`description`] | TOML | values with units and places; errors in [`diagnostic`] |
//! | [`mechanism`] | description | checked legs, platform, home configuration |
//! | [`derivation`] | mechanism | expressions of the algebra `cas` |
//! | `selection` | regressor | its form, and its present, independent and combined columns |
//! | [`lowering`] | expressions | a straight-line program with its operation count |
//! | [`backends`] | programs | Rust, C |
//! | [`interpreter`] | programs | numbers, block by block |
//!
//! The crate is pure: it maps text to a model or diagnostics.

pub mod backends;
#[allow(unreachable_pub, reason = "public to the stages above")]
mod cas;
mod checked;
mod choice;
mod compile;
pub mod derivation;
mod float;
#[doc(hidden)]
pub mod internals;
pub mod interpreter;
pub mod lowering;
pub mod mechanism;
mod model;
mod parallel;
mod request;
mod runtime;
mod selection;
mod total_cost;

pub use backends::{c, rust};
pub use checked::{Checked, check};
pub use choice::{Choice, Group, UnknownFunction, serves_model};
pub use compile::{Compiled, compile, compile_with, model_with};
pub use float::Float;
pub use model::{CompiledFunction, RobotModel};
pub use overact_core::Columns;
pub use overact_description::{self as description, Diagnostics, Effort, Source, diagnostic};
pub use request::{Progress, Request};
pub use runtime::{NotAPath, Runtime};
pub use selection::BaseParameter;
pub use total_cost::{Iteration, SideBySide, TotalCost};

/// Versions of the crates that determine the generated code.
pub const VERSIONS: [&str; 2] = [env!("CARGO_PKG_VERSION"), overact_core::VERSION];
