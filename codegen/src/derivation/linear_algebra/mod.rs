//! Symbolic linear algebra: elimination and inverses, least squares, null spaces.

pub(crate) mod constant_columns;
pub(crate) mod elimination;
pub(crate) mod linear;
pub(crate) mod null_space;
