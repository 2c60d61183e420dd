//! Runs the passes over a block, in the widest vectors of the processor.
//!
//! The code consists of loops over arrays. It is compiled once for every vector width, and chosen
//! at run time. No pass fuses a multiplication and an addition into one rounding, except in the
//! polynomials of sines, cosines and angles of directions, which dominate the arithmetic. AVX2 and
//! AVX-512 give identical results.

use super::BLOCK;
use super::direction::{angles, are_usual};
use super::passes::{Worker, work};
use super::plan::{Pass, Slot};
use super::trigonometry::{are_small, sines_and_cosines};
use pulp::NullaryFnOnce;
use std::cell::Cell;

/// Number of values per iteration: the widest vector.
pub(super) const WIDTH: usize = 8;

/// The values of one number at the samples of a block.
///
/// They are cells, because a step's result may overwrite its operands.
pub(super) type Lanes = [Cell<f64>; BLOCK];

/// Runs passes over a block.
pub(super) fn run(passes: &[Pass], blocks: &[Lanes]) {
    #[cfg(target_arch = "x86_64")]
    {
        let run = Run::<true> { passes, blocks };
        if let Some(simd) = pulp::x86::V4::try_new() {
            return simd.vectorize(run);
        }
        if let Some(simd) = pulp::x86::V3::try_new() {
            return simd.vectorize(run);
        }
    }
    Run::<false> { passes, blocks }.call();
}

/// `FUSED`: whether the processor adds a product with a single rounding.
#[derive(Clone, Copy)]
struct Run<'a, const FUSED: bool> {
    passes: &'a [Pass],
    blocks: &'a [Lanes],
}

impl<const FUSED: bool> NullaryFnOnce for Run<'_, FUSED> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        for pass in self.passes {
            work(pass, &self);
        }
    }
}

impl<'a, const FUSED: bool> Run<'a, FUSED> {
    #[inline(always)]
    fn block(&self, slot: Slot) -> &'a [[Cell<f64>; WIDTH]] {
        self.blocks[slot as usize].as_chunks().0
    }

    /// Sines and cosines by the library, kept out of line.
    #[cold]
    #[inline(never)]
    fn large_angles(&self, at: &Pass) {
        let [angles, sines, cosines] =
            [at.operands[0], at.results[0], at.results[1]].map(|slot| &self.blocks[slot as usize]);
        for ((angle, sine), cosine) in angles.iter().zip(sines).zip(cosines) {
            let angle = angle.get();
            sine.set(angle.sin());
            cosine.set(angle.cos());
        }
    }

    /// Angles of directions by the library, kept out of line.
    #[cold]
    #[inline(never)]
    fn unusual_directions(&self, at: &Pass) {
        let [y, x, angles] =
            [at.operands[0], at.operands[1], at.results[0]].map(|slot| &self.blocks[slot as usize]);
        for ((y, x), angle) in y.iter().zip(x).zip(angles) {
            angle.set(y.get().atan2(x.get()));
        }
    }
}

impl<const FUSED: bool> Worker for Run<'_, FUSED> {
    #[inline(always)]
    fn each<const N: usize>(&self, at: &Pass, f: impl Fn([f64; N]) -> f64) {
        // Loops, because closures for arrays would double the compile time.
        let mut operands = [self.block(at.operands[0]); N];
        for (operand, slot) in operands.iter_mut().zip(at.operands) {
            *operand = self.block(slot);
        }
        let results = self.block(at.results[0]);
        for part in 0..BLOCK / WIDTH {
            let mut values = [[0.0; WIDTH]; N];
            for i in 0..N {
                values[i] = load(&operands[i][part]);
            }
            let mut found = [0.0; WIDTH];
            for k in 0..WIDTH {
                let mut own = [0.0; N];
                for i in 0..N {
                    own[i] = values[i][k];
                }
                found[k] = f(own);
            }
            store(&results[part], found);
        }
    }

    #[inline(always)]
    fn two(&self, at: &Pass, f: impl Fn(f64, f64) -> f64) {
        let operands: [_; 3] = std::array::from_fn(|i| self.block(at.operands[i]));
        let results: [_; 2] = std::array::from_fn(|i| self.block(at.results[i]));
        for part in 0..BLOCK / WIDTH {
            let [a, b, c] = operands.map(|operand| load(&operand[part]));
            store(&results[0][part], both(a, b, &f));
            store(&results[1][part], both(a, c, &f));
        }
    }

    #[inline(always)]
    fn three(&self, at: &Pass, f: impl Fn(f64, f64) -> f64) {
        let operands: [_; 4] = std::array::from_fn(|i| self.block(at.operands[i]));
        let results: [_; 3] = std::array::from_fn(|i| self.block(at.results[i]));
        for part in 0..BLOCK / WIDTH {
            let [a, b, c, d] = operands.map(|operand| load(&operand[part]));
            store(&results[0][part], both(a, b, &f));
            store(&results[1][part], both(a, c, &f));
            store(&results[2][part], both(a, d, &f));
        }
    }

    #[inline(always)]
    fn angles(&self, at: &Pass) {
        let angles = self.block(at.operands[0]);
        let (sines, cosines) = (self.block(at.results[0]), self.block(at.results[1]));
        // Checked for the whole block, so that the loop has no branches. NaN results in NaN either
        // way.
        let mut largest = [0.0_f64; WIDTH];
        for part in angles {
            let part = load(part);
            largest = std::array::from_fn(|k| {
                let angle = part[k].abs();
                if angle > largest[k] {
                    angle
                } else {
                    largest[k]
                }
            });
        }
        if !are_small(&largest) {
            return self.large_angles(at);
        }
        for part in 0..BLOCK / WIDTH {
            let (sine, cosine) = sines_and_cosines::<WIDTH, FUSED>(load(&angles[part]));
            store(&sines[part], sine);
            store(&cosines[part], cosine);
        }
    }

    #[inline(always)]
    fn directions(&self, at: &Pass) {
        let [y, x, found] =
            [at.operands[0], at.operands[1], at.results[0]].map(|slot| self.block(slot));
        // Samples after the last one may be anything; the library handles them, too.
        let mut usual = true;
        for (y, x) in y.iter().zip(x) {
            usual &= are_usual(&load(y), &load(x));
        }
        if !usual {
            return self.unusual_directions(at);
        }
        for part in 0..BLOCK / WIDTH {
            let angles = angles::<WIDTH, FUSED>(load(&y[part]), load(&x[part]));
            store(&found[part], angles);
        }
    }
}

#[inline(always)]
fn both(a: [f64; WIDTH], b: [f64; WIDTH], f: impl Fn(f64, f64) -> f64) -> [f64; WIDTH] {
    std::array::from_fn(|k| f(a[k], b[k]))
}

#[inline(always)]
fn load<const N: usize>(from: &[Cell<f64>; N]) -> [f64; N] {
    let mut values = [0.0; N];
    for k in 0..N {
        values[k] = from[k].get();
    }
    values
}

#[inline(always)]
pub(super) fn store<const N: usize>(to: &[Cell<f64>; N], values: [f64; N]) {
    for k in 0..N {
        to[k].set(values[k]);
    }
}
