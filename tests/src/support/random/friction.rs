//! Random friction of other kinds than the symmetric one.
//!
//! It is drawn last from a separate random stream, so that it does not change the rest of a seed's
//! mechanism.

use super::{Dice, Shape, Sketch};
use crate::reference::parameters::SYMBOLS;
use crate::reference::{JointKind, Motion, Spring};

/// Offset of the seed for the random stream of friction.
const SEED_OFFSET: u64 = 0x0f12_1c71;

/// Groups and symbols of friction that is equal in both directions.
const SYMMETRIC: [&str; 5] = ["all", "friction", "fv", "fs", "off"];

/// The load a + b cos(q) of a revolute joint, or a + b q of a prismatic one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Load {
    /// Constant part.
    pub constant: f64,
    /// Factor of the position-dependent part.
    pub factor: f64,
}

impl Load {
    /// Load for the reference.
    fn spring(self, kind: JointKind) -> Spring {
        let Self { constant, factor } = self;
        Spring::new(move |q: f64| match kind {
            JointKind::Revolute => constant + factor * q.cos(),
            _ => constant + factor * q,
        })
    }

    /// Load as an expression of the description.
    pub(super) fn text(self, kind: JointKind) -> String {
        let Self { constant, factor } = self;
        match kind {
            JointKind::Revolute => format!("{constant:?} N m + {factor:?} N m * cos(q)"),
            _ => format!("{constant:?} N + {factor:?} N/m * q"),
        }
    }
}

impl Sketch {
    /// Draws Stribeck friction, direction-dependent and quadratic friction and, without a platform,
    /// load-dependent friction.
    pub(super) fn draw_friction(&mut self) {
        let mut dice = Dice::new(self.seed ^ SEED_OFFSET);
        let is_tree = self.motion == Motion::None;
        for shape in &mut self.shapes {
            shape.draw_friction(&mut dice, is_tree);
        }
    }
}

impl Shape {
    fn draw_friction(&mut self, dice: &mut Dice, is_tree: bool) {
        let directed: Vec<&'static str> = SYMBOLS[15..19].to_vec();
        for member in &mut self.members {
            let kind = member.joint.kind;
            if kind == JointKind::Fixed {
                continue;
            }
            if dice.chance(0.15) {
                member.joint.stribeck = Some(dice.distance(0.05, 2.0));
            }
            if dice.chance(0.15) {
                let own = if member.parameters.iter().any(|one| SYMMETRIC.contains(one)) {
                    // Both directions together would be symmetric friction again.
                    [[0, 2], [1, 3]]
                        .map(|pair| directed[dice.pick(&pair)])
                        .to_vec()
                } else {
                    directed.clone()
                };
                member.parameters.extend(dice.some(&own));
            }
            if dice.chance(0.15) {
                member.parameters.push("fq");
            }
            if is_tree && dice.chance(0.25) {
                let load = Load {
                    constant: dice.length(2.0),
                    factor: dice.distance(0.5, 3.0),
                };
                member.load = Some(load);
                member.joint.load = Some(load.spring(kind));
            }
        }
    }
}
