//! From the graph to the program: reachable nodes in an order in which operands come first.

use super::program::{Array, Condition, Entry, Guard, Operand, Operation, Program, Step};
use super::search::{Overlay, Place, Reach, Rewritten, States, search};
use super::trigonometry::{Plan, plan};
use crate::cas::arena::{Handle, Op};
use crate::cas::{Arena, Direction, Expr};
use std::collections::{HashMap, HashSet};

/// A condition on an expression.
#[derive(Debug, Clone)]
pub struct GuardedExpr<'a> {
    /// The expression.
    pub value: Expr<'a>,
    /// The condition.
    pub condition: Condition,
}

/// Lowers the expressions of one function. `inputs` are the arrays whose elements the graph's symbols
/// `name[index]` stand for, `states` some of their values; a guard is kept if the program divides by its
/// expression or takes its root.
///
/// Entries are visited column by column, so that the program works through leg after leg.
#[must_use]
pub fn lower<'a>(
    arena: &'a Arena,
    inputs: &[Array],
    output: Array,
    entries: &[Expr<'a>],
    guards: &[GuardedExpr<'a>],
    reach: Reach,
    states: &States<'_>,
) -> Program {
    let guarded: Vec<Expr<'a>> = guards.iter().map(|g| g.value).collect();
    let overlay = search(arena, entries, &guarded, reach, states);
    let mut lowering = Lowering::new(arena, inputs, entries, overlay);
    let (rows, columns) = match output.shape[..] {
        [rows, columns] => (rows, columns),
        _ => (output.len(), 1),
    };
    let mut found = vec![None; entries.len()];
    for column in 0..columns {
        for row in 0..rows {
            let at = row * columns + column;
            found[at] = Some(lowering.entry(entries[at].handle()));
        }
    }
    let entries: Vec<Entry> = found.into_iter().flatten().collect();
    // A condition matters where its value is divided by or has its root taken.
    let matters = |operand: Operand| {
        lowering.steps.iter().any(|step| match step.operation {
            Operation::Div(_, by) => by == operand,
            Operation::Sqrt(of) => of == operand,
            _ => false,
        })
    };
    let guards = guards
        .iter()
        .filter_map(|guard| {
            let place = Place::Arena(guard.value.handle().index());
            let operand = lowering.done.get(&place)?.operand;
            let condition = guard.condition.clone();
            matters(operand).then_some(Guard { operand, condition })
        })
        .collect();
    let program = Program {
        inputs: inputs.to_vec(),
        output,
        entries,
        steps: lowering.steps,
        guards,
    };
    super::peephole::improve(program)
}

struct Lowering<'a> {
    arena: &'a Arena,
    inputs: Vec<Array>,
    steps: Vec<Step>,
    done: HashMap<Place, Entry>,
    overlay: Overlay,
    angles: Vec<(Direction, Plan)>,
    units: HashMap<usize, (Operand, Operand)>,
    by_operation: Vec<(Operation, usize)>,
}

