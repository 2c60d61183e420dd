//! Groups of the samples from one that is kept to the next one, as sums over the modes of the low-pass.
//!
//! A group of N samples u_k adds to the modes
//!
//! ```text
//! F_i = Σ p_i^k u_k,   R_i = Σ p_i^(N-1-k) u_k,
//! X_i' = p_i^N X_i + p_i R_i,   B_i = F_i + p_i^N B_i',   kept value = c u_0 + 2 Re Σ r_i (X_i + B_i),
//! ```
//!
//! with X_i' before and B_i' from the next group on. F and R have the same weights from either end, so both are
//! told from the sums u_k + u_(N-1-k) and the differences u_k - u_(N-1-k), with the even and the odd parts of the
//! weights. All signals do that side by side, and no sample is filtered that is not kept.

use nalgebra::Complex;

use super::modes::{Mode, Modes};
use crate::widest::{Fused, fused, product_sum};

/// Modes of the low-pass: half its order.
pub(super) const MODES: usize = 4;

/// Real and imaginary parts of all modes.
pub(super) const PARTS: usize = 2 * MODES;

/// Signals that go side by side.
const LANES: usize = 8;

/// What groups of one length do.
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
            // The sample in the middle of an odd number stands for itself: its sum is not twice its value.
            even: (0..length.div_ceil(2)).map(|k| part(1.0, k)).collect(),
            odd: (0..length / 2).map(|k| part(-1.0, k)).collect(),
            length,
            modes,
            powers,
        }
    }

    /// Passes a group forwards: `rows` of `width` signals. Of X, in `before`, becomes that of the next group in
    /// `after`; `told` gets F, then the kept values as far as they are known. All have the real parts of a mode
    /// of all signals, then the imaginary ones.
    pub(super) fn pass(
        &self,
        (rows, width): (&[f64], usize),
        (before, after): (&[f64], &mut [f64]),
        told: &mut [f64],
    ) {
        fused(Pass {
            groups: self,
            rows,
            width,
            before,
            after,
            told,
        });
    }

    /// Passes a group backwards: what `told` has of it, and B' in `behind`, which becomes B; the kept values go to
    /// `kept` where these are wanted.
    pub(super) fn pass_backwards(
        &self,
        told: &[f64],
        behind: &mut [f64],
        kept: Option<&mut [f64]>,
    ) {
        fused(Backwards {
            groups: self,
            told,
            behind,
            kept,
        });
    }
}

/// A group on its way forwards.
struct Pass<'a> {
    groups: &'a Groups,
    rows: &'a [f64],
    width: usize,
    before: &'a [f64],
    after: &'a mut [f64],
    told: &'a mut [f64],
}

impl Fused for Pass<'_> {
    #[inline(always)]
    fn run<const FUSED: bool>(mut self) {
        let mut folded = vec![[[0.0; LANES]; 2]; self.groups.even.len()];
        let whole = self.width / LANES * LANES;
        for column in (0..whole).step_by(LANES) {
            self.columns::<LANES, FUSED>(column, &mut folded);
        }
        if whole == self.width {
            return;
        }
        if whole > 0 {
            // Some signals once more, to the same result.
            self.columns::<LANES, FUSED>(self.width - LANES, &mut folded);
            return;
        }
        let mut folded = vec![[[0.0]; 2]; self.groups.even.len()];
        for column in 0..self.width {
            self.columns::<1, FUSED>(column, &mut folded);
        }
    }
}

