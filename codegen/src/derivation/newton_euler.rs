//! Forces for a motion in the order of Newton and Euler: those of all bodies are summed once on the way
//! from the tips to the base, where the joints read them off.
//!
//! Before that, what a joint leaves as it is of the body behind it is counted to the body before it: a
//! revolute joint mass, first moment along its axis and the inertia of a rod along it, a prismatic one the
//! inertia. Which torques the robot needs does not change, and the bodies behind have fewer parameters.

use super::actuators::OwnForces;
use super::body::BodyMotion;
use super::composite::Chain;
use super::inertia::Inertia;
use super::motion::RobotMotion;
use super::names::{coordinate_label, joined};
use super::parameter::BodyParameter;
use super::regressor::add;
use super::robot::Robot;
use crate::cas::{Expr, Vector3};
use crate::mechanism::JointKind;

impl<'a> Robot<'a> {
    /// Γ¹ of given parameters; what acts on actuated joints alone goes to `actuators`. `None` if a sine or cosine
    /// does not follow from the configuration.
    pub(super) fn summed_forces(
        &self,
        motion: &RobotMotion<'a>,
        values: &[(BodyParameter, Expr<'a>)],
        actuators: &mut OwnForces<'a>,
    ) -> Option<Vec<Expr<'a>>> {
        let mut total = vec![self.arena.zero(); self.mechanism.dof()];
        // Of a platform that moves aside: what all put on its six components, which goes to the others at once.
        let mut free = vec![self.arena.zero(); self.free.len()];
        for (index, leg) in self.mechanism.legs.iter().enumerate() {
            self.arena.enter(&leg.name);
            // What a chain hands down to a body that moves is projected body by body.
            let mut forces = match leg.base_body {
                Some(_) => self.leg_forces(motion, values, index, &mut []),
                None => self.summed_leg_forces(motion, values, index)?,
            };
            for (joint, force) in leg.independent().zip(&forces) {
                let what = format!("force_on_u{}", leg.joints[joint].name);
                let _ = force.named(&joined(&[&what, &leg.name]));
            }
            actuators.take(index, &mut forces);
            let state = &self.legs[index];
            let at_end = state.closure.as_ref().filter(|c| c.feels_no_moment());
            match at_end.filter(|_| self.platform.is_some()) {
                Some(closure) if self.aside.is_some() => {
                    add(&mut free, closure.project_at_end(&forces));
                }
                Some(closure) => add(&mut total, closure.project_at_end(&forces)),
                None => add(&mut total, self.combine(&state.rows, &forces)),
            }
        }
        self.arena.enter("platform");
        if let Some(body) = &motion.platform {
            let wrench = body.wrench(&self.platform_inertia(values));
            self.name_wrench(wrench, "", "platform");
            let on_twist = body.project(&self.free, wrench);
            for (coordinate, force) in self.free.iter().zip(&on_twist) {
                let what = format!("force_on_{}_platform", coordinate_label(coordinate));
                let _ = force.named(&what);
            }
            match self.aside.is_some() {
                true => add(&mut free, on_twist),
                false => add(&mut total, on_twist),
            }
        }
        if let Some(aside) = &self.aside {
            add(&mut total, aside.on_independent(&free));
        }
        self.arena.enter("");
        Some(total)
    }

    /// The forces on the quasi-velocities of a leg.
    fn summed_leg_forces(
        &self,
        motion: &RobotMotion<'a>,
        values: &[(BodyParameter, Expr<'a>)],
        index: usize,
    ) -> Option<Vec<Expr<'a>>> {
        let chain = self.chain(index, values)?;
        let bodies = chain.grouped();
        let (arena, leg, state) = (self.arena, &self.mechanism.legs[index], &self.legs[index]);
        let count = leg.joints.len();
        let mut wrenches: Vec<[Vector3<'a>; 2]> = Vec::new();
        let mut about_axes = Vec::new();
        for (body, motion) in bodies.iter().zip(&motion.bodies[index]) {
            let wrench = motion.wrench(body);
            about_axes.push(wrench[1].z());
            wrenches.push(wrench);
        }
        let mut forces = vec![arena.zero(); state.rows.len()];
        for j in (0..count).rev() {
            let joint = &leg.joints[j];
            let wrench = wrenches[j];
            self.name_wrench(wrench, &joint.name, &leg.name);
            if let Some(before) = joint.antecedent {
                let [force, moment, lever] = chain.handed_down(j, wrench);
                about_axes[before] = about_axes[before] + lever.z();
                if state.rates.run[j].is_none() {
                    about_axes[before] = about_axes[before] + moment.z();
                }
                let sum = &mut wrenches[before];
                *sum = [sum[0] + force, sum[1] + (moment + lever)];
            }
            let on_joint = values.iter().filter_map(|(p, value)| {
                let symbol = p.of_joint(index, j).filter(|s| !s.is_inertial())?;
                Some(self.joint_force(motion, index, j, symbol) * *value)
            });
            let mut on_joint = on_joint.fold(self.known_force(index, j), |sum, force| sum + force);
            if joint.kind == JointKind::Prismatic {
                on_joint = on_joint + wrench[0].z();
            }
            let on_joint = on_joint.named(&joined(&["tau", &joint.name, &leg.name]));
            let (rate, turning) = (&state.rates.joint[j], &state.rates.turning[j]);
            let share =
                |i: usize| about_axes[j] * turning.coefficient(i) + on_joint * rate.coefficient(i);
            let shares = (0..forces.len()).map(share).collect();
            add(&mut forces, shares);
        }
        Some(forces)
    }
}

impl<'a> BodyMotion<'a> {
    /// Force and moment about the frame's origin that an inertia needs for the motion.
    fn wrench(&self, body: &Inertia<'a>) -> [Vector3<'a>; 2] {
        let force = self.acceleration.scaled(body.mass) + self.u_matrix * body.first;
        let moment = body.turning_moment(self.omega, self.alpha);
        [force, moment + body.first.cross(self.acceleration)]
    }
}

impl<'a> Chain<'_, 'a> {
    /// The bodies with what each joint leaves as it is moved onto the body before it.
    fn grouped(&self) -> Vec<Inertia<'a>> {
        let mut bodies = self.bodies();
        for j in (0..bodies.len()).rev() {
            let [kept, rest] = match self.kind(j) {
                JointKind::Revolute => bodies[j].split_about_z(),
                JointKind::Prismatic => bodies[j].split_along_z(),
                JointKind::Fixed => [bodies[j], Inertia::zero(bodies[j].mass.arena())],
            };
            bodies[j] = rest;
            if let Some(before) = self.antecedent(j) {
                bodies[before] = self.moved_onto(&kept, &bodies[before], j);
            }
        }
        bodies
    }
}
