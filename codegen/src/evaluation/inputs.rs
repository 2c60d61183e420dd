//! Inputs on their way into a block: from rows to values that lie side by side.

use super::lanes::{Lanes, store};
use super::plan::{Load, Plan};
use super::turn::{Plain, SIDE, Turn};
use super::{BLOCK, Rows};
use crate::lowering::Program;
use pulp::NullaryFnOnce;
use std::cell::Cell;

/// Fills the slots of the inputs with those of `count` samples from sample `first` on. Lanes beyond the
/// last sample repeat it, so that they stay harmless.
pub(super) fn load(
    program: &Program,
    plan: &Plan,
    first: usize,
    count: usize,
    inputs: &[Rows<'_>],
    slots: &[Lanes],
) {
    for loads in plan.loads.chunk_by(|a, b| a.array == b.array) {
        let array = loads[0].array;
        let width = program.inputs[array].len();
        let Some(rows) = inputs.get(array) else {
            fill(loads, &[], slots);
            continue;
        };
        if rows.shared {
            fill(loads, rows.values, slots);
            continue;
        }
        let values = rows.values.get(first * width..).unwrap_or_default();
        let read = Read {
            loads,
            values,
            width,
            count: count.min(values.len() / width),
            slots,
            turn: Plain,
        };
        #[cfg(target_arch = "x86_64")]
        if let Some(simd) = pulp::x86::V3::try_new() {
            simd.vectorize(read.with(simd));
            continue;
        }
        read.call();
    }
}

/// The same values for all samples; zeros where there are none.
fn fill(loads: &[Load], values: &[f64], slots: &[Lanes]) {
    for load in loads {
        let value = values.get(load.index).copied().unwrap_or(0.0);
        slots[load.slot].iter().for_each(|lane| lane.set(value));
    }
}

/// Numbers of one array, whose rows have `width` of them, on their way to their slots.
struct Read<'a, T> {
    loads: &'a [Load],
    values: &'a [f64],
    width: usize,
    count: usize,
    slots: &'a [Lanes],
    turn: T,
}

impl<T: Turn> NullaryFnOnce for Read<'_, T> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        if self.count == 0 {
            return fill(self.loads, &[], self.slots);
        }
        let mut rest = self.loads;
        while let Some(load) = rest.first() {
            let together = rest.iter().take_while(|l| l.index < load.index + SIDE);
            let (part, others) = rest.split_at(together.count());
            self.part(load.index, part);
            rest = others;
        }
    }
}

impl<'a, T: Turn> Read<'a, T> {
    #[cfg(target_arch = "x86_64")]
    const fn with<U>(&self, turn: U) -> Read<'a, U> {
        Read {
            loads: self.loads,
            values: self.values,
            width: self.width,
            count: self.count,
            slots: self.slots,
            turn,
        }
    }

    /// Numbers of which the first one is number `index` of a row, and the last one less than [`SIDE`] behind.
    #[inline(always)]
    fn part(&self, index: usize, loads: &[Load]) {
        let (values, width) = (&self.values[index..], self.width);
        let unused: Lanes = [const { Cell::new(0.0) }; BLOCK];
        let targets: [&Lanes; SIDE] = std::array::from_fn(|side| {
            let load = loads.iter().find(|load| load.index == index + side);
            load.map_or(&unused, |load| &self.slots[load.slot])
        });
        let targets = targets.map(|lanes| lanes.as_chunks::<SIDE>().0);
        // Squares may reach into the next row, but not beyond the last one.
        let reach = (SIDE - 1) * width + SIDE;
        let mut turned = 0;
        while turned + SIDE <= self.count {
            let Some(rows) = values.get(turned * width..turned * width + reach) else {
                break;
            };
            let row = |k: usize| *rows[k * width..].first_chunk().unwrap_or(&[0.0; SIDE]);
            let (a, b, c, d) = self.turn.turn(row(0), row(1), row(2), row(3));
            store(&targets[0][turned / SIDE], a);
            store(&targets[1][turned / SIDE], b);
            store(&targets[2][turned / SIDE], c);
            store(&targets[3][turned / SIDE], d);
            turned += SIDE;
        }
        for load in loads {
            let lanes = &self.slots[load.slot];
            for (sample, lane) in lanes.iter().enumerate().take(self.count).skip(turned) {
                lane.set(self.values[sample * width + load.index]);
            }
            let last = lanes[self.count - 1].get();
            lanes[self.count..].iter().for_each(|lane| lane.set(last));
        }
    }
}
