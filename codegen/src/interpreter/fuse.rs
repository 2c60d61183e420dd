//! Converts the steps of a program to passes over a block.
//!
//! Two or three steps are fused if a value is used once, or if several steps share an operand.

use crate::lowering::{Operand, Operation, Program};
use std::collections::HashMap;

/// Operations that can be fused.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Arithmetic {
    Add,
    Sub,
    Mul,
}

/// The computation of a pass on its operands a, b, c, d.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum PassKind {
    /// a ∘ b
    One(Arithmetic),
    /// (a ∘ b) ∘ c
    Then(Arithmetic, Arithmetic),
    /// c - (a ∘ b)
    From(Arithmetic),
    /// (a ∘ b) ∘ (c ∘ d): first, middle, last
    Both(Arithmetic, Arithmetic, Arithmetic),
    /// ((a ∘ b) ∘ c) ∘ d
    Chain(Arithmetic, Arithmetic, Arithmetic),
    /// d - ((a ∘ b) ∘ c)
    FromChain(Arithmetic, Arithmetic),
    /// a × b and a × c
    TwoProducts,
    /// a × b, a × c and a × d
    ThreeProducts,
    Divide,
    Negate,
    Root,
    Sign,
    /// b with the sign of a
    Signed,
    /// b, c and d with the sign of a
    ThreeSigned,
    /// The angle of the direction (b, a)
    Direction,
    /// Sine and cosine of a
    Angle,
}

impl PassKind {
    /// A unique number for each kind.
    pub(super) const fn code(self) -> u8 {
        match self {
            Self::One(a) => a as u8,
            Self::From(a) => 3 + a as u8,
            Self::Then(a, b) => 6 + 3 * (a as u8) + b as u8,
            Self::Both(a, b, c) => 15 + 9 * (a as u8) + 3 * (b as u8) + c as u8,
            Self::Chain(a, b, c) => 42 + 9 * (a as u8) + 3 * (b as u8) + c as u8,
            Self::FromChain(a, b) => 69 + 3 * (a as u8) + b as u8,
            Self::TwoProducts => 78,
            Self::ThreeProducts => 79,
            Self::Divide => 80,
            Self::Negate => 81,
            Self::Root => 82,
            Self::Sign => 83,
            Self::Signed => 84,
            Self::ThreeSigned => 85,
            Self::Direction => 86,
            Self::Angle => 87,
        }
    }
}

/// A value of a program; constants by their bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Value {
    Constant(u64),
    Input { array: usize, index: usize },
    Step(usize),
}

impl Value {
    pub(super) const fn of(operand: Operand) -> Self {
        match operand {
            Operand::Constant(value) => Self::Constant(value.to_bits()),
            Operand::Input { array, index } => Self::Input { array, index },
            Operand::Step(at) => Self::Step(at),
        }
    }
}

/// Largest number of results of a pass.
pub(super) const RESULTS: usize = 3;

/// A pass over a block whose operands have no slots yet.
#[derive(Debug, Clone)]
pub(super) struct Draft {
    pub(super) kind: PassKind,
    pub(super) operands: Vec<Value>,
    /// The computed values; for an angle the sine and the cosine, one of which may be unused.
    pub(super) results: [Option<Value>; RESULTS],
}

impl Draft {
    fn new(kind: PassKind, operands: &[Operand], result: Value) -> Self {
        Self {
            kind,
            operands: operands.iter().map(|&operand| Value::of(operand)).collect(),
            results: [Some(result), None, None],
        }
    }
}

/// The passes of a program in order; some steps are merged into earlier passes.
pub(super) fn drafts(program: &Program) -> Vec<Draft> {
    let fuse = Fuse::new(program);
    let mut angles = angles(program);
    let mut drafts = Vec::new();
    for (at, step) in program.steps.iter().enumerate() {
        if fuse.fused[at] {
            continue;
        }
        if let Operation::Sine(angle) | Operation::Cosine(angle) = step.operation {
            // Both at the position of the first.
            if let Some([sine, cosine]) = angles.remove(&Value::of(angle)) {
                drafts.push(Draft {
                    kind: PassKind::Angle,
                    operands: vec![Value::of(angle)],
                    results: [sine.map(Value::Step), cosine.map(Value::Step), None],
                });
            }
            continue;
        }
        drafts.push(fuse.draft(at, step.operation));
    }
    sharing(chains(program, drafts))
}

