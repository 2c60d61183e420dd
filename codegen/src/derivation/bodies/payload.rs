//! Payloads on bodies: their inertial parameters as combinations of those of the body.
//!
//! A payload's frame has the origin p and the orientation R in the body's frame. Parameters m, s
//! and I about the payload's frame are, about that of the body,
//!
//! - m' = m and s' = R s + m p;
//! - I' = R I Rᵀ + 2 (p · R s) 1 - p (R s)ᵀ - (R s) pᵀ + m (p² 1 - p pᵀ).
//!
//! The model is linear in the parameters, so a column of the payload is the same combination of
//! the body's columns.

use crate::cas::{Arena, Expr, Matrix3, Vector3};
use crate::derivation::kinematics::orientation::constant_rotation;
use crate::derivation::parameter::BodyParameter;
use crate::mechanism::{FrameBody, Payload};
use overact_description::StandardParameter;

/// The body's parameters with factors that one unit parameter of a payload amounts to.
pub(crate) fn on_body<'a>(
    arena: &'a Arena,
    payload: &Payload,
    symbol: StandardParameter,
) -> Vec<(BodyParameter, Expr<'a>)> {
    use StandardParameter as P;
    let rotation = constant_rotation(arena, payload.placement.rotation);
    let at = Vector3::constant(arena, payload.placement.at);
    let mut mass = arena.zero();
    let mut first = Vector3::zero(arena);
    let mut second = [[arena.zero(); 3]; 3];
    let product = |i: usize, j: usize| {
        let entry = |a: usize, b: usize| (a, b) == (i, j) || (b, a) == (i, j);
        let inner = Matrix3(std::array::from_fn(|a| {
            std::array::from_fn(|b| arena.integer(i64::from(entry(a, b))))
        }));
        let rows: [[Expr<'a>; 3]; 3] = std::array::from_fn(|a| {
            let turned = inner * Vector3(rotation.0[a]);
            std::array::from_fn(|b| turned.dot(Vector3(rotation.0[b])))
        });
        rows
    };
    match symbol {
        P::M => mass = arena.one(),
        P::Mx => first = rotation.column(0),
        P::My => first = rotation.column(1),
        P::Mz => first = rotation.column(2),
        P::Xx => second = product(0, 0),
        P::Xy => second = product(0, 1),
        P::Xz => second = product(0, 2),
        P::Yy => second = product(1, 1),
        P::Yz => second = product(1, 2),
        P::Zz => second = product(2, 2),
        _ => {}
    }
    let dot = at.dot(first);
    let trace = dot + dot + mass * at.dot(at);
    for (i, row) in second.iter_mut().enumerate() {
        for (j, entry) in row.iter_mut().enumerate() {
            let crossed = at.0[i] * first.0[j] + first.0[i] * at.0[j];
            *entry = *entry - crossed - mass * (at.0[i] * at.0[j]);
            if i == j {
                *entry = *entry + trace;
            }
        }
    }
    let first = first + at.scaled(mass);
    let all = [
        (P::Xx, second[0][0]),
        (P::Xy, second[0][1]),
        (P::Xz, second[0][2]),
        (P::Yy, second[1][1]),
        (P::Yz, second[1][2]),
        (P::Zz, second[2][2]),
        (P::Mx, first.0[0]),
        (P::My, first.0[1]),
        (P::Mz, first.0[2]),
        (P::M, mass),
    ];
    let of_body = |symbol: P| match payload.body {
        FrameBody::Platform => BodyParameter::Platform(symbol),
        FrameBody::Joint(body) => BodyParameter::Leg {
            leg: body.leg,
            joint: body.joint,
            symbol,
        },
    };
    let terms = all.into_iter().filter(|(_, factor)| !factor.is_zero());
    terms
        .map(|(symbol, factor)| (of_body(symbol), factor))
        .collect()
}
