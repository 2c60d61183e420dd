//! Inverse kinematics by rule: what a leg's closure says of its joints, without an angle.
//!
//! Two rules are tried, both on the leg's geometry and never on a robot's name. `planar` knows the
//! two links in a plane. `peeling` takes a leg apart one joint at a time after Paul: the closure
//! is written in the frame of every joint on the way, and of all the scalar equations that this gives
//! (`equations`) one is looked for that holds a single unknown and is linear in its cosine and
//! sine or quadratic in its slide. What is found makes others soluble.
//!
//! The closed forms hold square roots, whose signs are the working mode of the home configuration. Where one leg stands for
//! others of another mode, the signs are elements of an array ([`Home::signs`](crate::mechanism::Home)).

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

/// A condition for the pose to be within reach: the expression must not be negative.
#[derive(Debug, Clone, Copy)]
pub struct Reach<'a> {
    /// The radicand.
    pub radicand: Expr<'a>,
}

/// What a rule works on.
#[derive(Debug, Clone, Copy)]
pub struct Task<'a, 'm> {
    /// The graph.
    pub arena: &'a Arena,
    /// The leg.
    pub leg: &'m Leg,
    /// Index of the leg's first joint in q_t.
    pub first_joint: usize,
    /// The home configuration, which fixes the working mode.
    pub home: &'m Home,
    /// The point that the leg's end has to meet, in the base frame.
    pub target: Vector3<'a>,
    /// For a rigid end, the orientation that the last frame has to have.
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
            home: &mechanism.home,
            target: platform.origin + platform.arm(end.point()),
            axes,
        })
    }

    /// The value at home of an expression in the pose.
    fn at_home(&self, expr: Expr<'a>) -> f64 {
        self.home.value(self.arena, expr)
    }

    /// Names a root, and what it is with its sign where that is one of the numbers of a leg that stands for others.
    fn name_root(&self, root: Expr<'a>, radicand: Expr<'a>, name: &str) {
        let plain = radicand.sqrt();
        let _ = plain.named(name);
        if root != plain && root != -plain {
            let _ = root.named(&format!("signed_{name}"));
        }
    }

    /// The least size that an equation's coefficients have without cancelling: they are components of
    /// unit vectors, lengths, or squares of lengths.
    fn size(&self) -> f64 {
        let steps = self.leg.joints.iter().flat_map(|j| [j.d, j.b, j.r]);
        let end = self.leg.end.iter().flat_map(End::point);
        let lengths = steps.chain(self.leg.base.at).chain(end);
        let longest = lengths.map(|l| l.value().abs()).fold(0.0, f64::max);
        // A leg of a nanometre is one of orientations only.
        if longest > 1e-9 {
            longest.powi(2).min(1.0)
        } else {
            1.0
        }
    }

    /// The value at home of a sum of joint angles and a constant.
    fn turn_at_home(&self, turn: &Direction) -> f64 {
        let joint = |symbol: SymbolId| self.home.input(self.arena.input_element(symbol)?);
        let terms = turn.terms().iter();
        terms.fold(turn.offset().value(), |sum, (symbol, factor)| {
            sum + joint(*symbol).unwrap_or(0.0) * factor.value()
        })
    }
}

/// For each leg the signs at home of the roots in its closed form. `None` if a leg has none.
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

/// Learns the leg's angles and slides from the pose. `None` if no rule fits the leg.
pub(crate) fn solve_leg<'a>(
    task: Task<'a, '_>,
    configuration: &mut Configuration<'a>,
) -> Option<Vec<Reach<'a>>> {
    planar::solve(task, configuration).or_else(|| peeling::solve(task, configuration))
}
