//! Source text of a compiled robot model: Rust and C.
//!
//! Both take the same straight-line programs. `writing` decides names, order, comments and layout of expressions for
//! both; [`rust`] and [`c`] write the text.

pub mod c;
pub mod rust;
pub(crate) mod writing;
