//! Generalised forces of a motion by the Newton-Euler recursion: wrenches of all bodies are summed
//! once from the tips to the base, and joint forces are their components on the way.
//!
//! Before that, inertia that a joint's motion leaves invariant is moved to the body before the
//! joint. For a revolute joint these are the mass, the first moment along its axis, and the inertia
//! of a rod along it; for a prismatic joint it is the inertia. The torques of the robot do not
//! change, and later bodies have fewer parameters.
//!
//! Legs that are mounted on a body of another leg, chains and branches, transfer their whole wrench
//! to it. The body belongs to an earlier leg, so legs are processed from the last to the first.

use super::actuated_joint_forces::ActuatedJointForces;
use super::composite::Chain;
use super::tree_masses::{on_carrier, wrench_on_carrier};
use crate::cas::{Arena, Expr, Number, Vector3};
use crate::derivation::bodies::body::BodyMotion;
use crate::derivation::bodies::inertia::Inertia;
use crate::derivation::bodies::motion::RobotMotion;
use crate::derivation::kinematics::spatial::Wrench;
use crate::derivation::linear_algebra::linear::add_to;
use crate::derivation::names::{coordinate_label, joined};
use crate::derivation::parameter::BodyParameter;
use crate::derivation::robot::Robot;
use crate::mechanism::{End, JointIndex, JointKind, Leg};

