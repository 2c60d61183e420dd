//! Programs evaluated over blocks of samples.
//!
//! Every step of a [`Program`] is one loop over the samples of a block, whose values lie side by side
//! (structure of arrays), so that the loops vectorise and the overhead of interpretation is shared by
//! the whole block. Numbers enter and leave sample by sample, row-major.

mod single;

use crate::lowering::{Condition, Operation, Program, SINGULAR, Source};
use wide::f64x4;

/// Samples per block: the values of a few hundred steps stay in the second-level cache.
pub const BLOCK: usize = 64;

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

/// Memory of an evaluation, to be used again.
#[derive(Debug, Default)]
pub struct Workspace {
    steps: Vec<[f64; BLOCK]>,
    inputs: Vec<[f64; BLOCK]>,
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
        workspace.steps.resize(self.steps.len(), [0.0; BLOCK]);
        workspace
            .inputs
            .resize(self.inputs.iter().map(|a| a.len()).sum(), [0.0; BLOCK]);
        let offsets = self.input_offsets();
        for start in (0..samples).step_by(BLOCK) {
            let count = BLOCK.min(samples - start);
            self.load(start, count, inputs, &mut workspace.inputs);
            for at in 0..self.steps.len() {
                let (done, rest) = workspace.steps.split_at_mut(at);
                let fetch = Fetch {
                    done,
                    inputs: &workspace.inputs,
                    offsets: &offsets,
                };
                run_step(self.steps[at].operation, &fetch, &mut rest[0]);
            }
            let fetch = Fetch {
                done: &workspace.steps,
                inputs: &workspace.inputs,
                offsets: &offsets,
            };
            self.check(&fetch, start, count)?;
            for (column, entry) in self.entries.iter().enumerate() {
                let sign = if entry.negative { -1.0 } else { 1.0 };
                for lane in 0..count {
                    if let Some(slot) = output.get_mut((start + lane) * width + column) {
                        *slot = sign * fetch.lane(entry.source, lane);
                    }
                }
            }
        }
        Ok(())
    }

    fn input_offsets(&self) -> Vec<usize> {
        let mut offset = 0;
        let mut next = |len: usize| {
            offset += len;
            offset - len
        };
        self.inputs.iter().map(|a| next(a.len())).collect()
    }

    fn load(&self, start: usize, count: usize, inputs: &[Rows<'_>], block: &mut [[f64; BLOCK]]) {
        let mut at = 0;
        for (array, rows) in self.inputs.iter().zip(inputs) {
            let len = array.len();
            for index in 0..len {
                for (lane, slot) in block[at + index].iter_mut().enumerate() {
                    // Lanes beyond the last sample repeat it, so that they stay harmless.
                    let row = if rows.shared {
                        0
                    } else {
                        start + lane.min(count - 1)
                    };
                    *slot = rows.values.get(row * len + index).copied().unwrap_or(0.0);
                }
            }
            at += len;
        }
    }

    fn check(&self, fetch: &Fetch<'_>, start: usize, count: usize) -> Result<(), Failed> {
        let mut first: Option<Failed> = None;
        for (index, guard) in self.guards.iter().enumerate() {
            for lane in 0..count {
                let value = fetch.lane(guard.source, lane);
                let sample = start + lane;
                let earlier = first.as_ref().is_none_or(|f| sample < f.sample);
                if !guard.condition.holds(value) && earlier {
                    first = Some(Failed {
                        sample,
                        guard: index,
                        value,
                    });
                }
            }
        }
        first.map_or(Ok(()), Err)
    }
}

impl Condition {
    /// Whether the condition holds for a value; never for NaN.
    #[must_use]
    pub fn holds(&self, value: f64) -> bool {
        match self {
            Self::Reach { .. } => value >= 0.0,
            Self::Leg { home, .. } | Self::Platform { home, .. } => value.abs() > SINGULAR * home,
        }
    }
}

