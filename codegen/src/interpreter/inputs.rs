//! Loads inputs into a block: transposes rows of samples to contiguous values.

use super::plan::{Load, Plan};
use super::simd::{Lanes, WIDTH, store};
use super::{BLOCK, Rows};
use crate::lowering::Program;

/// Fills the slots of the inputs for `count` samples from sample `first` on.
///
/// Lanes after the last sample repeat it, so that they are harmless.
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
        let values = values.get(..count * width).unwrap_or(values);
        read(loads, values, width, slots);
    }
}

/// Fills slots with the same value for all samples; zero if it is missing.
fn fill(loads: &[Load], values: &[f64], slots: &[Lanes]) {
    for load in loads {
        let value = values.get(load.index).copied().unwrap_or(0.0);
        slots[load.slot as usize]
            .iter()
            .for_each(|lane| lane.set(value));
    }
}

/// Loads the numbers of one array, with rows of length `width`, into their slots.
fn read(loads: &[Load], values: &[f64], width: usize, slots: &[Lanes]) {
    macro_rules! of_width {
        ($($known:literal)*) => {
            match width {
                $($known => read_vectors::<$known>(loads, values, slots),)*
                _ => 0,
            }
        };
    }
    // Constant widths halve the time.
    let done = of_width!(1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16);
    let count = values.len() / width;
    for load in loads {
        let lanes = &slots[load.slot as usize];
        for (sample, lane) in lanes.iter().enumerate().take(count).skip(done) {
            lane.set(values[sample * width + load.index]);
        }
        if count < BLOCK {
            let last = count.checked_sub(1).map_or(0.0, |last| lanes[last].get());
            lanes[count..].iter().for_each(|lane| lane.set(last));
        }
    }
}

/// Loads as many samples as fill whole vectors; returns their number.
fn read_vectors<const N: usize>(loads: &[Load], values: &[f64], slots: &[Lanes]) -> usize {
    let vectors = values.as_chunks::<N>().0.as_chunks::<WIDTH>().0;
    for load in loads.iter().filter(|load| load.index < N) {
        let parts = slots[load.slot as usize].as_chunks::<WIDTH>().0;
        for (part, rows) in parts.iter().zip(vectors) {
            store(part, std::array::from_fn(|k| rows[k][load.index]));
        }
    }
    vectors.len() * WIDTH
}
