//! Position-dependent torques of joints: per unit of a spring's unknown coefficient, known torques,
//! and loads of friction.
//!
//! From the joints their position is an input. From the pose, the closure gives the sine and cosine
//! of a passive angle, and sines and cosines of its multiples follow by the addition theorem. Only
//! a formula that contains the angle itself takes an arc tangent, within half a turn of home like
//! the function of the joints.

use super::formula::{Variable, expression};
use crate::cas::{Angle, Arena, CosineSine, Direction, Expr, Number, Ratio};
use crate::derivation::derivation_error::DerivationError;
use crate::derivation::guard::{Guard, GuardKind};
use crate::derivation::motion_input::MotionInput;
use crate::derivation::robot::Robot;
use crate::mechanism::{Formula, JointIndex};

/// The position of a joint, for formulas.
struct Position<'r, 'a> {
    robot: &'r Robot<'a>,
    at: JointIndex,
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
            // Of a tree, springs are no part of a leg in generated code.
            if !self.mechanism.is_tree() {
                self.arena.enter(&leg.name);
            }
            for joint in 0..leg.joints.len() {
                let at = JointIndex { leg: index, joint };
                for formula in self.formulas(at) {
                    let _ = self.torque_of_position(at, Some(formula), &mut radicands);
                }
            }
            guards.extend(radicands.into_iter().map(|value| Guard {
                value,
                // A force has a value if a length vanishes, unless the length is a divisor.
                kind: GuardKind::Reach(0.0),
                leg: leg.name.clone(),
            }));
        }
        if !self.mechanism.is_tree() {
            self.arena.enter("");
        }
        guards
    }

    /// Checks that the configuration determines the formulas of all joints.
    ///
    /// # Errors
    /// A passive joint whose formula has a fraction of its angle in a sine or cosine. The closure
    /// gives the sine and cosine of the angle only; the joints then come from Newton's method.
    pub(crate) fn check_formulas(&self) -> Result<(), DerivationError> {
        if self.configuration.from() == MotionInput::Joints {
            return Ok(());
        }
        for (index, leg) in self.mechanism.legs.iter().enumerate() {
            self.arena.enter(&leg.name);
            for joint in 0..leg.joints.len() {
                let at = JointIndex { leg: index, joint };
                let position = Position { robot: self, at };
                let mut formulas = self.formulas(at);
                let is_unknown = |formula: &Formula| {
                    expression(self.arena, &position, formula, &mut Vec::new()).is_none()
                };
                if formulas.any(is_unknown) {
                    let leg = leg.name.clone();
                    return Err(DerivationError::InverseKinematics { leg });
                }
            }
        }
        self.arena.enter("");
        Ok(())
    }

    /// The formulas of a joint: spring, known torque, load of friction.
    fn formulas(&self, at: JointIndex) -> impl Iterator<Item = &'a Formula> + use<'a> {
        let joint = self.mechanism.joint(at);
        let spring = joint.spring.as_ref().map(|spring| &spring.formula);
        let load = joint.load.as_ref().map(|load| &load.formula);
        [spring, joint.known.as_ref(), load].into_iter().flatten()
    }

    fn torque_of_position(
        &self,
        at: JointIndex,
        formula: Option<&Formula>,
        radicands: &mut Vec<Expr<'a>>,
    ) -> Expr<'a> {
        let position = Position { robot: self, at };
        let value =
            formula.and_then(|formula| expression(self.arena, &position, formula, radicands));
        value.unwrap_or_else(|| self.arena.zero())
    }
}

impl Position<'_, '_> {
    /// The joints of q_t that the position combines, with their factors.
    fn terms(&self) -> Option<Vec<(usize, Ratio)>> {
        let leg = &self.robot.mechanism.legs[self.at.leg];
        let first = self.robot.legs[self.at.leg].first_joint;
        let variable = leg.joints[self.at.joint].variable.iter();
        let term = |(of, factor): &(usize, Ratio)| {
            let at = leg.independent().position(|own| own == *of)?;
            Some((first + at, *factor))
        };
        variable.map(term).collect()
    }
}

impl<'a> Variable<'a> for Position<'_, 'a> {
    /// The position without its constant, rad or m.
    fn number(&self) -> Option<Expr<'a>> {
        let robot = self.robot;
        let mut number = robot.arena.zero();
        for (at, factor) in self.terms()? {
            // The joints of a skeleton and of branches are in the pose, whatever the input.
            let in_pose = robot.configuration.in_pose(at);
            let position = in_pose.or_else(|| robot.joint_position(at))?;
            number = number + position * Number::ratio(factor);
        }
        Some(number)
    }

    /// Cosine and sine of `offset` + `factor` q.
    fn unit(&self, offset: Angle, factor: Ratio) -> Option<CosineSine<'a>> {
        let (arena, configuration) = (self.robot.arena, &self.robot.configuration);
        let mut turn = Direction::constant(Angle::ZERO);
        for (at, share) in self.terms()? {
            turn = turn.plus(&configuration.joint_angle(at).times(share)?)?;
        }
        let offset = Direction::constant(offset);
        let whole = turn.times(factor)?.plus(&offset)?;
        if configuration.from() == MotionInput::Joints || configuration.is_input(&whole) {
            return Some(arena.cosine_and_sine(&whole));
        }
        let times = (factor.denominator() == 1).then(|| factor.numerator())?;
        let unit = multiple(arena, configuration.unit(&turn)?, times);
        Some(unit.plus(arena.cosine_and_sine(&offset)))
    }
}

/// Cosine and sine of a multiple of an angle, by doubling.
fn multiple<'a>(arena: &'a Arena, unit: CosineSine<'a>, times: i128) -> CosineSine<'a> {
    let mut power = if times < 0 { unit.negated() } else { unit };
    let mut left = times.unsigned_abs();
    let mut product = CosineSine {
        cosine: arena.one(),
        sine: arena.zero(),
    };
    while left > 0 {
        if left % 2 == 1 {
            product = product.plus(power);
        }
        power = power.plus(power);
        left /= 2;
    }
    product
}
