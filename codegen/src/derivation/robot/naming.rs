//! Names of quantities that only readers of generated code need: velocities and accelerations of
//! the legs' ends, levers, joint rates.
//!
//! They are assigned at the end of the derivation. Quantities that the derivation uses itself are
//! named where they arise.

use super::Robot;
use crate::cas::Expr;
use crate::derivation::bodies::motion::Moved;
use crate::derivation::closure::leg::LegState;
use crate::derivation::closure::leg_closure::LegClosure;
use crate::derivation::kinematics::spatial::Wrench;
use crate::derivation::linear_algebra::elimination::{Inverse, Rows};
use crate::derivation::names::{AXES, Names, coordinate_label, joined};
use crate::mechanism::Leg;

impl<'a> Robot<'a> {
    /// Names quantities that only readers need.
    ///
    /// Runs last, because it builds expressions: the derivation would reuse them in the reader's
    /// form.
    pub(crate) fn give_names(&self) {
        self.name_closures();
        for moved in self.motions.borrow().iter() {
            self.name_motion(moved);
        }
    }

    /// Names quantities that are constant along a motion: levers of the legs' ends, wrenches, rows
    /// of Jacobians.
    fn name_closures(&self) {
        let mut names = Names::default();
        for (leg, state) in self.mechanism.legs.iter().zip(&self.legs) {
            let Some(closure) = &state.closure else {
                continue;
            };
            names.vector(closure.arm, "p", &leg.name);
            name_wrenches(&mut names, leg, closure);
            self.name_joint_rows(&mut names, leg, state);
        }
        names.give();
    }

    /// Names ∂q̇_j/∂v of the joints whose rate is no quasi-velocity.
    fn name_joint_rows(&self, names: &mut Names<'a>, leg: &Leg, state: &LegState<'a>) {
        for (index, joint) in leg.joints.iter().enumerate() {
            let row = state.rates.joint[index].row(self.arena, &state.rows);
            for (entry, coordinate) in row.iter().zip(&self.twist) {
                let what = format!("gq{}_{}", joint.suffix(), coordinate_label(coordinate));
                names.one(*entry, joined(&[&what, &leg.name]));
            }
        }
    }

