//! Tests of the workspace against numbers that were found independently.

pub mod reference;
