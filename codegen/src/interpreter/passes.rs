//! The computations of passes, for a block of samples or a single sample.

use super::fuse::{Arithmetic, PassKind};
use super::plan::Pass;
use super::signed;

/// Executes passes.
pub(super) trait Worker {
    /// One result of N operands.
    fn each<const N: usize>(&self, at: &Pass, f: impl Fn([f64; N]) -> f64);

    /// Two results of a common operand and one of their own.
    fn two(&self, at: &Pass, f: impl Fn(f64, f64) -> f64);

    /// Three results of a common operand and one of their own.
    fn three(&self, at: &Pass, f: impl Fn(f64, f64) -> f64);

    /// Sine and cosine of the operand.
    fn angles(&self, at: &Pass);

    /// The angle of the direction whose sine and cosine, times a length, are the operands.
    fn directions(&self, at: &Pass);
}

/// Expands the body for every operation in place of [`Arithmetic`] `$o`, with its function `$f`.
macro_rules! for_each {
    ($o:ident, $f:ident, $body:expr) => {{
        {
            const $o: Arithmetic = Arithmetic::Add;
            let $f = |x: f64, y: f64| x + y;
            $body
        }
        {
            const $o: Arithmetic = Arithmetic::Sub;
            let $f = |x: f64, y: f64| x - y;
            $body
        }
        {
            const $o: Arithmetic = Arithmetic::Mul;
            let $f = |x: f64, y: f64| x * y;
            $body
        }
    }};
}

/// Executes `$body` if the pass is of a kind.
macro_rules! when {
    ($at:ident, $kind:expr, $body:expr) => {
        if $at.code == const { $kind.code() } {
            return $body;
        }
    };
}

/// Executes a pass.
// A sequence of comparisons, which compiles to one jump table; nested kinds would give several.
#[inline(always)]
pub(super) fn work(at: &Pass, worker: &impl Worker) {
    for_each!(F, f, {
        when!(at, PassKind::One(F), worker.each(at, |[a, b]| f(a, b)));
        when!(
            at,
            PassKind::From(F),
            worker.each(at, |[a, b, c]| c - f(a, b))
        );
        for_each!(G, g, {
            when!(
                at,
                PassKind::Then(F, G),
                worker.each(at, |[a, b, c]| g(f(a, b), c))
            );
            when!(
                at,
                PassKind::FromChain(F, G),
                worker.each(at, |[a, b, c, d]| d - g(f(a, b), c))
            );
            for_each!(H, h, {
                when!(
                    at,
                    PassKind::Chain(F, G, H),
                    worker.each(at, |[a, b, c, d]| h(g(f(a, b), c), d))
                );
                when!(
                    at,
                    PassKind::Both(F, G, H),
                    worker.each(at, |[a, b, c, d]| g(f(a, b), h(c, d)))
                );
            });
        });
    });
    when!(at, PassKind::Divide, worker.each(at, |[a, b]| a / b));
    when!(at, PassKind::Negate, worker.each(at, |[a]| -a));
    when!(at, PassKind::Root, worker.each(at, |[a]| a.sqrt()));
    when!(at, PassKind::Sign, worker.each(at, |[a]| signed(1.0, a)));
    when!(at, PassKind::Signed, worker.each(at, |[a, b]| signed(b, a)));
    when!(
        at,
        PassKind::ThreeSigned,
        worker.three(at, |a, b| signed(b, a))
    );
    when!(at, PassKind::TwoProducts, worker.two(at, |a, b| a * b));
    when!(at, PassKind::ThreeProducts, worker.three(at, |a, b| a * b));
    when!(at, PassKind::Direction, worker.directions(at));
    when!(at, PassKind::Angle, worker.angles(at));
}