impl Pass<'_> {
    /// Passes some signals, from number `column` on.
    #[inline(always)]
    fn columns<const L: usize, const FUSED: bool>(
        &mut self,
        column: usize,
        folded: &mut [[[f64; L]; 2]],
    ) {
        let (groups, width) = (self.groups, self.width);
        let length = groups.length;
        for (k, [sum, difference]) in folded.iter_mut().enumerate() {
            let near = lanes::<L>(self.rows, k * width + column);
            let far = lanes::<L>(self.rows, (length - 1 - k) * width + column);
            let is_middle = 2 * k + 1 == length;
            for lane in 0..L {
                sum[lane] = near[lane] + if is_middle { 0.0 } else { far[lane] };
                difference[lane] = near[lane] - far[lane];
            }
        }
        let mut even = [[0.0; L]; PARTS];
        let mut odd = [[0.0; L]; PARTS];
        // Half of the sums at a time have room in the registers.
        for half in [0, MODES] {
            let all = folded.iter().zip(&groups.even);
            for ([sum, _], weights) in all {
                for part in 0..MODES {
                    let weight = weights[half + part];
                    for lane in 0..L {
                        let to = &mut even[half + part][lane];
                        *to = product_sum::<FUSED>(weight, sum[lane], *to);
                    }
                }
            }
            for ([_, difference], weights) in folded.iter().zip(&groups.odd) {
                for part in 0..MODES {
                    let weight = weights[half + part];
                    for lane in 0..L {
                        let to = &mut odd[half + part][lane];
                        *to = product_sum::<FUSED>(weight, difference[lane], *to);
                    }
                }
            }
        }
        let mut kept = lanes::<L>(self.rows, column).map(|own| groups.modes.direct * own);
        for mode in 0..MODES {
            let [real, imaginary] = [2 * mode, 2 * mode + 1];
            let (pole, power) = (groups.modes.poles[mode], groups.powers[mode]);
            let share = groups.modes.shares[mode];
            let places = [real, imaginary].map(|part| part * width + column);
            let [x, y] = places.map(|place| lanes::<L>(self.before, place));
            for lane in 0..L {
                let (a, b) = (even[real][lane], odd[real][lane]);
                let (c, d) = (even[imaginary][lane], odd[imaginary][lane]);
                kept[lane] += 2.0 * (share.re * x[lane] - share.im * y[lane]);
                let (f, g) = (a - b, c - d);
                self.told[places[0] + lane] = a + b;
                self.told[places[1] + lane] = c + d;
                self.after[places[0] + lane] =
                    power.re * x[lane] - power.im * y[lane] + (pole.re * f - pole.im * g);
                self.after[places[1] + lane] =
                    power.re * y[lane] + power.im * x[lane] + (pole.re * g + pole.im * f);
            }
        }
        self.told[PARTS * width + column..][..L].copy_from_slice(&kept);
    }
}

/// Successive numbers.
#[inline(always)]
fn lanes<const L: usize>(values: &[f64], first: usize) -> [f64; L] {
    let mut own = [0.0; L];
    own.copy_from_slice(&values[first..first + L]);
    own
}

/// A group on its way back.
struct Backwards<'a> {
    groups: &'a Groups,
    told: &'a [f64],
    behind: &'a mut [f64],
    kept: Option<&'a mut [f64]>,
}

impl Fused for Backwards<'_> {
    #[inline(always)]
    fn run<const FUSED: bool>(mut self) {
        let width = self.behind.len() / PARTS;
        if let Some(kept) = &mut self.kept {
            kept.copy_from_slice(&self.told[PARTS * width..]);
        }
        let told = self.told.chunks_exact(2 * width);
        let modes = self.behind.chunks_exact_mut(2 * width).zip(told);
        for ((mode, (behind, told)), power) in modes.enumerate().zip(&self.groups.powers) {
            let share = self.groups.modes.shares[mode];
            let (real, imaginary) = behind.split_at_mut(width);
            let (f, g) = told.split_at(width);
            for k in 0..width {
                let (x, y) = (real[k], imaginary[k]);
                real[k] = f[k] + (power.re * x - power.im * y);
                imaginary[k] = g[k] + (power.re * y + power.im * x);
            }
            if let Some(kept) = &mut self.kept {
                for k in 0..width {
                    kept[k] += 2.0 * (share.re * real[k] - share.im * imaginary[k]);
                }
            }
        }
    }
}
