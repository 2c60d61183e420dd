//! A walk over the TOML text that collects every error with its location.

pub(crate) mod place;
pub(crate) mod reader;
pub(crate) mod scope;
