//! Programs as people read them, in no language yet: what the Rust and the C of a robot have in common.
//!
//! Values have `names`, constants of the description theirs (`dimensions`), `labels` are what inputs and
//! outputs are called, the `legend` says what names mean. `body` is a program as assignments (`statement`)
//! with these names, `outline` a function around it: its arguments, what is found before it runs, its documentation.
//! `text` makes comments of what a person wrote.

#![allow(unreachable_pub, reason = "public to the languages")]

mod angles;
pub mod body;
mod dimensions;
pub mod labels;
pub mod legend;
mod names;
pub mod operations;
pub mod outline;
mod places;
pub mod statement;
#[cfg(test)]
mod tests;
pub mod text;
