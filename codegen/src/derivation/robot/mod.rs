//! Derivation of one robot in one graph: configuration, closures and motion, from which all
//! functions are built.

pub(crate) mod constraints;
pub(crate) mod derivable;
mod legs;
mod motors;
mod naming;

use crate::cas::{Arena, Expr, Vector3};
use crate::derivation::bodies::body::{LegRates, leg_base, leg_bodies};
use crate::derivation::bodies::motion::{Moved, RobotMotion};
use crate::derivation::bodies::platform_body::{Mount, PlatformBody};
use crate::derivation::closure::leg::LegState;
use crate::derivation::closure::leg_closure::LegClosure;
use crate::derivation::closure::parasitic_motion::ParasiticMotion;
use crate::derivation::derivation_error::DerivationError;
use crate::derivation::guard::Guard;
use crate::derivation::kinematics::configuration::Configuration;
use crate::derivation::kinematics::frames::LegFrames;
use crate::derivation::kinematics::platform::{PlatformMotion, PlatformPose};
use crate::derivation::kinematics::spatial::SpatialMotion;
use crate::derivation::linear_algebra::elimination::Rows;
use crate::derivation::linear_algebra::linear::apply;
use crate::derivation::motion_input::MotionInput;
use crate::derivation::names::{Accelerations, coordinate_label, joined};
use crate::derivation::selection::Formulation;
use crate::mechanism::{JointKind, Mechanism, TwistCoordinate};
use std::cell::RefCell;

/// The derivation of a robot.
#[derive(Debug)]
pub struct Robot<'a> {
    /// The graph.
    pub arena: &'a Arena,
    /// The mechanism.
    pub mechanism: &'a Mechanism,
    /// Sines and cosines of the joints.
    pub configuration: Configuration<'a>,
    /// The platform's pose; `None` for a tree and for a skeleton with chains.
    pub platform: Option<PlatformPose<'a>>,
    /// The independent twist coordinates.
    pub twist: Vec<TwistCoordinate>,
    /// Components of the platform's velocity along its pose coordinates.
    ///
    /// They are the independent ones, or all six of a platform with parasitic motion.
    pub(crate) free: Vec<TwistCoordinate>,
    /// Relation of these to the independent ones, for a platform with parasitic motion.
    pub(crate) parasitic_motion: Option<ParasiticMotion<'a>>,
    /// Relation of the rates of all joints in the pose to the independent ones, for a skeleton with
    /// dependent joints.
    pub(crate) dependent_joints: Option<ParasiticMotion<'a>>,
    /// The legs.
    pub legs: Vec<LegState<'a>>,
    /// See [`Formulation::at_end`].
    pub(crate) at_end: bool,
    /// See [`Formulation::own_axes`].
    pub(crate) own_axes: bool,
    /// See [`Formulation::lump_end_masses`].
    pub(crate) lump_end_masses: bool,
    /// See [`Formulation::by_ends`].
    pub(crate) by_ends: bool,
    /// See [`Formulation::by_rows`].
    by_rows: bool,
    /// Guards of the model.
    pub guards: Vec<Guard<'a>>,
    /// Derived motions, whose quantities are named at the end of the derivation.
    pub(crate) motions: RefCell<Vec<Moved<'a>>>,
}

