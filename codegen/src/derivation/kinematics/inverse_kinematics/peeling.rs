//! Solves a leg one joint at a time.
//!
//! Among the closure's equations ([`equations`](super::equations)), those with a single unknown are
//! used, the cheapest kind first:
//!
//! 1. two equations a c + b s = d in one turn, or one that is linear in a slide: no square root;
//! 2. one equation a c + b s = d in a turn: with w² = a² + b² - d², (a² + b²) c = a d + b w and
//!    (a² + b²) s = b d - a w;
//! 3. an equation that is quadratic in a slide.
//!
//! The root has its sign at home: w = ∂(a c + b s)/∂(turn). The sign can change only where the root
//! vanishes, and there the leg is singular. An equation whose root vanishes at home does not
//! determine its unknown and is not used.

use super::super::configuration::{Configuration, Unknown};
use super::equations::equations;
use super::polynomial::{Linear, Quadratic, linear, quadratic};
use super::{Reach, Task};
use crate::cas::{CosineSine, Expr, Number, Ratio};
use crate::mechanism::JointKind;

/// Fraction of its terms below which a divisor or root counts as zero.
const VANISHES: f64 = 1e-6;
/// Size at home below which coefficients are rounding errors of cancelling constants, relative to a
/// leg of one metre. An equation with only such coefficients is void.
const ROUNDING: f64 = 1e-11;

/// Solution of an unknown from the closure.
pub(super) enum Step<'a> {
    Pair(Linear<'a>, Linear<'a>),
    Slide(Quadratic<'a>),
    Root(Linear<'a>),
    SlideRoot(Quadratic<'a>),
}

impl<'a> Step<'a> {
    /// Cost for the choice among steps: preferred kinds first, then the number of symbols and
    /// terms.
    fn cost(&self) -> (usize, usize) {
        let size = |l: &Linear<'a>| l.a.size() + l.b.size() + l.d.size();
        let quadratic = |q: &Quadratic<'a>| q.a.size() + q.b.size() + q.e.size();
        match self {
            Self::Pair(first, second) => (0, size(first) + size(second)),
            Self::Slide(equation) => (0, quadratic(equation)),
            Self::Root(equation) => (1, size(equation)),
            Self::SlideRoot(equation) => (1, quadratic(equation)),
        }
    }
}

/// Solves the leg's angles and slides from the pose. `None` if some joint stays unknown.
pub(super) fn solve<'a>(
    task: Task<'a, '_>,
    configuration: &mut Configuration<'a>,
) -> Option<Vec<Reach<'a>>> {
    let mut conditions = Vec::new();
    while !is_solved(task, configuration) {
        conditions.extend(advance(task, configuration)?);
    }
    Some(conditions)
}

/// Solves one more turn or slide; returns the condition for its root to be real.
///
/// `None` if no equation has a single unknown.
pub(in crate::derivation) fn advance<'a>(
    task: Task<'a, '_>,
    configuration: &mut Configuration<'a>,
) -> Option<Option<Reach<'a>>> {
    let scratch = configuration.with_unknowns();
    let equations = equations(task, &scratch)?;
    let (step, unknown) = scratch
        .unknowns()
        .into_iter()
        .filter_map(|unknown| Some((step(task, &equations, &unknown)?, unknown)))
        .min_by_key(|(step, _)| step.cost())?;
    take(task, &unknown, step, configuration)
}

fn is_solved(task: Task<'_, '_>, configuration: &Configuration<'_>) -> bool {
    task.leg.independent().enumerate().all(|(i, joint)| {
        let index = task.first_joint + i;
        match task.leg.joints[joint].kind {
            JointKind::Prismatic => configuration.joint_position(index).is_some(),
            _ => configuration
                .unit(&configuration.joint_angle(index))
                .is_some(),
        }
    })
}

