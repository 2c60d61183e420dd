//! The program of a consistent estimate, solved by an interior-point method.
//!
//! ½ ||A x - b||² + γ D(x) is minimised, A x ≈ b being the data in units of their noise and D the sum of
//! all divergences, of -log of the distances from the bounds, and of ½ (x/scale)² of free unknowns. The
//! point follows the path on which the barriers of D weigh μ, from where the prior is good enough down to
//! μ = γ, and the multipliers of all barriers with it (primal-dual path following; Vandenberghe, *The
//! CVXOPT linear and quadratic cone program solvers*, 2010). A step d = S u in the coordinates of the cones
//! minimises ½ ||A d - r||² + ½ |u|² + gᵀ u, r being what is unexplained and g the slope. With M = A S that
//! is u = Mᵀ y - g and (1 + M Mᵀ) y = r + M g: a system of as many unknowns as there are base parameters.

use nalgebra::{DMatrix, DVector};

use super::{point::Point, start::start, unknowns::Unknowns};

/// Weight γ of the divergence: its growth by 1 is worth as much as a residual that grows by some hundredths
/// of its standard deviation.
const LAST_WEIGHT: f64 = 1e-3;

/// A step wants the weight to fall by this factor, after one that went far.
const FALL: f64 = 0.1;

/// And by this one after one that did not.
const SLOW_FALL: f64 = 0.5;

/// A step goes far when it is made by at least this part.
const FAR: f64 = 0.5;

/// A step is short when its length in the metric of D is below this.
const SHORT: f64 = 0.25;

/// Most steps; 75 are the most that were seen.
const STEPS: usize = 300;

/// The solution.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Solution {
    /// The unknowns.
    pub(super) values: DVector<f64>,
    /// For each unknown the part of its prior variance that the data took away, 0 to 1.
    pub(super) determined: DVector<f64>,
}

/// Minimises; the rows of A are independent. None where the steps do not end, or the prior is outside of the
/// cones.
pub(super) fn solve(unknowns: &Unknowns, a: &DMatrix<f64>, b: &DVector<f64>) -> Option<Solution> {
    let values = start(unknowns);
    let worst = (a * &values - b).norm_squared() / (2.0 * unknowns.len() as f64);
    let mut point = Point::new(unknowns, &values, (worst.max(LAST_WEIGHT), LAST_WEIGHT))?;
    let (mut fall, mut last) = (FALL, f64::INFINITY);
    for _ in 0..STEPS {
        let weight = (fall * point.weight()).max(LAST_WEIGHT);
        let step = point.advance((a, b), weight)?;
        fall = if step.part < FAR { SLOW_FALL } else { FALL };
        // As short as rounding lets steps become.
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

/// For each unknown 1 - σ²/σ_0²: σ² is its variance with the data, σ_0² that of the prior, both of the
/// Gaussians that have the objective's curvature.
fn determined(
    unknowns: &Unknowns,
    a: &DMatrix<f64>,
    values: &DVector<f64>,
) -> Option<DVector<f64>> {
    let none = DMatrix::zeros(0, a.ncols());
    let variances = |values: &DVector<f64>, a: &DMatrix<f64>| {
        let point = Point::new(unknowns, values, (LAST_WEIGHT, LAST_WEIGHT))?;
        Some(point.equations(a)?.variances())
    };
    let (before, after) = (variances(&start(unknowns), &none)?, variances(values, a)?);
    let part = after.zip_map(&before, |after, before| 1.0 - after / before);
    Some(part.map(|part| part.clamp(0.0, 1.0)))
}