impl<'a> Robot<'a> {
    /// Derives configuration and closures; `still` are pose coordinates that are known to be zero.
    ///
    /// # Errors
    /// A leg whose joints do not follow from the pose in closed form, or a structurally singular
    /// leg.
    pub fn new(
        arena: &'a Arena,
        mechanism: &'a Mechanism,
        from: MotionInput,
        formulation: &Formulation,
        still: &[usize],
    ) -> Result<Self, DerivationError> {
        let motion = mechanism.platform.as_ref().map(|p| p.motion);
        // The configuration of a tree consists of its joints, whatever the input is called.
        let from = if mechanism.is_tree() {
            MotionInput::Joints
        } else {
            from
        };
        // Functions normalise the quaternion of a pose, and legs at angles have determinants that
        // are multiples of lengths. If the platform may have any orientation, this knowledge saves
        // no operations.
        if mechanism.is_parasitic() {
            arena.find_irrational_multiples();
            arena.unit_quaternion("pose", mechanism.pose_len() - 4, still);
        }
        if formulation.over_divisors {
            arena.find_over_divisors();
        }
        let mut robot = Self {
            arena,
            mechanism,
            configuration: Configuration::new(arena, mechanism, from),
            platform: motion.map(|m| PlatformPose::new(arena, m.of_pose(), still)),
            twist: motion
                .map(crate::mechanism::Motion::twist)
                .unwrap_or_default(),
            free: Self::free_coordinates(motion),
            parasitic_motion: None,
            dependent_joints: None,
            legs: Vec::new(),
            at_end: formulation.at_end,
            own_axes: formulation.own_axes,
            lump_end_masses: formulation.lump_end_masses,
            by_ends: formulation.by_ends,
            by_rows: formulation.by_rows,
            guards: Vec::new(),
            motions: RefCell::default(),
        };
        for leg in 0..mechanism.legs.len() {
            robot.derive_leg(leg, formulation)?;
        }
        let dependent = robot.derive_parasitic_motion()?;
        if mechanism.has_dependent_joints() {
            robot.dependent_joints = dependent;
            robot.follow_independent_joints();
        } else if dependent.is_some() {
            robot.parasitic_motion = dependent;
            robot.follow_independent();
        }
        Ok(robot)
    }

    /// Transforms the legs' rows per component of the platform's velocity to rows per independent
    /// coordinate.
    fn follow_independent(&mut self) {
        let partials = self.parasitic_motion.as_ref().filter(|_| self.by_ends);
        let partials = partials.map(|parasitic| parasitic.partials(self.arena));
        for index in 0..self.legs.len() {
            let leg = &self.mechanism.legs[index];
            self.arena.enter(&leg.name);
            let rows = match (&self.legs[index].closure, &partials) {
                (Some(closure), Some(partials)) => closure.rows_on(partials),
                _ => {
                    let rows = std::mem::take(&mut self.legs[index].rows).into_iter();
                    rows.map(|row| self.on_independent(row)).collect()
                }
            };
            name_rows(&rows, leg, &self.twist);
            self.legs[index].rows = rows;
        }
        self.arena.enter("");
    }

    /// Transforms quantities of all legs per joint in the pose to those per independent joint: their
    /// rows, and the motions of the bodies at their ends.
    fn follow_independent_joints(&mut self) {
        let Some(dependent) = &self.dependent_joints else {
            return;
        };
        for (leg, state) in self.mechanism.legs.iter().zip(&mut self.legs) {
            self.arena.enter(&leg.name);
            for row in &mut state.rows {
                *row = dependent.on_independent(row);
            }
            let project = |motions: &[SpatialMotion<'a>]| dependent.motions(motions);
            if let Some(closure) = &mut state.closure {
                closure.project_directions(&project);
            }
            if let Some(end) = &mut state.platform {
                end.project_directions(&project);
            }
        }
        self.arena.enter("");
    }

    /// The frames of a leg in the base's axes.
    #[must_use]
    pub(crate) fn base_frames(&self, index: usize) -> Option<LegFrames<'a>> {
        let leg = &self.mechanism.legs[index];
        let first_joint = self.legs[index].first_joint;
        LegFrames::new(self.arena, leg, first_joint, &self.configuration, 0, None)
    }

