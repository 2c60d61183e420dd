//! Mass matrix of a leg by composite rigid bodies, in the frames' own axes.
//!
//! Masses, first moments and inertias are summed from the tips to the base. A column of the matrix
//! is the generalised forces for one quasi-acceleration alone, from rest. Beyond the last joint
//! that it moves, all bodies move as one. The wrench of this composite body is transferred joint by
//! joint towards the base. The forces on the quasi-velocities are its components on the way, so
//! every pair of them occurs once.
//!
//! Along a run of parallel axes the quasi-velocities are absolute rates: a body does not rotate
//! with the one before it. It acts as a mass at the end of a lever, and its moment does not act on
//! the body before.

use crate::cas::{Arena, Expr, Vector3};
use crate::derivation::bodies::inertia::Inertia;
use crate::derivation::closure::leg::LegState;
use crate::derivation::kinematics::joint::link_vector;
use crate::derivation::kinematics::spatial::{SpatialMotion, Wrench};
use crate::derivation::kinematics::turn::Turn;
use crate::derivation::names::{Names, joined};
use crate::derivation::parameter::BodyParameter;
use crate::derivation::robot::Robot;
use crate::mechanism::{End, JointKind, Leg};
use overact_description::StandardParameter;

/// A joint and the body that it moves.
struct Link<'a> {
    turn: Turn<'a>,
    /// From the antecedent's origin, in the antecedent frame.
    at: Vector3<'a>,
    /// The joints that start from this one.
    next: Vec<usize>,
    /// Inertia of the body.
    own: Inertia<'a>,
    /// Inertia of the body and all bodies beyond it.
    whole: Inertia<'a>,
    /// The composite inertia in the axes of the antecedent frame.
    turned: Inertia<'a>,
    /// Rotor inertia.
    motor: Expr<'a>,
}

/// The links of a leg.
pub(crate) struct Chain<'c, 'a> {
    arena: &'a Arena,
    leg: &'c Leg,
    state: &'c LegState<'a>,
    links: Vec<Link<'a>>,
}

/// Load on a joint: the moment about its axis and the force along it.
///
/// The moment excludes that of later bodies in the joint's run of parallel axes.
#[derive(Clone, Copy)]
struct OnJoint<'a> {
    moment: Expr<'a>,
    force: Expr<'a>,
}

/// Wrench on a joint in the axes of the joint's antecedent.
pub(crate) struct OnAntecedent<'a> {
    /// The wrench at the joint's origin.
    pub(crate) at_joint: Wrench<'a>,
    /// The moment of its force about the antecedent's origin.
    pub(crate) lever_moment: Vector3<'a>,
}

impl<'a> OnAntecedent<'a> {
    /// The wrench at the antecedent's origin.
    pub(crate) fn at_antecedent(&self) -> Wrench<'a> {
        Wrench {
            force: self.at_joint.force,
            moment: self.at_joint.moment + self.lever_moment,
        }
    }
}

/// Forces of a wrench on a body, transferred to the base.
pub(crate) struct WrenchToBase<'a> {
    /// The forces on the quasi-velocities of the leg.
    pub(crate) forces: Vec<Expr<'a>>,
    /// The wrench on the base.
    pub(crate) at_base: Wrench<'a>,
}

