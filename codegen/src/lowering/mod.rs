//! From expressions to a straight-line [`Program`].
//!
//! The graph is walked from the outputs, so what nothing needs is never seen. Cheaper ways to write its
//! nodes are searched ([`search`](mod@search)). Angles are planned so that few sines and cosines are
//! evaluated; products with a sign become selections. The [`Cost`] of a program is counted by one rule,
//! which the generated documentation and the snapshots quote.

pub mod lower;
pub mod peephole;
pub mod program;
pub mod search;
pub mod trigonometry;

pub use lower::{GuardedExpr, lower};
pub use program::{
    Array, Condition, Cost, Entry, Guard, Operand, Operation, Program, SINGULAR, Step,
};
pub use search::{Reach, States};