/// Merges passes of one step into the only pass of two steps that needs them.
fn chains(program: &Program, drafts: Vec<Draft>) -> Vec<Draft> {
    let entries = program.entries.iter().map(|entry| entry.operand);
    let kept = entries.chain(program.guards.iter().map(|guard| guard.operand));
    let operands = drafts.iter().flat_map(|draft| &draft.operands).copied();
    let mut uses: HashMap<Value, usize> = HashMap::new();
    for value in operands.chain(kept.map(Value::of)) {
        *uses.entry(value).or_default() += 1;
    }
    let mut made: HashMap<Value, usize> = HashMap::new();
    let mut chained: Vec<Option<Draft>> = Vec::new();
    for draft in drafts {
        let link = (0..draft.operands.len()).find_map(|place| {
            let value = draft.operands[place];
            let maker = *made.get(&value).filter(|_| uses[&value] == 1)?;
            let longer = draft.after(chained[maker].as_ref()?, place)?;
            Some((maker, longer))
        });
        let draft = match link {
            Some((maker, longer)) => {
                chained[maker] = None;
                longer
            }
            None => draft,
        };
        made.extend(draft.results[0].map(|value| (value, chained.len())));
        chained.push(Some(draft));
    }
    chained.into_iter().flatten().collect()
}

/// The steps with the sine and the cosine of each angle.
fn angles(program: &Program) -> HashMap<Value, [Option<usize>; 2]> {
    let mut angles: HashMap<Value, [Option<usize>; 2]> = HashMap::new();
    for (at, step) in program.steps.iter().enumerate() {
        let (angle, which) = match step.operation {
            Operation::Sine(angle) => (angle, 0),
            Operation::Cosine(angle) => (angle, 1),
            _ => continue,
        };
        angles.entry(Value::of(angle)).or_default()[which] = Some(at);
    }
    angles
}

/// The arithmetic of a step, and its operands.
fn arithmetic(operation: Operation) -> Option<(Arithmetic, Operand, Operand)> {
    match operation {
        Operation::Add(a, b) => Some((Arithmetic::Add, a, b)),
        Operation::Sub(a, b) => Some((Arithmetic::Sub, a, b)),
        Operation::Mul(a, b) => Some((Arithmetic::Mul, a, b)),
        _ => None,
    }
}

struct Fuse<'p> {
    program: &'p Program,
    /// Whether a step is computed by its only user.
    fused: Vec<bool>,
}

impl<'p> Fuse<'p> {
    fn new(program: &'p Program) -> Self {
        let count = program.steps.len();
        let mut kept = vec![false; count];
        for entry in &program.entries {
            if let Operand::Step(at) = entry.operand {
                kept[at] = true;
            }
        }
        for guard in &program.guards {
            if let Operand::Step(at) = guard.operand {
                kept[at] = true;
            }
        }
        let uses = program.uses();
        let mut fused = vec![false; count];
        // In reverse order, so that a fused step absorbs no other step.
        for at in (0..count).rev() {
            let operands = arithmetic(program.steps[at].operation).filter(|_| !fused[at]);
            for operand in operands.into_iter().flat_map(|(_, a, b)| [a, b]) {
                if let Operand::Step(inner) = operand {
                    let is_arithmetic = arithmetic(program.steps[inner].operation).is_some();
                    fused[inner] = is_arithmetic && uses[inner] == 1 && !kept[inner];
                }
            }
        }
        Self { program, fused }
    }

    /// The step that is computed together with its user.
    fn inner(&self, operand: Operand) -> Option<(Arithmetic, Operand, Operand)> {
        match operand {
            Operand::Step(at) if self.fused[at] => arithmetic(self.program.steps[at].operation),
            _ => None,
        }
    }

    fn draft(&self, at: usize, operation: Operation) -> Draft {
        let of = |kind: PassKind, operands: &[Operand]| Draft::new(kind, operands, Value::Step(at));
        match operation {
            Operation::Div(a, b) => of(PassKind::Divide, &[a, b]),
            Operation::Signed(a, b) => of(PassKind::Signed, &[b, a]),
            Operation::Atan2(y, x) => of(PassKind::Direction, &[y, x]),
            Operation::Neg(a) => of(PassKind::Negate, &[a]),
            Operation::Sqrt(a) => of(PassKind::Root, &[a]),
            Operation::Sign(a) => of(PassKind::Sign, &[a]),
            Operation::Sine(a) | Operation::Cosine(a) => of(PassKind::Angle, &[a]),
            Operation::Add(a, b) => self.arithmetic(at, Arithmetic::Add, a, b),
            Operation::Sub(a, b) => self.arithmetic(at, Arithmetic::Sub, a, b),
            Operation::Mul(a, b) => self.arithmetic(at, Arithmetic::Mul, a, b),
        }
    }

