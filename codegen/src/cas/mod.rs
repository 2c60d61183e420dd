//! A small computer algebra system that shares expressions by meaning.
//!
//! An [`Arena`] owns a graph of nodes; an [`Expr`] is a `Copy` handle that carries its arena, so
//! `x * x + c` is Rust. Every node exists once. Nodes are shared by *meaning*, not by shape: as it
//! is built, each node is evaluated at two random points of a prime field ([`field`]). There, the
//! constants, sines and cosines of robots are exact. A node of value zero is zero, whatever the
//! identity (c² + s² - 1 never enters the graph). A node whose value is known is replaced by the
//! existing node. A node whose ratio to another is the same rational at both points becomes a
//! multiple of it. A floating-point sample confirms each of these identities.
//!
//! Negation is a bit of the handle, as in and-inverter graphs, and costs nothing. Constants are
//! [`Number`]s, folded exactly. Angles are linear combinations of symbols with an exact [`Angle`],
//! so frames about parallel axes merge into one sine and cosine.
//!
//! The module knows nothing about robots.

pub mod arena;
pub mod calculus;
pub mod cosine_sine;
pub mod direction;
mod divisors;
pub(crate) mod jacobian;
pub mod print;
mod sample;
pub mod stream;
pub mod vector;

pub use arena::expr::Expr;
pub use arena::{Arena, InputElement};
pub use calculus::Substitution;
pub use cosine_sine::CosineSine;
pub use direction::{Direction, SymbolId};
pub use overact_exact::{Angle, Number, Ratio, field, hasher};
pub use stream::Stream;
pub use vector::{Matrix3, Vector3};
