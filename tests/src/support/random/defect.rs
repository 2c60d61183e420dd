//! Damages to a sound mechanism, each of which the generator has to find.

use super::{Attachment, Dice, Member, Sketch};
use crate::reference::{Joint, JointKind, Motion};

/// What is wrong with a mechanism.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Defect {
    /// A leg's base is farther away than the leg is long.
    OutOfReach,
    /// Fewer actuators than degrees of freedom.
    ActuatorMissing,
    /// A leg has a joint that the platform's motion does not determine.
    JointTooMany,
    /// A leg has one joint less than it needs to follow the platform.
    JointMissing,
    /// Two axes of a leg coincide.
    AxesCoincide,
    /// A joint follows itself.
    Cycle,
}

impl Defect {
    /// All of them.
    pub const ALL: [Self; 6] = [
        Self::OutOfReach,
        Self::ActuatorMissing,
        Self::JointTooMany,
        Self::JointMissing,
        Self::AxesCoincide,
        Self::Cycle,
    ];

    /// Damages a mechanism; none if the damage does not apply to it.
    #[must_use]
    pub fn apply(self, sketch: &Sketch) -> Option<Sketch> {
        let mut dice = Dice::new(sketch.seed ^ 0xdefec7);
        let mut sketch = sketch.clone();
        // Names of kept actuators are no longer right.
        sketch.kept = None;
        if sketch.motion == Motion::None {
            return None;
        }
        let at = dice.below(sketch.shapes.len());
        let shape = &mut sketch.shapes[at];
        let last = shape.members.len() - 1;
        let is_turning = |m: &Member| m.joint.kind != JointKind::Prismatic;
        match self {
            Self::OutOfReach => {
                let everywhere = match shape.places[0].end {
                    Attachment::Rigid(_) => true,
                    Attachment::Point(_, along) => along == [true; 3],
                    Attachment::Free => false,
                };
                if !everywhere || !shape.members.iter().all(is_turning) {
                    return None;
                }
                shape.places[0].base.at[dice.below(3)] += 30.0;
            }
            Self::ActuatorMissing => {
                let dof = sketch.motion.dof();
                while sketch.actuators() >= dof {
                    let driven = sketch.shapes.iter_mut().flat_map(|s| &mut s.members);
                    let next = driven.map(|m| &mut m.joint).find(|j| j.actuated)?;
                    next.actuated = false;
                }
            }
            Self::JointTooMany => {
                // Closure equations are as many as the joints where the end is general.
                if !matches!(shape.places[0].end, Attachment::Point(..)) {
                    return None;
                }
                for placed in &mut shape.places {
                    placed.home.push(0.0);
                }
                shape.members.push(Member {
                    joint: Joint {
                        alpha: 1.0,
                        ..Joint::revolute(last + 1, 1.0, 0.0)
                    },
                    parameters: Vec::new(),
                });
            }
            Self::JointMissing => {
                let own = shape.independent();
                let first = *own.first()?;
                let followed = |m: &Member| m.joint.terms.iter().any(|t| t.0 == first);
                if own.len() < 2 || shape.members.iter().filter(|m| followed(m)).count() > 1 {
                    return None;
                }
                let joint = &mut shape.members[first].joint;
                let position = |placed: &super::Placed| placed.home[0];
                // All placements keep the position of the first.
                let constant = position(shape.places.first()?);
                match joint.kind {
                    JointKind::Revolute => joint.theta += constant,
                    _ => joint.r += constant,
                }
                joint.kind = JointKind::Fixed;
                joint.terms.clear();
                joint.actuated = false;
                shape.members[first].parameters = Vec::new();
                shape.places.truncate(1);
                shape.places[0].home.remove(0);
            }
            Self::AxesCoincide => {
                let own = shape.independent();
                let (first, second) = (*own.first()?, *own.get(1)?);
                let kinds = [first, second].map(|j| shape.members[j].joint.kind);
                let own_only = |(at, m): (usize, &Member)| m.joint.terms.iter().all(|t| t.0 == at);
                let alone = shape.members.iter().enumerate().all(own_only);
                if second != first + 1 || kinds != [JointKind::Revolute; 2] || !alone {
                    return None;
                }
                let joint = &mut shape.members[second].joint;
                (joint.alpha, joint.d) = (0.0, 0.0);
            }
            Self::Cycle => {
                let own = shape.independent();
                let (first, second) = (*own.first()?, *own.get(1)?);
                shape.members[first].joint.terms = vec![(second, 1.0)];
                shape.members[second].joint.terms = vec![(first, 1.0)];
                for at in [first, second] {
                    shape.members[at].joint.actuated = false;
                }
                for placed in &mut shape.places {
                    placed.home.drain(..2);
                }
            }
        }
        Some(sketch)
    }
}
