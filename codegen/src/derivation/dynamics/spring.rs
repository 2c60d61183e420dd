//! Position-dependent torques of joints: per unit of a spring's unknown coefficient, and known
//! torques.

use crate::cas::{Angle, Arena, Direction, Expr, Number, Ratio};
use crate::derivation::guard::{Guard, GuardKind};
use crate::derivation::kinematics::joint::{joint_slide, joint_turn};
use crate::derivation::robot::Robot;
use crate::mechanism::{Formula, JointIndex, JointKind};

/// Position of a joint as a number, and as an angle if the joint is revolute.
struct Position<'a> {
    number: Expr<'a>,
    turn: Direction,
}

impl<'a> Robot<'a> {
    /// Torque of a joint's spring per unit of its coefficient; zero without a spring.
    pub(crate) fn spring_force(&self, at: JointIndex) -> Expr<'a> {
        let spring = self.mechanism.joint(at).spring.as_ref();
        let formula = spring.map(|spring| &spring.formula);
        self.torque_of_position(at, formula, &mut Vec::new())
    }

    /// Known position-dependent torque of a joint; zero if it has none.
    pub(crate) fn known_force(&self, at: JointIndex) -> Expr<'a> {
        let known = self.mechanism.joint(at).known.as_ref();
        self.torque_of_position(at, known, &mut Vec::new())
    }

    /// Load to which a joint's friction is proportional; zero if none is described.
    pub(crate) fn load(&self, at: JointIndex) -> Expr<'a> {
        let load = self.mechanism.joint(at).load.as_ref();
        let formula = load.map(|load| &load.formula);
        self.torque_of_position(at, formula, &mut Vec::new())
    }

    /// Guards for springs, known torques and loads to have a value: radicands must not be negative.
    pub(crate) fn spring_guards(&self) -> Vec<Guard<'a>> {
        let mut guards = Vec::new();
        for (index, leg) in self.mechanism.legs.iter().enumerate() {
            let mut radicands = Vec::new();
            for (joint, own) in leg.joints.iter().enumerate() {
                let spring = own.spring.as_ref().map(|spring| &spring.formula);
                let load = own.load.as_ref().map(|load| &load.formula);
                let at = JointIndex { leg: index, joint };
                for formula in [spring, own.known.as_ref(), load] {
                    let _ = self.torque_of_position(at, formula, &mut radicands);
                }
            }
            guards.extend(radicands.into_iter().map(|value| Guard {
                value,
                // A force has a value if a length vanishes, unless the length is a divisor.
                kind: GuardKind::Reach(0.0),
                leg: leg.name.clone(),
            }));
        }
        guards
    }

    fn torque_of_position(
        &self,
        at: JointIndex,
        formula: Option<&Formula>,
        radicands: &mut Vec<Expr<'a>>,
    ) -> Expr<'a> {
        let value = formula
            .zip(formula.and_then(|_| self.position(at)))
            .and_then(|(formula, position)| expression(self.arena, formula, &position, radicands));
        value.unwrap_or_else(|| self.arena.zero())
    }

    /// Position of a joint without its constant.
    fn position(&self, at: JointIndex) -> Option<Position<'a>> {
        let JointIndex { leg, joint: index } = at;
        let (of, first) = (&self.mechanism.legs[leg], self.legs[leg].first_joint);
        let joint = &of.joints[index];
        let turn = joint_turn(of, index, first, &self.configuration)?.without_offset();
        if joint.kind == JointKind::Prismatic {
            let slide = joint_slide(self.arena, of, index, first, &self.configuration)?;
            let number = slide - self.arena.number(joint.r);
            return Some(Position { number, turn });
        }
        let mut number = self.arena.zero();
        for (other, factor) in &joint.variable {
            let at = first + of.independent().position(|i| i == *other)?;
            number = number + self.arena.input("joints", at) * Number::ratio(*factor);
        }
        Some(Position { number, turn })
    }
}

/// A formula at a position; `None` if an angle exceeds the range of numbers.
fn expression<'a>(
    arena: &'a Arena,
    formula: &Formula,
    position: &Position<'a>,
    radicands: &mut Vec<Expr<'a>>,
) -> Option<Expr<'a>> {
    let mut of = |part: &Formula| expression(arena, part, position, radicands);
    let unit = |offset: &Angle, factor: &Ratio| {
        let turn = position.turn.times(*factor)?;
        Some(arena.cosine_and_sine(&turn.plus(&Direction::constant(*offset))?))
    };
    Some(match formula {
        Formula::Linear { offset, factor } => {
            position.number * Number::ratio(*factor) + arena.number(*offset)
        }
        Formula::Cosine { offset, factor } => unit(offset, factor)?.cosine,
        Formula::Sine { offset, factor } => unit(offset, factor)?.sine,
        Formula::Sum(a, b) => of(a)? + of(b)?,
        Formula::Product(a, b) => of(a)? * of(b)?,
        Formula::Quotient(a, b) => of(a)? * of(b)?.reciprocal(),
        Formula::SquareRoot(a) => {
            let radicand = of(a)?;
            radicands.push(radicand);
            radicand.sqrt()
        }
    })
}
