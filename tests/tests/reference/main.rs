//! Tests of the numeric reference: the paper's formulas, finite differences and Lagrange's
//! equations.

mod dualv;
mod dynamics;
mod errors;
mod kinematics;
mod lagrange;
mod ranks;
