//! Design of Butterworth and Chebyshev type I low-pass filters as second-order sections.
//!
//! The analogue prototype of order n with a cutoff of 1 rad/s has the poles -sinh(μ) sin θ_k ± i
//! cosh(μ) cos θ_k with θ_k = π (2k + 1)/(2n). For a ripple of 10 log10(1 + ε²) dB, sinh(μ n) =
//! 1/ε; for Butterworth both hyperbolic factors are 1.
//!
//! The bilinear transform with prewarping, t = tan(π f_c/f_m), maps a pole p to z = (1 + p t)/(1 -
//! p t), and all zeros to -1. A pair of poles gives the section (1 + z^-1)²/(1 - 2 Re(z) z^-1 +
//! |z|² z^-2).

use overact::Code;
use std::f64::consts::PI;

use nalgebra::Complex;

use overact_logs::{Error, Problem};

/// Largest order; higher orders have no benefit for identification.
const LARGEST_ORDER: usize = 50;

/// One second-order section b(z)/a(z) in powers of z^-1, with a\[0\] = 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Section {
    /// Numerator.
    pub b: [f64; 3],
    /// Denominator.
    pub a: [f64; 3],
}

/// A low-pass filter: a cascade of sections, the one nearest to the unit circle last.
///
/// The first section contains the gain.
#[derive(Debug, Clone, PartialEq)]
pub struct LowPass {
    sections: Vec<Section>,
    order: usize,
}

impl LowPass {
    /// Sections in the order of filtering.
    #[must_use]
    pub fn sections(&self) -> &[Section] {
        &self.sections
    }

    /// Order of the filter.
    #[must_use]
    pub const fn order(&self) -> usize {
        self.order
    }

    /// Samples by which [`filtfilt`](super::filtfilt) extends a signal at either end, 3 × order.
    #[must_use]
    pub const fn padding(&self) -> usize {
        3 * self.order
    }

    /// Polynomials b and a of the whole filter in powers of z^-1, order + 1 coefficients each.
    ///
    /// For comparison and plots; use the sections for filtering.
    #[must_use]
    pub fn polynomials(&self) -> (Vec<f64>, Vec<f64>) {
        let mut b = vec![1.0];
        let mut a = vec![1.0];
        for section in &self.sections {
            b = multiply(&b, &section.b);
            a = multiply(&a, &section.a);
        }
        b.truncate(self.order + 1);
        a.truncate(self.order + 1);
        (b, a)
    }
}

/// Coefficients of the product of two polynomials.
fn multiply(x: &[f64], y: &[f64]) -> Vec<f64> {
    let mut product = vec![0.0; x.len() + y.len() - 1];
    for (i, x) in x.iter().enumerate() {
        for (p, y) in product.iter_mut().skip(i).zip(y) {
            *p += x * y;
        }
    }
    product
}

/// Butterworth low-pass of `order`.
///
/// `cutoff` is the -3 dB frequency as a fraction of the Nyquist frequency, between 0 and 1.
///
/// # Errors
/// An order of 0 or above 50, or a cutoff outside ]0, 1\[.
pub fn butterworth(order: usize, cutoff: f64) -> Result<LowPass, Error> {
    check(order, cutoff)?;
    Ok(low_pass(order, cutoff, 1.0, 1.0, 1.0))
}

/// Chebyshev type I low-pass of `order` with `ripple_db` of ripple in the pass band.
///
/// `cutoff` is the end of the pass band as a fraction of the Nyquist frequency, between 0 and 1.
///
/// # Errors
/// An order of 0 or above 50, a cutoff outside ]0, 1\[, or a ripple that is not positive.
pub fn chebyshev1(order: usize, ripple_db: f64, cutoff: f64) -> Result<LowPass, Error> {
    check(order, cutoff)?;
    if !(ripple_db.is_finite() && ripple_db > 0.0) {
        return Err(Problem::new(
            Code::SETTINGS,
            format!("the ripple of a Chebyshev filter is {ripple_db} dB; it must be positive"),
        )
        .into());
    }
    let epsilon = (10.0_f64.powf(ripple_db / 10.0) - 1.0).sqrt();
    let mu = (1.0 / epsilon).asinh() / order as f64;
    // The static gain of an even order is the minimum of the ripple.
    let gain = if order.is_multiple_of(2) {
        10.0_f64.powf(-ripple_db / 20.0)
    } else {
        1.0
    };
    Ok(low_pass(order, cutoff, mu.sinh(), mu.cosh(), gain))
}

/// Checks the parameters common to both designs.
fn check(order: usize, cutoff: f64) -> Result<(), Error> {
    let mut problems = Vec::new();
    if order == 0 || order > LARGEST_ORDER {
        problems.push(
            Problem::new(
                Code::SETTINGS,
                format!("a filter of order {order} is not possible"),
            )
            .help(format!(
                "choose an order from 1 to {LARGEST_ORDER}; 4 is usual"
            )),
        );
    }
    if !(cutoff > 0.0 && cutoff < 1.0) {
        problems.push(
            Problem::new(
                Code::SETTINGS,
                format!(
                    "a cutoff frequency of {cutoff} times the Nyquist frequency is not possible"
                ),
            )
            .help("choose a cutoff between 0 and half the sampling frequency"),
        );
    }
    Error::check(problems)
}

/// Digital filter from the prototype with poles on an ellipse.
///
/// `real` and `imaginary` are its half axes, and `gain` is the static gain.
fn low_pass(order: usize, cutoff: f64, real: f64, imaginary: f64, gain: f64) -> LowPass {
    let t = (PI * cutoff / 2.0).tan();
    let mut sections = Vec::with_capacity(order.div_ceil(2));
    // The overall gain makes the response at z = 1 equal to `gain`. The factor per pair is |1 -
    // z|²/4, with 1 - z = -2 p t/(1 - p t), which is accurate at low cutoff frequencies.
    let mut product = gain;
    if !order.is_multiple_of(2) {
        let p = -real * t;
        let z = (1.0 + p) / (1.0 - p);
        product *= -p / (1.0 - p);
        sections.push(Section {
            b: [1.0, 1.0, 0.0],
            a: [1.0, -z, 0.0],
        });
    }
    for k in (0..order / 2).rev() {
        let theta = PI * (2 * k + 1) as f64 / (2 * order) as f64;
        let p = Complex::new(-real * theta.sin(), imaginary * theta.cos()) * t;
        let one = Complex::new(1.0, 0.0);
        let z = (one + p) / (one - p);
        product *= p.norm_sqr() / (one - p).norm_sqr();
        sections.push(Section {
            b: [1.0, 2.0, 1.0],
            a: [1.0, -2.0 * z.re, z.norm_sqr()],
        });
    }
    if let Some(first) = sections.first_mut() {
        first.b = first.b.map(|b| b * product);
    }
    LowPass { sections, order }
}
