//! Stores outputs of a block: transposes contiguous values to rows, in whole cache lines.

use super::plan::Output;
use super::turn::{Plain, SIDE, Turn};
use super::{BLOCK, LINE};
use pulp::NullaryFnOnce;

/// All numbers of an output over a block, in order.
#[derive(Clone, Copy)]
pub(super) struct Block<'a> {
    pub(super) outputs: &'a [Output],
    pub(super) slots: &'a [[f64; BLOCK]],
    pub(super) samples: usize,
}

/// Writes a block as rows, one for every sample.
pub(super) fn write(block: &Block<'_>, rows: &mut [f64]) {
    #[cfg(target_arch = "x86_64")]
    if let Some(simd) = pulp::x86::V3::try_new() {
        return simd.vectorize(Write {
            block,
            rows,
            turn: simd,
        });
    }
    let turn = Plain;
    Write { block, rows, turn }.call();
}

struct Write<'a, T> {
    block: &'a Block<'a>,
    rows: &'a mut [f64],
    turn: T,
}

impl<T: Turn> NullaryFnOnce for Write<'_, T> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { block, rows, turn } = self;
        let width = block.outputs.len();
        if width == 0 {
            return;
        }
        let (lines, rest) = block.outputs.as_chunks::<LINE>();
        let whole = block.samples / SIDE;
        for (line, outputs) in lines.iter().enumerate() {
            let columns =
                outputs.map(|output| block.slots[output.slot as usize].as_chunks::<SIDE>().0);
            let signs = outputs.map(|output| output.sign);
            for (group, rows) in rows.chunks_exact_mut(SIDE * width).enumerate().take(whole) {
                let side = |k: usize| columns[k][group].map(|x| x * signs[k]);
                let left = turn.turn(side(0), side(1), side(2), side(3));
                let right = turn.turn(side(4), side(5), side(6), side(7));
                let (rows, more) = rows.split_at_mut(2 * width);
                let (first, second) = rows.split_at_mut(width);
                let (third, fourth) = more.split_at_mut(width);
                put(first, line, left.0, right.0);
                put(second, line, left.1, right.1);
                put(third, line, left.2, right.2);
                put(fourth, line, left.3, right.3);
            }
        }
        let done = lines.len() * LINE;
        number_by_number(block, rest, done, 0, rows);
        number_by_number(block, &block.outputs[..done], 0, whole * SIDE, rows);
    }
}

/// Writes cache line `line` of a row.
#[inline(always)]
fn put(row: &mut [f64], line: usize, left: [f64; SIDE], right: [f64; SIDE]) {
    let place = &mut row[line * LINE..(line + 1) * LINE];
    place[..SIDE].copy_from_slice(&left);
    place[SIDE..].copy_from_slice(&right);
}

/// Writes `outputs`, from column `column` on, at the samples from `first` on.
#[inline(always)]
fn number_by_number(
    block: &Block<'_>,
    outputs: &[Output],
    column: usize,
    first: usize,
    rows: &mut [f64],
) {
    let width = block.outputs.len();
    for (at, output) in outputs.iter().enumerate() {
        let values: &[f64; BLOCK] = &block.slots[output.slot as usize];
        let Some(places) = rows.get_mut(first * width + column + at..) else {
            return;
        };
        for (place, value) in places.iter_mut().step_by(width).zip(&values[first..]) {
            *place = value * output.sign;
        }
    }
}
