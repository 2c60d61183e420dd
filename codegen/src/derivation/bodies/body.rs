//! Bodies in their own frames: velocities, accelerations, partial velocities, and the wrench of
//! each standard parameter.
//!
//! The recursion is Khalil's: with `U = [ω̇]× + [ω]×[ω]×`, the acceleration of the next origin is
//! a + U l. Gravity enters as an acceleration -g of the base. Partial velocities ∂V/∂u_i and
//! ∂Ω/∂u_i follow the same path. By virtual power (Kane), the generalised force of parameter p on
//! u_i is their scalar product with the wrench of p alone.

use crate::cas::{Arena, Expr, Matrix3, Vector3};
use crate::derivation::closure::leg::LegState;
use crate::derivation::kinematics::configuration::Configuration;
use crate::derivation::kinematics::joint::link_vector;
use crate::derivation::kinematics::orientation::constant_rotation;
use crate::derivation::kinematics::platform::centripetal;
use crate::derivation::kinematics::spatial::{SpatialMotion, Wrench};
use crate::derivation::kinematics::turn::Turn;
use crate::mechanism::{JointKind, Leg};
use overact_description::StandardParameter;

/// Axes that meet in a point, relative to a body.
#[derive(Debug, Clone)]
pub struct Lever<'a> {
    /// From the point to the frame's origin.
    pub vector: Vector3<'a>,
    /// Quasi-velocities of these axes.
    pub axes: Vec<usize>,
}

/// The motion of a body in its own frame.
#[derive(Debug, Clone)]
pub struct BodyMotion<'a> {
    /// Angular velocity ω.
    pub omega: Vector3<'a>,
    /// Angular acceleration ω̇.
    pub alpha: Vector3<'a>,
    /// Acceleration of the frame's origin minus gravity.
    pub acceleration: Vector3<'a>,
    /// `U = [ω̇]× + [ω]×[ω]×`.
    pub u_matrix: Matrix3<'a>,
    /// ∂V/∂u_i and ∂Ω/∂u_i: partial velocities of the frame.
    pub partials: Vec<SpatialMotion<'a>>,
    /// Axes on which a wrench acts by its moment about a common point.
    pub levers: Vec<Lever<'a>>,
}

impl<'a> BodyMotion<'a> {
    /// A body from its velocities and accelerations.
    #[must_use]
    pub fn new(
        omega: Vector3<'a>,
        alpha: Vector3<'a>,
        acceleration: Vector3<'a>,
        partials: Vec<SpatialMotion<'a>>,
        levers: Vec<Lever<'a>>,
    ) -> Self {
        let u_matrix = centripetal(omega, alpha);
        Self {
            omega,
            alpha,
            acceleration,
            u_matrix,
            partials,
            levers,
        }
    }

    /// Generalised forces on all u of a wrench in the body's frame.
    #[must_use]
    pub fn project(&self, wrench: Wrench<'a>) -> Vec<Expr<'a>> {
        let Wrench { force, moment } = wrench;
        // Only one form may be constructed: the graph replaces a second one by the first.
        let moments: Vec<Vector3<'a>> = self
            .levers
            .iter()
            .map(|l| moment + l.vector.cross(force))
            .collect();
        let on = |(u, partial): (usize, &SpatialMotion<'a>)| {
            let lever = self.levers.iter().position(|l| l.axes.contains(&u));
            match lever {
                Some(at) => partial.angular.dot(moments[at]),
                None => partial.linear.dot(force) + partial.angular.dot(moment),
            }
        };
        self.partials.iter().enumerate().map(on).collect()
    }

    /// Wrench at the frame's origin per unit of an inertial parameter.
    #[must_use]
    pub(crate) fn unit_wrench(&self, arena: &'a Arena, parameter: StandardParameter) -> Wrench<'a> {
        use StandardParameter as P;
        let zero = Vector3::zero(arena);
        let first = |k: usize| Wrench {
            force: self.u_matrix.column(k),
            moment: Vector3::unit(arena, k).cross(self.acceleration),
        };
        match parameter {
            P::M => Wrench {
                force: self.acceleration,
                moment: zero,
            },
            P::Mx => first(0),
            P::My => first(1),
            P::Mz => first(2),
            _ => Wrench {
                force: zero,
                moment: second_moment(arena, parameter, self.omega, self.alpha),
            },
        }
    }
}

/// Row and column in the matrix of second moments, first moments (last column) and mass.
const PLACES: [(usize, usize); 10] = [
    (0, 0),
    (0, 1),
    (0, 2),
    (1, 1),
    (1, 2),
    (2, 2),
    (0, 3),
    (1, 3),
    (2, 3),
    (3, 3),
];

/// Place of an inertial parameter; `None` for other parameters.
pub(crate) fn place(parameter: StandardParameter) -> Option<(usize, usize)> {
    let mut all = StandardParameter::INERTIA.into_iter().zip(PLACES);
    all.find_map(|(one, place)| (one == parameter).then_some(place))
}

/// Moment in a body's axes per unit of a second moment: h(ω̇) + ω × h(ω), with the angular momentum
/// h of the parameter.
#[must_use]
pub(crate) fn second_moment<'a>(
    arena: &'a Arena,
    parameter: StandardParameter,
    omega: Vector3<'a>,
    alpha: Vector3<'a>,
) -> Vector3<'a> {
    let Some((i, j)) = place(parameter).filter(|(_, j)| *j < 3) else {
        return Vector3::zero(arena);
    };
    let momentum = |w: Vector3<'a>| {
        let mut h = Vector3::zero(arena);
        h.0[i] = w.0[j];
        h.0[j] = w.0[i];
        h
    };
    momentum(alpha) + omega.cross(momentum(omega))
}

