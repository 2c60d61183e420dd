//! Where sines and cosines of joint angles come from.
//!
//! From measured joints they are the sine and cosine of an input. From a platform pose no passive
//! angle is ever computed: the closure gives its sine and cosine algebraically, and every other angle
//! of the leg follows by the addition theorem.

use crate::cas::{Arena, Direction, Expr, Ratio};
use crate::mechanism::Mechanism;

/// What a model is evaluated from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum From {
    /// The platform's pose; joints follow from the closure.
    Pose,
    /// The joint positions (and the pose, for the platform's orientation).
    Joints,
    /// The pose that forward kinematics finds, with the actuators' velocities and accelerations.
    Actuators,
}

/// Cosine and sine of an angle.
pub type Unit<'a> = (Expr<'a>, Expr<'a>);

/// The configuration of a robot as expressions.
#[derive(Debug)]
pub struct Configuration<'a> {
    arena: &'a Arena,
    from: From,
    /// Angles whose sine and cosine are known from the closure.
    known: Vec<(Direction, Unit<'a>)>,
    /// Positions of prismatic joints known from the closure, by joint index in q_t.
    positions: Vec<(usize, Expr<'a>)>,
    /// For every joint of q_t: its leg's name and its own name.
    names: Vec<(String, String)>,
}

impl<'a> Configuration<'a> {
    /// The configuration of `mechanism`.
    #[must_use]
    pub fn new(arena: &'a Arena, mechanism: &Mechanism, from: From) -> Self {
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
            known: Vec::new(),
            positions: Vec::new(),
            names: names.collect(),
        }
    }

    /// What the configuration is given by.
    #[must_use]
    pub const fn from(&self) -> From {
        self.from
    }

    /// The input that holds joint `index` of q_t.
    #[must_use]
    pub fn joint_symbol(index: usize) -> String {
        format!("joints[{index}]")
    }

    /// The angle of a revolute joint.
    #[must_use]
    pub fn joint_angle(&self, index: usize) -> Direction {
        self.arena.angle(&Self::joint_symbol(index))
    }

    /// The position of a prismatic joint, m; `None` if it is not known from the pose.
    #[must_use]
    pub fn joint_position(&self, index: usize) -> Option<Expr<'a>> {
        match self.from {
            From::Joints => Some(self.arena.variable(&Self::joint_symbol(index))),
            From::Pose | From::Actuators => self
                .positions
                .iter()
                .find(|(at, _)| *at == index)
                .map(|p| p.1),
        }
    }

    /// Declares the sine and cosine of an angle.
    pub fn learn(&mut self, angle: Direction, unit: Unit<'a>) {
        self.name(&angle, unit);
        self.known.push((angle, unit));
    }

    /// Declares the position of a prismatic joint.
    pub fn learn_position(&mut self, index: usize, position: Expr<'a>) {
        self.positions.push((index, position));
    }

    /// Cosine and sine of an angle; `None` if they do not follow from what is known.
    #[must_use]
    pub fn unit(&self, angle: &Direction) -> Option<Unit<'a>> {
        let unit = match self.from {
            From::Joints => self.arena.cosine_and_sine(angle),
            _ if self.is_input(angle) => self.arena.cosine_and_sine(angle),
            From::Pose | From::Actuators => self.composed(angle)?,
        };
        self.name(angle, unit);
        Some(unit)
    }

    /// Whether the angle holds no joint.
    fn is_input(&self, angle: &Direction) -> bool {
        angle
            .terms()
            .iter()
            .all(|(symbol, _)| !self.arena.symbol_name(*symbol).starts_with("joints["))
    }

    /// The angle as a known one plus or minus another, plus a constant.
    fn composed(&self, angle: &Direction) -> Option<Unit<'a>> {
        let rest = |known: &Direction, sign: i64| {
            let part = known.times(Ratio::integer(sign))?;
            angle.plus(&part.negative())
        };
        let turned = |unit: Unit<'a>, sign: i64| if sign < 0 { (unit.0, -unit.1) } else { unit };
        for (known, unit) in &self.known {
            for sign in [1, -1] {
                let Some(rest) = rest(known, sign) else {
                    continue;
                };
                if rest.is_constant() {
                    let constant = self.arena.cosine_and_sine(&rest);
                    return Some(add_angles(turned(*unit, sign), constant));
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
                        if last.is_constant() {
                            let sum = add_angles(turned(*unit, sign), turned(*other, other_sign));
                            return Some(add_angles(sum, self.arena.cosine_and_sine(&last)));
                        }
                    }
                }
            }
        }
        None
    }

    /// Names sine and cosine after the joints of the angle: `c12_leg1`.
    fn name(&self, angle: &Direction, unit: Unit<'a>) {
        let mut leg: Option<&str> = None;
        let mut label = String::new();
        for (symbol, factor) in angle.terms() {
            let name = self.arena.symbol_name(*symbol);
            if *factor != Ratio::ONE {
                return;
            }
            let index = name
                .strip_prefix("joints[")
                .and_then(|n| n.strip_suffix(']'));
            match index
                .and_then(|i| i.parse::<usize>().ok())
                .and_then(|i| self.names.get(i))
            {
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
        let (cosine, sine) = unit;
        let _ = cosine.named(&format!("c{separator}{label}{suffix}"));
        let _ = sine.named(&format!("s{separator}{label}{suffix}"));
    }
}

/// Cosine and sine of a sum of two angles.
#[must_use]
pub fn add_angles<'a>((ca, sa): Unit<'a>, (cb, sb): Unit<'a>) -> Unit<'a> {
    (ca * cb - sa * sb, sa * cb + ca * sb)
}
