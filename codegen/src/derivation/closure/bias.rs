//! Bias acceleration of a leg's end: its acceleration when all quasi-accelerations u̇ are zero.

use crate::cas::{Arena, Expr, Vector3};
use crate::derivation::kinematics::frames::{LegFrames, path_to_end};
use crate::derivation::kinematics::rates::Rates;
use crate::derivation::kinematics::spatial::SpatialMotion;
use crate::mechanism::{JointKind, Leg};

/// A term of the end's acceleration at u̇ = 0.
#[derive(Debug, Clone, Copy)]
pub struct BiasTerm<'a> {
    /// A factor, for instance -ω².
    pub scalar: Expr<'a>,
    /// The acceleration per unit of the factor.
    pub acceleration: SpatialMotion<'a>,
}

/// Angular velocity and acceleration of a frame on the path.
#[derive(Clone, Copy)]
struct AngularState<'a> {
    /// Angular velocity ω.
    omega: Vector3<'a>,
    /// Angular acceleration β at u̇ = 0.
    beta: Vector3<'a>,
}

/// The end's linear and angular acceleration in the base frame at u̇ = 0, as a sum of terms.
///
/// Along the path, with ω the angular velocity of the antecedent and q̇ the joint rate:
/// ω' = ω + z q̇, β' = β + ω × z q̇, b' = b + β × l + ω (ω · l) - ω² l + 2 ω × z ṙ.
#[must_use]
pub(crate) fn end_bias<'a>(
    arena: &'a Arena,
    leg: &Leg,
    frames: &LegFrames<'a>,
    rates: &Rates,
    u: &[Expr<'a>],
) -> Vec<BiasTerm<'a>> {
    let zero = Vector3::zero(arena);
    let mut terms = Vec::new();
    let mut add = |scalar: Expr<'a>, linear: Vector3<'a>, angular: Vector3<'a>| {
        let is_zero = scalar.is_zero() || (linear.is_zero() && angular.is_zero());
        if !is_zero {
            terms.push(BiasTerm {
                scalar,
                acceleration: SpatialMotion { linear, angular },
            });
        }
    };
    let path = path_to_end(leg);
    let mut states: Vec<AngularState<'a>> = Vec::new();
    for (index, joint) in leg.joints.iter().enumerate() {
        let still = AngularState {
            omega: zero,
            beta: zero,
        };
        let AngularState { omega, beta } = joint.antecedent.map_or(still, |a| states[a]);
        let frame = &frames.frames[index];
        let rate = frame.axis().scaled(rates.joint[index].value(arena, u));
        let mut next = AngularState { omega, beta };
        if joint.kind == JointKind::Revolute {
            next = AngularState {
                omega: omega + rate,
                beta: beta + omega.cross(rate),
            };
        }
        if path.contains(&index) {
            let link = frame.link;
            add(-omega.dot(omega), link, zero);
            add(omega.dot(link), omega, zero);
            add(arena.one(), beta.cross(link), zero);
            if joint.kind == JointKind::Prismatic {
                add(arena.integer(2), omega.cross(rate), zero);
            }
        }
        states.push(next);
    }
    if let Some(last) = states.last() {
        add(arena.one(), zero, last.beta);
    }
    terms
}
