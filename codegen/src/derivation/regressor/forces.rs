//! Generalised forces for given parameters: columns of the identification model, summed before
//! projection.

use super::Projection;
use crate::cas::Expr;
use crate::derivation::bodies::motion::RobotMotion;
use crate::derivation::dynamics::actuated_joint_forces::ActuatedJointForces;
use crate::derivation::kinematics::spatial::Wrench;
use crate::derivation::linear_algebra::linear::add_to;
use crate::derivation::names::{coordinate_label, joined};
use crate::derivation::parameter::BodyParameter;
use crate::derivation::robot::Robot;
use crate::mechanism::JointIndex;
use overact_description::StandardParameter;

impl<'a> Robot<'a> {
    /// Γ for all parameters at once, r numbers: body wrenches are summed before they are projected.
    ///
    /// Forces on actuated joints alone go to `actuators`.
    #[must_use]
    pub(crate) fn generalised_forces(
        &self,
        motion: &RobotMotion<'a>,
        projection: &Projection<'a>,
        values: &[(BodyParameter, Expr<'a>)],
        actuators: &mut ActuatedJointForces<'a>,
    ) -> Vec<Expr<'a>> {
        let mut total = vec![self.arena.zero(); self.mechanism.dof()];
        // Forces on the twist coordinates of all bodies that move with the platform.
        let mut on_twist = vec![self.arena.zero(); self.free.len()];
        for (l, leg) in self.mechanism.legs.iter().enumerate() {
            let mut forces = self.leg_forces(motion, values, l, &mut on_twist);
            for (joint, force) in leg.independent().zip(&forces) {
                let what = format!("force_on_u{}", leg.joints[joint].suffix());
                let _ = force.named(&joined(&[&what, &leg.name]));
            }
            actuators.take(l, &mut forces);
            add_to(&mut total, self.combine(&projection.legs[l], &forces));
        }
        if let Some(body) = &motion.platform {
            let own = |p: BodyParameter| match p {
                BodyParameter::Platform(symbol) | BodyParameter::Payload(symbol) => Some(symbol),
                BodyParameter::Leg { .. }
                | BodyParameter::Load { .. }
                | BodyParameter::Spring(_)
                | BodyParameter::Motor { .. } => None,
            };
            let wrench = self.wrench(values, &own, &|s| body.unit_wrench(self.arena, s));
            self.name_wrench(&wrench, "", "platform");
            add_to(&mut on_twist, body.project(&self.free, wrench));
        }
        for (coordinate, force) in self.free.iter().zip(&on_twist) {
            let _ = force.named(&format!(
                "force_on_{}_platform",
                coordinate_label(coordinate)
            ));
        }
        let on_twist = self.on_independent(on_twist);
        add_to(&mut total, self.combine(&projection.platform, &on_twist));
        total
    }

    /// Forces on the quasi-velocities of a leg.
    ///
    /// Those of bodies that move with the platform are added to `on_twist`.
    pub(crate) fn leg_forces(
        &self,
        motion: &RobotMotion<'a>,
        values: &[(BodyParameter, Expr<'a>)],
        l: usize,
        on_twist: &mut [Expr<'a>],
    ) -> Vec<Expr<'a>> {
        let leg = &self.mechanism.legs[l];
        let mut forces = vec![self.arena.zero(); self.legs[l].rows.len()];
        for j in 0..leg.joints.len() {
            let own = |p: BodyParameter| match p {
                BodyParameter::Leg { leg, joint, symbol } if (leg, joint) == (l, j) => Some(symbol),
                _ => None,
            };
            match &motion.platform_bodies[l][j] {
                Some(body) => {
                    let wrench = self.wrench(values, &own, &|s| body.unit_wrench(self.arena, s));
                    add_to(on_twist, body.project(&self.free, wrench));
                }
                None => {
                    let body = &motion.bodies[l][j];
                    let wrench = self.wrench(values, &own, &|s| body.unit_wrench(self.arena, s));
                    self.name_wrench(&wrench, &leg.joints[j].suffix(), &leg.name);
                    add_to(&mut forces, body.project(wrench));
                }
            }
            let at = JointIndex { leg: l, joint: j };
            let on_joint = values.iter().filter_map(|(p, value)| {
                let symbol = own(*p).filter(|s| !s.is_inertial())?;
                Some(self.joint_force(motion, at, symbol) * *value)
            });
            let known = self.known_force(at);
            let on_joint = on_joint.fold(known, |sum, force| sum + force);
            let on_joint = on_joint.named(&joined(&["tau", &leg.joints[j].name, &leg.name]));
            let form = &self.legs[l].rates.joint[j];
            let shares = (0..forces.len()).map(|i| on_joint * form.coefficient(i));
            add_to(&mut forces, shares.collect());
        }
        forces
    }

    /// Wrench of a body's inertial parameters.
    fn wrench(
        &self,
        values: &[(BodyParameter, Expr<'a>)],
        own: &dyn Fn(BodyParameter) -> Option<StandardParameter>,
        unit_wrench: &dyn Fn(StandardParameter) -> Wrench<'a>,
    ) -> Wrench<'a> {
        let mut total = Wrench::zero(self.arena);
        for (parameter, value) in values {
            if let Some(symbol) = own(*parameter).filter(|s| s.is_inertial()) {
                total = total.plus_scaled(&unit_wrench(symbol), *value);
            }
        }
        total
    }
}
