//! Plan of a program for blocks: passes and memory slots of values.
//!
//! A value gets a slot of the memory, which is free after its last use, so that live values stay in
//! the first-level cache. For the same reason, the output's hundreds of numbers are delivered soon
//! after they are computed.

use super::fuse::{Draft, RESULTS, Value, drafts};
use crate::lowering::Program;
use std::{collections::HashMap, ops::Range};

/// A slot of the memory: the values of one number over a block. 32 bits keep a pass short.
pub(super) type Slot = u32;

/// One pass over a block: one to three steps of the program.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Pass {
    pub(super) code: u8,
    pub(super) operands: [Slot; 4],
    /// Slots of the results.
    pub(super) results: [Slot; RESULTS],
}

/// An element of an input and its slot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Load {
    pub(super) array: usize,
    pub(super) index: usize,
    pub(super) slot: Slot,
}

/// A number of the output.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Output {
    /// Index of the number.
    pub(super) index: usize,
    pub(super) slot: Slot,
    /// -1 for the negative of the value, otherwise 1.
    pub(super) sign: f64,
}

/// Some passes, and the numbers of the output that are delivered after them.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Stage {
    pub(super) passes: Range<usize>,
    pub(super) outputs: Range<usize>,
}

/// A program prepared for blocks.
#[derive(Debug, Default)]
pub(super) struct Plan {
    pub(super) passes: Vec<Pass>,
    pub(super) stages: Vec<Stage>,
    pub(super) constants: Vec<(Slot, f64)>,
    pub(super) loads: Vec<Load>,
    /// In order of delivery.
    pub(super) outputs: Vec<Output>,
    pub(super) guards: Vec<Slot>,
    /// Number of slots.
    pub(super) slots: Slot,
}

impl Plan {
    /// Plans a program whose numbers are delivered in groups of `together`.
    pub(super) fn new(program: &Program, together: usize) -> Self {
        let drafts = drafts(program);
        let mut planner = Planner::new(program, &drafts);
        let mut outputs: HashMap<Value, Vec<usize>> = HashMap::new();
        for (index, entry) in program.entries.iter().enumerate() {
            let value = Value::of(entry.operand);
            outputs.entry(value).or_default().push(index);
        }
        for draft in &drafts {
            planner.pass(draft);
            let results = draft.results.iter().flatten();
            let computed = results.filter_map(|value| outputs.remove(value));
            planner.waiting.extend(computed.flatten());
            if planner.waiting.len() >= together {
                planner.hand_out();
            }
        }
        // Constants and inputs, which are not computed.
        planner.waiting.extend(outputs.into_values().flatten());
        planner.hand_out();
        planner.finish()
    }
}

/// Allocates slots, in the order of the passes.
struct Planner<'p> {
    program: &'p Program,
    plan: Plan,
    slots: HashMap<Value, Slot>,
    free: Vec<Slot>,
    /// Remaining uses of a value by passes, the output and guards.
    needed: HashMap<Value, usize>,
    /// Numbers of the output that are computed but not delivered yet.
    waiting: Vec<usize>,
}

impl<'p> Planner<'p> {
    fn new(program: &'p Program, drafts: &[Draft]) -> Self {
        let operands = drafts.iter().flat_map(|draft| &draft.operands).copied();
        let entries = program.entries.iter().map(|e| e.operand);
        let kept = entries.chain(program.guards.iter().map(|g| g.operand));
        let mut needed = HashMap::new();
        for value in operands.chain(kept.map(Value::of)) {
            *needed.entry(value).or_default() += 1;
        }
        Self {
            program,
            plan: Plan::default(),
            slots: HashMap::new(),
            free: Vec::new(),
            needed,
            waiting: Vec::new(),
        }
    }

    fn pass(&mut self, draft: &Draft) {
        let mut operands = [0; 4];
        for (slot, &value) in operands.iter_mut().zip(&draft.operands) {
            *slot = self.slot(value);
        }
        // A result may overwrite an operand at its last use: operands are read first.
        draft.operands.iter().for_each(|&value| self.used(value));
        let results = draft.results.map(|value| self.result(value));
        self.plan.passes.push(Pass {
            code: draft.kind.code(),
            operands,
            results,
        });
    }

    /// Counts a use of a value; frees its slot after the last one.
    ///
    /// Inputs are loaded again with the next block, constants are not.
    fn used(&mut self, value: Value) {
        let needed = self.needed.entry(value).or_default();
        *needed = needed.saturating_sub(1);
        if *needed == 0 && !matches!(value, Value::Constant(_)) {
            self.free.extend(self.slots.remove(&value));
        }
    }

    /// The slot of an existing value; constants and inputs get theirs at the first use.
    fn slot(&mut self, value: Value) -> Slot {
        if let Some(&slot) = self.slots.get(&value) {
            return slot;
        }
        let slot = self.fresh();
        self.slots.insert(value, slot);
        match value {
            Value::Constant(bits) => self.plan.constants.push((slot, f64::from_bits(bits))),
            Value::Input { array, index } => self.plan.loads.push(Load { array, index, slot }),
            // Steps are in order, so operands are already computed.
            Value::Step(_) => {}
        }
        slot
    }

    /// A new slot. Constants and inputs exist before the first pass, so their slots are not shared.
    fn fresh(&mut self) -> Slot {
        self.plan.slots += 1;
        self.plan.slots - 1
    }

    /// The slot of a result; an unused one gets a slot that is free.
    fn result(&mut self, value: Option<Value>) -> Slot {
        let slot = self.free.pop().unwrap_or_else(|| self.fresh());
        match value.filter(|value| self.needed.contains_key(value)) {
            Some(value) => {
                self.slots.insert(value, slot);
            }
            None => self.free.insert(0, slot),
        }
        slot
    }

    /// Ends a stage; delivers the waiting numbers.
    fn hand_out(&mut self) {
        let ends = |stage: &Stage| (stage.passes.end, stage.outputs.end);
        let (pass, output) = self.plan.stages.last().map_or((0, 0), ends);
        self.waiting.sort_unstable();
        for index in std::mem::take(&mut self.waiting) {
            let entry = self.program.entries[index];
            let value = Value::of(entry.operand);
            let slot = self.slot(value);
            self.plan.outputs.push(Output {
                index,
                slot,
                sign: if entry.negative { -1.0 } else { 1.0 },
            });
            self.used(value);
        }
        self.plan.stages.push(Stage {
            passes: pass..self.plan.passes.len(),
            outputs: output..self.plan.outputs.len(),
        });
    }

    fn finish(mut self) -> Plan {
        let guards = self.program.guards.iter().map(|g| Value::of(g.operand));
        self.plan.guards = guards.map(|value| self.slot(value)).collect();
        // Inputs of one array are loaded together.
        self.plan.loads.sort_by_key(|load| (load.array, load.index));
        self.plan
    }
}