    /// Names quantities of the actuator projection: J_a⁻¹, its determinants, and ∂u/∂q̇_a of every
    /// leg.
    pub(crate) fn name_partition(&self, inverted: &Inverse<'a>, legs: &[Rows<'a>], kept: &[usize]) {
        let mut names = Names::default();
        let kept: Vec<String> = kept.iter().map(|at| format!("a{}", at + 1)).collect();
        for determinant in &inverted.determinants {
            names.one(determinant.factor_and_base().1, "det_ja");
        }
        for (row, coordinate) in inverted.rows.iter().zip(&self.twist) {
            for (entry, actuator) in row.iter().zip(&kept) {
                names.one(
                    *entry,
                    format!("{}_by_{actuator}", coordinate_label(coordinate)),
                );
            }
        }
        for (leg, rows) in self.mechanism.legs.iter().zip(legs) {
            for (joint, row) in leg.independent().zip(rows) {
                for (entry, actuator) in row.iter().zip(&kept) {
                    let what = format!("g{}_{actuator}", leg.joints[joint].suffix());
                    names.one(*entry, joined(&[&what, &leg.name]));
                }
            }
        }
        names.give();
    }

    /// Names a body's force and moment.
    pub(crate) fn name_wrench(&self, wrench: &Wrench<'a>, body: &str, place: &str) {
        let mut names = Names::default();
        names.vector(wrench.force, &format!("force{body}"), place);
        names.vector(wrench.moment, &format!("moment{body}"), place);
        names.give();
    }

    /// Names quantities of a motion: the platform's vectors in its own axes, and every leg's end
    /// and joints.
    fn name_motion(&self, moved: &Moved<'a>) {
        let Moved {
            motion,
            platform,
            accelerations,
        } = moved;
        let mut names = Names::default();
        let dot = |what: &str| accelerations.name(what);
        if let Some((pose, platform)) = self.platform.as_ref().zip(platform.as_ref()) {
            let into = pose.rotation.transposed();
            names.vector(into * platform.angular_velocity, "w", "platform");
            names.vector(into * platform.angular_acceleration, &dot("wd"), "platform");
            names.vector(into * platform.acceleration, &dot("a"), "platform");
        }
        for (index, (leg, state)) in self.mechanism.legs.iter().zip(&self.legs).enumerate() {
            if let Some((closure, platform)) = state.closure.as_ref().zip(platform.as_ref()) {
                let velocity = platform.point_velocity(closure.arm);
                let acceleration = platform.point_acceleration(closure.at, closure.arm);
                names.vector(velocity, "v_end", &leg.name);
                names.vector(acceleration, &dot("a_end"), &leg.name);
                names.vector(velocity - platform.velocity, "v_arm", &leg.name);
                names.vector(
                    acceleration - platform.acceleration,
                    &dot("a_arm"),
                    &leg.name,
                );
            }
            for (joint, u) in leg.independent().zip(&motion.u[index]) {
                let what = format!("rate_{}_squared", leg.joints[joint].name);
                names.one(*u * *u, joined(&[&what, &leg.name]));
            }
            let forms = leg.joints.iter().zip(&state.rates.joint);
            for (joint, form) in forms {
                let rate = form.value(self.arena, &motion.u[index]);
                let acceleration = form.value(self.arena, &motion.u_dot[index]);
                names.one(rate, joined(&["qd", &joint.name, &leg.name]));
                names.one(acceleration, joined(&[&dot("qdd"), &joint.name, &leg.name]));
            }
            for (joint, body) in leg.joints.iter().zip(&motion.bodies[index]) {
                let of = |what: &str| format!("{what}{}", joint.suffix());
                names.vector(body.omega, &of("w"), &leg.name);
                names.vector(body.alpha, &dot(&of("wd")), &leg.name);
                names.vector(body.acceleration, &dot(&of("a")), &leg.name);
                for (row, axis) in body.u_matrix.0.iter().zip(AXES) {
                    for (entry, other) in row.iter().zip(AXES) {
                        let what = format!("{}_{axis}{other}", dot(&of("u")));
                        names.one(*entry, joined(&[&what, &leg.name]));
                    }
                }
                for (of_u, partial) in leg.independent().zip(&body.partials) {
                    let by = &leg.joints[of_u].name;
                    names.vector(partial.linear, &format!("{}_by_{by}", of("v")), &leg.name);
                    names.vector(partial.angular, &format!("{}_by_{by}", of("w")), &leg.name);
                }
            }
        }
        names.give();
    }
}

/// Names the common factor of a leg's wrenches, and the wrenches without and with it.
fn name_wrenches<'a>(names: &mut Names<'a>, leg: &Leg, closure: &LegClosure<'a>) {
    let positive = |value: Expr<'a>| {
        if value.handle().is_negative() {
            -value
        } else {
            value
        }
    };
    let factors = || {
        closure
            .wrenches
            .iter()
            .map(|wrench| positive(wrench.factor))
    };
    let first = factors().next();
    let is_one = factors().all(|factor| Some(factor) == first);
    let all = closure
        .wrenches
        .iter()
        .zip(&closure.forces)
        .zip(&closure.moments);
    for (joint, ((wrench, force), moment)) in leg.independent().zip(all) {
        let label = leg.joints[joint].suffix();
        let factor = if is_one {
            "k".to_owned()
        } else {
            format!("k{label}")
        };
        names.one(positive(wrench.factor), joined(&[&factor, &leg.name]));
        names.vector(*force, &format!("f{label}"), &leg.name);
        names.vector(*moment, &format!("n{label}"), &leg.name);
        names.vector(wrench.wrench.force, &format!("fk{label}"), &leg.name);
        names.vector(wrench.wrench.moment, &format!("nk{label}"), &leg.name);
    }
    for determinant in &closure.determinants {
        names.one(determinant.factor_and_base().1, joined(&["det", &leg.name]));
    }
}
