//! Programs evaluated over blocks of samples.
//!
//! A [`Program`] becomes a plan: a list of passes over a block, each of which computes one to three steps
//! for all its samples at once, with the widest vectors that the processor has. The values of a number
//! lie side by side (structure of arrays), and the overhead of interpretation is shared by the whole
//! block. Numbers enter sample by sample, row-major; they are handed out block by block as they lie
//! ([`Program::evaluate_blocks`]), or row-major too ([`Program::evaluate`]), which takes about as long
//! again: a model has hundreds of numbers, and each has to be moved.

mod fuse;
mod inputs;
mod lanes;
mod plan;
mod rows;
mod single;
#[cfg(test)]
mod tests;
mod trigonometry;
mod turn;

use crate::lowering::{Condition, Program, SINGULAR};
use plan::{Output, Plan};
use std::cell::Cell;

/// Samples per block: what a program has alive stays in the nearest caches.
pub const BLOCK: usize = 64;

/// Numbers in a line of the cache.
const LINE: usize = 8;

/// A program whose condition failed at a sample.
#[derive(Debug, Clone, PartialEq)]
pub struct Failed {
    /// The sample.
    pub sample: usize,
    /// Index of the guard.
    pub guard: usize,
    /// The guarded value.
    pub value: f64,
}

/// Memory of an evaluation, to be used again. It remembers the plan of its last program.
#[derive(Debug, Default)]
pub struct Workspace {
    plan: Plan,
    /// The slots of the plan, a block each, behind what aligns them.
    memory: Vec<f64>,
    start: usize,
    single: Vec<f64>,
}

/// An input of a block: one row of numbers per sample, or one row for all.
#[derive(Debug, Clone, Copy)]
pub struct Rows<'a> {
    /// The numbers.
    pub values: &'a [f64],
    /// Whether one row serves all samples.
    pub shared: bool,
}

/// The numbers of an output over a block of samples.
#[derive(Debug, Clone, Copy)]
pub struct Block<'a> {
    outputs: &'a [Output],
    slots: &'a [[f64; BLOCK]],
    first: usize,
    samples: usize,
}

impl<'a> Block<'a> {
    /// The first sample.
    #[must_use]
    pub const fn first(&self) -> usize {
        self.first
    }

    /// Number of samples, at most [`BLOCK`].
    #[must_use]
    pub const fn samples(&self) -> usize {
        self.samples
    }

    /// The values at all samples of number `index` of the output, and the sign to give them: ±1. Numbers
    /// that are equal but for the sign share their values.
    #[must_use]
    pub fn column(&self, index: usize) -> Option<(f64, &'a [f64])> {
        let output = self.outputs.get(index)?;
        let values = self.slots[output.slot].get(..self.samples)?;
        Some((if output.negative { -1.0 } else { 1.0 }, values))
    }
}

impl Program {
    /// Evaluates the program at `samples` samples. Each input holds `len` numbers per sample (or once,
    /// if shared); the output receives as many rows.
    ///
    /// # Errors
    /// The first sample at which a guard fails. Inputs and outputs of a wrong length are the caller's
    /// error and give an incomplete output.
    pub fn evaluate(
        &self,
        samples: usize,
        inputs: &[Rows<'_>],
        output: &mut [f64],
        workspace: &mut Workspace,
    ) -> Result<(), Failed> {
        if samples == 1 {
            return single::evaluate(self, inputs, output, &mut workspace.single);
        }
        let width = self.entries.len();
        self.evaluate_blocks(samples, inputs, workspace, |block| {
            let range = block.first * width..(block.first + block.samples) * width;
            rows::write(&block, output.get_mut(range).unwrap_or_default());
        })
    }

    /// Evaluates the program at `samples` samples, and hands out the numbers of its output block by block.
    ///
    /// # Errors
    /// The first sample at which a guard fails; its block is not handed out. Inputs of a wrong length are
    /// the caller's error and count as zeros.
    pub fn evaluate_blocks(
        &self,
        samples: usize,
        inputs: &[Rows<'_>],
        workspace: &mut Workspace,
        mut take: impl FnMut(Block<'_>),
    ) -> Result<(), Failed> {
        workspace.prepare(self);
        for first in (0..samples).step_by(BLOCK) {
            let count = BLOCK.min(samples - first);
            let memory = &mut workspace.memory[workspace.start..];
            let slots = Cell::from_mut(memory).as_slice_of_cells().as_chunks().0;
            inputs::load(self, &workspace.plan, first, count, inputs, slots);
            lanes::run(&workspace.plan, slots);
            let block = Block {
                outputs: &workspace.plan.outputs,
                slots: workspace.memory[workspace.start..].as_chunks().0,
                first,
                samples: count,
            };
            self.check(&workspace.plan.guards, &block)?;
            take(block);
        }
        Ok(())
    }

    fn check(&self, guards: &[plan::Slot], block: &Block<'_>) -> Result<(), Failed> {
        let mut first: Option<Failed> = None;
        for (index, (guard, slot)) in self.guards.iter().zip(guards).enumerate() {
            let values = &block.slots[*slot][..block.samples];
            if guard.condition.holds_for_all(values) {
                continue;
            }
            let failed = values.iter().position(|v| !guard.condition.holds(*v));
            let earlier = |lane: &usize| {
                let sample = block.first + lane;
                first.as_ref().is_none_or(|f| sample < f.sample)
            };
            if let Some(lane) = failed.filter(earlier) {
                first = Some(Failed {
                    sample: block.first + lane,
                    guard: index,
                    value: values[lane],
                });
            }
        }
        first.map_or(Ok(()), Err)
    }
}

impl Workspace {
    /// Makes the memory fit a program.
    fn prepare(&mut self, program: &Program) {
        if self.plan.is_of(program) {
            return;
        }
        self.plan = Plan::new(program);
        self.memory = vec![0.0; self.plan.slots * BLOCK + LINE];
        // Vectors that lie across two lines of the cache take twice the time.
        self.start = self.memory.as_ptr().align_offset(LINE * size_of::<f64>());
        self.start = self.start.min(LINE);
        let slots = self.memory[self.start..].as_chunks_mut::<BLOCK>().0;
        for &(slot, value) in &self.plan.constants {
            slots[slot].fill(value);
        }
    }
}

impl Condition {
    /// Whether the condition holds for a value; never for NaN.
    #[must_use]
    pub fn holds(&self, value: f64) -> bool {
        self.holds_for_all(&[value])
    }

    /// Whether the condition holds for all values.
    #[must_use]
    pub fn holds_for_all(&self, values: &[f64]) -> bool {
        // Without an early end, so that several values are compared at a time.
        match self {
            Self::Reach { .. } => values.iter().fold(true, |all, v| all & (*v >= 0.0)),
            Self::Leg { home, .. } | Self::Platform { home, .. } => {
                let least = SINGULAR * home;
                values.iter().fold(true, |all, v| all & (v.abs() > least))
            }
        }
    }
}

/// a with the sign of b; zero where b is zero or no number.
#[inline(always)]
pub(crate) fn signed(a: f64, b: f64) -> f64 {
    // On bits, which vectors of all processors have operations for.
    let sign = b.to_bits() & (-0.0_f64).to_bits();
    if b.abs() > 0.0 {
        f64::from_bits(a.to_bits() ^ sign)
    } else {
        0.0
    }
}