impl<'a> Robot<'a> {
    /// Upper triangle of a leg's mass matrix in its quasi-velocities: row i from column i on.
    ///
    /// `None` if the configuration does not determine a sine or cosine.
    pub(crate) fn leg_masses(
        &self,
        index: usize,
        values: &[(BodyParameter, Expr<'a>)],
    ) -> Option<Vec<Vec<Expr<'a>>>> {
        let mut chain = self.chain(index, values)?;
        chain.add_up();
        let count = chain.state.rows.len();
        let columns: Vec<Vec<Expr<'a>>> = (0..count).map(|k| chain.column(k)).collect();
        let row = |i: usize| (i..count).map(|k| columns[k][i]).collect();
        Some((0..count).map(row).collect())
    }

    /// The links of a leg with their bodies.
    pub(crate) fn chain(
        &self,
        index: usize,
        values: &[(BodyParameter, Expr<'a>)],
    ) -> Option<Chain<'_, 'a>> {
        let (arena, leg, state) = (self.arena, &self.mechanism.legs[index], &self.legs[index]);
        let on_platform = matches!(leg.end, Some(End::Rigid(_))) && leg.end_body.is_none();
        let on_platform = on_platform.then(|| leg.joints.len() - 1);
        let mut links = Vec::new();
        for j in 0..leg.joints.len() {
            let own = |p: BodyParameter| p.of_joint(index, j);
            let motor = values
                .iter()
                .filter(|(p, _)| own(*p) == Some(StandardParameter::Ia));
            let body = if on_platform == Some(j) {
                Inertia::zero(arena)
            } else {
                Inertia::of(arena, values, &own)
            };
            let next = (j + 1..leg.joints.len()).filter(|&c| leg.joints[c].antecedent == Some(j));
            links.push(Link {
                turn: Turn::new(arena, leg, j, state.first_joint, &self.configuration)?,
                at: link_vector(arena, leg, j, state.first_joint, &self.configuration)?,
                next: next.collect(),
                own: body,
                whole: body,
                turned: body,
                motor: motor.fold(arena.zero(), |sum, (_, value)| sum + *value),
            });
        }
        Some(Chain {
            arena,
            leg,
            state,
            links,
        })
    }
}

impl<'a> Chain<'_, 'a> {
    /// Sums inertias from the tips to the base.
    pub(crate) fn add_up(&mut self) {
        for j in (0..self.links.len()).rev() {
            let link = &self.links[j];
            let behind = link.next.iter().map(|&c| &self.links[c]);
            let whole = behind.fold(link.own, |sum, c| c.turned.moved_onto(&sum, c.at));
            let turned = whole.turned_back(&link.turn);
            let mut names = Names::default();
            whole.name(&mut names, &self.leg.joints[j].suffix(), &self.leg.name);
            names.give();
            self.links[j].whole = whole;
            self.links[j].turned = turned;
        }
    }

    /// The sum of all bodies about the leg's base, in its axes; call after
    /// [`add_up`](Self::add_up).
    pub(crate) fn at_base(&self) -> Inertia<'a> {
        let first = self.roots().map(|j| &self.links[j]);
        first.fold(Inertia::zero(self.arena), |sum, link| {
            link.turned.moved_onto(&sum, link.at)
        })
    }

    /// Adds another inertia, in a body's frame, to the body.
    pub(crate) fn carry(&mut self, j: usize, other: &Inertia<'a>) {
        let still = Vector3::zero(self.arena);
        self.links[j].own = other.moved_onto(&self.links[j].own, still);
    }

    pub(crate) const fn arena(&self) -> &'a Arena {
        self.arena
    }

