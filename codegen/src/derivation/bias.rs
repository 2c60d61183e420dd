//! The acceleration of a leg's end that is left when all quasi-accelerations u̇ are zero.

use super::frames::{LegFrames, path_to_end};
use super::rates::Rates;
use crate::cas::{Arena, Expr, Vector3};
use crate::mechanism::{JointKind, Leg};

/// A part of the end's acceleration at u̇ = 0: scalar × (linear, angular).
#[derive(Debug, Clone, Copy)]
pub struct BiasTerm<'a> {
    /// The common factor, for instance -ω².
    pub scalar: Expr<'a>,
    /// Linear acceleration per unit of the factor.
    pub linear: Vector3<'a>,
    /// Angular acceleration per unit of the factor.
    pub angular: Vector3<'a>,
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
                linear,
                angular,
            });
        }
    };
    let path = path_to_end(leg);
    // Angular velocity and angular bias of every frame.
    let mut states: Vec<[Vector3<'a>; 2]> = Vec::new();
    for (index, joint) in leg.joints.iter().enumerate() {
        let [omega, beta] = joint.antecedent.map_or([zero; 2], |a| states[a]);
        let frame = &frames.frames[index];
        let rate = frame.axis().scaled(rates.joint[index].value(arena, u));
        let mut next = [omega, beta];
        if joint.kind == JointKind::Revolute {
            next = [omega + rate, beta + omega.cross(rate)];
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
    if let Some([_, beta]) = states.last() {
        add(arena.one(), zero, *beta);
    }
    terms
}
