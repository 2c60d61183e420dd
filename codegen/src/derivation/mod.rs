//! From the mechanism to symbolic kinematics, Jacobians and regressors.
pub mod body;
pub mod configuration;
pub mod elimination;
pub mod family;
pub mod functions;
pub mod inverse_kinematics;
pub mod leg;
pub mod linear;
pub mod platform;
pub mod rates;
pub mod regressor;
pub mod robot;

pub use configuration::From;
pub use family::{Columns, Family};
pub use functions::{Combination, Derived, JointsBy, Selection, derive};
pub use regressor::BodyParameter;
pub use robot::{Guard, GuardKind, Robot, Underivable};
