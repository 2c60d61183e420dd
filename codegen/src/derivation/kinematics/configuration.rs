//! Sines and cosines of joint angles, from joints or from the pose.
//!
//! If joints are measured they are the sine and cosine of an input. If the platform pose is given,
//! no passive angle is computed: the closure gives its sine and cosine algebraically, and all other
//! angles of the leg follow by the addition theorem.

use super::quaternion::half;
use crate::cas::{Arena, CosineSine, Direction, Expr, Number, Ratio, SymbolId};
use crate::derivation::motion_input::MotionInput;
use crate::mechanism::{Home, Mechanism};
use std::cell::RefCell;

/// Input array of all joints.
const JOINTS: &str = "joints";
/// Input array of the platform's coordinates, or of the joints of a skeleton.
const POSE: &str = "pose";

/// The configuration of a robot as expressions.
#[derive(Debug, Clone)]
pub struct Configuration<'a> {
    arena: &'a Arena,
    from: MotionInput,
    /// Unknown quantities that were requested; `None` if these have no symbols.
    unknowns: Option<RefCell<Vec<Unknown>>>,
    /// Angles whose sine and cosine the closure gives.
    known: Vec<(Direction, CosineSine<'a>)>,
    /// Positions of prismatic joints that the closure gives, by joint index in q_t.
    positions: Vec<(usize, Expr<'a>)>,
    /// Name of the leg and suffix of the joint, for every joint of q_t.
    names: Vec<(String, String)>,
    /// The joints of q_t in the pose, in its order: those of a skeleton and of branches.
    in_pose: Vec<usize>,
    /// For every square root taken: the first joint of its leg, and whether it is positive at home.
    roots: Vec<(usize, bool)>,
    /// Whether sines and cosines of input angles are computed from those of half the angles.
    by_halves: bool,
}

impl<'a> Configuration<'a> {
    /// The configuration of `mechanism`.
    #[must_use]
    pub fn new(arena: &'a Arena, mechanism: &Mechanism, from: MotionInput) -> Self {
        let joints = mechanism.joints();
        let names = joints.iter().map(|&index| {
            (
                mechanism.legs[index.leg].name.clone(),
                mechanism.joint(index).suffix(),
            )
        });
        Self {
            arena,
            from,
            unknowns: None,
            known: Vec::new(),
            positions: Vec::new(),
            names: names.collect(),
            in_pose: (mechanism.skeleton())
                .map_or_else(Vec::new, |_| mechanism.coordinate_joints()),
            roots: Vec::new(),
            by_halves: false,
        }
    }

    /// The next square root in the closed form of a leg, with its sign at home.
    ///
    /// If the leg's code is shared with legs of other working modes, the sign is an input.
    pub(crate) fn root(
        &mut self,
        first_joint: usize,
        home: &Home,
        radicand: Expr<'a>,
        is_positive: bool,
    ) -> Expr<'a> {
        let own = self.roots.iter().filter(|(leg, _)| *leg == first_joint);
        let sign = match first_joint {
            0 => home.signs.get(own.count()).copied().flatten(),
            _ => None,
        };
        self.roots.push((first_joint, is_positive));
        let root = match sign {
            Some(sign) => radicand.sqrt() * self.arena.input(sign.array, sign.index),
            None => radicand.sqrt(),
        };
        if is_positive { root } else { -root }
    }

    /// Whether each square root taken is positive at home.
    pub(crate) fn signs(&self) -> Vec<bool> {
        self.roots
            .iter()
            .map(|&(_, is_positive)| is_positive)
            .collect()
    }

    /// The arena of the expressions.
    pub(crate) const fn arena(&self) -> &'a Arena {
        self.arena
    }

    /// The input that determines the configuration.
    #[must_use]
    pub const fn from(&self) -> MotionInput {
        self.from
    }

    /// The same configuration with symbols for unknown quantities, see [`Unknown`].
    #[must_use]
    pub(crate) fn with_unknowns(&self) -> Self {
        Self {
            unknowns: Some(RefCell::default()),
            ..self.clone()
        }
    }

    /// Unknown quantities that were requested.
    #[must_use]
    pub fn unknowns(&self) -> Vec<Unknown> {
        let list = self.unknowns.as_ref();
        list.map_or_else(Vec::new, |list| list.borrow().clone())
    }

    /// Records an unknown, if unknowns are allowed.
    fn ask(&self, unknown: Unknown) -> Option<Unknown> {
        let mut list = self.unknowns.as_ref()?.borrow_mut();
        if !list.contains(&unknown) {
            list.push(unknown.clone());
        }
        Some(unknown)
    }

    /// Input array and index of a joint's position.
    fn place(&self, index: usize) -> (&'static str, usize) {
        match self.in_pose.iter().position(|&own| own == index) {
            Some(at) => (POSE, at),
            None => (JOINTS, index),
        }
    }

    /// The angle of a revolute joint.
    #[must_use]
    pub(crate) fn joint_angle(&self, index: usize) -> Direction {
        let (array, at) = self.place(index);
        self.arena.input_angle(array, at)
    }

    /// Position of a joint that is in the pose; `None` for a platform's pose, which has no joints.
    #[must_use]
    pub(crate) fn in_pose(&self, index: usize) -> Option<Expr<'a>> {
        match self.place(index) {
            (POSE, at) => Some(self.arena.input(POSE, at)),
            _ => None,
        }
    }

    /// Position of a prismatic joint, m; `None` if the pose does not determine it.
    #[must_use]
    pub(crate) fn joint_position(&self, index: usize) -> Option<Expr<'a>> {
        if let Some(position) = self.in_pose(index) {
            return Some(position);
        }
        match self.from {
            MotionInput::Joints => Some(self.arena.input(JOINTS, index)),
            MotionInput::Pose | MotionInput::Actuators => {
                let known = self.positions.iter().find(|(at, _)| *at == index);
                let asked = || Some(self.ask(Unknown::Slide(index))?.slide(self.arena));
                known.map(|p| p.1).or_else(asked)
            }
        }
    }

    /// Sets the sine and cosine of an angle.
    pub(crate) fn learn(&mut self, angle: Direction, unit: CosineSine<'a>) {
        self.name(&angle, unit);
        self.known.push((angle, unit));
    }

    /// Sets the position of a prismatic joint.
    pub(crate) fn learn_position(&mut self, index: usize, position: Expr<'a>) {
        if let Some((leg, joint)) = self.names.get(index) {
            let _ = position.named(&format!("q{joint}_{leg}"));
        }
        self.positions.push((index, position));
    }

    /// Cosine and sine of an angle; `None` if they do not follow from known quantities.
    #[must_use]
    pub fn unit(&self, angle: &Direction) -> Option<CosineSine<'a>> {
        let unit = match self.from {
            MotionInput::Joints => self.unit_of_input(angle),
            _ if self.is_input(angle) => self.unit_of_input(angle),
            MotionInput::Pose | MotionInput::Actuators => match self.composed(angle) {
                Some(unit) => unit,
                None => return self.unknown_unit(angle),
            },
        };
        self.name(angle, unit);
        Some(unit)
    }

    /// The same configuration, in which cos θ = 1 - 2 sin² θ/2 and sin θ = 2 sin θ/2 cos θ/2 for
    /// angles θ of inputs.
    ///
    /// A function that needs half angles then has one trigonometric pair for each.
    pub(crate) fn with_half_angles(&self) -> Self {
        Self {
            by_halves: true,
            ..self.clone()
        }
    }

    /// Cosine and sine of an angle of inputs; `None` if it contains a joint that is no input.
    pub(crate) fn input_unit(&self, angle: &Direction) -> Option<CosineSine<'a>> {
        let is_known = self.from == MotionInput::Joints || self.is_input(angle);
        is_known.then(|| self.arena.cosine_and_sine(angle))
    }

    fn unit_of_input(&self, angle: &Direction) -> CosineSine<'a> {
        let half = angle.times(half());
        match half.filter(|_| self.by_halves && !angle.is_constant()) {
            Some(half) => self.arena.cosine_and_sine(&half).doubled(),
            None => self.arena.cosine_and_sine(angle),
        }
    }

    /// Cosine and sine of an angle with an unknown variable part.
    fn unknown_unit(&self, angle: &Direction) -> Option<CosineSine<'a>> {
        let is_negative = angle.terms()[0].1.value() < 0.0;
        let turn = if is_negative {
            angle.negative()
        } else {
            angle.clone()
        };
        let offset = self
            .arena
            .cosine_and_sine(&Direction::constant(turn.offset()));
        let unknown = self.ask(Unknown::Turn(turn.without_offset()))?;
        let unit = unknown.unit(self.arena).plus(offset);
        Some(if is_negative { unit.negated() } else { unit })
    }

    /// Symbol of a joint's position.
    pub(crate) fn joint_symbol(&self, index: usize) -> SymbolId {
        let (array, at) = self.place(index);
        self.arena.input_symbol(array, at)
    }

    /// Quantities that the closure gives, with their derivatives with respect to symbols of
    /// positions.
    pub(crate) fn solved(&self) -> Vec<Solved<'a>> {
        let of_unit = |(angle, unit): &(Direction, CosineSine<'a>)| {
            let CosineSine { cosine, sine } = *unit;
            let by = |derivative: Expr<'a>| {
                let terms = angle.terms().iter();
                let by = |(symbol, factor): &(SymbolId, Ratio)| {
                    (*symbol, derivative * Number::ratio(*factor))
                };
                terms.map(by).collect()
            };
            [(cosine, by(-sine)), (sine, by(cosine))].map(|(value, by)| Solved { value, by })
        };
        let of_position = |(index, value): &(usize, Expr<'a>)| Solved {
            value: *value,
            by: vec![(self.joint_symbol(*index), self.arena.one())],
        };
        let units = self.known.iter().flat_map(of_unit);
        units
            .chain(self.positions.iter().map(of_position))
            .collect()
    }

    /// The joint of q_t whose position a symbol is.
    pub(crate) fn joint(&self, symbol: SymbolId) -> Option<usize> {
        let element = self.arena.input_element(symbol)?;
        (element.array == JOINTS).then_some(element.index)
    }

    /// The joint of a skeleton or branch whose position a symbol is.
    fn pose_joint(&self, symbol: SymbolId) -> Option<usize> {
        let element = self.arena.input_element(symbol)?;
        let own = self.in_pose.get(element.index).copied();
        own.filter(|_| element.array == POSE)
    }

    /// Whether the angle contains no joint but those in the pose.
    pub(crate) fn is_input(&self, angle: &Direction) -> bool {
        angle
            .terms()
            .iter()
            .all(|(symbol, _)| self.joint(*symbol).is_none())
    }

    /// The angle as a known one plus or minus another, plus one without joints.
    fn composed(&self, angle: &Direction) -> Option<CosineSine<'a>> {
        let rest = |known: &Direction, sign: i64| {
            let part = known.times(Ratio::integer(sign))?;
            angle.plus(&part.negative())
        };
        let turned = |unit: CosineSine<'a>, sign: i64| if sign < 0 { unit.negated() } else { unit };
        for (known, unit) in &self.known {
            for sign in [1, -1] {
                let Some(rest) = rest(known, sign) else {
                    continue;
                };
                if self.is_input(&rest) {
                    let input = self.arena.cosine_and_sine(&rest);
                    return Some(turned(*unit, sign).plus(input));
                }
            }
        }
        for (i, (first, unit)) in self.known.iter().enumerate() {
            for sign in [1, -1] {
                let Some(rest) = rest(first, sign) else {
                    continue;
                };
                for (second, other) in &self.known[..i] {
                    for other_sign in [1, -1] {
                        let part = second.times(Ratio::integer(other_sign))?;
                        let Some(last) = rest.plus(&part.negative()) else {
                            continue;
                        };
                        if self.is_input(&last) {
                            let sum = turned(*unit, sign).plus(turned(*other, other_sign));
                            return Some(sum.plus(self.arena.cosine_and_sine(&last)));
                        }
                    }
                }
            }
        }
        None
    }

    /// Names sine and cosine after the joints of the angle: `c12_leg1`.
    fn name(&self, angle: &Direction, unit: CosineSine<'a>) {
        let mut leg: Option<&str> = None;
        let mut label = String::new();
        for (symbol, factor) in angle.terms() {
            if *factor != Ratio::ONE {
                return;
            }
            let own = self.joint(*symbol).or_else(|| self.pose_joint(*symbol));
            match own.and_then(|i| self.names.get(i)) {
                Some((of, joint)) => {
                    leg = Some(of);
                    label += joint;
                }
                None => label += "_phi",
            }
        }
        if label.is_empty() {
            return;
        }
        let suffix = leg.map_or(String::new(), |l| format!("_{l}"));
        // Names refer to the joints' own angles: offsets by right angles are removed, others are
        // marked.
        let (co, so) = angle.offset().cosine_and_sine();
        let is_right = co.is_zero() || so.is_zero();
        let CosineSine {
            mut cosine,
            mut sine,
        } = unit;
        if is_right {
            (cosine, sine) = (cosine * co + sine * so, sine * co - cosine * so);
        } else {
            label += "o";
        }
        let _ = cosine.named(&format!("c{label}{suffix}"));
        let _ = sine.named(&format!("s{label}{suffix}"));
    }
}

/// A sine, cosine or position that the closure gives.
#[derive(Debug)]
pub(crate) struct Solved<'a> {
    pub(crate) value: Expr<'a>,
    /// Derivatives with respect to symbols of positions.
    pub(crate) by: Vec<(SymbolId, Expr<'a>)>,
}

/// An unknown quantity of a leg, with its own symbol in an equation.
///
/// A direction has two symbols: the equation's terms treat its cosine and sine as independent.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Unknown {
    /// A sum of joint angles without constant; its first factor is positive.
    Turn(Direction),
    /// The position of the prismatic joint of this index in q_t.
    Slide(usize),
}

impl Unknown {
    /// Symbols of the cosine and sine of an unknown turn.
    #[must_use]
    pub fn unit<'a>(&self, arena: &'a Arena) -> CosineSine<'a> {
        let symbol = |of: &str| arena.placeholder(&format!("{of} of unknown {self:?}"));
        CosineSine {
            cosine: symbol("cosine"),
            sine: symbol("sine"),
        }
    }

    /// Symbol of an unknown slide.
    #[must_use]
    pub fn slide<'a>(&self, arena: &'a Arena) -> Expr<'a> {
        arena.placeholder(&format!("unknown {self:?}"))
    }
}
