//! Numbers with dimensions: tokens, expressions, functions and units of a description.

pub(crate) mod dimension;
pub(crate) mod expression;
pub(crate) mod formula;
pub(crate) mod function;
pub(crate) mod scalar;
pub(crate) mod token;
pub(crate) mod value;
