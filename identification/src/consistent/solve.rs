//! Interior-point method for a consistent estimate.
//!
//! It minimises ½ ||A x - b||² + γ D(x). A x ≈ b are the data in units of their noise. D is the sum
//! of all divergences, of -log of the distances from the bounds, and of ½ (x/scale)² of free
//! unknowns. The iterates follow the central path with barrier weight μ, from large μ down to μ =
//! γ, together with the multipliers (primal-dual path following; Vandenberghe, *The CVXOPT linear
//! and quadratic cone program solvers*, 2010).
//!
//! A step d = S u in cone coordinates minimises ½ ||A d - r||² + ½ |u|² + gᵀ u, with the residual r
//! and the gradient g. With M = A S, u = Mᵀ y - g and (1 + M Mᵀ) y = r + M g. This system has the
//! size of the number of base parameters.

use nalgebra::{DMatrix, DVector};

use super::{point::Point, start::start, unknowns::Unknowns};

/// Weight γ of the divergence.
///
/// An increase of the divergence by 1 is worth some hundredths of the residual's standard
/// deviation.
const LAST_WEIGHT: f64 = 1e-3;

/// Reduction of the weight after a long step.
const FALL: f64 = 0.1;

/// Reduction of the weight after a short step.
const SLOW_FALL: f64 = 0.5;

/// Fraction of a step above which it is long.
const FAR: f64 = 0.5;

/// Length of a step, in the metric of D, below which it is short.
const SHORT: f64 = 0.25;

/// Largest number of steps; 75 is the largest number observed.
const STEPS: usize = 300;

/// Solution.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Solution {
    /// Unknowns.
    pub(super) values: DVector<f64>,
    /// For each unknown the fraction of its prior variance that the data removed, 0 to 1.
    pub(super) determined: DVector<f64>,
}

/// Minimises the objective; the rows of A must be independent.
///
/// `None` if the steps do not converge, or the prior is outside the cones.
pub(super) fn solve(unknowns: &Unknowns, a: &DMatrix<f64>, b: &DVector<f64>) -> Option<Solution> {
    let values = start(unknowns);
    let worst = (a * &values - b).norm_squared() / (2.0 * unknowns.len() as f64);
    let mut point = Point::new(unknowns, &values, worst.max(LAST_WEIGHT), LAST_WEIGHT)?;
    let (mut fall, mut last) = (FALL, f64::INFINITY);
    for _ in 0..STEPS {
        let weight = (fall * point.weight()).max(LAST_WEIGHT);
        let step = point.advance(a, b, weight)?;
        fall = if step.part < FAR { SLOW_FALL } else { FALL };
        // The steps have reached rounding errors.
        let is_full = weight <= LAST_WEIGHT && step.part >= 1.0;
        if is_full && (step.length == 0.0 || last <= SHORT && step.length > 0.5 * last) {
            let values = point.values();
            let determined = determined(unknowns, a, &values)?;
            return Some(Solution { values, determined });
        }
        last = if is_full { step.length } else { f64::INFINITY };
    }
    None
}

/// 1 - σ²/σ_0² for each unknown, with its variances σ² with and σ_0² without data.
///
/// Both are those of Gaussians with the objective's curvature.
fn determined(
    unknowns: &Unknowns,
    a: &DMatrix<f64>,
    values: &DVector<f64>,
) -> Option<DVector<f64>> {
    let none = DMatrix::zeros(0, a.ncols());
    let variances = |values: &DVector<f64>, a: &DMatrix<f64>| {
        let point = Point::new(unknowns, values, LAST_WEIGHT, LAST_WEIGHT)?;
        Some(point.equations(a)?.variances())
    };
    let (before, after) = (variances(&start(unknowns), &none)?, variances(values, a)?);
    let part = after.zip_map(&before, |after, before| 1.0 - after / before);
    Some(part.map(|part| part.clamp(0.0, 1.0)))
}
