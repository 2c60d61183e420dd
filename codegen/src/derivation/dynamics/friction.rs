//! Friction of a joint per unit of each of its coefficients.
//!
//! Friction that differs by direction has the columns (q̇ ± |q̇|)/2 and (sign q̇ ± 1)/2. Their sums
//! and differences are the columns of symmetric friction, of |q̇| and of the offset. This holds at
//! every velocity and at rest, where the sign is 0. The excess of static friction over Coulomb
//! friction decreases with the velocity as 1/(1 + (q̇/v)²), where v is the Stribeck velocity. This
//! form needs no exponential (Hess and Soom, *Friction at a lubricated line contact operating at
//! oscillating sliding velocities*, 1990). Load-dependent friction, with the load a known function
//! of the position, has the column |load| sign q̇.

use crate::cas::{Arena, Expr, Number, Ratio};
use crate::derivation::robot::Robot;
use crate::mechanism::JointIndex;
use overact_description::StandardParameter;

impl<'a> Robot<'a> {
    /// Friction at a rate per unit of a joint's parameter; `None` if it is no friction parameter.
    pub(crate) fn friction_force(
        &self,
        at: JointIndex,
        symbol: StandardParameter,
        rate: impl Fn() -> Expr<'a>,
    ) -> Option<Expr<'a>> {
        let velocity = self.mechanism.joint(at).stribeck;
        friction(self.arena, symbol, &rate, velocity, &|| self.load(at))
    }
}

/// Friction at a rate per unit of a parameter; `None` if it is no friction parameter.
pub(crate) fn friction<'a>(
    arena: &'a Arena,
    symbol: StandardParameter,
    rate: &dyn Fn() -> Expr<'a>,
    velocity: Option<Number>,
    load: &dyn Fn() -> Expr<'a>,
) -> Option<Expr<'a>> {
    use StandardParameter as P;
    let one = || arena.one();
    Some(match symbol {
        P::Fv => rate(),
        P::Fq => rate() * magnitude(rate()),
        P::Fs => rate().sign(),
        P::FvPos => (rate() + magnitude(rate())) * half(),
        P::FvNeg => (rate() - magnitude(rate())) * half(),
        P::FsPos => (rate().sign() + one()) * half(),
        P::FsNeg => (rate().sign() - one()) * half(),
        P::Fst => velocity.map_or_else(
            || arena.zero(),
            |velocity| stribeck(arena, rate(), velocity),
        ),
        P::Fl => rate().sign() * magnitude(load()),
        _ => return None,
    })
}

/// sign(q̇) / (1 + (q̇/v)²).
fn stribeck<'a>(arena: &'a Arena, rate: Expr<'a>, velocity: Number) -> Expr<'a> {
    let relative = rate * (Number::ONE / velocity);
    let divisor = relative.squared() + arena.one();
    arena.assert_never_zero(divisor);
    rate.sign() / divisor
}

/// |x|.
fn magnitude(x: Expr<'_>) -> Expr<'_> {
    x * x.sign()
}

fn half() -> Number {
    Number::ratio(Ratio::new(1, 2).unwrap_or(Ratio::ONE))
}
