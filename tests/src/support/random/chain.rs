//! Random chains of joints, built from the base outwards.

use super::{Dice, Member, draw_parameters};
use crate::reference::{Joint, JointKind};

/// Factors of a joint variable in a dependent joint's position.
const FACTORS: [f64; 6] = [-1.0, -1.0, 1.0, 0.5, -2.0, 0.3];

/// A chain with branches that end freely.
#[derive(Debug)]
pub(super) struct Chain<'d> {
    pub(super) dice: &'d mut Dice,
    pub(super) members: Vec<Member>,
    /// Joint at which the chain continues.
    tip: Option<usize>,
}

impl<'d> Chain<'d> {
    pub(super) fn new(dice: &'d mut Dice) -> Self {
        Self {
            dice,
            members: Vec::new(),
            tip: None,
        }
    }

    /// Joint after the tip with its own variable; geometry all zero.
    pub(super) fn next(&self, kind: JointKind) -> Joint {
        Joint {
            antecedent: self.tip,
            ..Joint::new(kind, self.members.len())
        }
    }

    /// Appends a joint to the chain.
    pub(super) fn push(&mut self, joint: Joint) {
        self.put(joint);
        self.tip = Some(self.members.len() - 1);
    }

    fn put(&mut self, joint: Joint) {
        let parameters = draw_parameters(self.dice, joint.kind);
        self.members.push(Member {
            joint,
            parameters,
            load: None,
        });
    }

    /// Continues at any joint, or at the base.
    pub(super) fn jump(&mut self) {
        let at = self.dice.below(self.members.len() + 1);
        self.tip = at.checked_sub(1);
    }

    /// Draws a revolute or, less often, prismatic joint.
    pub(super) fn draw_kind(&mut self) -> JointKind {
        if self.dice.chance(0.3) {
            JointKind::Prismatic
        } else {
            JointKind::Revolute
        }
    }

    /// Draws a joint with any placement.
    pub(super) fn draw_joint(&mut self, kind: JointKind) -> Joint {
        let gamma_and_b = self.dice.chance(0.3);
        let dice = &mut *self.dice;
        Joint {
            gamma: if gamma_and_b { dice.angle(1.5) } else { 0.0 },
            b: if gamma_and_b { dice.length(0.2) } else { 0.0 },
            alpha: dice.twist(),
            d: dice.length(0.5),
            theta: dice.angle(1.0),
            r: dice.length(0.3),
            ..self.next(kind)
        }
    }

    /// Joints so far with a variable of their own.
    fn owners(&self) -> Vec<usize> {
        let own = |at: &usize| self.members[*at].joint.terms.iter().any(|t| t.0 == *at);
        (0..self.members.len()).filter(own).collect()
    }

    /// Draws a joint coupled to one or two others, or a fixed one if there are none.
    pub(super) fn draw_follower(&mut self) -> Joint {
        let kind = self.draw_kind();
        // A position in metres that depends on an angle is a screw; factors are then per radian.
        let owners = self.owners();
        let mut terms: Vec<(usize, f64)> = Vec::new();
        for _ in 0..self.dice.pick(&[1, 1, 2]) {
            if owners.is_empty() {
                break;
            }
            let of = self.dice.pick(&owners);
            if terms.iter().all(|t| t.0 != of) {
                terms.push((of, self.dice.pick(&FACTORS)));
            }
        }
        terms.sort_by_key(|t| t.0);
        if terms.is_empty() || self.dice.chance(0.3) {
            return self.draw_joint(JointKind::Fixed);
        }
        self.draw_joint(kind).dependent(&terms)
    }

    /// Sometimes adds a branch body: fixed, or coupled to the chain.
    pub(super) fn maybe_branch(&mut self) {
        if self.dice.chance(0.1) {
            let branch = self.draw_follower();
            self.put(branch);
        }
    }

    /// Sometimes adds a body in the chain: fixed, or coupled to earlier joints.
    pub(super) fn maybe_follow(&mut self) {
        if self.dice.chance(0.1) {
            let link = self.draw_follower();
            self.push(link);
        }
    }
}
