//! Nothing but dependencies: the features in which other packages of the workspace need crates that the
//! generator stands on.
//!
//! Cargo builds a package once for each set of features of what it depends on. The generator is built
//! optimised, which takes a minute of processor time, for tests and commands on one side, for the macro
//! and a build script on the other, and for `cargo xtask` by itself. With the same features on all sides
//! one build serves all.
