//! Cosine and sine of one angle.

use super::arena::{Arena, Op};
use super::{Angle, Direction, Expr, Number, Ratio};

/// Cosine and sine of an angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CosineSine<'a> {
    /// The cosine.
    pub cosine: Expr<'a>,
    /// The sine.
    pub sine: Expr<'a>,
}

impl<'a> CosineSine<'a> {
    /// Cosine and sine of the sum of two angles, by the addition theorem.
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        let ((ca, sa), (cb, sb)) = ((self.cosine, self.sine), (other.cosine, other.sine));
        Self {
            cosine: ca * cb - sa * sb,
            sine: sa * cb + ca * sb,
        }
    }

    /// Cosine and sine of twice the angle: 1 - 2 s² and 2 s c.
    #[must_use]
    pub fn doubled(self) -> Self {
        let twice = self.sine + self.sine;
        Self {
            cosine: self.sine.arena().one() - twice * self.sine,
            sine: twice * self.cosine,
        }
    }

    /// Cosine and sine of the negative angle.
    #[must_use]
    pub fn negated(self) -> Self {
        Self {
            cosine: self.cosine,
            sine: -self.sine,
        }
    }

    /// The angle, within half a turn of its value at home.
    #[must_use]
    pub fn angle_near(self, arena: &'a Arena, home: f64) -> Expr<'a> {
        let Self { cosine, sine } = self;
        let [ch, sh] = [home.cos(), home.sin()].map(Number::float);
        let turned = (sine * ch - cosine * sh).atan2(cosine * ch + sine * sh);
        turned + arena.number(Number::float(home))
    }
}

impl Arena {
    /// Cosine and sine of an angle, reduced by its sign and by multiples of a right angle.
    ///
    /// For instance, cos(x + 90 deg) becomes -sin(x).
    pub fn cosine_and_sine(&self, direction: &Direction) -> CosineSine<'_> {
        if direction.is_constant() {
            let (cosine, sine) = direction.offset().cosine_and_sine();
            return CosineSine {
                cosine: self.number(cosine),
                sine: self.number(sine),
            };
        }
        if direction.terms()[0].1.value() < 0.0 {
            return self.cosine_and_sine(&direction.negative()).negated();
        }
        let (quarters, rest) = split_quarters(direction.offset());
        let reduced = direction.without_offset().plus(&Direction::constant(rest));
        let reduced = reduced.unwrap_or_else(|| direction.clone());
        let id = self.direction(&reduced);
        let cosine = self.expr(self.intern(Op::Cosine(id)));
        let sine = self.expr(self.intern(Op::Sine(id)));
        let (cosine, sine) = match quarters {
            0 => (cosine, sine),
            1 => (-sine, cosine),
            2 => (-cosine, -sine),
            _ => (sine, -cosine),
        };
        CosineSine { cosine, sine }
    }

    /// The direction of an angle symbol.
    pub fn angle(&self, name: &str) -> Direction {
        Direction::symbol(self.symbol(name))
    }
}

/// Splits an angle into right angles (0 to 3) and a remainder that is no multiple of one.
fn split_quarters(angle: Angle) -> (u8, Angle) {
    let (half_turns, radians) = angle.parts();
    let doubled = half_turns.times(Ratio::integer(2));
    match doubled {
        Some(d) if d.denominator() == 1 => {
            (d.numerator().rem_euclid(4) as u8, Angle::radians(radians))
        }
        _ => (0, angle),
    }
}
