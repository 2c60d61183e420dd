//! A small computer algebra: expressions that know what they mean.
//!
//! An [`Arena`] owns a graph of nodes; an [`Expr`] is a `Copy` handle that carries its arena, so
//! `x * x + c` is Rust. Every node is held once. What makes the algebra strong is that it shares by
//! *meaning* and not by shape: each node is evaluated, as it is built, at two random points of a
//! prime field ([`field`]), where robots' constants, sines and cosines are exact. A node whose value
//! is zero is zero, whatever identity made it so (c² + s² - 1 never enters the graph); a node whose
//! value is known is the node that has it; a node whose ratio to another one is the same rational at
//! both points is that one, scaled. Each such find is confirmed by a floating-point sample.
//!
//! Negation costs nothing and is a bit of the handle, as in and-inverter graphs. Constants are
//! [`Number`]s, folded exactly; angles are linear combinations of symbols with an exact [`Angle`],
//! so frames about parallel axes merge into one sine and cosine.
//!
//! The module knows nothing about robots.

pub mod arena;
pub mod calculus;
pub mod cosine_sine;
pub mod direction;
mod divisors;
pub mod expr;
pub(crate) mod filter;
pub mod print;
mod sample;
pub mod stream;
pub mod vector;

pub use arena::{Arena, InputElement};
pub use calculus::Substitution;
pub use cosine_sine::CosineSine;
pub use direction::{Direction, SymbolId};
pub use expr::Expr;
pub use overact_exact::{Angle, Number, Ratio, field, hasher};
pub use stream::Stream;
pub use vector::{Matrix3, Vector3};
