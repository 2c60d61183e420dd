//! Traversal of the TOML text that collects all errors with their locations.

pub(crate) mod place;
pub(crate) mod reader;
pub(crate) mod scope;
