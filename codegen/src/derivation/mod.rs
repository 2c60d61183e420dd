//! From the mechanism to symbolic kinematics, Jacobians and regressors.
//!
//! `closure` opens the robot at its platform and closes it again, eqs. (9) to (13): quasi-velocities
//! (`rates`), joints and `frames` in the axes that suit the leg (`orientation`), and the wrenches that feel
//! one joint alone (`elimination`, `bias`). `body` runs the recursion of Newton and Euler in the bodies' own
//! frames, `carried` has those that move with the platform, `spring` has what a
//! joint's position adds to its torque and `friction` what its rate does, `centres` finds axes that meet in a point.
//! `parasitic` and `blocked` have platforms whose legs block directions that change with the pose. `regressor` projects what each standard parameter produces on the platform, eq. (30), or on kept
//! actuators, eq. (36). `robot` holds one derivation together. `inverse_kinematics` finds joints from a pose
//! and `forward_kinematics` a pose from actuators, in closed form where there is one. `functions` says what
//! each function is made of, on a `context`: its `kinematics`, its `dynamics`, the systems between platform and
//! `actuators`, and the `matrices` of the
//! closure equations.

#![allow(unreachable_pub, reason = "public to the files of this folder")]

mod actuators;
mod bias;
mod blocked;
mod body;

mod centres;
#[cfg(test)]
mod closed_forms;
mod closure;
mod composite;
mod configuration;
mod constant_columns;
mod context;
mod derivable;
mod divisors;
mod dynamics;
mod elimination;
mod forward_dynamics;
mod forward_kinematics;
mod frames;
mod friction;
mod function_form;
mod functions;
mod guard;
mod inertia;
mod inventory;
mod inverse_kinematics;
mod joint;
mod kinematics;
mod leg;
mod legs;
mod linear;
mod masses;
mod matrices;
mod motion;
mod motion_input;
mod names;
mod naming;
mod newton_euler;
mod null_space;
mod orientation;
mod parameter;
mod parasitic;
mod path;
mod platform;
mod platform_body;
mod pose_step;
mod rates;
mod regressor;
mod robot;
mod selection;

mod spatial;
mod spring;
mod sums;
mod tree_masses;
mod turn;
mod underivable;

pub(crate) use derivable::derivable;
pub use function_form::FunctionForm;
pub use functions::{Derived, derive};
pub(crate) use guard::{Guard, GuardKind};
pub(crate) use inventory::sources;
pub use inventory::{function_name, inventory};
pub(crate) use inverse_kinematics::working_modes;
pub use motion_input::MotionInput;
pub(crate) use orientation::{closure_frame_choices, may_use_any_axes};
pub use parameter::BodyParameter;
pub(crate) use path::observer_frame_choices;
pub use selection::{Combination, DynamicsBy, Formulation, JointsBy, Selection};
pub(crate) use sums::{Addends, LegRowLayout, ROWS, SUMS};
pub(crate) use sums::{derive_addends, derive_of_rows, derive_of_sums};
pub use underivable::Underivable;