    /// Rates of joints that are in the pose, per joint in the pose.
    pub(crate) fn identity_rows(&self, own: std::ops::Range<usize>) -> Rows<'a> {
        let count = self.mechanism.pose_len();
        let entry = |i: usize, j: usize| self.arena.integer(i64::from(i == j));
        own.map(|i| (0..count).map(|j| entry(i, j)).collect())
            .collect()
    }

    /// Value of an expression at the home configuration, with all rates set to small numbers.
    #[must_use]
    pub(crate) fn at_home(&self, expr: Expr<'a>) -> f64 {
        self.mechanism.home.value(self.arena, expr)
    }

    /// Inputs `name[0]`, `name[1]`, … as expressions.
    #[must_use]
    pub fn inputs(&self, name: &'static str, count: usize) -> Vec<Expr<'a>> {
        (0..count).map(|i| self.arena.input(name, i)).collect()
    }

    /// Velocities and accelerations of all legs and bodies.
    #[must_use]
    pub fn motion(&self, twist: &[Expr<'a>], acceleration: &[Expr<'a>]) -> Option<RobotMotion<'a>> {
        let platform = self.platform.as_ref().map(|p| {
            let (velocity, acceleration) = self.free_motion(twist, acceleration);
            p.motion(&velocity, &acceleration)
        });
        let (pose_rates, pose_accelerations) = self.skeleton_motion(twist, acceleration);
        let gravity = Vector3::constant(self.arena, self.mechanism.gravity);
        let accelerations = Accelerations::new(acceleration);
        let platform_body = |mount: &Mount<'a>| {
            let both = self.platform.as_ref().zip(platform.as_ref());
            both.map(|(pose, motion)| PlatformBody::new(pose, motion, gravity, mount))
        };
        let mut motion = RobotMotion {
            twist: twist.to_vec(),
            u: vec![],
            u_dot: vec![],
            bodies: vec![],
            platform_bodies: vec![],
            ends: vec![],
            platform: None,
        };
        for (leg, state) in self.mechanism.legs.iter().zip(&self.legs) {
            self.arena.enter(&leg.name);
            let own = match (&state.closure, &platform) {
                (Some(_), None) => state
                    .platform
                    .as_ref()
                    .map(|p| p.motion(&motion.u.concat(), &motion.u_dot.concat()))
                    .map(|end| state.less_gravity(end)),
                _ => None,
            };
            let rates = match (&state.closure, own.as_ref().or(platform.as_ref())) {
                (Some(closure), Some(platform)) => {
                    let u = self.rates_of_leg(state, closure, twist, platform);
                    name_rates(leg, &u, "rate");
                    let labels = accelerations.labels(leg, "a_on_f");
                    let u_dot = if let Some(course) = &state.cable {
                        vec![closure.cable_acceleration(course, platform, u[0], &labels[0])]
                    } else {
                        let bias = state.bias(self.arena, leg, &u);
                        closure.accelerations(self.arena, platform, &bias, &labels)
                    };
                    name_rates(leg, &u_dot, &accelerations.name("rate_dot"));
                    LegRates { u, u_dot }
                }
                _ => {
                    let range = self.mechanism.coordinate_range(motion.u.len());
                    LegRates {
                        u: pose_rates[range.clone()].to_vec(),
                        u_dot: pose_accelerations[range].to_vec(),
                    }
                }
            };
            let carrier = leg.base_body;
            let carrier = carrier.map(|body| &motion.bodies[body.leg][body.joint]);
            let base = leg_base(self.arena, leg, rates.u.len(), carrier, gravity);
            let bodies = leg_bodies(self.arena, leg, state, &self.configuration, &rates, &base)?;
            let end = own.as_ref().or(platform.as_ref());
            motion
                .ends
                .push(end.and_then(|end| state.end_less_gravity(leg, end)));
            motion.u.push(rates.u);
            motion.u_dot.push(rates.u_dot);
            let mounts = Mount::of_leg(self.arena, leg);
            let on_platform = mounts.iter().map(|m| m.as_ref().and_then(&platform_body));
            motion.platform_bodies.push(on_platform.collect());
            motion.bodies.push(bodies);
        }
        self.arena.enter("platform");
        motion.platform = platform_body(&Mount::platform(self.arena));
        self.arena.enter("");
        self.motions.borrow_mut().push(Moved {
            motion: motion.clone(),
            platform,
            accelerations,
        });
        Some(motion)
    }

    /// Quasi-velocities of a leg, from the velocity of its end body or from the independent rates.
    pub(crate) fn rates_of_leg(
        &self,
        state: &LegState<'a>,
        closure: &LegClosure<'a>,
        twist: &[Expr<'a>],
        end: &PlatformMotion<'a>,
    ) -> Vec<Expr<'a>> {
        if self.by_rows {
            apply(&state.rows[..closure.wrenches.len()].to_vec(), twist)
        } else {
            closure.velocities(end)
        }
    }

    /// J_p^inv, n × r: the rows of the actuated joints in the reduced Jacobians, then those of the
    /// motors.
    #[must_use]
    pub fn inverse_jacobian(&self) -> Rows<'a> {
        let all = self.joint_rows();
        let actuated = self.mechanism.actuated();
        let mut rows: Rows<'a> = actuated.iter().map(|&i| all[i].clone()).collect();
        let legs: Vec<&Rows<'a>> = self.legs.iter().map(|state| &state.rows).collect();
        rows.extend((0..self.mechanism.motors.len()).map(|motor| self.motor_row(motor, &legs)));
        rows
    }

    /// Generalised forces on the actuated joints for their torques, and the reverse: a tension
    /// shortens its cable.
    #[must_use]
    pub(crate) fn with_tensions(&self, torques: Vec<Expr<'a>>) -> Vec<Expr<'a>> {
        let signed = torques.into_iter().zip(self.mechanism.pulls());
        signed
            .map(|(torque, pulls)| if pulls { -torque } else { torque })
            .collect()
    }

    /// ∂q̇_t/∂v, n_t × r.
    #[must_use]
    pub(crate) fn joint_rows(&self) -> Rows<'a> {
        let mut rows = Vec::new();
        for (leg, state) in self.mechanism.legs.iter().zip(&self.legs) {
            self.arena.enter(&leg.name);
            for joint in leg.independent() {
                rows.push(state.rates.joint[joint].row(self.arena, &state.rows));
            }
        }
        self.arena.enter("");
        rows
    }

    /// Position of a joint of q_t, rad or m.
    ///
    /// Passive angles are arc tangents within half a turn of the home configuration. `None` if the
    /// configuration does not determine it.
    pub(crate) fn joint_position(&self, index: usize) -> Option<Expr<'a>> {
        let configuration = &self.configuration;
        if configuration.from() == MotionInput::Joints {
            return Some(self.arena.input("joints", index));
        }
        if let Some(position) = configuration.in_pose(index) {
            return Some(position);
        }
        let kind = self.mechanism.joint(self.mechanism.joints()[index]).kind;
        if kind == JointKind::Prismatic {
            return configuration.joint_position(index);
        }
        let unit = configuration.unit(&configuration.joint_angle(index))?;
        Some(unit.angle_near(self.arena, self.mechanism.home.joints[index]))
    }

    /// Values for all joints of q_t of their forms of quasi-velocities.
    #[must_use]
    pub fn joint_values(&self, u: &[Vec<Expr<'a>>]) -> Vec<Expr<'a>> {
        let mut values = Vec::new();
        for ((leg, state), u) in self.mechanism.legs.iter().zip(&self.legs).zip(u) {
            values.extend(
                leg.independent()
                    .map(|j| state.rates.joint[j].value(self.arena, u)),
            );
        }
        values
    }
}

fn name_rates(leg: &crate::mechanism::Leg, values: &[Expr<'_>], prefix: &str) {
    for (joint, value) in leg.independent().zip(values) {
        let _ = value.named(&format!("{prefix}_{}_{}", leg.joints[joint].name, leg.name));
    }
}

pub(crate) fn name_rows(rows: &Rows<'_>, leg: &crate::mechanism::Leg, twist: &[TwistCoordinate]) {
    for (joint, row) in leg.independent().zip(rows) {
        for (entry, coordinate) in row.iter().zip(twist) {
            let what = format!(
                "g{}_{}",
                leg.joints[joint].name,
                coordinate_label(coordinate)
            );
            let _ = entry.named(&joined(&[&what, &leg.name]));
        }
    }
}
