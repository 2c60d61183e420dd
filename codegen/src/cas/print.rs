//! Expressions as text, for debugging, tests and snapshots.

use super::arena::expr::Expr;
use super::arena::{Arena, Handle, Op};
use super::direction::Direction;
use std::fmt;

impl fmt::Display for Expr<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&text(self.arena(), self.handle(), 0))
    }
}

/// The text of a node; `binding` is 0 in a sum, 1 in a product, 2 as a divisor or operand.
fn text(arena: &Arena, handle: Handle, binding: u8) -> String {
    let t = |handle: Handle, binding: u8| text(arena, handle, binding);
    let (own, body) = match arena.op(handle.index()) {
        Op::Constant(id) => (2, arena.constant_at(id).to_string()),
        Op::Symbol(id) => (2, arena.symbol_name(id)),
        Op::Cosine(id) => (2, format!("cos({})", angle(arena, &arena.direction_at(id)))),
        Op::Sine(id) => (2, format!("sin({})", angle(arena, &arena.direction_at(id)))),
        Op::Add(a, b) => (0, format!("{} + {}", t(a, 0), t(b, 0))),
        Op::Sub(a, b) => (0, format!("{} - {}", t(a, 0), t(b, 1))),
        Op::Mul(a, b) => (1, format!("{} {}", t(a, 1), t(b, 1))),
        Op::Div(a, b) => (1, format!("{}/{}", t(a, 1), t(b, 2))),
        Op::Sqrt(a) => (2, format!("sqrt({})", t(a, 0))),
        Op::Sign(a) => (2, format!("sign({})", t(a, 0))),
        Op::Atan2(y, x) => (2, format!("atan2({}, {})", t(y, 0), t(x, 0))),
    };
    let own = if handle.is_negative() {
        own.min(1)
    } else {
        own
    };
    let body = match (handle.is_negative(), arena.op(handle.index())) {
        (true, Op::Add(..) | Op::Sub(..)) => format!("-({body})"),
        (true, _) => format!("-{body}"),
        (false, _) => body,
    };
    if own < binding {
        format!("({body})")
    } else {
        body
    }
}

fn angle(arena: &Arena, direction: &Direction) -> String {
    let mut out = String::new();
    for &(symbol, factor) in direction.terms() {
        let name = arena.symbol_name(symbol);
        let negative = factor.value() < 0.0;
        let size = if negative { factor.negative() } else { factor };
        out += match (out.is_empty(), negative) {
            (true, true) => "-",
            (true, false) => "",
            (false, true) => " - ",
            (false, false) => " + ",
        };
        if size != super::Ratio::ONE {
            out += &format!("{size} ");
        }
        out += &name;
    }
    if !direction.offset().is_zero() {
        out += &format!(" + {}", direction.offset());
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn identities_are_simplified_at_construction() {
        let arena = Arena::new();
        let (a, b) = (arena.angle("a"), arena.angle("b"));
        let sum = a.plus(&b).unwrap();
        let [(ca, sa), (cb, sb), (cs, ss)] = [a, b, sum].map(|angle| {
            let both = arena.cosine_and_sine(&angle);
            (both.cosine, both.sine)
        });
        assert!((ca.squared() + sa.squared()).is_one());
        assert!((ca * cb - sa * sb - cs).is_zero());
        assert_eq!(sa * cb + ca * sb, ss);
        let x = arena.variable("x");
        assert_eq!((x + x).to_string(), "2 x");
        let product = x * ca;
        let same = (x + ca).squared() - x.squared() - ca.squared();
        assert_eq!(same, product + product);
        assert_eq!(same.to_string(), "2 cos(a) x");
    }

    #[test]
    fn unequal_expressions_are_distinguished() {
        let arena = Arena::new();
        let (x, y) = (arena.variable("x"), arena.variable("y"));
        assert_ne!(x * y, x + y);
        assert_eq!((x - y).to_string(), "x - y");
        assert_eq!(y - x, -(x - y));
        assert_eq!((-x * y).sign(), -(x * y).sign());
    }
}
