//! Groups of samples from one kept sample to the next, as sums over the modes of the low-pass.
//!
//! A group of N samples u_k contributes
//!
//! ```text
//! F_i = Σ p_i^k u_k,   R_i = Σ p_i^(N-1-k) u_k,
//! X_i' = p_i^N X_i + p_i R_i,   B_i = F_i + p_i^N B_i',   kept value = c u_0 + 2 Re Σ r_i (X_i + B_i),
//! ```
//!
//! where X_i is before the group and B_i' after it. F and R have the same weights in opposite
//! order. Both follow from the sums u_k + u_(N-1-k) and differences u_k - u_(N-1-k), with the even
//! and odd parts of the weights. All signals are processed in parallel, and no discarded sample is
//! filtered. Signals that have been zero so far, as many columns of robots without loops, stay zero.

use nalgebra::Complex;
use pulp::{Arch, Simd, WithSimd};

use super::modes::{Mode, Modes};

/// Number of modes of the low-pass: half its order.
const MODES: usize = 4;

/// Vector length from which on registers suffice for two vectors of signals.
const WIDE: usize = 8;

/// Real and imaginary parts of all modes.
pub(super) const PARTS: usize = 2 * MODES;

/// Weights for groups of one length.
#[derive(Debug, PartialEq)]
pub(super) struct Groups {
    pub(super) length: usize,
    pub(super) modes: Modes,
    /// Even and odd parts of the weights, from the first sample to the middle.
    even: Vec<[f64; PARTS]>,
    odd: Vec<[f64; PARTS]>,
    /// p_i^N.
    powers: Vec<Mode>,
}

impl Groups {
    pub(super) fn new(modes: Modes, length: usize) -> Self {
        let mut weights = vec![[0.0; PARTS]; length];
        let mut powers = Vec::new();
        for (place, pole) in modes.poles.iter().enumerate() {
            let mut power = Complex::new(1.0, 0.0);
            for weights in &mut weights {
                [weights[2 * place], weights[2 * place + 1]] = [power.re, power.im];
                power *= pole;
            }
            powers.push(power);
        }
        let part = |sign: f64, k: usize| -> [f64; PARTS] {
            let (near, far) = (&weights[k], &weights[length - 1 - k]);
            std::array::from_fn(|own| 0.5 * (near[own] + sign * far[own]))
        };
        Self {
            // The middle sample of an odd number is its own partner, so it is not doubled.
            even: (0..length.div_ceil(2)).map(|k| part(1.0, k)).collect(),
            odd: (0..length / 2).map(|k| part(-1.0, k)).collect(),
            length,
            modes,
            powers,
        }
    }

    /// Runs a group forwards: `rows` of all signals.
    ///
    /// `before` is X, and `after` receives that of the next group. `partial` receives F, then the
    /// partial kept values. All contain the real parts of a mode for all signals, then the
    /// imaginary ones.
    pub(super) fn pass(
        &self,
        rows: &[f64],
        before: &[f64],
        after: &mut [f64],
        partial: &mut [f64],
    ) {
        Arch::new().dispatch(Pass {
            groups: self,
            rows,
            width: before.len() / PARTS,
            before,
            after,
            partial,
        });
    }

    /// Runs a group backwards.
    ///
    /// `partial` is its result of the forward pass. `after` is B' and becomes B. Kept values are
    /// written to `kept` if requested.
    pub(super) fn pass_backwards(
        &self,
        partial: &[f64],
        after: &mut [f64],
        kept: Option<&mut [f64]>,
    ) {
        Arch::new().dispatch(Backwards {
            groups: self,
            partial,
            after,
            kept,
        });
    }
}

/// Forward pass of a group.
struct Pass<'a> {
    groups: &'a Groups,
    rows: &'a [f64],
    width: usize,
    before: &'a [f64],
    after: &'a mut [f64],
    partial: &'a mut [f64],
}

impl WithSimd for Pass<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        if self.width < S::F64_LANES {
            self.padded(simd);
        } else {
            self.all(simd);
        }
    }
}