impl<'a> Lowering<'a> {
    fn new(arena: &'a Arena, inputs: &[Array], entries: &[Expr<'a>], overlay: Overlay) -> Self {
        let angles = plan(&reachable_angles(arena, entries, &overlay));
        Self {
            arena,
            inputs: inputs.to_vec(),
            steps: Vec::new(),
            done: HashMap::new(),
            overlay,
            angles,
            units: HashMap::new(),
            by_operation: Vec::new(),
        }
    }

    fn entry(&mut self, handle: Handle) -> Entry {
        self.signed(Place::Arena(handle.index()), handle.is_negative())
    }

    /// A node or its negative; the sign of a constant is the constant's.
    fn signed(&mut self, place: Place, negative: bool) -> Entry {
        let Entry { operand, negative } = self.node(place).times(negative);
        match operand {
            Operand::Constant(value) if negative => Entry::positive(Operand::Constant(-value)),
            _ => Entry { operand, negative },
        }
    }

    /// The operand that a handle is; a negative one is negated first.
    fn operand(&mut self, handle: Handle) -> Operand {
        let entry = self.entry(handle);
        if entry.negative {
            self.push(Operation::Neg(entry.operand), None, String::new())
        } else {
            entry.operand
        }
    }

    fn node(&mut self, place: Place) -> Entry {
        if let Some(&entry) = self.done.get(&place) {
            return entry;
        }
        let entry = match (self.overlay.definitions.get(&place).copied(), place) {
            (Some((rewritten, scope)), _) => self.rewritten(place, rewritten, scope),
            (None, Place::Arena(index)) => self.original(index),
            // A node of the search's own is always defined by it.
            (None, Place::New(_)) => Entry::positive(Operand::Constant(f64::NAN)),
        };
        self.done.insert(place, entry);
        entry
    }

    fn rewritten(&mut self, place: Place, rewritten: Rewritten, scope: u32) -> Entry {
        let (a, b) = match rewritten {
            Rewritten::Sum(a, b) | Rewritten::Product(a, b) | Rewritten::Quotient(a, b) => (a, b),
        };
        let (a, b) = (self.signed(a.0, a.1), self.signed(b.0, b.1));
        let (operation, negative) = match rewritten {
            Rewritten::Sum(..) => sum(a, b),
            Rewritten::Product(..) => product(a, b),
            Rewritten::Quotient(..) => quotient(a, b),
        };
        let name = match place {
            Place::Arena(index) => self.arena.name_of(index),
            Place::New(_) => None,
        };
        let name = name.map(|name| {
            if negative {
                format!("minus_{name}")
            } else {
                name
            }
        });
        let operand = self.push(operation, name, self.arena.scope_name(scope));
        Entry { operand, negative }
    }

    /// A node as the arena has it.
    fn original(&mut self, index: usize) -> Entry {
        let (operation, negative) = match self.arena.op(index) {
            Op::Constant(id) => {
                let value = self.arena.constant_at(id).value();
                return Entry::positive(Operand::Constant(value));
            }
            Op::Symbol(id) => {
                return Entry::positive(self.input(&self.arena.symbol_name(id)));
            }
            Op::Cosine(id) => {
                let operand = self.unit_of(&self.arena.direction_at(id)).0;
                return self.named(index, operand);
            }
            Op::Sine(id) => {
                let operand = self.unit_of(&self.arena.direction_at(id)).1;
                return self.named(index, operand);
            }
            Op::Add(a, b) => sum(self.entry(a), self.entry(b)),
            Op::Sub(a, b) => sum(self.entry(a), self.entry(b).times(true)),
            Op::Mul(a, b) => product(self.entry(a), self.entry(b)),
            Op::Div(a, b) => quotient(self.entry(a), self.entry(b)),
            Op::Sqrt(a) => (Operation::Sqrt(self.operand(a)), false),
            Op::Sign(a) => (Operation::Sign(self.operand(a)), false),
            Op::Atan2(y, x) => (Operation::Atan2(self.operand(y), self.operand(x)), false),
        };
        let name = self.arena.name_of(index);
        let name = name.map(|name| {
            if negative {
                format!("minus_{name}")
            } else {
                name
            }
        });
        let operand = self.push(operation, name, self.arena.scope(index));
        Entry { operand, negative }
    }

    /// Sines and cosines are steps already; the node's name goes to the step.
    fn named(&mut self, index: usize, operand: Operand) -> Entry {
        if let Operand::Step(at) = operand {
            let step = &mut self.steps[at];
            if step.name.is_none() {
                step.name = self.arena.name_of(index);
                step.scope = self.arena.scope(index);
            }
        }
        Entry::positive(operand)
    }

    fn push(&mut self, operation: Operation, name: Option<String>, scope: String) -> Operand {
        self.steps.push(Step {
            operation,
            name,
            scope,
        });
        Operand::Step(self.steps.len() - 1)
    }

    /// The input element of a symbol `name[index]`. A symbol that is none is a bug of the caller's
    /// and becomes NaN, which no test survives.
    fn input(&self, symbol: &str) -> Operand {
        let parts = symbol.strip_suffix(']').and_then(|s| s.split_once('['));
        let found = parts.and_then(|(name, index)| {
            let array = self.inputs.iter().position(|a| a.name == name)?;
            Some(Operand::Input {
                array,
                index: index.parse().ok()?,
            })
        });
        debug_assert!(found.is_some(), "`{symbol}` is no input");
        found.unwrap_or(Operand::Constant(f64::NAN))
    }

    fn unit_of(&mut self, direction: &Direction) -> (Operand, Operand) {
        match self.angles.iter().position(|(d, _)| d == direction) {
            Some(at) => self.unit(at),
            None => self.direct(direction),
        }
    }

    /// Cosine and sine of a planned angle.
    fn unit(&mut self, at: usize) -> (Operand, Operand) {
        if let Some(&unit) = self.units.get(&at) {
            return unit;
        }
        let (direction, how) = self.angles[at].clone();
        let unit = match how {
            Plan::Direct => self.direct(&direction),
            Plan::Sum {
                first,
                second,
                sign,
                rest,
            } => {
                let mut unit = Turned {
                    unit: self.unit(first),
                    mirrored: sign < 0,
                };
                if let Some((second, sign)) = second {
                    let other = Turned {
                        unit: self.unit(second),
                        mirrored: sign < 0,
                    };
                    unit = self.sum(unit, other);
                }
                if !rest.offset().is_zero() {
                    let (cosine, sine) = rest.offset().cosine_and_sine();
                    let constant = (
                        Operand::Constant(cosine.value()),
                        Operand::Constant(sine.value()),
                    );
                    unit = self.sum(
                        unit,
                        Turned {
                            unit: constant,
                            mirrored: false,
                        },
                    );
                }
                self.resolved(unit)
            }
        };
        self.units.insert(at, unit);
        unit
    }

    fn direct(&mut self, direction: &Direction) -> (Operand, Operand) {
        let angle = self.angle_value(direction);
        let cosine = self.push(Operation::Cosine(angle), None, String::new());
        let sine = self.push(Operation::Sine(angle), None, String::new());
        (cosine, sine)
    }

    fn angle_value(&mut self, direction: &Direction) -> Operand {
        let mut sum: Option<Operand> = None;
        for (symbol, factor) in direction.terms() {
            let input = self.input(&self.arena.symbol_name(*symbol));
            let size = factor.value().abs();
            let part = if size == 1.0 {
                input
            } else {
                self.push(
                    Operation::Mul(Operand::Constant(size), input),
                    None,
                    String::new(),
                )
            };
            let negative = factor.value() < 0.0;
            sum = Some(match (sum, negative) {
                (None, false) => part,
                (None, true) => self.push(Operation::Neg(part), None, String::new()),
                (Some(s), false) => self.push(Operation::Add(s, part), None, String::new()),
                (Some(s), true) => self.push(Operation::Sub(s, part), None, String::new()),
            });
        }
        let offset = direction.offset();
        match sum {
            Some(sum) if !offset.is_zero() => {
                let constant = Operand::Constant(offset.value());
                self.push(Operation::Add(sum, constant), None, String::new())
            }
            Some(sum) => sum,
            None => Operand::Constant(offset.value()),
        }
    }

    /// The addition theorem, with the signs of mirrored angles put into the additions.
    fn sum(&mut self, a: Turned, b: Turned) -> Turned {
        let ((ca, sa), (cb, sb)) = (a.unit, b.unit);
        let mut product = |x, y| self.product(x, y);
        let (cc, ss, sc, cs) = (
            product(ca, cb),
            product(sa, sb),
            product(sa, cb),
            product(ca, sb),
        );
        let same = a.mirrored == b.mirrored;
        let cosine = if same {
            Operation::Sub(cc, ss)
        } else {
            Operation::Add(cc, ss)
        };
        let sine = if same {
            Operation::Add(sc, cs)
        } else {
            Operation::Sub(sc, cs)
        };
        let cosine = self.push(cosine, None, String::new());
        let sine = self.push(sine, None, String::new());
        // With a mirrored the whole sine changes its sign.
        Turned {
            unit: (cosine, sine),
            mirrored: a.mirrored,
        }
    }

    fn product(&mut self, x: Operand, y: Operand) -> Operand {
        let operation = Operation::Mul(x, y);
        if let Some((_, at)) = self.by_operation.iter().find(|(o, _)| *o == operation) {
            return Operand::Step(*at);
        }
        let operand = self.push(operation, None, String::new());
        if let Operand::Step(at) = operand {
            self.by_operation.push((operation, at));
        }
        operand
    }

    fn resolved(&mut self, turned: Turned) -> (Operand, Operand) {
        let (cosine, sine) = turned.unit;
        if !turned.mirrored {
            return (cosine, sine);
        }
        (cosine, self.push(Operation::Neg(sine), None, String::new()))
    }
}

