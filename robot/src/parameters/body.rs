//! Maps standard parameters to the bodies that they belong to.

use overact::Body;
use overact_codegen::{derivation::BodyParameter, mechanism::Mechanism};

/// Body of a standard parameter.
pub(crate) fn body(mechanism: &Mechanism, parameter: BodyParameter) -> Body {
    match parameter {
        BodyParameter::Platform(_) => Body::Platform,
        BodyParameter::Payload(_) | BodyParameter::Load { .. } => Body::Payload,
        BodyParameter::Spring(index) => Body::Spring {
            index: small(index),
        },
        BodyParameter::Motor { motor, .. } => Body::Motor {
            index: small(motor),
        },
        BodyParameter::Leg { leg, joint, .. } => leg_body(
            leg,
            joint,
            mechanism.legs.get(leg).map_or(0, |leg| leg.shape),
        ),
    }
}

/// Body of a leg, by indices; descriptions are too small for these to saturate.
pub(crate) fn leg_body(leg: usize, index: usize, shape: usize) -> Body {
    Body::Leg {
        leg: small(leg),
        index: small(index),
        shape: small(shape),
    }
}

fn small(number: usize) -> u16 {
    u16::try_from(number).unwrap_or(u16::MAX)
}
