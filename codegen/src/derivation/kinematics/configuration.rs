//! Where sines and cosines of joint angles come from.
//!
//! From measured joints they are the sine and cosine of an input. From a platform pose no passive
//! angle is ever computed: the closure gives its sine and cosine algebraically, and every other angle
//! of the leg follows by the addition theorem.

use crate::cas::{Arena, CosineSine, Direction, Expr, Ratio, SymbolId};
use crate::derivation::motion_input::MotionInput;
use crate::mechanism::{Home, Mechanism};
use std::cell::RefCell;

/// The input array of all joints.
const JOINTS: &str = "joints";
/// The input array of the platform's coordinates, or of the joints of a skeleton.
const POSE: &str = "pose";

/// The configuration of a robot as expressions.
#[derive(Debug, Clone)]
pub struct Configuration<'a> {
    arena: &'a Arena,
    from: MotionInput,
    /// What was asked for without being known, if that has symbols instead of no value.
    unknowns: Option<RefCell<Vec<Unknown>>>,
    /// Angles whose sine and cosine are known from the closure.
    known: Vec<(Direction, CosineSine<'a>)>,
    /// Positions of prismatic joints known from the closure, by joint index in q_t.
    positions: Vec<(usize, Expr<'a>)>,
    /// For every joint of q_t: its leg's name and its own name.
    names: Vec<(String, String)>,
    /// The joints of q_t that are the pose, in its order: those of a skeleton and of branches.
    in_pose: Vec<usize>,
    /// For every root that was taken: the first joint of its leg, and whether it is positive at home.
    roots: Vec<(usize, bool)>,
}

impl<'a> Configuration<'a> {
    /// The configuration of `mechanism`.
    #[must_use]
    pub fn new(arena: &'a Arena, mechanism: &Mechanism, from: MotionInput) -> Self {
        let joints = mechanism.joints();
        let names = joints.iter().map(|&index| {
            (
                mechanism.legs[index.leg].name.clone(),
                mechanism.joint(index).name.clone(),
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
        }
    }

    /// The next root in the closed form of a leg, with the sign that it has at home. What is negative in the leg's
    /// working mode may be positive in that of another leg that it stands for.
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

    /// For every root that was taken, whether it is positive at home.
    pub(crate) fn signs(&self) -> Vec<bool> {
        self.roots
            .iter()
            .map(|&(_, is_positive)| is_positive)
            .collect()
    }

    /// The arena of its expressions.
    pub(crate) const fn arena(&self) -> &'a Arena {
        self.arena
    }

    /// What the configuration is given by.
    #[must_use]
    pub const fn from(&self) -> MotionInput {
        self.from
    }

    /// The same configuration with symbols for what is not known, see [`Unknown`].
    #[must_use]
    pub(crate) fn with_unknowns(&self) -> Self {
        Self {
            unknowns: Some(RefCell::default()),
            ..self.clone()
        }
    }

    /// What was asked for without being known.
    #[must_use]
    pub fn unknowns(&self) -> Vec<Unknown> {
        let list = self.unknowns.as_ref();
        list.map_or_else(Vec::new, |list| list.borrow().clone())
    }

    /// Notes an unknown, where there may be any.
    fn ask(&self, unknown: Unknown) -> Option<Unknown> {
        let mut list = self.unknowns.as_ref()?.borrow_mut();
        if !list.contains(&unknown) {
            list.push(unknown.clone());
        }
        Some(unknown)
    }

    /// The input array that a joint's position is in, and where in it.
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

    /// The position of a joint that is one of the pose's numbers; none of a platform's pose is.
    #[must_use]
    pub(crate) fn in_pose(&self, index: usize) -> Option<Expr<'a>> {
        match self.place(index) {
            (POSE, at) => Some(self.arena.input(POSE, at)),
            _ => None,
        }
    }

    /// The position of a prismatic joint, m; `None` if it is not known from the pose.
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

    /// Declares the sine and cosine of an angle.
    pub(crate) fn learn(&mut self, angle: Direction, unit: CosineSine<'a>) {
        self.name(&angle, unit);
        self.known.push((angle, unit));
    }

    /// Declares the position of a prismatic joint.
    pub(crate) fn learn_position(&mut self, index: usize, position: Expr<'a>) {
        if let Some((leg, joint)) = self.names.get(index) {
            let _ = position.named(&format!("q{joint}_{leg}"));
        }
        self.positions.push((index, position));
    }

    /// Cosine and sine of an angle; `None` if they do not follow from what is known.
    #[must_use]
    pub fn unit(&self, angle: &Direction) -> Option<CosineSine<'a>> {
        let unit = match self.from {
            MotionInput::Joints => self.arena.cosine_and_sine(angle),
            _ if self.is_input(angle) => self.arena.cosine_and_sine(angle),
            MotionInput::Pose | MotionInput::Actuators => match self.composed(angle) {
                Some(unit) => unit,
                None => return self.unknown_unit(angle),
            },
        };
        self.name(angle, unit);
        Some(unit)
    }

    /// Cosine and sine of an angle whose variable part is not known.
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

    /// The joint of q_t that a symbol is the position of.
    pub(crate) fn joint(&self, symbol: SymbolId) -> Option<usize> {
        let element = self.arena.input_element(symbol)?;
        (element.array == JOINTS).then_some(element.index)
    }

    /// The joint of a skeleton, or of a branch, that a symbol is the position of.
    fn pose_joint(&self, symbol: SymbolId) -> Option<usize> {
        let element = self.arena.input_element(symbol)?;
        let own = self.in_pose.get(element.index).copied();
        own.filter(|_| element.array == POSE)
    }

    /// Whether the angle holds no joint.
    fn is_input(&self, angle: &Direction) -> bool {
        angle
            .terms()
            .iter()
            .all(|(symbol, _)| self.joint(*symbol).is_none())
    }

    /// The angle as a known one plus or minus another, plus one that holds no joint.
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
                None => label += "phi",
            }
        }
        if label.is_empty() {
            return;
        }
        let suffix = leg.map_or(String::new(), |l| format!("_{l}"));
        let separator = if label.starts_with(|c: char| c.is_ascii_digit()) {
            ""
        } else {
            "_"
        };
        // Names are those of the joints' own angles: offsets of right angles are removed, others are marked.
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
        let _ = cosine.named(&format!("c{separator}{label}{suffix}"));
        let _ = sine.named(&format!("s{separator}{label}{suffix}"));
    }
}

/// A quantity of a leg that is not known yet. It has a symbol of its own in an equation, or two: the
/// cosine and the sine of a direction are as independent as the equation's terms need.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Unknown {
    /// A sum of joint angles without a constant, its first factor positive.
    Turn(Direction),
    /// The position of the prismatic joint of this index in q_t.
    Slide(usize),
}

impl Unknown {
    /// The symbols of an unknown turn's cosine and sine.
    #[must_use]
    pub fn unit<'a>(&self, arena: &'a Arena) -> CosineSine<'a> {
        let symbol = |of: &str| arena.placeholder(&format!("{of} of unknown {self:?}"));
        CosineSine {
            cosine: symbol("cosine"),
            sine: symbol("sine"),
        }
    }

    /// The symbol of an unknown slide.
    #[must_use]
    pub fn slide<'a>(&self, arena: &'a Arena) -> Expr<'a> {
        arena.placeholder(&format!("unknown {self:?}"))
    }
}
