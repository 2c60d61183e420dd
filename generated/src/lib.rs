//! The robots of `robots/`, generated and checked in: to use, to read beside the paper, to compare.
//!
//! One module per description. `overact generate robots/*.toml -o generated/src` writes them, and with
//! `--check` says whether they are up to date.

#[rustfmt::skip]
mod dualv;
#[rustfmt::skip]
mod emps;

pub use dualv::DualV;
pub use emps::Emps;
