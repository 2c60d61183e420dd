//! From bodies and closures to a skeleton and chains.

pub(crate) mod ears;
pub(crate) mod idle;
pub(crate) mod layout;
pub(crate) mod motion;
pub(crate) mod network;
pub(crate) mod simple;