/// ±a ± b as an operation, and whether its negative is meant.
fn sum(a: Entry, b: Entry) -> (Operation, bool) {
    match (a.negative, b.negative) {
        (false, false) => (Operation::Add(a.operand, b.operand), false),
        (false, true) => (Operation::Sub(a.operand, b.operand), false),
        (true, false) => (Operation::Sub(b.operand, a.operand), false),
        (true, true) => (Operation::Add(a.operand, b.operand), true),
    }
}

fn product(a: Entry, b: Entry) -> (Operation, bool) {
    let operation = Operation::Mul(a.operand, b.operand);
    (operation, a.negative != b.negative)
}

fn quotient(a: Entry, b: Entry) -> (Operation, bool) {
    let operation = Operation::Div(a.operand, b.operand);
    (operation, a.negative != b.negative)
}

/// A cosine and sine, perhaps of the opposite angle.
#[derive(Clone, Copy)]
struct Turned {
    unit: (Operand, Operand),
    mirrored: bool,
}

/// All angles whose sine or cosine the entries need, in the order of their first use.
fn reachable_angles(arena: &Arena, entries: &[Expr<'_>], overlay: &Overlay) -> Vec<Direction> {
    let mut seen = HashSet::new();
    let places = entries.iter().rev();
    let mut stack: Vec<Place> = places.map(|e| Place::Arena(e.handle().index())).collect();
    let mut angles: Vec<Direction> = Vec::new();
    while let Some(place) = stack.pop() {
        if !seen.insert(place) {
            continue;
        }
        if let Some((rewritten, _)) = overlay.definitions.get(&place) {
            let (Rewritten::Sum(a, b) | Rewritten::Product(a, b) | Rewritten::Quotient(a, b)) =
                rewritten;
            stack.extend([b.0, a.0]);
            continue;
        }
        let Place::Arena(index) = place else { continue };
        let of = |handle: Handle| Place::Arena(handle.index());
        match arena.op(index) {
            Op::Cosine(id) | Op::Sine(id) => {
                let direction = arena.direction_at(id);
                if !angles.contains(&direction) {
                    angles.push(direction);
                }
            }
            Op::Add(a, b) | Op::Sub(a, b) | Op::Mul(a, b) | Op::Div(a, b) | Op::Atan2(a, b) => {
                stack.extend([of(b), of(a)]);
            }
            Op::Sqrt(a) | Op::Sign(a) => stack.push(of(a)),
            Op::Constant(_) | Op::Symbol(_) => {}
        }
    }
    angles
}
