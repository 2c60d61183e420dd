//! Programs evaluated over blocks of samples.
//!
//! A [`Program`] becomes a plan: a list of passes over a block. Each pass computes one to three
//! steps for all samples of the block, in the widest vectors of the processor. Values of one number
//! are contiguous (structure of arrays), so the whole block shares the overhead of interpretation.
//! Inputs are row-major, sample by sample. Outputs are delivered number by number, soon after they
//! are computed ([`Evaluator::evaluate_numbers`]), or row-major ([`Evaluator::evaluate`]). The
//! latter takes several times as long, since a model has hundreds of numbers that have to be
//! transposed.

mod direction;
mod fuse;
mod guards;
mod inputs;
mod passes;
mod plan;
mod rows;
mod simd;
mod single;
mod tensions;
#[cfg(test)]
mod tests;
mod trigonometry;
mod turn;

use crate::lowering::Program;
use guards::check;
use plan::Plan;
use single::Single;
use std::cell::Cell;
use tensions::Tensions;

/// Samples per block: live values of a program fit into the first-level cache.
pub const BLOCK: usize = 64;

/// Numbers in a cache line.
const LINE: usize = 8;

/// Numbers of an output that are delivered at a time.
const TOGETHER: usize = 16;

/// A failed guard of a program, and the sample.
#[derive(Debug, Clone, PartialEq)]
pub struct Failed {
    /// The sample.
    pub sample: usize,
    /// Index of the guard; the number of guards if there are no tensions.
    pub guard: usize,
    /// The guarded value.
    pub value: f64,
}

/// An input of a block: one row of numbers per sample, or one row for all.
#[derive(Debug, Clone, Copy)]
pub struct Rows<'a> {
    /// The numbers.
    pub values: &'a [f64],
    /// Whether one row serves all samples.
    pub shared: bool,
}

/// One number of an output at successive samples.
#[derive(Debug, Clone, Copy)]
pub struct Number<'a> {
    /// Index of the number in the output.
    pub index: usize,
    /// The first sample.
    pub first: usize,
    /// Sign of the values: ±1. Numbers that differ by the sign only share their values.
    pub sign: f64,
    /// The values, at most [`BLOCK`].
    pub values: &'a [f64],
}

impl Program {
    /// Evaluates the program at `samples` samples.
    ///
    /// Each input has `len` numbers per sample (or once, if shared); the output receives one row
    /// per sample. An [`Evaluator`] repeats this without preparation.
    ///
    /// # Errors
    /// The first sample at which a guard fails. Inputs and outputs of a wrong length are an error
    /// of the caller and give an incomplete output.
    pub fn evaluate(
        &self,
        samples: usize,
        inputs: &[Rows<'_>],
        output: &mut [f64],
    ) -> Result<(), Failed> {
        match samples {
            1 if self.least_torques.is_empty() => single::evaluate(self, inputs, output),
            _ => Evaluator::new(self).evaluate(samples, inputs, output),
        }
    }
}

/// A program prepared for evaluation, with its memory.
#[derive(Debug)]
pub struct Evaluator {
    program: Program,
    single: Option<Single>,
    rows: Option<Memory>,
    numbers: Option<Memory>,
    tensions: Tensions,
}

impl Evaluator {
    /// Prepares a program. Data for single samples or for blocks are prepared at the first use.
    #[must_use]
    pub fn new(program: &Program) -> Self {
        Self {
            program: program.clone(),
            single: None,
            rows: None,
            numbers: None,
            tensions: Tensions::new(program),
        }
    }

