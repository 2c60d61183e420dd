//! Defects of mechanisms, each of which the generator must detect.

use super::{Attachment, Dice, Member, Shape, Sketch};
use crate::reference::linear::condition;
use crate::reference::{Joint, JointKind, Motion, State};
use nalgebra::DVector;

/// A defect of a mechanism.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Defect {
    /// The base of a leg is too far away.
    OutOfReach,
    /// Fewer actuators than degrees of freedom.
    ActuatorMissing,
    /// A leg has a joint that the platform's motion does not determine.
    JointTooMany,
    /// A leg has one joint too few to follow the platform.
    JointMissing,
    /// Two axes of a leg coincide.
    AxesCoincide,
    /// A joint is coupled to itself.
    Cycle,
    /// As many actuators as degrees of freedom, but they do not determine the motion.
    ActuatorsDependent,
}

impl Defect {
    /// All defects.
    pub const ALL: [Self; 7] = [
        Self::OutOfReach,
        Self::ActuatorMissing,
        Self::JointTooMany,
        Self::JointMissing,
        Self::AxesCoincide,
        Self::Cycle,
        Self::ActuatorsDependent,
    ];

    /// Applies the defect; `None` if it does not apply to the mechanism.
    #[must_use]
    pub fn apply(self, sketch: &Sketch) -> Option<Sketch> {
        let mut dice = Dice::new(sketch.seed ^ 0xdefec7);
        let mut sketch = sketch.clone();
        // Names of kept actuators are no longer valid.
        sketch.kept = None;
        if sketch.motion == Motion::None {
            return None;
        }
        let at = dice.below(sketch.shapes.len());
        let shape = &mut sketch.shapes[at];
        match self {
            Self::OutOfReach => shape.move_away(&mut dice),
            Self::ActuatorMissing => sketch.take_actuators(),
            Self::JointTooMany => shape.add_joint(),
            Self::JointMissing => shape.fix_joint(),
            Self::AxesCoincide => shape.lay_axes_together(),
            Self::Cycle => shape.close_cycle(),
            Self::ActuatorsDependent => sketch.actuate_dependently(&mut dice),
        }?;
        // A leg with more mobility than the platform requires may lose a joint.
        let is_valid = self == Self::JointMissing && sketch.moves();
        (!is_valid).then_some(sketch)
    }
}

impl Shape {
    fn move_away(&mut self, dice: &mut Dice) -> Option<()> {
        let is_held = match self.places[0].end {
            Attachment::Rigid(_) => true,
            Attachment::Point(_, along) => along == [true; 3],
            Attachment::Free => false,
        };
        let stays = |m: &Member| m.joint.kind != JointKind::Prismatic;
        let is_short = is_held && self.members.iter().all(stays);
        self.places[0].base.at[dice.below(3)] += 30.0;
        is_short.then_some(())
    }

    /// Adds a joint whose axis passes through the leg's end and which therefore rotates freely.
    fn add_joint(&mut self) -> Option<()> {
        if !matches!(self.places[0].end, Attachment::Point(..)) {
            return None;
        }
        for placed in &mut self.places {
            placed.home.push(0.0);
        }
        self.members.push(Member {
            joint: Joint {
                alpha: 1.0,
                ..Joint::revolute(self.members.len(), 1.0, 0.0)
            },
            parameters: Vec::new(),
            load: None,
        });
        Some(())
    }

    /// Fixes the first joint at home.
    fn fix_joint(&mut self) -> Option<()> {
        let own = self.independent();
        let first = *own.first()?;
        let follows = |m: &&Member| m.joint.terms.iter().any(|t| t.0 == first);
        if own.len() < 2 || self.members.iter().filter(follows).count() > 1 {
            return None;
        }
        self.places.truncate(1);
        let constant = self.places[0].home.remove(0);
        let member = &mut self.members[first];
        match member.joint.kind {
            JointKind::Revolute => member.joint.theta += constant,
            _ => member.joint.r += constant,
        }
        member.joint = Joint {
            kind: JointKind::Fixed,
            actuated: false,
            ..member.joint.clone().dependent(&[])
        };
        member.parameters.clear();
        Some(())
    }

    fn lay_axes_together(&mut self) -> Option<()> {
        let own = self.independent();
        let (first, second) = (*own.first()?, *own.get(1)?);
        let turns = |j: usize| self.members[j].joint.kind == JointKind::Revolute;
        let is_pair = second == first + 1 && turns(first) && turns(second);
        // A coupled joint could distinguish them.
        let alone = |(at, m): (usize, &Member)| m.joint.terms.iter().all(|t| t.0 == at);
        let has_no_follower = self.members.iter().enumerate().all(alone);
        let joint = &mut self.members[second].joint;
        (joint.alpha, joint.d) = (0.0, 0.0);
        (is_pair && has_no_follower).then_some(())
    }

    fn close_cycle(&mut self) -> Option<()> {
        let own = self.independent();
        let (first, second) = (*own.first()?, *own.get(1)?);
        for (at, of) in [(first, second), (second, first)] {
            let joint = &mut self.members[at].joint;
            joint.terms = vec![(of, 1.0)];
            joint.actuated = false;
        }
        for placed in &mut self.places {
            placed.home.drain(..2);
        }
        Some(())
    }
}

impl Sketch {
    /// Whether every leg can follow the platform at home.
    fn moves(&self) -> bool {
        let mechanism = self.mechanism();
        let still = DVector::zeros(mechanism.dof());
        State::solve(&mechanism, &mechanism.home, &still, &still).is_ok()
    }

    fn take_actuators(&mut self) -> Option<()> {
        let dof = self.motion.dof();
        while self.actuators() >= dof {
            let joints = self.shapes.iter_mut().flat_map(|s| &mut s.members);
            let driven = joints.map(|m| &mut m.joint).find(|j| j.actuated);
            driven?.actuated = false;
        }
        Some(())
    }

    /// Places r motors such that they do not determine the platform's motion, if possible.
    fn actuate_dependently(&mut self, dice: &mut Dice) -> Option<()> {
        let dof = self.motion.dof();
        let mechanism = self.mechanism();
        let still = DVector::zeros(dof);
        let state = State::solve(&mechanism, &mechanism.home, &still, &still).ok()?;
        let rates = state.jacobians(&mechanism).ok()?.joints;
        if self.shapes.iter().any(|s| s.places.len() > 1) || dof < 2 {
            return None;
        }
        let mut order: Vec<usize> = (0..rates.nrows()).collect();
        let is_dependent = |chosen: &[usize]| {
            let rows = rates.select_rows(chosen);
            condition(&rows) > 1e12
        };
        let mut tries = 0..50;
        tries.find(|_| {
            dice.shuffle(&mut order);
            is_dependent(&order[..dof])
        })?;
        let variables = mechanism.variables();
        let chosen: Vec<(usize, usize)> = order[..dof].iter().map(|&at| variables[at]).collect();
        for (leg, shape) in self.shapes.iter_mut().enumerate() {
            for (joint, member) in shape.members.iter_mut().enumerate() {
                member.joint.actuated = chosen.contains(&(leg, joint));
            }
        }
        Some(())
    }
}