    /// Inertias of the single bodies.
    pub(crate) fn bodies(&self) -> Vec<Inertia<'a>> {
        self.links.iter().map(|link| link.own).collect()
    }

    pub(crate) fn kind(&self, j: usize) -> JointKind {
        self.leg.joints[j].kind
    }

    pub(crate) fn antecedent(&self, j: usize) -> Option<usize> {
        self.leg.joints[j].antecedent
    }

    /// The leg's end.
    pub(crate) const fn end(&self) -> Option<&End> {
        self.leg.end.as_ref()
    }

    /// A point of a joint's frame in the antecedent's.
    pub(crate) fn before(&self, j: usize, point: Vector3<'a>) -> Vector3<'a> {
        self.links[j].at + self.links[j].turn.back(point)
    }

    /// An inertia in a joint's frame that is invariant under its motion, added to that of the
    /// antecedent.
    pub(crate) fn moved_onto(&self, of: &Inertia<'a>, onto: &Inertia<'a>, j: usize) -> Inertia<'a> {
        let link = &self.links[j];
        of.turned_back(&link.turn).moved_onto(onto, link.at)
    }

    /// A wrench at a joint's origin, in the axes of the antecedent.
    pub(crate) fn on_antecedent(&self, j: usize, wrench: &Wrench<'a>) -> OnAntecedent<'a> {
        let link = &self.links[j];
        let at_joint = link.turn.back_wrench(wrench);
        OnAntecedent {
            at_joint,
            lever_moment: link.at.cross(at_joint.force),
        }
    }

    /// Wrench about the base's origin, in its axes, for the quasi-acceleration k. `None` if no body
    /// moves.
    pub(crate) fn base_wrench(&self, k: usize) -> Option<Wrench<'a>> {
        let mut on = vec![self.nothing(); self.links.len()];
        let still = SpatialMotion::zero(self.arena);
        let moved = self.roots().filter_map(|first| {
            let Wrench { force, moment } = self.wrench(first, k, &still, &mut on)?;
            let moment = moment + self.links[first].at.cross(force);
            Some(Wrench { force, moment })
        });
        moved.reduce(|sum, one| sum.plus(&one))
    }

    /// Forces on the quasi-velocities and on the base of a wrench at the origin of a body's frame.
    pub(crate) fn project_to_base(&self, body: usize, wrench: Wrench<'a>) -> WrenchToBase<'a> {
        let mut wrench = wrench;
        let rates = &self.state.rates;
        let count = self.leg.independent().count();
        let mut forces = vec![self.arena.zero(); count];
        let mut about_axis = wrench.moment.z();
        let mut at = Some(body);
        while let Some(j) = at {
            for (i, sum) in forces.iter_mut().enumerate() {
                *sum = *sum + about_axis * rates.turning[j].coefficient(i);
                if self.kind(j) == JointKind::Prismatic {
                    *sum = *sum + wrench.force.z() * rates.joint[j].coefficient(i);
                }
            }
            let onto = self.on_antecedent(j, &wrench);
            about_axis = match rates.run[j] {
                None => onto.lever_moment.z() + onto.at_joint.moment.z(),
                Some(_) => onto.lever_moment.z(),
            };
            wrench = onto.at_antecedent();
            at = self.antecedent(j);
        }
        WrenchToBase {
            forces,
            at_base: wrench,
        }
    }

    fn nothing(&self) -> OnJoint<'a> {
        let zero = self.arena.zero();
        OnJoint {
            moment: zero,
            force: zero,
        }
    }

    /// Forces on the quasi-velocities up to k for the quasi-acceleration k.
    pub(crate) fn column(&self, k: usize) -> Vec<Expr<'a>> {
        let zero = self.arena.zero();
        let mut on = vec![self.nothing(); self.links.len()];
        let still = SpatialMotion::zero(self.arena);
        for first in self.roots() {
            let _ = self.wrench(first, k, &still, &mut on);
        }
        let rates = &self.state.rates;
        let entry = |i: usize| {
            let of_joint = |sum: Expr<'a>, j: usize| {
                let slides = self.leg.joints[j].kind == JointKind::Prismatic;
                let along = if slides {
                    on[j].force * rates.joint[j].coefficient(i)
                } else {
                    zero
                };
                let both = rates.joint[j].coefficient(i) * rates.joint[j].coefficient(k);
                sum + on[j].moment * rates.turning[j].coefficient(i)
                    + along
                    + self.links[j].motor * both
            };
            (0..self.links.len()).fold(zero, of_joint)
        };
        (0..=k).map(entry).collect()
    }

    fn roots(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.links.len()).filter(|&j| self.leg.joints[j].antecedent.is_none())
    }

    /// Wrench about a joint's origin of all bodies beyond the joint, in the antecedent's axes.
    ///
    /// It is that of the quasi-acceleration k and the acceleration of the antecedent frame. `None`
    /// if no body moves.
    fn wrench(
        &self,
        j: usize,
        k: usize,
        antecedent: &SpatialMotion<'a>,
        on: &mut [OnJoint<'a>],
    ) -> Option<Wrench<'a>> {
        let link = &self.links[j];
        let own = self.state.rates.joint[j].coefficient(k);
        let angular = antecedent.angular;
        let arrived = antecedent.linear_at(link.at);
        let rests = own.is_zero() && arrived.is_zero() && angular.is_zero();
        if rests && !self.behind(j).any(|c| self.is_moved(c, k)) {
            return None;
        }
        let axis = Vector3::unit(self.arena, 2).scaled(self.arena.number(own));
        let angular = link.turn.apply(angular);
        let linear = link.turn.apply(arrived);
        let mut motion = SpatialMotion { linear, angular };
        match self.leg.joints[j].kind {
            JointKind::Revolute => motion.angular = motion.angular + axis,
            JointKind::Prismatic => motion.linear = motion.linear + axis,
            JointKind::Fixed => {}
        }
        let is_one = self.is_one(j, k);
        let slides = self.leg.joints[j].kind == JointKind::Prismatic;
        if is_one && motion.angular.is_zero() && !slides && !self.counts(j, k) {
            // The bodies translate only, and the moment about the joint's axis is not needed.
            let moment = link.turned.first.cross(arrived);
            let force = arrived.scaled(link.turned.mass);
            return Some(Wrench { force, moment });
        }
        let of = if is_one { &link.whole } else { &link.own };
        let mut sum = of.wrench(&motion);
        let mut about_axis = sum.moment.z();
        for &c in link.next.iter().filter(|_| !is_one) {
            let Some(own) = self.wrench(c, k, &motion, on) else {
                continue;
            };
            let lever = self.links[c].at.cross(own.force);
            sum = sum.plus(&own);
            sum.moment = sum.moment + lever;
            about_axis = about_axis + lever.z();
            if self.state.rates.run[c].is_none() {
                about_axis = about_axis + own.moment.z();
            }
        }
        on[j] = OnJoint {
            moment: about_axis,
            force: sum.force.z(),
        };
        self.name_wrench(&sum, j, k);
        Some(link.turn.back_wrench(&sum))
    }

    fn name_wrench(&self, wrench: &Wrench<'a>, j: usize, k: usize) {
        let of = self.leg.independent().nth(k).unwrap_or(k);
        let by = &self.leg.joints[of].name;
        let body = self.leg.joints[j].suffix();
        let mut names = Names::default();
        let place = joined(&["by", by, &self.leg.name]);
        names.vector(wrench.force, &format!("force{body}"), &place);
        names.vector(wrench.moment, &format!("moment{body}"), &place);
        names.give();
    }

    /// Whether all bodies beyond a joint move as one for the quasi-acceleration k, and no force on
    /// their joints is needed.
    fn is_one(&self, j: usize, k: usize) -> bool {
        let runs_on = |c: &usize| self.state.rates.run[*c].is_some();
        let splits = self.counts(j, k) && self.links[j].next.iter().any(runs_on);
        let mut behind = self.behind(j);
        !splits && !behind.any(|c| self.is_moved(c, k) || self.counts(c, k))
    }

    /// Whether the force on a joint contributes to one on the quasi-velocities up to k.
    fn counts(&self, j: usize, k: usize) -> bool {
        let slides = self.leg.joints[j].kind == JointKind::Prismatic;
        let rates = &self.state.rates;
        (0..=k).any(|i| {
            let is_moved = slides && !rates.joint[j].coefficient(i).is_zero();
            is_moved || !rates.turning[j].coefficient(i).is_zero()
        })
    }

    fn is_moved(&self, j: usize, k: usize) -> bool {
        !self.state.rates.joint[j].coefficient(k).is_zero()
    }

    /// All joints beyond a joint.
    fn behind(&self, j: usize) -> impl Iterator<Item = usize> + '_ {
        let mut open = self.links[j].next.clone();
        std::iter::from_fn(move || {
            let next = open.pop()?;
            open.extend(&self.links[next].next);
            Some(next)
        })
    }
}
