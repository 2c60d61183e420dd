//! From the mechanism to symbolic kinematics, Jacobians and regressors.
//!
//! [`leg`] opens the robot at its platform and closes it again, eqs. (9) to (13): quasi-velocities
//! ([`rates`]), frames in the axes that suit the leg ([`orientation`]), and the wrenches that feel one joint alone ([`elimination`], [`bias`]). [`body`]
//! runs the recursion of Newton and Euler in the bodies' own frames, [`carried`] has those that move with the
//! platform, [`centres`] finds axes that meet in a point. [`regressor`] projects what each
//! standard parameter produces on the platform, eq. (30), or on kept actuators, eq. (36). [`robot`] holds
//! one derivation together. [`inverse_kinematics`] finds joints from a pose and [`forward_kinematics`] a
//! pose from actuators, in closed form where there is one, and [`functions`] names what comes out of it.

pub mod bias;
pub mod body;
pub mod carried;
pub mod centres;
#[cfg(test)]
mod closed_forms;
pub mod configuration;
pub mod elimination;
pub mod family;
pub mod forward_kinematics;
pub mod functions;
pub mod guard;
pub mod inverse_kinematics;
pub mod leg;
pub mod linear;
mod matrices;
pub mod motion_input;
pub mod orientation;
pub mod parameter;
pub mod platform;
pub mod rates;
pub mod regressor;
pub mod robot;
pub mod selection;
pub mod underivable;

pub use family::{Columns, Family};
pub use functions::{Derived, derive};
pub use guard::{Guard, GuardKind};
pub use motion_input::MotionInput;
pub use orientation::station_count;
pub use parameter::BodyParameter;
pub use robot::Robot;
pub use selection::{Combination, Formulation, JointsBy, Selection};
pub use underivable::Underivable;