impl Pass<'_> {
    /// Processes all signals, at least one vector of them.
    #[inline(always)]
    fn all<S: Simd>(mut self, simd: S) {
        let (lanes, width) = (S::F64_LANES, self.width);
        let mut first = 0;
        // With enough registers, a weight serves two vectors of signals.
        while lanes >= WIDE && first + 2 * lanes <= width {
            self.columns::<S, 2>(simd, first);
            first += 2 * lanes;
        }
        while first < width {
            // The last vector overlaps the one before, with equal results.
            self.columns::<S, 1>(simd, first.min(width - lanes));
            first += lanes;
        }
    }

    /// Processes fewer signals than a vector has.
    #[inline(always)]
    fn padded<S: Simd>(self, simd: S) {
        let (lanes, width) = (S::F64_LANES, self.width);
        let widened = |values: &[f64]| -> Vec<f64> {
            let mut all = vec![0.0; values.len() / width * lanes];
            let rows = all.chunks_exact_mut(lanes).zip(values.chunks_exact(width));
            rows.for_each(|(to, from)| to[..width].copy_from_slice(from));
            all
        };
        let (rows, before) = (widened(self.rows), widened(self.before));
        let mut after = vec![0.0; before.len()];
        let mut partial = vec![0.0; (PARTS + 1) * lanes];
        let wide = Pass {
            groups: self.groups,
            rows: &rows,
            width: lanes,
            before: &before,
            after: &mut after,
            partial: &mut partial,
        };
        wide.all(simd);
        for (to, from) in [(self.after, &after), (self.partial, &partial)] {
            let rows = to.chunks_exact_mut(width).zip(from.chunks_exact(lanes));
            rows.for_each(|(to, from)| to.copy_from_slice(&from[..width]));
        }
    }

    /// Processes `N` vectors of signals from number `column` on.
    #[inline(always)]
    fn columns<S: Simd, const N: usize>(&mut self, simd: S, column: usize) {
        let groups = self.groups;
        if self.are_zero::<S, N>(simd, column) {
            self.put_zeros::<S, N>(simd, column);
            return;
        }
        let even = self.folded::<S, N>(
            simd,
            column,
            &groups.even,
            #[inline(always)]
            |near, far| simd.add_f64s(near, far),
        );
        let odd = self.folded::<S, N>(
            simd,
            column,
            &groups.odd,
            #[inline(always)]
            |near, far| simd.sub_f64s(near, far),
        );
        for (place, (even, odd)) in even.iter().zip(&odd).enumerate() {
            self.put(simd, column + place * S::F64_LANES, even, odd);
        }
    }

    /// Whether vectors of signals are zero in the group and before it.
    #[inline(always)]
    fn are_zero<S: Simd, const N: usize>(&self, simd: S, column: usize) -> bool {
        // Other signals mostly differ from zero in the first row.
        for row in 0..self.groups.length {
            if !is_zero::<S, N>(simd, self.rows, row * self.width + column) {
                return false;
            }
        }
        for part in 0..PARTS {
            if !is_zero::<S, N>(simd, self.before, part * self.width + column) {
                return false;
            }
        }
        true
    }

    /// Stores the results for vectors of zeros.
    #[inline(always)]
    fn put_zeros<S: Simd, const N: usize>(&mut self, simd: S, column: usize) {
        for first in (0..N).map(|place| column + place * S::F64_LANES) {
            for part in 0..PARTS {
                let place = part * self.width + first;
                *vector_mut::<S>(self.partial, place) = simd.splat_f64s(0.0);
                *vector_mut::<S>(self.after, place) = simd.splat_f64s(0.0);
            }
            let place = PARTS * self.width + first;
            *vector_mut::<S>(self.partial, place) = simd.splat_f64s(0.0);
        }
    }

    /// Weighted sums of each sample combined with its mirror image.
    ///
    /// The middle sample of an odd number is its own partner.
    #[inline(always)]
    fn folded<S: Simd, const N: usize>(
        &self,
        simd: S,
        column: usize,
        all: &[[f64; PARTS]],
        meet: impl Fn(S::f64s, S::f64s) -> S::f64s,
    ) -> [[S::f64s; PARTS]; N] {
        let (last, width) = (self.groups.length - 1, self.width);
        let mut sums = [[simd.splat_f64s(0.0); PARTS]; N];
        for (k, weights) in all.iter().enumerate() {
            let mut samples = vectors::<S, N>(self.rows, k * width + column);
            if 2 * k != last {
                let far = vectors::<S, N>(self.rows, (last - k) * width + column);
                for place in 0..N {
                    samples[place] = meet(samples[place], far[place]);
                }
            }
            add::<S, N>(simd, &mut sums, &samples, weights);
        }
        sums
    }

    /// Stores the results of sums and differences for a vector of signals.
    #[inline(always)]
    fn put<S: Simd>(
        &mut self,
        simd: S,
        column: usize,
        even: &[S::f64s; PARTS],
        odd: &[S::f64s; PARTS],
    ) {
        let (groups, width) = (self.groups, self.width);
        let direct = simd.splat_f64s(groups.modes.direct);
        let mut kept = simd.mul_f64s(direct, vector::<S>(self.rows, column));
        for mode in 0..MODES {
            let places = [2 * mode, 2 * mode + 1].map(|part| part * width + column);
            let [x, y] = places.map(|place| vector::<S>(self.before, place));
            let (a, b) = (even[2 * mode], odd[2 * mode]);
            let (c, d) = (even[2 * mode + 1], odd[2 * mode + 1]);
            let share = 2.0 * groups.modes.shares[mode];
            kept = simd.add_f64s(kept, times(simd, share, x, y)[0]);
            *vector_mut::<S>(self.partial, places[0]) = simd.add_f64s(a, b);
            *vector_mut::<S>(self.partial, places[1]) = simd.add_f64s(c, d);
            let (late, turned) = (simd.sub_f64s(a, b), simd.sub_f64s(c, d));
            let late = times(simd, groups.modes.poles[mode], late, turned);
            let old = times(simd, groups.powers[mode], x, y);
            for part in 0..2 {
                let new = simd.add_f64s(old[part], late[part]);
                *vector_mut::<S>(self.after, places[part]) = new;
            }
        }
        *vector_mut::<S>(self.partial, PARTS * width + column) = kept;
    }
}

