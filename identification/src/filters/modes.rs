//! Zero-phase low-pass as sums over its modes.
//!
//! Take one pole p_i of each conjugate pair of H. The response of both passes is the sum of a
//! causal and an anticausal part of each mode,
//!
//! ```text
//! H(z) H(1/z) = c + 2 Re Σ r_i (1/(1 - p_i z^-1) + p_i z/(1 - p_i z)),
//! y[n] = c u[n] + 2 Re Σ r_i (X_i + B_i),   X_i = Σ_(m<n) p_i^(n-m) u[m],   B_i = Σ_(m≥n) p_i^(m-n) u[m].
//! ```
//!
//! The poles of a Chebyshev low-pass are separated by about its bandwidth. The sums therefore
//! hardly cancel for any bandwidth: |r_i| is about 1 - |p_i|. At the ends of a signal, the states
//! of the sections are known. The modes follow from them by the transforms of the sections'
//! responses at the poles, which are products of pole differences.

use nalgebra::Complex;

use super::design::{LowPass, Section};

/// Complex value of a mode.
pub(super) type Mode = Complex<f64>;

/// Modes of a low-pass of even order.
#[derive(Debug, PartialEq)]
pub(super) struct Modes {
    sections: Vec<Section>,
    /// One pole p_i of each section.
    pub(super) poles: Vec<Mode>,
    /// r_i.
    pub(super) shares: Vec<Mode>,
    /// c.
    pub(super) direct: f64,
    /// ρ_i of the forward pass: H(z) = h + 2 Re Σ ρ_i/(1 - p_i z^-1).
    forward_shares: Vec<Mode>,
    /// h of the forward pass.
    forward_direct: f64,
    /// H(1/p_i).
    mirrored: Vec<Mode>,
}

impl Modes {
    pub(super) fn new(low_pass: &LowPass) -> Self {
        let sections = low_pass.sections().to_vec();
        let pole = |section: &Section| {
            let [_, a, b] = section.a;
            let half = -0.5 * a;
            // One rounding keeps the difference accurate.
            Complex::new(half, (-half).mul_add(half, b).max(0.0).sqrt())
        };
        let poles: Vec<Mode> = sections.iter().map(pole).collect();
        let own = |p: Mode| {
            let all = sections.iter().zip(&poles);
            let factors = all.map(|(section, other)| numerator(section, p) / mirrored(*other, p));
            factors.product::<Mode>()
        };
        let mirror: Vec<Mode> = poles.iter().map(|p| own(*p)).collect();
        let residue = |(number, p): (usize, &Mode)| {
            let inverse = p.inv();
            let all = sections.iter().zip(&poles).enumerate();
            all.fold(
                Complex::new(1.0, 0.0),
                |product, (place, (section, other))| {
                    let below = if place == number {
                        Complex::new(1.0, 0.0) - p.conj() * inverse
                    } else {
                        denominator(*other, inverse)
                    };
                    product * numerator(section, inverse) / below
                },
            )
        };
        let forward: Vec<Mode> = poles.iter().enumerate().map(residue).collect();
        let first: f64 = sections.iter().map(|own| own.b[0]).product();
        let last: f64 = sections.iter().map(|own| own.b[2] / own.a[2]).product();
        Self {
            shares: forward
                .iter()
                .zip(&mirror)
                .map(|(own, h)| own * h)
                .collect(),
            direct: first * last,
            forward_shares: forward,
            forward_direct: last,
            mirrored: mirror,
            sections,
            poles,
        }
    }

    /// X_i before a sample, from the states s1 and s2 of the sections there.
    pub(super) fn past(&self, states: &[[f64; 2]]) -> Vec<Mode> {
        let of = |p: &Mode| {
            let inverse = p.inv();
            let (mut sum, mut factor) = (Complex::ZERO, Complex::new(1.0, 0.0));
            let all = self.sections.iter().zip(&self.poles);
            for ((section, other), [first, second]) in all.zip(states) {
                factor /= numerator(section, inverse);
                sum += factor * (first + second * inverse);
                factor *= denominator(*other, inverse);
            }
            sum
        };
        self.poles.iter().map(of).collect()
    }

    /// Runs the forward pass over a signal after `past`, in place.
    pub(super) fn pass(&self, past: &[Mode], signal: &mut [f64]) {
        let mut modes = past.to_vec();
        for value in signal {
            let own = *value;
            let mut sum = self.forward_direct * own;
            let shares = self.poles.iter().zip(&self.forward_shares);
            for (mode, (pole, share)) in modes.iter_mut().zip(shares) {
                *mode += own;
                sum += 2.0 * (share * *mode).re;
                *mode *= pole;
            }
            *value = sum;
        }
    }

    /// B_i from a sample on.
    ///
    /// `states` are those of the backward pass after the sample, and `past` is X_i before it.
    pub(super) fn future(&self, states: &[[f64; 2]], past: &[Mode]) -> Vec<Mode> {
        let behind = self.past(states);
        let all = self.poles.iter().zip(&behind).zip(&self.mirrored);
        all.map(|((p, behind), mirrored)| {
            // Remove the decay of the forward pass, which is no input.
            let modes = self.poles.iter().zip(past).zip(&self.forward_shares);
            let decay = modes.map(|((other, past), share)| {
                let own = past * share;
                let one = Complex::new(1.0, 0.0);
                own / (one - p * other) + own.conj() / (one - p * other.conj())
            });
            (behind / p - decay.sum::<Mode>()) / mirrored
        })
        .collect()
    }
}

/// b_0 + b_1 z^-1 + b_2 z^-2 of a section.
fn numerator(section: &Section, inverse: Mode) -> Mode {
    let [first, second, third] = section.b;
    first + inverse * (second + inverse * third)
}

/// (1 - p z^-1)(1 - p̄ z^-1).
fn denominator(pole: Mode, inverse: Mode) -> Mode {
    // Differences first, which are exact.
    let z = inverse.inv();
    (z - pole) * (z - pole.conj()) * inverse * inverse
}

/// The same at z = 1/`point`.
fn mirrored(pole: Mode, point: Mode) -> Mode {
    let one = Complex::new(1.0, 0.0);
    (one - pole * point) * (one - pole.conj() * point)
}