impl<'a> Robot<'a> {
    /// Γ¹ for given parameters; forces on actuated joints alone go to `actuators`.
    ///
    /// `None` if the configuration does not determine a sine or cosine.
    pub(crate) fn summed_forces(
        &self,
        motion: &RobotMotion<'a>,
        values: &[(BodyParameter, Expr<'a>)],
        actuators: &mut ActuatedJointForces<'a>,
    ) -> Option<Vec<Expr<'a>>> {
        let mut total = vec![self.arena.zero(); self.mechanism.dof()];
        // Forces on the six components of a platform with parasitic motion, projected together at
        // the end.
        let mut free = vec![self.arena.zero(); self.free.len()];
        let partials = self.parasitic_motion.as_ref().filter(|_| self.by_ends);
        let partials = partials.map(|parasitic| parasitic.partials(self.arena));
        let mut transferred = Transferred::nothing(self.arena, &self.mechanism.legs);
        let of_legs = self
            .forces_of_legs(motion, values, &mut transferred)?
            .into_iter();
        for (index, (leg, mut forces)) in self.mechanism.legs.iter().zip(of_legs).enumerate() {
            self.arena.enter(&leg.name);
            for (joint, force) in leg.independent().zip(&forces) {
                let what = format!("force_on_u{}", leg.joints[joint].suffix());
                let _ = force.named(&joined(&[&what, &leg.name]));
            }
            actuators.take(index, &mut forces);
            let state = &self.legs[index];
            let at_end = state.closure.as_ref().filter(|c| c.feels_no_moment());
            match at_end.filter(|_| self.platform.is_some() || self.at_end) {
                Some(closure) => {
                    let on_ends = partials.as_ref();
                    match on_ends.map(|partials| closure.project_on(partials, &forces)) {
                        Some(own) => add_to(&mut total, own),
                        None if self.parasitic_motion.is_some() => {
                            add_to(&mut free, closure.project_at_end(&forces));
                        }
                        None => add_to(&mut total, closure.project_at_end(&forces)),
                    }
                }
                None => {
                    let rows = state.rows[..forces.len()].to_vec();
                    add_to(&mut total, self.combine(&rows, &forces));
                }
            }
        }
        self.arena.enter("platform");
        if let Some(body) = &motion.platform {
            let whole = with(&transferred.on_platform, &self.platform_inertia(values));
            let wrench = body.wrench(&whole);
            self.name_wrench(&wrench, "", "platform");
            let on_twist = body.project(&self.free, wrench);
            for (coordinate, force) in self.free.iter().zip(&on_twist) {
                let what = format!("force_on_{}_platform", coordinate_label(coordinate));
                let _ = force.named(&what);
            }
            if self.parasitic_motion.is_some() {
                add_to(&mut free, on_twist)
            } else {
                add_to(&mut total, on_twist)
            }
        }
        if let Some(parasitic) = &self.parasitic_motion {
            add_to(&mut total, parasitic.on_independent(&free));
        }
        self.arena.enter("");
        Some(total)
    }

    /// Forces on the quasi-velocities of all legs.
    fn forces_of_legs(
        &self,
        motion: &RobotMotion<'a>,
        values: &[(BodyParameter, Expr<'a>)],
        transferred: &mut Transferred<'a>,
    ) -> Option<Vec<Vec<Expr<'a>>>> {
        let legs = &self.mechanism.legs;
        let mut order: Vec<usize> = (0..legs.len()).collect();
        let meets_another = |leg: &Leg| leg.base_body.is_some() || leg.end_body.is_some();
        if legs.iter().any(meets_another) {
            order.reverse();
        }
        let mut all = vec![Vec::new(); legs.len()];
        for index in order {
            self.arena.enter(&legs[index].name);
            all[index] = self.summed_leg_forces(motion, values, index, transferred)?;
        }
        Some(all)
    }

    /// Forces on the quasi-velocities of a leg; the wrench at its base is transferred to its base
    /// body.
    fn summed_leg_forces(
        &self,
        motion: &RobotMotion<'a>,
        values: &[(BodyParameter, Expr<'a>)],
        index: usize,
        transferred: &mut Transferred<'a>,
    ) -> Option<Vec<Expr<'a>>> {
        let (arena, leg, state) = (self.arena, &self.mechanism.legs[index], &self.legs[index]);
        let chain = self.chain(index, values)?;
        let mut bodies = chain.bodies();
        transferred.add_to(index, &mut bodies);
        if self.lump_end_masses
            && let Some(end_mass) = chain.take_end_mass(&mut bodies)
        {
            transferred.add_end_mass(leg, &end_mass);
        }
        let kept = chain.group(&mut bodies, leg.base_body.is_some());
        let count = leg.joints.len();
        let mut wrenches: Vec<Wrench<'a>> = Vec::new();
        let mut about_axes = Vec::new();
        for (joint, body) in bodies.iter().enumerate() {
            let own = motion.bodies[index][joint].wrench(body);
            let suspended = transferred.wrenches[index][joint];
            let wrench = own.plus(&suspended);
            about_axes.push(wrench.moment.z());
            wrenches.push(wrench);
        }
        let mut at_base = Wrench::zero(arena);
        let mut forces = vec![arena.zero(); leg.independent().count()];
        for j in (0..count).rev() {
            let joint = &leg.joints[j];
            let wrench = wrenches[j];
            self.name_wrench(&wrench, &joint.suffix(), &leg.name);
            if let Some(before) = joint.antecedent {
                let onto = chain.on_antecedent(j, &wrench);
                about_axes[before] = about_axes[before] + onto.lever_moment.z();
                if state.rates.run[j].is_none() {
                    about_axes[before] = about_axes[before] + onto.at_joint.moment.z();
                }
                wrenches[before] = wrenches[before].plus(&onto.at_antecedent());
            } else if leg.base_body.is_some() {
                let onto = chain.on_antecedent(j, &wrench);
                at_base = at_base.plus(&onto.at_antecedent());
            }
            let at = JointIndex {
                leg: index,
                joint: j,
            };
            let on_joint = values.iter().filter_map(|(p, value)| {
                let symbol = p.of_joint(index, j).filter(|s| !s.is_inertial())?;
                Some(self.joint_force(motion, at, symbol) * *value)
            });
            let mut on_joint = on_joint.fold(self.known_force(at), |sum, force| sum + force);
            if joint.kind == JointKind::Prismatic {
                on_joint = on_joint + wrench.force.z();
            }
            let on_joint = on_joint.named(&joined(&["tau", &joint.name, &leg.name]));
            let (rate, turning) = (&state.rates.joint[j], &state.rates.turning[j]);
            let share =
                |i: usize| about_axes[j] * turning.coefficient(i) + on_joint * rate.coefficient(i);
            let shares = (0..forces.len()).map(share).collect();
            add_to(&mut forces, shares);
        }
        transferred.transfer_to_base_body(arena, leg, &kept, &at_base);
        Some(forces)
    }
}

/// Inertias and wrenches that legs transfer to the bodies on which they are mounted.
struct Transferred<'a> {
    /// Inertias of mounted legs that their joints do not move, for the bodies of every leg.
    inertias: Vec<Vec<Option<Inertia<'a>>>>,
    /// Wrenches of mounted legs, for the bodies of every leg.
    wrenches: Vec<Vec<Wrench<'a>>>,
    /// End masses of legs that are lumped on the platform.
    on_platform: Inertia<'a>,
}

impl<'a> Transferred<'a> {
    fn nothing(arena: &'a Arena, legs: &[Leg]) -> Self {
        let still = Wrench::zero(arena);
        let counts = || legs.iter().map(|leg| leg.joints.len());
        Self {
            inertias: counts().map(|count| vec![None; count]).collect(),
            wrenches: counts().map(|count| vec![still; count]).collect(),
            on_platform: Inertia::zero(arena),
        }
    }

    /// Adds the transferred inertias to a leg's bodies.
    fn add_to(&self, index: usize, bodies: &mut [Inertia<'a>]) {
        for (body, other) in bodies.iter_mut().zip(&self.inertias[index]) {
            if let Some(other) = other {
                *body = with(other, body);
            }
        }
    }

    /// Adds an end mass to the body or platform at which the leg ends.
    fn add_end_mass(&mut self, leg: &Leg, end_mass: &Inertia<'a>) {
        let onto = match leg.end_body {
            Some(body) => self.inertias[body.leg][body.joint]
                .get_or_insert(Inertia::zero(end_mass.mass.arena())),
            None => &mut self.on_platform,
        };
        *onto = with(end_mass, onto);
    }

    /// Transfers to the base body of a leg the wrench at the leg's base, and the inertia that the
    /// leg's first joints do not move.
    fn transfer_to_base_body(
        &mut self,
        arena: &'a Arena,
        leg: &Leg,
        kept: &Inertia<'a>,
        at_base: &Wrench<'a>,
    ) {
        let Some(carrier) = leg.base_body else { return };
        let kept = on_carrier(arena, leg, kept);
        let onto = &mut self.inertias[carrier.leg][carrier.joint];
        *onto = Some(onto.map_or(kept, |onto| with(&kept, &onto)));
        let wrench = wrench_on_carrier(arena, leg, at_base);
        let sum = &mut self.wrenches[carrier.leg][carrier.joint];
        *sum = sum.plus(&wrench);
    }
}

/// Sum of two inertias in one frame.
pub(super) fn with<'a>(one: &Inertia<'a>, other: &Inertia<'a>) -> Inertia<'a> {
    one.moved_onto(other, Vector3::zero(one.mass.arena()))
}

impl<'a> BodyMotion<'a> {
    /// Force and moment about the frame's origin that an inertia needs for the motion.
    fn wrench(&self, body: &Inertia<'a>) -> Wrench<'a> {
        let force = self.acceleration.scaled(body.mass) + self.u_matrix * body.first;
        let moment = body.turning_moment(self.omega, self.alpha);
        Wrench {
            force,
            moment: moment + body.first.cross(self.acceleration),
        }
    }
}

impl<'a> Chain<'_, 'a> {
    /// Removes a point mass at the end from a leg's last body, so that the rest has no first moment
    /// towards it.
    ///
    /// Returns the mass in the frame of the body at which the leg ends.
    fn take_end_mass(&self, bodies: &mut [Inertia<'a>]) -> Option<Inertia<'a>> {
        let Some(End::Point {
            at,
            along: [true, true, true],
        }) = self.end()
        else {
            return None;
        };
        let arena = self.arena();
        let mut last = bodies.len().checked_sub(1)?;
        let mut point = Vector3::zero(arena);
        while self.kind(last) == JointKind::Fixed {
            let before = self.antecedent(last)?;
            bodies[before] = self.moved_onto(&bodies[last], &bodies[before], last);
            bodies[last] = Inertia::zero(arena);
            point = self.before(last, point);
            last = before;
        }
        let body = &mut bodies[last];
        let square = point.dot(point);
        let mass = if square.is_zero() {
            body.mass
        } else {
            body.first.dot(point) * (Number::ONE / square.as_number()?)
        };
        if mass.is_zero() {
            return None;
        }
        *body = Inertia::point(-mass).moved_onto(body, point);
        let there = Vector3::constant(arena, *at);
        Some(Inertia::point(mass).moved_onto(&Inertia::zero(arena), there))
    }

    /// Moves the inertia that a joint does not move onto the body before it, for all bodies of a
    /// leg.
    ///
    /// Returns the part that the first joints do not move, in the axes of the leg's base, if the
    /// base moves.
    pub(super) fn group(&self, bodies: &mut [Inertia<'a>], is_on_moving_base: bool) -> Inertia<'a> {
        let mut at_base = Inertia::zero(self.arena());
        for j in (0..bodies.len()).rev() {
            let [kept, rest] = match self.kind(j) {
                JointKind::Revolute => bodies[j].split_about_z(),
                JointKind::Prismatic => bodies[j].split_along_z(),
                JointKind::Fixed => [bodies[j], Inertia::zero(bodies[j].mass.arena())],
            };
            bodies[j] = rest;
            match self.antecedent(j) {
                Some(before) => bodies[before] = self.moved_onto(&kept, &bodies[before], j),
                None if is_on_moving_base => at_base = self.moved_onto(&kept, &at_base, j),
                None => {}
            }
        }
        at_base
    }
}
