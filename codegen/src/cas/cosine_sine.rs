//! Cosine and sine of one angle.

use super::{Arena, Expr, Number};

/// Cosine and sine of an angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CosineSine<'a> {
    /// The cosine.
    pub cosine: Expr<'a>,
    /// The sine.
    pub sine: Expr<'a>,
}

impl<'a> CosineSine<'a> {
    /// Those of the sum of two angles, by the addition theorem.
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        let ((ca, sa), (cb, sb)) = ((self.cosine, self.sine), (other.cosine, other.sine));
        Self {
            cosine: ca * cb - sa * sb,
            sine: sa * cb + ca * sb,
        }
    }

    /// Those of the negative angle.
    #[must_use]
    pub fn negated(self) -> Self {
        Self {
            cosine: self.cosine,
            sine: -self.sine,
        }
    }

    /// The angle within half a turn of its value at home.
    #[must_use]
    pub fn angle_near(self, arena: &'a Arena, home: f64) -> Expr<'a> {
        let Self { cosine, sine } = self;
        let [ch, sh] = [home.cos(), home.sin()].map(Number::float);
        let turned = (sine * ch - cosine * sh).atan2(cosine * ch + sine * sh);
        turned + arena.number(Number::float(home))
    }
}
