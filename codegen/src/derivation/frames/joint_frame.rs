//! A frame on a body that joints move: the path to it, and its motion for the joints' rates.
//!
//! All vectors are in the base's axes. Along a run of parallel axes the rates are summed before
//! they turn anything, and each lever is computed once: that of a joint is the lever of the next
//! joint on the same axis plus the part between both.

use crate::cas::{Arena, Expr, Number, Vector3};
use crate::derivation::kinematics::orientation::Orientation;
use crate::derivation::kinematics::path::{KnownMotion, Step, seen, steps};
use crate::derivation::kinematics::spatial::{SpatialMotion, Wrench};
use crate::derivation::linear_algebra::elimination::Rows;
use crate::mechanism::{BodyIndex, JointKind};

/// A frame on a body that joints move.
pub(crate) struct JointFrame<'a> {
    arena: &'a Arena,
    /// The joints from the base to the body.
    steps: Vec<Step<'a>>,
    /// For each joint, the vector from its origin to the frame's.
    to_frame: Vec<Vector3<'a>>,
    /// From the origin of the body's frame to that of the frame.
    arm: Vector3<'a>,
}

/// The rotation of a run of parallel axes.
#[derive(Clone, Copy)]
struct Run<'a> {
    axis: Vector3<'a>,
    /// Rate about the axis, of all joints of the run so far.
    rate: Expr<'a>,
    /// Its derivative.
    rate_dot: Expr<'a>,
}

impl<'a> JointFrame<'a> {
    /// A frame at a point of a body, in the body's axes.
    ///
    /// `None` if the configuration does not determine a sine or cosine.
    pub(super) fn new(
        known: &KnownMotion<'_, 'a>,
        body: BodyIndex,
        at: Vector3<'a>,
    ) -> Option<Self> {
        let base = Orientation::default();
        let steps = steps(known, None, body, &base)?;
        let arm = seen(known, &base, Some(body))? * at;
        let mut to_frame = vec![arm; steps.len()];
        for index in (1..steps.len()).rev() {
            to_frame[index - 1] = steps[index].link + to_frame[index];
        }
        Some(Self {
            arena: known.arena,
            steps,
            to_frame,
            arm,
        })
    }

    /// Velocities of the frame per independent rate, from ∂u/∂v of all quasi-velocities.
    pub(super) fn columns(&self, rows: &Rows<'a>, dof: usize) -> Vec<SpatialMotion<'a>> {
        let levers = self.levers();
        let partials: Vec<SpatialMotion<'a>> =
            (0..rows.len()).map(|u| self.partial(u, &levers)).collect();
        let column = |c: usize| {
            let zero = SpatialMotion::zero(self.arena);
            let parts = partials.iter().zip(rows);
            parts.fold(zero, |sum, (partial, row)| sum.plus_scaled(partial, row[c]))
        };
        (0..dof).map(column).collect()
    }

    /// Velocity of the frame's origin for a unit rate of each revolute joint alone.
    fn levers(&self) -> Vec<Vector3<'a>> {
        let mut levers = vec![Vector3::zero(self.arena); self.steps.len()];
        for (index, step) in self.steps.iter().enumerate().rev() {
            let next = (index + 1..self.steps.len()).find(|&at| self.is_turning(at));
            let sign = next.and_then(|next| self.sign(index, next));
            levers[index] = match (next, sign) {
                (Some(next), Some(sign)) => {
                    let onward = levers[next].scaled(self.arena.integer(sign));
                    step.axis.cross(self.between(index, next)) + onward
                }
                _ => step.axis.cross(self.to_frame[index]),
            };
        }
        levers
    }

