//! Course of a cable from its exit point over a pulley to a platform point P.
//!
//! From a fixed eyelet E the cable is straight: ℓ = |P - E|, e = (P - E)/ℓ. Its direction turns with
//! the velocity across it, ė · Ṗ = (Ṗ² - ℓ̇²)/ℓ.
//!
//! A pulley of radius ρ swivels about the z axis of the leg's base frame, along which the cable
//! reaches it at the exit point. In the plane of that axis and P, with r the distance of P from the
//! axis and h its height, the centre is at (ρ, 0) and d² = (r - ρ)² + h². The straight part has the
//! length s = √(d² - ρ²) and the direction (sin β, cos β), with the wrapped angle β:
//!
//! - d² sin β = ρ h + s (r - ρ), d² cos β = s h - ρ (r - ρ);
//! - ℓ = s + ρ β, and ∂ℓ/∂P = e, since the wrapped arc is stationary;
//! - ė · Ṗ = v_t²/s + sin β v_b²/r, with the velocities of P across the cable in the plane, v_t, and
//!   across the plane, v_b.

use crate::cas::{Arena, Expr, Number, Vector3};
use crate::derivation::guard::{Guard, GuardKind};
use crate::derivation::kinematics::orientation::constant_rotation;
use crate::mechanism::{Cable, Leg};
use std::f64::consts::FRAC_PI_2;

/// The course of a cable, in the axes of the robot's base.
#[derive(Debug)]
pub(crate) struct CableCourse<'a> {
    /// Length ℓ from the exit point to the platform point, m.
    pub(crate) length: Expr<'a>,
    /// Vector along the straight part.
    pub(crate) along: Vector3<'a>,
    /// Factor that makes it a unit vector.
    pub(crate) factor: Expr<'a>,
    /// The length by which it divides, ℓ or s, m.
    pub(crate) divisor: Expr<'a>,
    /// The pulley; `None` for an eyelet.
    pulley: Option<Swivel<'a>>,
}

/// The plane of a pulley.
#[derive(Debug)]
struct Swivel<'a> {
    /// Unit vector in the plane across the straight part.
    across: Vector3<'a>,
    /// Unit vector normal to the plane, divided by r; zero if the plane never turns.
    turning: Vector3<'a>,
    /// r sin β.
    lever: Expr<'a>,
}

/// The course of a leg's cable, with the conditions for it to exist.
///
/// `between` is the vector from the exit point to the platform point in base axes; `home` evaluates an expression at the home configuration.
pub(crate) fn cable_course<'a>(
    arena: &'a Arena,
    leg: &Leg,
    cable: &Cable,
    between: Vector3<'a>,
    home: &dyn Fn(Expr<'a>) -> f64,
) -> (CableCourse<'a>, Vec<Guard<'a>>) {
    if cable.pulley.is_zero() {
        let length = between.dot(between).sqrt();
        let course = CableCourse {
            length,
            along: between,
            factor: length.reciprocal(),
            divisor: length,
            pulley: None,
        };
        return (course, Vec::new());
    }
    let radius = arena.number(cable.pulley);
    let axes = constant_rotation(arena, leg.base.rotation);
    let local = axes.transposed() * between;
    let height = local.z();
    let plane = SwivelPlane::new(arena, local, home);
    let from_axis = plane.distance.named(&format!("from_axis_{}", leg.name));
    let beyond = from_axis - radius;
    let square = beyond.squared() + height.squared();
    let radicand = square - radius.squared();
    let straight = radicand.sqrt().named(&format!("straight_{}", leg.name));
    let inverse = square.reciprocal();
    // d² sin β and d² cos β.
    let [sine, cosine] = [
        radius * height + straight * beyond,
        straight * height - radius * beyond,
    ];
    let quarter = arena.number(Number::float(FRAC_PI_2));
    let wrapped = (-cosine).atan2(sine) + quarter;
    let wrapped = wrapped.named(&format!("wrapped_{}", leg.name));
    let sine = (sine * inverse).named(&format!("s_wrapped_{}", leg.name));
    let cosine = (cosine * inverse).named(&format!("c_wrapped_{}", leg.name));
    let zero = arena.zero();
    let in_plane = |out: Expr<'a>, up: Expr<'a>| {
        let local = plane.outwards.scaled(plane.scale * out) + Vector3([zero, zero, up]);
        axes * local
    };
    let normal = Vector3([-plane.outwards.0[1], plane.outwards.0[0], zero]);
    let turning = if plane.is_turning {
        axes * normal.scaled(plane.scale * from_axis.reciprocal())
    } else {
        Vector3::zero(arena)
    };
    let swivel = Swivel {
        across: in_plane(cosine, -sine),
        turning,
        lever: from_axis * sine,
    };
    let guard = |value: Expr<'a>, kind: fn(f64) -> GuardKind| Guard {
        value,
        kind: kind(home(value).abs()),
        leg: leg.name.clone(),
    };
    let guards = vec![
        guard(radicand, GuardKind::Reach),
        guard(from_axis, GuardKind::Reach),
    ];
    let course = CableCourse {
        length: straight + radius * wrapped,
        along: in_plane(sine, cosine),
        factor: arena.one(),
        divisor: straight,
        pulley: Some(swivel),
    };
    (course, guards)
}

/// The plane of the swivel axis and a point.
struct SwivelPlane<'a> {
    /// Distance r of the point from the axis; in a fixed plane a coordinate with its sign at home.
    distance: Expr<'a>,
    /// Vector from the axis to the point.
    outwards: Vector3<'a>,
    /// Factor that makes it a unit vector.
    scale: Expr<'a>,
    /// Whether the plane turns.
    is_turning: bool,
}

impl<'a> SwivelPlane<'a> {
    /// The plane of a point in axes whose z axis is the swivel axis.
    fn new(arena: &'a Arena, local: Vector3<'a>, home: &dyn Fn(Expr<'a>) -> f64) -> Self {
        let (zero, one) = (arena.zero(), arena.one());
        let (x, y) = (local.x(), local.y());
        let fixed = |coordinate: Expr<'a>, axis: Vector3<'a>| {
            let sign = if home(coordinate) < 0.0 { -one } else { one };
            Self {
                distance: coordinate * sign,
                outwards: axis,
                scale: sign,
                is_turning: false,
            }
        };
        if y.is_zero() {
            return fixed(x, Vector3([one, zero, zero]));
        }
        if x.is_zero() {
            return fixed(y, Vector3([zero, one, zero]));
        }
        let distance = (x.squared() + y.squared()).sqrt();
        Self {
            distance,
            outwards: Vector3([x, y, zero]),
            scale: distance.reciprocal(),
            is_turning: true,
        }
    }
}

impl<'a> CableCourse<'a> {
    /// ė · Ṗ, the part of the second derivative of the length that the turning direction causes.
    pub(crate) fn turning(&self, velocity: Vector3<'a>, rate: Expr<'a>) -> Expr<'a> {
        let Some(pulley) = &self.pulley else {
            return (velocity.dot(velocity) - rate.squared()) * self.factor;
        };
        let across = pulley.across.dot(velocity).squared() * self.divisor.reciprocal();
        across + pulley.turning.dot(velocity).squared() * pulley.lever
    }
}
