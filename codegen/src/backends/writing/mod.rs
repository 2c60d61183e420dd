//! Readable programs, independent of a language: the common part of the Rust and C backends.
//!
//! `names` has names of values, `dimensions` those of description constants, `labels` those of
//! inputs and outputs; `legend` explains the names. `body` is a program as assignments
//! (`statement`) with these names. `outline` is a function around it: arguments, iterations before
//! it, documentation. `text` converts text of users to comments.

#![allow(unreachable_pub, reason = "public to the languages")]

mod angles;
pub mod body;
mod dimensions;
pub mod labels;
pub mod legend;
mod names;
pub mod operations;
pub mod outline;
mod output_ranges;
pub mod statement;
#[cfg(test)]
mod tests;
pub mod text;