    /// Velocity of the frame for a unit rate of one quasi-velocity.
    fn partial(&self, u: usize, levers: &[Vector3<'a>]) -> SpatialMotion<'a> {
        let mut sum = SpatialMotion::zero(self.arena);
        let mut open: Vec<(usize, Number)> = Vec::new();
        for (index, step) in self.steps.iter().enumerate() {
            let rate = self.rate(step, u);
            if rate.is_zero() {
                continue;
            }
            let factor = self.arena.number(rate);
            if step.kind == JointKind::Prismatic {
                sum.linear = sum.linear + step.axis.scaled(factor);
            }
            if step.kind != JointKind::Revolute {
                continue;
            }
            let run = open.iter_mut().find_map(|(at, rate_before)| {
                let sign = self.sign(*at, index)?;
                Some((at, rate_before, sign))
            });
            match run {
                // The axes before turn with their rate up to here.
                Some((at, rate_before, sign)) => {
                    let turned = self.steps[*at].axis.cross(self.between(*at, index));
                    let factor = self.arena.number(*rate_before);
                    sum.linear = sum.linear + turned.scaled(factor);
                    *rate_before = *rate_before * Number::integer(sign) + rate;
                    *at = index;
                }
                None => open.push((index, rate)),
            }
        }
        for (index, rate) in open {
            let factor = self.arena.number(rate);
            sum.linear = sum.linear + levers[index].scaled(factor);
            sum.angular = sum.angular + self.steps[index].axis.scaled(factor);
        }
        sum
    }

    /// Rate of a joint per rate of one quasi-velocity of all legs.
    fn rate(&self, step: &Step<'a>, u: usize) -> Number {
        let own = u.checked_sub(step.first);
        own.map_or(Number::ZERO, |own| step.rate.coefficient(own))
    }

    fn is_turning(&self, index: usize) -> bool {
        self.steps[index].kind == JointKind::Revolute
    }

    /// 1 or -1 if two joints have parallel axes in every configuration.
    fn sign(&self, one: usize, other: usize) -> Option<i64> {
        parallel(self.steps[one].axis, self.steps[other].axis)
    }

    /// The vector from the origin of a joint to that of a later one.
    fn between(&self, from: usize, to: usize) -> Vector3<'a> {
        let links = self.steps[from + 1..=to].iter().map(|step| step.link);
        links.fold(Vector3::zero(self.arena), |sum, link| sum + link)
    }

    /// Velocity of the frame for the quasi-velocities of all legs.
    pub(super) fn velocity(&self, rates: &[Expr<'a>]) -> SpatialMotion<'a> {
        let still = vec![self.arena.zero(); rates.len()];
        self.motion(rates, &still)[0]
    }

    /// Acceleration of the frame for the quasi-velocities of all legs and their derivatives.
    pub(super) fn acceleration(
        &self,
        rates: &[Expr<'a>],
        accelerations: &[Expr<'a>],
    ) -> SpatialMotion<'a> {
        self.motion(rates, accelerations)[1]
    }

    /// Velocity and acceleration of the frame.
    fn motion(&self, rates: &[Expr<'a>], accelerations: &[Expr<'a>]) -> [SpatialMotion<'a>; 2] {
        let zero = SpatialMotion::zero(self.arena);
        let (mut velocity, mut acceleration) = (zero, zero);
        // Angular velocity and acceleration before the current run of parallel axes.
        let mut before = [zero.angular; 2];
        let mut run: Option<Run<'a>> = None;
        let moved =
            |at: &mut SpatialMotion<'a>, change: &mut SpatialMotion<'a>, arm: Vector3<'a>| {
                let turned = at.angular.cross(arm);
                at.linear = at.linear + turned;
                let tangential = change.angular.cross(arm);
                change.linear = change.linear + tangential + at.angular.cross(turned);
            };
        for step in &self.steps {
            moved(&mut velocity, &mut acceleration, step.link);
            let of = |all: &[Expr<'a>]| step.rate.value(self.arena, &all[step.first..]);
            let (rate, rate_dot) = (of(rates), of(accelerations));
            match step.kind {
                JointKind::Revolute => {
                    let sign = run.and_then(|run| parallel(run.axis, step.axis));
                    let own = match (run, sign) {
                        (Some(run), Some(sign)) => Run {
                            rate: run.rate + rate * Number::integer(sign),
                            rate_dot: run.rate_dot + rate_dot * Number::integer(sign),
                            ..run
                        },
                        _ => {
                            before = [velocity.angular, acceleration.angular];
                            let axis = step.axis;
                            Run {
                                axis,
                                rate,
                                rate_dot,
                            }
                        }
                    };
                    run = Some(own);
                    let spin = own.axis.scaled(own.rate);
                    velocity.angular = before[0] + spin;
                    acceleration.angular =
                        before[1] + before[0].cross(spin) + own.axis.scaled(own.rate_dot);
                }
                JointKind::Prismatic => {
                    let slide = step.axis.scaled(rate);
                    let swept = velocity.angular.cross(slide);
                    velocity.linear = velocity.linear + slide;
                    acceleration.linear =
                        acceleration.linear + swept + swept + step.axis.scaled(rate_dot);
                }
                JointKind::Fixed => {}
            }
        }
        moved(&mut velocity, &mut acceleration, self.arm);
        [velocity, acceleration]
    }

    /// Forces on the quasi-velocities of all legs, of a wrench at the frame's origin.
    pub(super) fn forces(&self, count: usize, wrench: Wrench<'a>) -> Vec<Expr<'a>> {
        let mut forces = vec![self.arena.zero(); count];
        let mut moment = wrench.moment + self.arm.cross(wrench.force);
        for step in self.steps.iter().rev() {
            let own = match step.kind {
                JointKind::Revolute => step.axis.dot(moment),
                JointKind::Prismatic => step.axis.dot(wrench.force),
                JointKind::Fixed => self.arena.zero(),
            };
            for (u, force) in forces.iter_mut().enumerate() {
                *force = *force + own * self.rate(step, u);
            }
            moment = moment + step.link.cross(wrench.force);
        }
        forces
    }
}

/// 1 or -1 if two axes are parallel in every configuration.
fn parallel(one: Vector3<'_>, other: Vector3<'_>) -> Option<i64> {
    if one == other {
        return Some(1);
    }
    (one == -other).then_some(-1)
}
