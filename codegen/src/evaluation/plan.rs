//! A program made ready for blocks: passes over a block, and the memory that values take.
//!
//! A value gets a slot of the memory, which is free again after the last use, so that what is alive at a
//! time stays in the nearest cache. Numbers of the output are handed out soon after they are computed, for
//! the same reason: a model has hundreds of them.

use super::fuse::{Draft, RESULTS, Value, drafts};
use crate::lowering::Program;
use std::{collections::HashMap, ops::Range};

/// A slot of the memory, which holds the values of one number over a block. Half a word, so that a pass is
/// half as long.
pub(super) type Slot = u32;

/// One pass over a block: one to three steps of the program.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Pass {
    pub(super) code: u8,
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
    /// Which one it is.
    pub(super) index: usize,
    pub(super) slot: Slot,
    /// -1 where its negative is meant, else 1.
    pub(super) sign: f64,
}

/// Some passes, and the numbers of the output that are handed out after them.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Stage {
    pub(super) passes: Range<usize>,
    pub(super) outputs: Range<usize>,
}

/// A program made ready for blocks.
#[derive(Debug, Default)]
pub(super) struct Plan {
    pub(super) passes: Vec<Pass>,
    pub(super) stages: Vec<Stage>,
    pub(super) constants: Vec<(Slot, f64)>,
    pub(super) loads: Vec<Load>,
    /// In the order in which they are handed out.
    pub(super) outputs: Vec<Output>,
    pub(super) guards: Vec<Slot>,
    /// Slots of the memory.
    pub(super) slots: Slot,
}

impl Plan {
    /// Makes a program ready whose numbers are handed out when `together` of them are there.
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
        // What is not computed: constants and inputs.
        planner.waiting.extend(outputs.into_values().flatten());
        planner.hand_out();
        planner.finish()
    }
}

/// Gives out slots, in the order of the passes.
struct Planner<'p> {
    program: &'p Program,
    plan: Plan,
    slots: HashMap<Value, Slot>,
    free: Vec<Slot>,
    /// How often a value is still needed, by passes, by the output and by guards.
    needed: HashMap<Value, usize>,
    /// The numbers of the output that are computed, and not handed out yet.
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
        // A result may take the place of an operand that ends here: all is read before it is written.
        draft.operands.iter().for_each(|&value| self.used(value));
        let results = draft.results.map(|value| self.result(value));
        self.plan.passes.push(Pass {
            code: draft.kind.code(),
            operands,
            results,
        });
    }

    /// A value is needed once less; where it is needed no more, its slot is free again. Inputs come again
    /// with the next block, constants do not.
    fn used(&mut self, value: Value) {
        let needed = self.needed.entry(value).or_default();
        *needed = needed.saturating_sub(1);
        if *needed == 0 && !matches!(value, Value::Constant(_)) {
            self.free.extend(self.slots.remove(&value));
        }
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
        match value.filter(|value| self.needed.contains_key(value)) {
            Some(value) => {
                self.slots.insert(value, slot);
            }
            None => self.free.insert(0, slot),
        }
        slot
    }

    /// Ends a stage with the numbers that wait.
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
