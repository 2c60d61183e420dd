//! From where on numbers count as zero, for each precision that robots are computed in.
//!
//! A limit is a number of roundings away from zero, and so of another size where numbers are shorter. The
//! runtime, the interpreter and generated C take theirs from here.

use crate::singular::SINGULAR;

/// The limits of a precision.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// A determinant below this fraction of its magnitude at home counts as zero.
    pub singular: f64,
    /// How far from 1 the square of a quaternion's length may be for its inverse root to be linear: the error is 3/8
    /// of the square of this.
    pub quaternion: f64,
    /// Forward kinematics has converged when the largest step is below this (m, rad).
    pub step: f64,
    /// Beyond (m, rad) a pose is rounded by more than that step, and steps vanish that have led nowhere.
    pub farthest: f64,
    /// A pivot of the normal matrix below this fraction of the largest counts as zero.
    pub pivot: f64,
    /// Newton's method on the joints has converged when the largest step is below this (m, rad).
    pub joint_step: f64,
    /// A leg whose closure errors (m, rad) are smaller counts as closed when the iterations are used up.
    pub closed: f64,
    /// A partition of case 2 whose condition number is larger counts as singular.
    pub partition: f64,
}

/// Of numbers of 64 bits, whose roundings are 10⁻¹⁶ of them.
pub const DOUBLE: Limits = Limits {
    singular: SINGULAR,
    quaternion: 1e-8,
    step: 1e-12,
    farthest: 4e3,
    pivot: 1e-15,
    joint_step: 1e-13,
    closed: 1e-10,
    partition: 1e9,
};

/// Of numbers of 32 bits, whose roundings are 6 · 10⁻⁸ of them. Lengths and angles of about 1 are known to 10⁻⁷, and
/// steps of an iteration, which divide by a Jacobian, to some 10⁻⁶.
pub const SINGLE: Limits = Limits {
    singular: 1e-5,
    quaternion: 2e-4,
    step: 1e-5,
    farthest: 80.0,
    pivot: 1e-7,
    joint_step: 3e-6,
    closed: 3e-5,
    partition: 1e5,
};