/// The best step for an unknown, from the equations that contain no other unknown.
fn step<'a>(task: Task<'a, '_>, equations: &[Expr<'a>], unknown: &Unknown) -> Option<Step<'a>> {
    let arena = task.arena;
    let own = match unknown {
        Unknown::Turn(_) => {
            let CosineSine { cosine, sine } = unknown.unit(arena);
            vec![cosine, sine]
        }
        Unknown::Slide(_) => vec![unknown.slide(arena)],
    };
    let own: Vec<_> = own.iter().flat_map(|e| e.symbols()).collect();
    let others_known = |e: &&Expr<'a>| {
        let unknown = |id: &_| arena.is_placeholder(*id);
        let symbols = e.symbols();
        symbols.iter().all(|id| own.contains(id) || !unknown(id))
            && symbols.iter().any(|id| own.contains(id))
    };
    let mut steps: Vec<Step<'a>> = Vec::new();
    let mut turns: Vec<Linear<'a>> = Vec::new();
    for &equation in equations.iter().filter(others_known) {
        match unknown {
            Unknown::Turn(_) => turns.extend(linear(arena, equation, unknown)),
            Unknown::Slide(_) => {
                steps.extend(quadratic(arena, equation, unknown).and_then(|q| slide(task, q)))
            }
        }
    }
    for (i, first) in turns.iter().enumerate() {
        if root_at_home(task, first, unknown).is_some() {
            steps.push(Step::Root(*first));
        }
        let pairs = turns[..i]
            .iter()
            .filter(|other| is_regular(task, first, other));
        steps.extend(pairs.map(|other| Step::Pair(*other, *first)));
    }
    steps.into_iter().min_by_key(Step::cost)
}

/// Solution of a slide from an equation, if the equation determines it at home.
pub(super) fn slide<'a>(task: Task<'a, '_>, equation: Quadratic<'a>) -> Option<Step<'a>> {
    let home = |e: Expr<'a>| task.at_home(e);
    if equation.a.is_zero() {
        return (home(equation.b).abs() > VANISHES * task.size()).then_some(Step::Slide(equation));
    }
    let (p, radicand) = completed(equation);
    let scale = home(p).abs().max(home(radicand).abs());
    (home(radicand) > VANISHES * scale).then_some(Step::SlideRoot(equation))
}

/// (q + p)² = radicand.
fn completed<'a>(Quadratic { a, b, e }: Quadratic<'a>) -> (Expr<'a>, Expr<'a>) {
    let half = Number::ratio(Ratio::new(1, 2).unwrap_or(Ratio::ONE));
    let p = b / a * half;
    (p, p * p - e / a)
}

/// w at home, if it determines the turn.
pub(super) fn root_at_home<'a>(
    task: Task<'a, '_>,
    l: &Linear<'a>,
    unknown: &Unknown,
) -> Option<f64> {
    let Unknown::Turn(turn) = unknown else {
        return None;
    };
    let (sine, cosine) = task.turn_at_home(turn).sin_cos();
    let (a, b) = (task.at_home(l.a), task.at_home(l.b));
    let w = b * cosine - a * sine;
    let is_root = a.hypot(b) > ROUNDING * task.size() && w.abs() > VANISHES * a.hypot(b);
    is_root.then_some(w)
}

/// Whether two equations determine a turn's cosine and sine at home.
fn is_regular<'a>(task: Task<'a, '_>, first: &Linear<'a>, second: &Linear<'a>) -> bool {
    let [a, b, c, d] = [first.a, first.b, second.a, second.b].map(|e| task.at_home(e));
    let sizes = [a.hypot(b), c.hypot(d)];
    let is_said = sizes.iter().all(|size| *size > ROUNDING * task.size());
    is_said && (a * d - b * c).abs() > VANISHES * sizes[0] * sizes[1]
}

/// Performs the step. Returns the condition for its root to be real.
fn take<'a>(
    task: Task<'a, '_>,
    unknown: &Unknown,
    step: Step<'a>,
    configuration: &mut Configuration<'a>,
) -> Option<Option<Reach<'a>>> {
    let label = unknown_label(task, configuration, unknown);
    let named = |value: Expr<'a>, what: &str| value.named(&format!("{what}{label}"));
    let (value, reach) = match step {
        Step::Pair(first, second) if task.blocks => (normalised(pair(first, second)), None),
        Step::Pair(first, second) => (pair(first, second), None),
        Step::Root(equation) => {
            let w = root_at_home(task, &equation, unknown)?;
            let (unit, radicand) = root(task, equation, w, configuration);
            if let Some(radicand) = radicand {
                let _ = named(radicand, "w_squared");
                let _ = named(radicand.sqrt(), "w");
            }
            (unit, radicand.map(|radicand| Reach { radicand }))
        }
        Step::Slide(Quadratic { b, e, .. }) => return learn_slide(unknown, -e / b, configuration),
        Step::SlideRoot(equation) => {
            let Unknown::Slide(index) = unknown else {
                return None;
            };
            let (p, radicand) = completed(equation);
            let is_positive = task.home.joints[*index] + task.at_home(p) > 0.0;
            let _ = named(p, "middle");
            let radicand = named(radicand, "w_squared");
            let root = configuration.root(task.first_joint, task.home, radicand, is_positive);
            task.name_root(root, radicand, &format!("w{label}"));
            let position = root - p;
            learn_slide(unknown, position, configuration);
            return Some(Some(Reach { radicand }));
        }
    };
    let Unknown::Turn(turn) = unknown else {
        return None;
    };
    configuration.learn(turn.clone(), value);
    Some(reach)
}

