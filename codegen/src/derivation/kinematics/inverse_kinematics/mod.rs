//! Inverse kinematics in closed form: sines, cosines and slides of a leg's joints from its closure.
//!
//! Two rules are tried; both depend on the leg's geometry only. `planar` solves two links in a
//! plane. `peeling` solves a leg joint by joint after Paul. It writes the closure in the frame of
//! every joint (`equations`), and searches a scalar equation with a single unknown. The equation
//! has to be linear in the unknown's cosine and sine, or quadratic in its slide. Each solution
//! makes other equations solvable.
//!
//! The closed forms contain square roots, whose signs are the working mode of the home
//! configuration. If legs of different modes share code, the signs are elements of an array
//! ([`Home::signs`](crate::mechanism::Home)).

mod equations;
mod peeling;
mod planar;
mod polynomial;
#[cfg(test)]
mod tests;

use super::configuration::Configuration;
use super::platform::PlatformPose;
use crate::cas::{Arena, Direction, Expr, Matrix3, SymbolId, Vector3};
use crate::derivation::motion_input::MotionInput;
use crate::mechanism::{End, Home, Leg, Mechanism};

pub(in crate::derivation) use equations::equations;
pub(in crate::derivation) use peeling::advance;
pub(in crate::derivation) use polynomial::at_zero;

/// Condition for a pose to be within reach: the radicand must not be negative.
#[derive(Debug, Clone, Copy)]
pub struct Reach<'a> {
    /// The radicand.
    pub radicand: Expr<'a>,
}

/// Input of a rule.
#[derive(Debug, Clone, Copy)]
pub struct Task<'a, 'm> {
    /// The graph.
    pub arena: &'a Arena,
    /// The leg.
    pub leg: &'m Leg,
    /// Index of the leg's first joint in q_t.
    pub first_joint: usize,
    /// Whether the leg blocks directions of a skeleton, so that a pose may be one that it does not
    /// reach.
    pub blocks: bool,
    /// The home configuration, which fixes the working mode.
    pub home: &'m Home,
    /// Target of the leg's end, in the base frame.
    pub target: Vector3<'a>,
    /// Required orientation of the last frame, for a rigid end.
    pub axes: Option<Matrix3<'a>>,
}

impl<'a, 'm> Task<'a, 'm> {
    /// The leg `index` for a platform's pose; `None` for a leg without an end.
    #[must_use]
    pub fn new(
        arena: &'a Arena,
        mechanism: &'m Mechanism,
        index: usize,
        platform: &PlatformPose<'a>,
    ) -> Option<Self> {
        let leg = &mechanism.legs[index];
        let end = leg.end.as_ref()?;
        let axes = match end {
            End::Rigid(placement) => Some(platform.orientation(placement)),
            End::Point { .. } => None,
        };
        Some(Self {
            arena,
            leg,
            first_joint: mechanism.leg_range(index).start,
            blocks: mechanism.blocking.contains(&index),
            home: &mechanism.home,
            target: platform.origin + platform.arm(end.point()),
            axes,
        })
    }

    /// Value at home of an expression in the pose.
    fn at_home(&self, expr: Expr<'a>) -> f64 {
        self.home.value(self.arena, expr)
    }

    /// Names a root, and its product with its sign if the sign is an input.
    fn name_root(&self, root: Expr<'a>, radicand: Expr<'a>, name: &str) {
        let plain = radicand.sqrt();
        let _ = plain.named(name);
        if root != plain && root != -plain {
            let _ = root.named(&format!("signed_{name}"));
        }
    }

    /// The least size of an equation's coefficients without cancellation.
    ///
    /// They are components of unit vectors, lengths, or squares of lengths.
    fn size(&self) -> f64 {
        let steps = self.leg.joints.iter().flat_map(|j| [j.d, j.b, j.r]);
        let end = self.leg.end.iter().flat_map(End::point);
        let lengths = steps.chain(self.leg.base.at).chain(end);
        let longest = lengths.map(|l| l.value().abs()).fold(0.0, f64::max);
        // A leg shorter than a nanometre consists of orientations only.
        if longest > 1e-9 {
            longest.powi(2).min(1.0)
        } else {
            1.0
        }
    }

    /// Value at home of a sum of joint angles and a constant.
    fn turn_at_home(&self, turn: &Direction) -> f64 {
        let joint = |symbol: SymbolId| self.home.input(self.arena.input_element(symbol)?);
        let terms = turn.terms().iter();
        terms.fold(turn.offset().value(), |sum, (symbol, factor)| {
            sum + joint(*symbol).unwrap_or(0.0) * factor.value()
        })
    }
}

/// Signs at home of the roots in each leg's closed form. `None` if a leg has no closed form.
pub(crate) fn working_modes(mechanism: &Mechanism) -> Option<Vec<Vec<bool>>> {
    let motion = mechanism.platform.as_ref()?.motion;
    let arena = Arena::new();
    let platform = PlatformPose::new(&arena, motion.of_pose(), &[]);
    let of_leg = |leg| {
        let task = Task::new(&arena, mechanism, leg, &platform)?;
        let mut configuration = Configuration::new(&arena, mechanism, MotionInput::Pose);
        solve_leg(task, &mut configuration)?;
        Some(configuration.signs())
    };
    (0..mechanism.legs.len()).map(of_leg).collect()
}

/// Solves the leg's angles and slides from the pose. `None` if no rule fits the leg.
pub(crate) fn solve_leg<'a>(
    task: Task<'a, '_>,
    configuration: &mut Configuration<'a>,
) -> Option<Vec<Reach<'a>>> {
    planar::solve(task, configuration).or_else(|| peeling::solve(task, configuration))
}