/// Adds samples of `N` vectors of signals, weighted for all parts, to `sums`.
#[inline(always)]
fn add<S: Simd, const N: usize>(
    simd: S,
    sums: &mut [[S::f64s; PARTS]; N],
    samples: &[S::f64s; N],
    weights: &[f64; PARTS],
) {
    for part in 0..PARTS {
        let weight = simd.splat_f64s(weights[part]);
        for place in 0..N {
            sums[place][part] = simd.mul_add_e_f64s(weight, samples[place], sums[place][part]);
        }
    }
}

/// A complex factor times a vector of complex numbers x + i y, as real and imaginary parts.
#[inline(always)]
fn times<S: Simd>(simd: S, factor: Mode, x: S::f64s, y: S::f64s) -> [S::f64s; 2] {
    let [a, b] = [factor.re, factor.im].map(|part| simd.splat_f64s(part));
    [
        simd.sub_f64s(simd.mul_f64s(a, x), simd.mul_f64s(b, y)),
        simd.add_f64s(simd.mul_f64s(a, y), simd.mul_f64s(b, x)),
    ]
}

/// Whether `N` vectors of successive numbers are zero.
#[inline(always)]
fn is_zero<S: Simd, const N: usize>(simd: S, values: &[f64], first: usize) -> bool {
    let mut sum = simd.splat_f64s(0.0);
    for own in vectors::<S, N>(values, first) {
        sum = simd.add_f64s(sum, simd.abs_f64s(own));
    }
    simd.reduce_sum_f64s(sum) == 0.0
}

/// `N` vectors of successive numbers.
#[inline(always)]
fn vectors<S: Simd, const N: usize>(values: &[f64], first: usize) -> [S::f64s; N] {
    let all = S::as_simd_f64s(&values[first..first + N * S::F64_LANES]).0;
    std::array::from_fn(
        #[inline(always)]
        |place| all[place],
    )
}

/// A vector of successive numbers.
#[inline(always)]
fn vector<S: Simd>(values: &[f64], first: usize) -> S::f64s {
    S::as_simd_f64s(&values[first..first + S::F64_LANES]).0[0]
}

/// A mutable vector of successive numbers.
#[inline(always)]
fn vector_mut<S: Simd>(values: &mut [f64], first: usize) -> &mut S::f64s {
    &mut S::as_mut_simd_f64s(&mut values[first..first + S::F64_LANES]).0[0]
}

/// Backward pass of a group.
struct Backwards<'a> {
    groups: &'a Groups,
    partial: &'a [f64],
    after: &'a mut [f64],
    kept: Option<&'a mut [f64]>,
}

impl WithSimd for Backwards<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) {
        let width = self.after.len() / PARTS;
        if let Some(kept) = &mut self.kept {
            kept.copy_from_slice(&self.partial[PARTS * width..]);
        }
        let partial = self.partial.chunks_exact(2 * width);
        let modes = self.after.chunks_exact_mut(2 * width).zip(partial);
        for ((mode, (after, partial)), power) in modes.enumerate().zip(&self.groups.powers) {
            let share = 2.0 * self.groups.modes.shares[mode];
            let (real, imaginary) = after.split_at_mut(width);
            let (f, g) = partial.split_at(width);
            let (real, more) = S::as_mut_simd_f64s(real);
            let (imaginary, rest) = S::as_mut_simd_f64s(imaginary);
            let ((f, last), (g, end)) = (S::as_simd_f64s(f), S::as_simd_f64s(g));
            let mut kept = self.kept.as_deref_mut().map(S::as_mut_simd_f64s);
            for k in 0..real.len().min(imaginary.len()).min(f.len()).min(g.len()) {
                let [x, y] = times(simd, *power, real[k], imaginary[k]);
                (real[k], imaginary[k]) = (simd.add_f64s(f[k], x), simd.add_f64s(g[k], y));
                if let Some((kept, _)) = &mut kept {
                    let own = times(simd, share, real[k], imaginary[k]);
                    kept[k] = simd.add_f64s(kept[k], own[0]);
                }
            }
            for k in 0..more.len().min(rest.len()).min(last.len()).min(end.len()) {
                let own = Mode::new(last[k], end[k]) + power * Mode::new(more[k], rest[k]);
                (more[k], rest[k]) = (own.re, own.im);
                if let Some((_, kept)) = &mut kept {
                    kept[k] += (share * own).re;
                }
            }
        }
    }
}
