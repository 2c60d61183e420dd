//! From the mechanism to symbolic kinematics, Jacobians and regressors.
//!
//! Folders in the order of a derivation; imports between them run upwards in this table only.
//!
//! | folder | content |
//! |---|---|
//! | `linear_algebra` | elimination and inverses, least squares, null spaces |
//! | `kinematics` | configuration, frames, rates, the pose of the platform, joints from the pose |
//! | `closure` | closure of a leg and reduced Jacobians, eqs. (9) to (13); parasitic motion of the platform |
//! | `bodies` | motion, inertia and unit wrenches of bodies |
//! | `robot` | the derivation of one robot: legs, constraints, motion |
//! | `dynamics` | joint forces, mass matrices, the recursion of Newton and Euler |
//! | `regressor` | one column per standard parameter, on the platform, eq. (30), or on kept actuators, eq. (36) |
//! | `frames` | frames on bodies: pose, Jacobian, motion |
//! | `derivatives` | linearised graphs along displacements and with respect to the twist |
//! | `forward` | forward kinematics and forward dynamics |
//! | `functions` | the functions of the table, from inputs to outputs |
//!
//! Files in this folder itself are shared: inputs of functions, choices for a robot, guards, names.
//! `DerivationContext` holds the state of one function's derivation.

#![allow(unreachable_pub, reason = "public to the files of this folder")]

mod bodies;
mod closure;
mod context;
mod derivation_error;
mod derivatives;
mod dynamics;
mod forward;
mod frames;
mod function_form;
mod functions;
mod guard;
mod kinematics;
mod linear_algebra;
mod motion_input;
mod names;
mod parameter;
mod regressor;
mod robot;
mod selection;

pub use derivation_error::DerivationError;
pub use function_form::FunctionForm;
pub(crate) use functions::inventory::sources;
pub use functions::inventory::{function_name, inventory, name_in_robot};
pub(crate) use functions::sums::{Addends, LegRowLayout, ROWS, SUMS};
pub(crate) use functions::sums::{derive_addends, derive_of_rows, derive_of_sums};
pub use functions::{Derived, derive};
pub(crate) use guard::{Guard, GuardKind, rounded_magnitude};
pub(crate) use kinematics::inverse_kinematics::working_modes;
pub(crate) use kinematics::orientation::{closure_frame_choices, may_use_any_axes};
pub(crate) use kinematics::path::observer_frame_choices;
pub use motion_input::MotionInput;
pub use parameter::BodyParameter;
pub(crate) use robot::derivable::derivable;
pub use selection::{Combination, DynamicsBy, Formulation, JointsBy, Selection};
