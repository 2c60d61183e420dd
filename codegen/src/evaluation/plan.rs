//! A program made ready for blocks: passes over a block, and the memory that values take.
//!
//! A value gets a slot of the arena, which is free again after the last use, so that what is alive at a
//! time stays in the nearest cache. Numbers of the output keep theirs until the end of the block.

use super::fuse::{Draft, Kind, RESULTS, Value, drafts};
use crate::lowering::{Entry, Operation, Program, Source};
use std::collections::HashMap;

/// A slot of the arena, which holds the values of one number over a block.
pub(super) type Slot = usize;

/// One pass over a block: one to three steps of the program.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Pass {
    pub(super) kind: Kind,
    pub(super) operands: [Slot; 4],
    /// Where the results go.
    pub(super) results: [Slot; RESULTS],
}

/// An input's number and its slot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Load {
    pub(super) array: usize,
    pub(super) index: usize,
    pub(super) slot: Slot,
}

/// A number of the output.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Output {
    pub(super) slot: Slot,
    /// Whether its negative is meant.
    pub(super) negative: bool,
}

/// A program made ready for blocks.
#[derive(Debug, Clone, Default)]
pub(super) struct Plan {
    pub(super) passes: Vec<Pass>,
    pub(super) constants: Vec<(Slot, f64)>,
    pub(super) loads: Vec<Load>,
    pub(super) outputs: Vec<Output>,
    pub(super) guards: Vec<Slot>,
    /// Slots of the arena.
    pub(super) slots: usize,
    /// What the plan was made of.
    operations: Vec<Operation>,
    entries: Vec<Entry>,
    guarded: Vec<Source>,
}

impl Plan {
    /// Makes a program ready.
    pub(super) fn new(program: &Program) -> Self {
        let drafts = drafts(program);
        let mut planner = Planner::new(program, &drafts);
        for (number, draft) in drafts.iter().enumerate() {
            planner.pass(number, draft);
        }
        planner.finish(program)
    }

    /// Whether the plan is that of a program.
    pub(super) fn is_of(&self, program: &Program) -> bool {
        let operations = program.steps.iter().map(|s| &s.operation);
        let guarded = program.guards.iter().map(|g| &g.source);
        self.entries == program.entries
            && operations.eq(&self.operations)
            && guarded.eq(&self.guarded)
    }
}

/// Gives out slots.
struct Planner {
    plan: Plan,
    slots: HashMap<Value, Slot>,
    free: Vec<Slot>,
    /// The last pass that needs a value; `usize::MAX` for what is needed at the end.
    last: HashMap<Value, usize>,
}

impl Planner {
    fn new(program: &Program, drafts: &[Draft]) -> Self {
        let mut last = HashMap::new();
        for (number, draft) in drafts.iter().enumerate() {
            last.extend(draft.operands.iter().map(|&value| (value, number)));
        }
        let entries = program.entries.iter().map(|e| e.source);
        let kept = entries.chain(program.guards.iter().map(|g| g.source));
        last.extend(kept.map(|source| (Value::of(source), usize::MAX)));
        Self {
            plan: Plan::default(),
            slots: HashMap::new(),
            free: Vec::new(),
            last,
        }
    }

    fn pass(&mut self, number: usize, draft: &Draft) {
        let mut operands = [0; 4];
        for (slot, &value) in operands.iter_mut().zip(&draft.operands) {
            *slot = self.slot(value);
        }
        // A result may take the place of an operand that ends here: all is read before it is written.
        for &value in &draft.operands {
            if value.is_computed() && self.last.get(&value) == Some(&number) {
                self.release(value);
            }
        }
        let results = draft.results.map(|value| self.result(value));
        for value in draft.results.into_iter().flatten() {
            if !self.last.contains_key(&value) {
                self.release(value);
            }
        }
        self.plan.passes.push(Pass {
            kind: draft.kind,
            operands,
            results,
        });
    }

    fn release(&mut self, value: Value) {
        self.free.extend(self.slots.remove(&value));
    }

    /// The slot of a value that is there; constants and inputs get theirs when they are first needed.
    fn slot(&mut self, value: Value) -> Slot {
        if let Some(&slot) = self.slots.get(&value) {
            return slot;
        }
        let slot = self.fresh();
        self.slots.insert(value, slot);
        match value {
            Value::Constant(bits) => self.plan.constants.push((slot, f64::from_bits(bits))),
            Value::Input { array, index } => self.plan.loads.push(Load { array, index, slot }),
            // Steps are in order: what they need is computed.
            Value::Step(_) => {}
        }
        slot
    }

    /// A new slot. Constants and inputs are there before the first pass: theirs are not shared.
    fn fresh(&mut self) -> Slot {
        self.plan.slots += 1;
        self.plan.slots - 1
    }

    /// The slot of a result; one that nothing needs goes to a slot that is free.
    fn result(&mut self, value: Option<Value>) -> Slot {
        let slot = self.free.pop().unwrap_or_else(|| self.fresh());
        match value {
            Some(value) => {
                self.slots.insert(value, slot);
            }
            None => self.free.insert(0, slot),
        }
        slot
    }

    fn finish(mut self, program: &Program) -> Plan {
        let outputs = program.entries.iter().map(|entry| Output {
            slot: self.slot(Value::of(entry.source)),
            negative: entry.negative,
        });
        self.plan.outputs = outputs.collect();
        let guards = program.guards.iter().map(|g| Value::of(g.source));
        self.plan.guards = guards.map(|value| self.slot(value)).collect();
        // Inputs of one array are loaded together.
        self.plan.loads.sort_by_key(|load| (load.array, load.index));
        self.plan.operations = program.steps.iter().map(|s| s.operation).collect();
        self.plan.entries.clone_from(&program.entries);
        self.plan.guarded = program.guards.iter().map(|g| g.source).collect();
        self.plan
    }
}