struct Fetch<'a> {
    done: &'a [[f64; BLOCK]],
    inputs: &'a [[f64; BLOCK]],
    offsets: &'a [usize],
}

impl Fetch<'_> {
    fn lane(&self, source: Source, lane: usize) -> f64 {
        match source {
            Source::Constant(value) => value,
            Source::Input { array, index } => self.inputs[self.offsets[array] + index][lane],
            Source::Step(at) => self.done[at][lane],
        }
    }

    /// The values of an operand; a constant is spread.
    fn block(&self, source: Source) -> Operand<'_> {
        match source {
            Source::Constant(value) => Operand::Constant(value),
            Source::Input { array, index } => {
                Operand::Block(&self.inputs[self.offsets[array] + index])
            }
            Source::Step(at) => Operand::Block(&self.done[at]),
        }
    }
}

#[derive(Clone, Copy)]
enum Operand<'a> {
    Constant(f64),
    Block(&'a [f64; BLOCK]),
}

fn run_step(operation: Operation, fetch: &Fetch<'_>, out: &mut [f64; BLOCK]) {
    let binary = |a: Source, b: Source, out: &mut [f64; BLOCK], f: fn(f64, f64) -> f64| {
        zip(fetch.block(a), fetch.block(b), out, f);
    };
    match operation {
        Operation::Add(a, b) => binary(a, b, out, |a, b| a + b),
        Operation::Sub(a, b) => binary(a, b, out, |a, b| a - b),
        Operation::Mul(a, b) => binary(a, b, out, |a, b| a * b),
        Operation::Div(a, b) => binary(a, b, out, |a, b| a / b),
        Operation::Atan2(y, x) => binary(y, x, out, f64::atan2),
        Operation::Signed(a, b) => binary(a, b, out, signed),
        Operation::Neg(a) => binary(a, a, out, |a, _| -a),
        Operation::Sqrt(a) => binary(a, a, out, |a, _| a.sqrt()),
        Operation::Sign(a) => binary(a, a, out, |a, _| signed(1.0, a)),
        Operation::Sine(a) => trigonometric(fetch.block(a), out, f64::sin, f64x4::sin),
        Operation::Cosine(a) => trigonometric(fetch.block(a), out, f64::cos, f64x4::cos),
    }
}

/// a with the sign of b; zero where b is zero.
pub(crate) fn signed(a: f64, b: f64) -> f64 {
    if b > 0.0 {
        a
    } else if b < 0.0 {
        -a
    } else {
        0.0
    }
}

#[inline]
fn zip(a: Operand<'_>, b: Operand<'_>, out: &mut [f64; BLOCK], f: impl Fn(f64, f64) -> f64) {
    match (a, b) {
        (Operand::Block(a), Operand::Block(b)) => {
            for ((o, a), b) in out.iter_mut().zip(a).zip(b) {
                *o = f(*a, *b);
            }
        }
        (Operand::Constant(a), Operand::Block(b)) => {
            for (o, b) in out.iter_mut().zip(b) {
                *o = f(a, *b);
            }
        }
        (Operand::Block(a), Operand::Constant(b)) => {
            for (o, a) in out.iter_mut().zip(a) {
                *o = f(*a, b);
            }
        }
        (Operand::Constant(a), Operand::Constant(b)) => out.fill(f(a, b)),
    }
}

/// Sine or cosine, four lanes at a time.
fn trigonometric(
    a: Operand<'_>,
    out: &mut [f64; BLOCK],
    one: fn(f64) -> f64,
    four: fn(f64x4) -> f64x4,
) {
    let Operand::Block(angles) = a else {
        if let Operand::Constant(angle) = a {
            out.fill(one(angle));
        }
        return;
    };
    for (o, a) in out
        .as_chunks_mut::<4>()
        .0
        .iter_mut()
        .zip(angles.as_chunks::<4>().0)
    {
        *o = four(f64x4::new(*a)).to_array();
    }
}
