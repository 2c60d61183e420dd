//! Dependencies with the same features as in other packages of the workspace.
//!
//! Cargo builds a package once for each set of features of its dependencies. The optimised
//! generator takes a minute of processor time to build, for tests and commands, for macro and build
//! script, and for `cargo xtask`. Equal features share one build.