    /// Evaluates the program at `samples` samples, like [`Program::evaluate`].
    ///
    /// # Errors
    /// The first sample at which a guard fails. Inputs and outputs of a wrong length are an error
    /// of the caller and give an incomplete output.
    pub fn evaluate(
        &mut self,
        samples: usize,
        inputs: &[Rows<'_>],
        output: &mut [f64],
    ) -> Result<(), Failed> {
        if self.program.least_torques.is_empty() {
            return self.evaluate_entries(samples, inputs, output);
        }
        let mut entries = std::mem::take(&mut self.tensions.entries);
        entries.resize(samples * self.program.entries.len(), 0.0);
        let evaluated = self.evaluate_entries(samples, inputs, &mut entries);
        let complete = evaluated
            .as_ref()
            .map_or_else(|failed| failed.sample, |()| samples);
        if complete < samples {
            // Samples before the failed one may have no tensions and then fail first. Entries of
            // its block are not written, so these samples are evaluated again.
            let again = self.evaluate_entries(complete, inputs, &mut entries);
            debug_assert!(again.is_ok(), "the first failed sample comes later");
        }
        let distributed = self
            .tensions
            .distribute(&self.program, complete, &entries, output);
        self.tensions.entries = entries;
        distributed.and(evaluated)
    }

    /// Evaluates the entries of the program.
    fn evaluate_entries(
        &mut self,
        samples: usize,
        inputs: &[Rows<'_>],
        output: &mut [f64],
    ) -> Result<(), Failed> {
        let program = &self.program;
        if samples == 1 {
            let single = self.single.get_or_insert_with(|| Single::new(program));
            return single.evaluate(program, inputs, output);
        }
        // Numbers of a row are adjacent, so they are moved when all are computed.
        let memory = self
            .rows
            .get_or_insert_with(|| Memory::new(program, usize::MAX));
        let width = program.entries.len();
        for first in (0..samples).step_by(BLOCK) {
            let count = BLOCK.min(samples - first);
            memory.load(program, first, count, inputs);
            for stage in 0..memory.plan.stages.len() {
                memory.run(stage);
            }
            let slots = memory.slots();
            check(&program.guards, &memory.plan.guards, slots, first, count)?;
            let block = rows::Block {
                outputs: &memory.plan.outputs,
                slots,
                samples: count,
            };
            let range = first * width..(first + count) * width;
            rows::write(&block, output.get_mut(range).unwrap_or_default());
        }
        Ok(())
    }

    /// Evaluates the program at `samples` samples, and delivers its numbers while they are in the
    /// first-level cache.
    ///
    /// The order is block by block; the numbers of a block have no particular order.
    ///
    /// # Errors
    /// The first sample at which a guard fails; numbers delivered from its block are invalid.
    /// Inputs of a wrong length are an error of the caller and count as zeros.
    pub fn evaluate_numbers(
        &mut self,
        samples: usize,
        inputs: &[Rows<'_>],
        mut take: impl FnMut(Number<'_>),
    ) -> Result<(), Failed> {
        let program = &self.program;
        let memory = self
            .numbers
            .get_or_insert_with(|| Memory::new(program, TOGETHER));
        for first in (0..samples).step_by(BLOCK) {
            let count = BLOCK.min(samples - first);
            memory.load(program, first, count, inputs);
            for stage in 0..memory.plan.stages.len() {
                memory.run(stage);
                let slots = memory.slots();
                for output in &memory.plan.outputs[memory.plan.stages[stage].outputs.clone()] {
                    take(Number {
                        index: output.index,
                        first,
                        sign: output.sign,
                        values: &slots[output.slot as usize][..count],
                    });
                }
            }
            let slots = memory.slots();
            check(&program.guards, &memory.plan.guards, slots, first, count)?;
        }
        Ok(())
    }
}

/// The slots of a plan, one block each.
#[derive(Debug)]
struct Memory {
    plan: Plan,
    /// The slots, after padding for alignment.
    values: Vec<f64>,
    start: usize,
}

impl Memory {
    /// Memory for a program whose numbers are delivered in groups of `together`.
    fn new(program: &Program, together: usize) -> Self {
        let plan = Plan::new(program, together);
        let mut values = vec![0.0; plan.slots as usize * BLOCK + LINE];
        // Vectors that cross a cache line take twice the time.
        let start = values.as_ptr().align_offset(LINE * size_of::<f64>());
        let start = start.min(LINE);
        let slots = values[start..].as_chunks_mut::<BLOCK>().0;
        for &(slot, value) in &plan.constants {
            slots[slot as usize].fill(value);
        }
        Self {
            plan,
            values,
            start,
        }
    }

    /// Loads the inputs at `count` samples from `first` on.
    fn load(&mut self, program: &Program, first: usize, count: usize, inputs: &[Rows<'_>]) {
        let values = Cell::from_mut(&mut self.values[self.start..]);
        let slots = values.as_slice_of_cells().as_chunks().0;
        inputs::load(program, &self.plan, first, count, inputs, slots);
    }

    /// Runs the passes of a stage.
    fn run(&mut self, stage: usize) {
        let values = Cell::from_mut(&mut self.values[self.start..]);
        let slots = values.as_slice_of_cells().as_chunks().0;
        let passes = self.plan.stages[stage].passes.clone();
        simd::run(&self.plan.passes[passes], slots);
    }

    fn slots(&self) -> &[[f64; BLOCK]] {
        self.values[self.start..].as_chunks().0
    }
}

/// a with the sign of b; zero if b is zero or NaN.
#[inline(always)]
pub(crate) fn signed(a: f64, b: f64) -> f64 {
    // On bits, for which all processors have vector operations.
    let sign = b.to_bits() & (-0.0_f64).to_bits();
    if b.abs() > 0.0 {
        f64::from_bits(a.to_bits() ^ sign)
    } else {
        0.0
    }
}
