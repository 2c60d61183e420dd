//! Fault hypotheses, tested on the residual of an estimate.
//!
//! A hypothesis has one unknown size δ: torques are delayed by δ seconds, the gain of a drive has
//! the relative error δ, a joint has a spring of stiffness δ. To first order it adds a column z δ
//! to Y = W χ. Wald's test decides whether δ is zero. With the part of z outside the columns W,
//! z⊥ = z - W B with B = (Wᵀ W)^-1 Wᵀ z, and the residual ρ,
//!
//! ```text
//! δ = z⊥ᵀ ρ/(z⊥ᵀ z⊥),   χ is off by B δ.
//! ```
//!
//! The standard deviation of δ is estimated from ρ - z⊥ δ, as if δ were a parameter of the model.
//! The residual ρ itself contains the fault and would hide it. B δ is the shift of the parameters.
//! A certain fault that shifts no parameter is a remark; a shift of several standard deviations
//! makes the parameter unusable.
//!
//! Three errors of the model are not faults but resemble them:
//!
//! - Position errors enter as accelerations, with the square of the frequency, and the controller
//!   answers them with torques. Torques and accelerations are then correlated, as after a delay.
//!   The tests use half of the estimate's band, which contains a thirtieth of this error.
//! - A joint sticks around reversals, which no function of a filtered velocity describes. Each dry
//!   friction column w therefore has a column -ẇ in the model, as for a delay of its own.
//! - Some errors are equal in each period of the motion: friction at reversals, steps of an
//!   encoder. Slow variations of the scores do not show them. In periodic motion, the standard
//!   deviation is at least that of the mean over all periods (`estimation::periodic_variance`).
//!
//! Columns made of torques use τ - J (Jᵀ J)^-1 ρ, the torques without the residual. Measured
//! torques contain the noise of the residual, which would make every drive appear faulty.
//!
//! - `shapes`: dependence of a missing torque on the motion;
//! - `columns`: hypotheses and their columns;
//! - `misreading`: dependence of an encoder error on the position;
//! - `potential`: constant forces and weights that the first joints of a tree feel;
//! - `prediction`: prediction for a slightly different motion;
//! - `sections`: products of columns and residual, by section of the time;
//! - `pairs`, `correlations`: correlated residuals of actuators;
//! - `pace`: residual and motion over time;
//! - `pass`: inputs of a pass over a run; `motion_data`: data of the rows; `run`: the pass;
//! - `products`: products of the columns of a line, as far as they are not always zero;
//! - `scores`: result of all passes;
//! - `model_columns`: the model's columns in a test;
//! - `scaled`: normal equations of columns with different units;
//! - `score_covariance`: covariance of the scores;
//! - `group`: columns that are tested together;
//! - `test`: sizes, standard deviations, p-values; `wald_test`: their result.

mod columns;
mod correlations;
mod group;
mod misreading;
mod model_columns;
mod motion_data;
mod pace;
mod pairs;
mod pass;
mod potential;
mod prediction;
mod products;
mod run;
mod scaled;
mod score_covariance;
mod scores;
mod sections;
mod shapes;
mod test;
mod wald_test;

pub(crate) use columns::{FaultHypothesis, fault_hypotheses, gear_hypotheses};
pub(crate) use correlations::Correlation;
pub(crate) use group::Group;
pub(crate) use misreading::Misreading;
pub(crate) use pace::{Pace, is_quasi_static};
pub(crate) use scores::{ScoreTest, Scores};
pub(crate) use shapes::{PositionRange, Shape, wave_amplitude};
pub(crate) use wald_test::WaldTest;
