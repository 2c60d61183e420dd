//! Estimation of parameters while the robot moves, in bounded memory and time.
//!
//! A sample gives rows of the regressor W, torques y and their standard deviation σ:
//! y = W χ + e. The [`Filter`] keeps an upper triangular R and z with
//!
//! R χ = z, covariance of χ = R⁻¹R⁻ᵀ.
//!
//! Givens rotations add each row over σ (Bierman, *Factorization Methods for Discrete Sequential
//! Estimation*, 1977):
//!
//! Qᵀ [R z; w/σ y/σ] = [R' z'; 0 ν],
//!
//! where ν is the [`Innovation`] in its standard deviations. Without forgetting, R' is the factor
//! of batch least squares of the same rows.
//!
//! | item | purpose |
//! |---|---|
//! | [`Filter`] | estimate and covariance of P parameters, with or without prior |
//! | [`Forgetting`] | old information loses weight: not at all, exponentially, along excited directions |
//! | [`ChangeTest`] | two-sided CUSUM of innovations with a given rate of false alarms |
//! | [`Whitening`] | innovations without correlation in time, for the change test |
//! | [`StateVariableFilter`] | q, q̇, q̈ from positions, and torques with the same delay |
//! | [`PayloadEstimator`] | mass, centre and inertia of a payload, physically consistent |
//! | [`SliceFilter`] | the filter for a number of parameters known at run time |
//!
//! [`C_FILES`] are the same estimators in C.
//!
//! All items work with `f64` and `f32`. None allocates or panics. Numbers that are not finite or
//! too large are rejected and leave the state unchanged. A regular R stays regular.
//!
//! With `f32`, rounding limits the memory: after about 10⁷ equal rows, new rows have no effect. Use
//! forgetting there.

mod bounds;
mod c_files;
mod change;
mod error;
mod filter;
mod forgetting;
mod innovation;
mod payload;
mod slices;
mod state_variable;
mod triangle;
mod whitening;

pub use c_files::{C_FILES, CFile};
pub use change::{Change, ChangeTest};
pub use error::Error;
pub use filter::Filter;
pub use forgetting::Forgetting;
pub use innovation::Innovation;
pub use payload::{Payload, PayloadEstimator, PayloadSize};
pub use slices::{FilterState, SliceFilter};
pub use state_variable::{Signal, StateVariableFilter};
pub use whitening::Whitening;