/// Base frame of a leg with `count` quasi-velocities, fixed or moving with a body.
///
/// The quasi-velocities of that body come after those of the leg.
pub(crate) fn leg_base<'a>(
    arena: &'a Arena,
    leg: &Leg,
    count: usize,
    carrier: Option<&BodyMotion<'a>>,
    gravity: Vector3<'a>,
) -> BodyMotion<'a> {
    let zero = Vector3::zero(arena);
    let into = constant_rotation(arena, leg.base.rotation).transposed();
    let mut partials = vec![SpatialMotion::zero(arena); count];
    let Some(carrier) = carrier else {
        return BodyMotion::new(zero, zero, -(into * gravity), partials, vec![]);
    };
    let at = Vector3::constant(arena, leg.base.at);
    let moved = |partial: &SpatialMotion<'a>| SpatialMotion {
        linear: into * partial.linear_at(at),
        angular: into * partial.angular,
    };
    partials.extend(carrier.partials.iter().map(moved));
    BodyMotion::new(
        into * carrier.omega,
        into * carrier.alpha,
        into * (carrier.acceleration + carrier.u_matrix * at),
        partials,
        vec![],
    )
}

/// Quasi-velocities of a leg and their derivatives.
#[derive(Debug, Clone)]
pub struct LegRates<'a> {
    /// Quasi-velocities u.
    pub u: Vec<Expr<'a>>,
    /// Their derivatives.
    pub u_dot: Vec<Expr<'a>>,
}

/// Motion of all bodies of a leg for its quasi-velocities and their derivatives.
///
/// `None` if the configuration does not determine a sine or cosine.
pub(crate) fn leg_bodies<'a>(
    arena: &'a Arena,
    leg: &Leg,
    state: &LegState<'a>,
    configuration: &Configuration<'a>,
    rates: &LegRates<'a>,
    base: &BodyMotion<'a>,
) -> Option<Vec<BodyMotion<'a>>> {
    let first_joint = state.first_joint;
    let mut bodies: Vec<BodyMotion<'a>> = Vec::new();
    for (index, joint) in leg.joints.iter().enumerate() {
        let from = joint.antecedent.map_or(base, |a| &bodies[a]);
        let link = link_vector(arena, leg, index, first_joint, configuration)?;
        let turn = Turn::new(arena, leg, index, first_joint, configuration)?;
        let form = &state.rates.joint[index];
        let rate = form.value(arena, &rates.u);
        let rate_dot = form.value(arena, &rates.u_dot);
        let axis = Vector3::unit(arena, 2);
        let (mut omega, mut alpha) = (turn.apply(from.omega), turn.apply(from.alpha));
        let mut acceleration = turn.apply(from.acceleration + from.u_matrix * link);
        match joint.kind {
            JointKind::Revolute => {
                alpha = alpha + omega.cross(axis.scaled(rate)) + axis.scaled(rate_dot);
                omega = omega + axis.scaled(rate);
            }
            JointKind::Prismatic => {
                let coriolis = omega.cross(axis.scaled(rate)).scaled(arena.integer(2));
                acceleration = acceleration + coriolis + axis.scaled(rate_dot);
            }
            JointKind::Fixed => {}
        }
        let partials = (0..from.partials.len()).map(|i| {
            let before = from.partials[i];
            let mut partial = SpatialMotion {
                linear: turn.apply(before.linear_at(link)),
                angular: turn.apply(before.angular),
            };
            let own = axis.scaled(arena.number(form.coefficient(i)));
            match joint.kind {
                JointKind::Revolute => partial.angular = partial.angular + own,
                JointKind::Prismatic => partial.linear = partial.linear + own,
                JointKind::Fixed => {}
            }
            partial
        });
        let partials = partials.collect();
        let moved = |l: &Lever<'a>| Lever {
            vector: turn.apply(l.vector + link),
            axes: l.axes.clone(),
        };
        let mut levers: Vec<Lever<'a>> = from.levers.iter().map(moved).collect();
        levers.extend(first_levers(arena, state, index));
        bodies.push(BodyMotion::new(
            omega,
            alpha,
            acceleration,
            partials,
            levers,
        ));
    }
    Some(bodies)
}

/// The levers of the centres whose first axis is that of a joint, in the joint's frame.
fn first_levers<'a>(
    arena: &'a Arena,
    state: &LegState<'a>,
    joint: usize,
) -> impl Iterator<Item = Lever<'a>> {
    let centres = state.centres.iter();
    let first = centres.filter(move |centre| centre.joints.first() == Some(&joint));
    first.map(move |centre| Lever {
        vector: Vector3::unit(arena, 2).scaled(arena.number(-centre.offset)),
        axes: state.rates.own(&centre.joints),
    })
}