    fn arithmetic(&self, at: usize, middle: Arithmetic, left: Operand, right: Operand) -> Draft {
        let of = |kind: PassKind, operands: &[Operand]| Draft::new(kind, operands, Value::Step(at));
        match (self.inner(left), self.inner(right)) {
            (None, None) => of(PassKind::One(middle), &[left, right]),
            (Some((first, a, b)), None) => of(PassKind::Then(first, middle), &[a, b, right]),
            (None, Some((last, a, b))) if middle == Arithmetic::Sub => {
                of(PassKind::From(last), &[a, b, left])
            }
            // Addition and multiplication are commutative.
            (None, Some((last, a, b))) => of(PassKind::Then(last, middle), &[a, b, left]),
            (Some((first, a, b)), Some((last, c, d))) => {
                of(PassKind::Both(first, middle, last), &[a, b, c, d])
            }
        }
    }
}

/// Merges products with a common factor, and numbers with a common sign.
fn sharing(drafts: Vec<Draft>) -> Vec<Draft> {
    let mut made: HashMap<Value, usize> = HashMap::new();
    let mut users: HashMap<(PassKind, Value), Vec<usize>> = HashMap::new();
    for (number, draft) in drafts.iter().enumerate() {
        made.extend(draft.results.into_iter().flatten().map(|v| (v, number)));
        for common in draft.common() {
            users.entry((draft.kind, common)).or_default().push(number);
        }
    }
    let mut taken = vec![false; drafts.len()];
    let mut shared = Vec::new();
    for (number, draft) in drafts.iter().enumerate() {
        if taken[number] {
            continue;
        }
        let is_there = |value: &Value| made.get(value).is_none_or(|&maker| maker < number);
        // Later passes whose operands exist already.
        let mates = |common: Value| -> Vec<usize> {
            let later = users[&(draft.kind, common)].iter().copied();
            later
                .filter(|&mate| mate > number && !taken[mate])
                .filter(|&mate| drafts[mate].operands.iter().all(is_there))
                .take(RESULTS - 1)
                .collect()
        };
        let choices = draft.common().map(|common| (common, mates(common)));
        let best = choices.reduce(|a, b| if b.1.len() > a.1.len() { b } else { a });
        let together = best.and_then(|(common, mates)| {
            let members = std::iter::once(number).chain(mates.iter().copied());
            let draft = draft.with_common(common, members.map(|m| &drafts[m]).collect());
            draft.map(|draft| (draft, mates))
        });
        match together {
            Some((draft, mates)) => {
                mates.into_iter().for_each(|mate| taken[mate] = true);
                shared.push(draft);
            }
            None => shared.push(draft.clone()),
        }
    }
    shared
}

impl Draft {
    /// This pass merged with the single-step pass of its operand at `place`, if there is a pass for
    /// the three steps.
    fn after(&self, first: &Self, place: usize) -> Option<Self> {
        let PassKind::One(f) = first.kind else {
            return None;
        };
        let (kind, g) = match self.kind {
            PassKind::Then(g, h) => (PassKind::Chain(f, g, h), g),
            PassKind::From(g) => (PassKind::FromChain(f, g), g),
            _ => return None,
        };
        let other = match (place, g) {
            (0, _) => self.operands[1],
            // Addition and multiplication are commutative.
            (1, Arithmetic::Add | Arithmetic::Mul) => self.operands[0],
            _ => return None,
        };
        let rest = [other, self.operands[2]];
        Some(Self {
            kind,
            operands: first.operands.iter().copied().chain(rest).collect(),
            results: self.results,
        })
    }

    /// The operands that it may share with passes of its kind.
    fn common(&self) -> impl Iterator<Item = Value> {
        let count = match self.kind {
            PassKind::One(Arithmetic::Mul) if self.operands[0] == self.operands[1] => 1,
            PassKind::One(Arithmetic::Mul) => 2,
            PassKind::Signed => 1,
            _ => 0,
        };
        self.operands.clone().into_iter().take(count)
    }

    /// Several passes of this kind as one, if there is a pass for that number.
    fn with_common(&self, common: Value, members: Vec<&Self>) -> Option<Self> {
        let kind = match (self.kind, members.len()) {
            (PassKind::One(_), 2) => PassKind::TwoProducts,
            (PassKind::One(_), 3) => PassKind::ThreeProducts,
            (PassKind::Signed, 3) => PassKind::ThreeSigned,
            _ => return None,
        };
        let mut draft = Self {
            kind,
            operands: vec![common],
            results: [None; RESULTS],
        };
        for (result, member) in draft.results.iter_mut().zip(members) {
            *result = member.results[0];
            let other = usize::from(member.operands[0] == common);
            draft.operands.push(member.operands[other]);
        }
        Some(draft)
    }
}