/// Label of an unknown from its joints, such as `1_leg2`, for the names of intermediate values.
fn unknown_label(
    task: Task<'_, '_>,
    configuration: &Configuration<'_>,
    unknown: &Unknown,
) -> String {
    let joint = |index: usize| {
        let local = index.checked_sub(task.first_joint)?;
        let joint = task.leg.independent().nth(local)?;
        Some(task.leg.joints[joint].suffix())
    };
    let label: Option<String> = match unknown {
        Unknown::Slide(index) => joint(*index),
        Unknown::Turn(turn) => {
            let symbols = turn.terms().iter().map(|(symbol, _)| *symbol);
            symbols.map(|s| joint(configuration.joint(s)?)).collect()
        }
    };
    format!("{}_{}", label.unwrap_or_default(), task.leg.name)
}

fn learn_slide<'a>(
    unknown: &Unknown,
    position: Expr<'a>,
    configuration: &mut Configuration<'a>,
) -> Option<Option<Reach<'a>>> {
    let Unknown::Slide(index) = unknown else {
        return None;
    };
    configuration.learn_position(*index, position);
    Some(None)
}

/// Cosine and sine from two equations.
fn pair<'a>(first: Linear<'a>, second: Linear<'a>) -> CosineSine<'a> {
    if first.a.is_zero() && second.b.is_zero() {
        return CosineSine {
            cosine: second.d / second.a,
            sine: first.d / first.b,
        };
    }
    if first.b.is_zero() && second.a.is_zero() {
        return CosineSine {
            cosine: first.d / first.a,
            sine: second.d / second.b,
        };
    }
    let reciprocal = (first.a * second.b - first.b * second.a).reciprocal();
    let cosine = (first.d * second.b - first.b * second.d) * reciprocal;
    let sine = (first.a * second.d - first.d * second.a) * reciprocal;
    CosineSine { cosine, sine }
}

/// Cosine and sine of the direction of a vector.
///
/// The pose of a leg that blocks directions determines them twice, and equally only if it is closed.
fn normalised(CosineSine { cosine, sine }: CosineSine<'_>) -> CosineSine<'_> {
    let reciprocal = (cosine * cosine + sine * sine).sqrt().reciprocal();
    CosineSine {
        cosine: cosine * reciprocal,
        sine: sine * reciprocal,
    }
}

/// Cosine and sine from one equation, with the sign of w at home; also returns the radicand, which
/// must not be negative.
fn root<'a>(
    task: Task<'a, '_>,
    Linear { a, b, d }: Linear<'a>,
    w_at_home: f64,
    configuration: &mut Configuration<'a>,
) -> (CosineSine<'a>, Option<Expr<'a>>) {
    let mut root = |radicand: Expr<'a>, is_positive: bool| {
        configuration.root(task.first_joint, task.home, radicand, is_positive)
    };
    let is_positive = w_at_home > 0.0;
    if d.is_zero() {
        // w² = a² + b²: the turn is perpendicular to (a, b).
        let reciprocal = root(a * a + b * b, is_positive).reciprocal();
        let turned = CosineSine {
            cosine: b * reciprocal,
            sine: -a * reciprocal,
        };
        return (turned, None);
    }
    let one = task.arena.one();
    if a.is_zero() {
        let sine = d / b;
        let radicand = one - sine * sine;
        let cosine = root(radicand, is_positive == (task.at_home(b) > 0.0));
        return (CosineSine { cosine, sine }, Some(radicand));
    }
    if b.is_zero() {
        let cosine = d / a;
        let radicand = one - cosine * cosine;
        let sine = root(radicand, is_positive != (task.at_home(a) > 0.0));
        return (CosineSine { cosine, sine }, Some(radicand));
    }
    let square = a * a + b * b;
    let reciprocal = square.reciprocal();
    let radicand = square - d * d;
    let w = root(radicand, is_positive);
    let cosine = (a * d + b * w) * reciprocal;
    let sine = (b * d - a * w) * reciprocal;
    (CosineSine { cosine, sine }, Some(radicand))
}
