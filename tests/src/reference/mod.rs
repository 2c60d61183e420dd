//! Purely numeric reference of the models of parallel robots, redundant or not.
//!
//! The generator derives symbolic models. This module computes the same quantities by other
//! means, so that a wrong sign on either side shows:
//!
//! - every vector is expressed in the base frame; body frames serve only to store constants;
//! - a Jacobian's column is the velocity that one unit rate causes, found by forward recursion;
//! - a Jacobian's time derivative never appears: the recursion with zero accelerations gives the
//!   bias accelerations of (10) exactly;
//! - joint positions come from Newton's method on the closure (7), whatever the leg;
//! - torques of the virtual tree come from the recursive Newton-Euler algorithm;
//! - loops are closed with Lagrange multipliers, solved by singular value decomposition.
//!
//! Order of use: a [`Mechanism`] (plain data) gives a [`State`] (pose, twist, acceleration and all
//! joints), the state gives its [`Jacobians`] and, with [`Dynamics`], torques and regressors.
//!
//! Equation numbers are those of Briot, Krut and Gautier, "Dynamic Parameter Identification of
//! Overactuated Parallel Robots" (2015), in their corrected form.

pub mod cables;
pub mod closure;
pub mod dynamics;
pub mod elements;
pub mod energy;
pub mod jacobians;
pub mod kinematics;
pub mod linear;
pub mod masses;
pub mod mechanism;
pub mod motion;
pub mod motors;
pub mod newton_euler;
pub mod parameters;
pub mod placement;
pub mod robots;
pub mod states;
pub mod torques;
pub mod trajectory;
pub mod units;

use std::fmt;

pub use closure::State;
pub use dynamics::Dynamics;
pub use jacobians::Jacobians;
pub use mechanism::{
    Element, ElementBody, ElementEnd, End, Joint, JointKind, Law, Leg, Mechanism, Motor, Spring,
};
pub use motion::Motion;
pub use placement::Frame;

/// Why a quantity can't be computed. Legs are counted from 0.
#[derive(Clone, Debug, PartialEq)]
pub enum Error {
    /// Newton's method left a closure residual above the tolerance.
    NoConvergence {
        /// Leg that can't reach the platform.
        leg: usize,
        /// Norm of the remaining residual, in metres and radians.
        residual: f64,
    },
    /// A leg can't follow the platform: its equations contradict each other.
    Inconsistent {
        /// Leg whose equations have no solution.
        leg: usize,
        /// Relative residual of the least-squares solution.
        residual: f64,
    },
    /// The independent equations of a leg aren't as many as its joint variables.
    NotSquare {
        /// Leg whose Jacobian isn't square.
        leg: usize,
        /// Number of independent equations found.
        equations: usize,
        /// Number of joint variables.
        variables: usize,
    },
    /// A system of equations is singular, or has no exact solution.
    Singular(&'static str),
    /// No regular state was found in the number of attempts allowed.
    NoRegularState,
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoConvergence { leg, residual } => {
                write!(
                    f,
                    "leg {leg} does not reach the platform (residual {residual:e})"
                )
            }
            Self::Inconsistent { leg, residual } => {
                write!(
                    f,
                    "leg {leg} can't follow the platform (residual {residual:e})"
                )
            }
            Self::NotSquare {
                leg,
                equations,
                variables,
            } => {
                write!(
                    f,
                    "leg {leg} has {equations} equations for {variables} variables"
                )
            }
            Self::Singular(what) => write!(f, "{what} is singular"),
            Self::NoRegularState => write!(f, "no regular state found"),
        }
    }
}

impl std::error::Error for Error {}
