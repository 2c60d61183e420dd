//! Derives a skeleton and chains from bodies and closures.

pub(crate) mod blocks;
pub(crate) mod idle;
pub(crate) mod layout;
pub(crate) mod motion;
pub(crate) mod network;
pub(crate) mod simple;
pub(crate) mod solvable_chains;
