//! The program of a consistent estimate, solved by Newton's method on a path of falling weights.
//!
//! ½ ||A x - b||² + γ D(x) is minimised, A x ≈ b being the data in units of their noise and D the sum of
//! all divergences, of -log of the distances from the bounds, and of ½ (x/scale)² of free unknowns. D/γ is
//! self-concordant, so that Newton's steps, shortened while they are long, lead to the minimum from any
//! start inside the cones (Nesterov, Nemirovskii 1994). With H the block-diagonal Hessian of D and g its
//! gradient, a step d = H^-1 (Aᵀ y - g) follows from a system of as many unknowns as there are base
//! parameters, (γ I + A H^-1 Aᵀ) y = b - A x + A H^-1 g: H is never formed, and its inverse stays harmless
//! where a body is about to degenerate.

use nalgebra::{DMatrix, DVector, DVectorView, SMatrix};

use super::{
    pseudo_inertia::{Inertia, Metric, curvature, divergence, reach},
    unknowns::{Group, Kind, Unknowns},
};

/// Weight of the divergence at the end: its growth by 1 then is worth as much as a residual that grows by
/// some hundredths of its standard deviation.
const LAST_WEIGHT: f64 = 1e-3;

/// The weights fall by this factor.
const FALL: f64 = 0.1;

/// A step is short when its length in the metric of D is below this.
const SHORT: f64 = 0.25;

/// Most steps for a weight.
const STEPS: usize = 200;

/// A step goes no farther than this part of the way to where a body degenerates.
const CLEAR: f64 = 0.8;

/// Bounded unknowns start at least this part of the bounds' distance from either.
const INSIDE: f64 = 0.1;

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
    let mut values = start(unknowns);
    let worst = (a * &values - b).norm_squared() / (2.0 * unknowns.len() as f64);
    let mut weight = worst.max(LAST_WEIGHT);
    loop {
        let is_last = weight <= LAST_WEIGHT;
        centre(
            unknowns,
            (a, b),
            weight,
            &mut values,
            if is_last { 0.0 } else { SHORT },
        )?;
        if is_last {
            break;
        }
        weight = (FALL * weight).max(LAST_WEIGHT);
    }
    let determined = determined(unknowns, a, weight, &values)?;
    Some(Solution { values, determined })
}

/// For each unknown 1 - σ²/σ_0²: σ² is its variance with the data, σ_0² that of the prior, both of the
/// Gaussians that have the objective's curvature.
fn determined(
    unknowns: &Unknowns,
    a: &DMatrix<f64>,
    weight: f64,
    values: &DVector<f64>,
) -> Option<DVector<f64>> {
    let (_, before) = barrier(unknowns, &start(unknowns))?;
    let (_, inverse) = barrier(unknowns, values)?;
    let spread = inverse.times(a);
    let gram = a * &spread + DMatrix::identity(a.nrows(), a.nrows()) * weight;
    let solved = gram.cholesky()?.solve(&spread.transpose());
    let part = |k: usize| {
        let told = spread.row(k).transpose().dot(&solved.column(k));
        1.0 - (inverse.diagonal(k) - told) / before.diagonal(k)
    };
    Some(DVector::from_fn(unknowns.len(), |k, _| {
        part(k).clamp(0.0, 1.0)
    }))
}

/// Steps until they are short enough, or as short as rounding lets them become.
fn centre(
    unknowns: &Unknowns,
    data: (&DMatrix<f64>, &DVector<f64>),
    weight: f64,
    values: &mut DVector<f64>,
    wanted: f64,
) -> Option<()> {
    let mut last = f64::INFINITY;
    for _ in 0..STEPS {
        let length = advance(unknowns, data, weight, values)?;
        if length <= wanted || (last <= SHORT && length > 0.5 * last) {
            return Some(());
        }
        last = length;
    }
    None
}

/// One step; its length in the metric of D.
fn advance(
    unknowns: &Unknowns,
    (a, b): (&DMatrix<f64>, &DVector<f64>),
    weight: f64,
    values: &mut DVector<f64>,
) -> Option<f64> {
    let (gradient, inverse) = barrier(unknowns, values)?;
    let spread = inverse.times(a);
    let gram = a * &spread + DMatrix::identity(a.nrows(), a.nrows()) * weight;
    let right = b - a * &*values + spread.tr_mul(&gradient);
    let multipliers = gram.cholesky()?.solve(&right);
    let push = a.tr_mul(&multipliers) - &gradient;
    let step = inverse.applied(&push);
    // d H d + |A d|²/γ: the length by which the quadratic model promises a descent.
    let square = step.dot(&push) + (a * &step).norm_squared() / weight;
    let length = square.max(0.0).sqrt();
    // The shortened step is safe but for rounding; a longer one is often better, but not one that ends at
    // the brink of the cones, from which only small steps lead back.
    let farthest = CLEAR * reach_of(unknowns, values, &step)?;
    let mut part = if length > SHORT {
        1.0 / (1.0 + length)
    } else {
        1.0
    };
    part = part.min(farthest);
    let mut longer = farthest.min(1.0);
    let before = objective(unknowns, (a, b), weight, values)?;
    while longer > part {
        let tried = &*values + &step * longer;
        let after = objective(unknowns, (a, b), weight, &tried);
        if after.is_some_and(|after| after < before - 0.1 * longer * weight * square) {
            part = longer;
        }
        longer *= 0.5;
    }
    values.axpy(part, &step, 1.0);
    Some(length)
}

/// How many times a step can be made inside the cones and bounds.
fn reach_of(unknowns: &Unknowns, values: &DVector<f64>, step: &DVector<f64>) -> Option<f64> {
    let mut farthest = f64::INFINITY;
    let until = |distance: f64, closer: f64| {
        if closer > 0.0 {
            distance / closer
        } else {
            f64::INFINITY
        }
    };
    for group in &unknowns.groups {
        let own = values.rows(group.first, group.len());
        let moved = step.rows(group.first, group.len());
        farthest = farthest.min(match group.kind {
            Kind::Body { .. } => reach(&fixed(own), &fixed(moved))?,
            Kind::Positive { .. } => until(own[0], -moved[0]),
            Kind::Free { .. } => f64::INFINITY,
        });
        for (k, [low, high]) in &group.bounds {
            let nearer = until(own[*k] - low, -moved[*k]).min(until(high - own[*k], moved[*k]));
            farthest = farthest.min(nearer);
        }
    }
    Some(farthest)
}

/// ½ ||A x - b||² + γ D(x), none outside the cones and bounds.
fn objective(
    unknowns: &Unknowns,
    (a, b): (&DMatrix<f64>, &DVector<f64>),
    weight: f64,
    values: &DVector<f64>,
) -> Option<f64> {
    let mut sum = 0.0;
    for group in &unknowns.groups {
        let own = values.rows(group.first, group.len());
        sum += match &group.kind {
            Kind::Body { prior } => divergence(&fixed(own), prior)?,
            Kind::Positive { prior } => {
                let ratio = own[0] / prior;
                (ratio > 0.0).then(|| ratio - ratio.ln() - 1.0)?
            }
            Kind::Free { scale } => 0.5 * (own[0] / scale).powi(2),
        };
        for (k, [low, high]) in &group.bounds {
            let distances = [own[*k] - low, high - own[*k]];
            let inside = distances.iter().all(|distance| *distance > 0.0);
            sum -= inside.then(|| {
                distances
                    .map(f64::ln)
                    .iter()
                    .filter(|one| one.is_finite())
                    .sum::<f64>()
            })?;
        }
    }
    Some(0.5 * (a * values - b).norm_squared() + weight * sum)
}

fn fixed(own: DVectorView<'_, f64>) -> Inertia {
    Inertia::from_iterator(own.iter().copied())
}

/// The priors, those that have bounds moved inside.
fn start(unknowns: &Unknowns) -> DVector<f64> {
    let mut values = DVector::zeros(unknowns.len());
    for group in &unknowns.groups {
        let mut own = values.rows_mut(group.first, group.len());
        match &group.kind {
            Kind::Body { prior } => own.copy_from(prior),
            Kind::Positive { prior } => own[0] = *prior,
            Kind::Free { .. } => {}
        }
        for (k, [low, high]) in &group.bounds {
            let is_free = matches!(group.kind, Kind::Free { .. });
            let low = if is_free { *low } else { low.max(0.0) };
            let inside = moved_inside(own[*k], low, *high);
            match &group.kind {
                // A heavier or lighter body of the same shape.
                Kind::Body { .. } => own *= inside / own[*k],
                _ => own[*k] = inside,
            }
        }
    }
    values
}

/// The value, or the nearest one that is clear of the bounds.
fn moved_inside(value: f64, low: f64, high: f64) -> f64 {
    match (low.is_finite(), high.is_finite()) {
        (true, true) => {
            let margin = INSIDE * (high - low);
            value.max(low + margin).min(high - margin)
        }
        (true, false) => value.max(low + INSIDE * low.abs()),
        (false, true) => value.min(high - INSIDE * high.abs()),
        (false, false) => value,
    }
}

/// The inverse of a block-diagonal matrix.
struct Inverse<'a> {
    groups: &'a [Group],
    blocks: Vec<Metric>,
}

impl Inverse<'_> {
    /// The product with Aᵀ.
    fn times(&self, a: &DMatrix<f64>) -> DMatrix<f64> {
        let mut product = DMatrix::zeros(a.ncols(), a.nrows());
        for (group, block) in self.groups.iter().zip(&self.blocks) {
            let n = group.len();
            let rows = block.view((0, 0), (n, n)) * a.columns(group.first, n).transpose();
            product.rows_mut(group.first, n).copy_from(&rows);
        }
        product
    }

    fn applied(&self, vector: &DVector<f64>) -> DVector<f64> {
        let mut product = DVector::zeros(vector.len());
        for (group, block) in self.groups.iter().zip(&self.blocks) {
            let n = group.len();
            let rows = block.view((0, 0), (n, n)) * vector.rows(group.first, n);
            product.rows_mut(group.first, n).copy_from(&rows);
        }
        product
    }

    fn diagonal(&self, unknown: usize) -> f64 {
        let own = |group: &Group| (group.first..group.first + group.len()).contains(&unknown);
        let found = self
            .groups
            .iter()
            .zip(&self.blocks)
            .find(|(group, _)| own(group));
        found.map_or(f64::NAN, |(group, block)| {
            block[(unknown - group.first, unknown - group.first)]
        })
    }
}

/// The gradient of D and the inverse of its Hessian; none outside the cones.
fn barrier<'a>(
    unknowns: &'a Unknowns,
    values: &DVector<f64>,
) -> Option<(DVector<f64>, Inverse<'a>)> {
    let mut gradient = DVector::zeros(values.len());
    let mut blocks = Vec::with_capacity(unknowns.groups.len());
    for group in &unknowns.groups {
        let own = values.rows(group.first, group.len());
        let mut slope = gradient.rows_mut(group.first, group.len());
        let mut inverse = Metric::zeros();
        match &group.kind {
            Kind::Body { prior } => {
                let (own, metric) = curvature(&fixed(own), prior)?;
                slope.copy_from(&own);
                inverse = metric;
            }
            Kind::Positive { prior } => {
                slope[0] = 1.0 / prior - 1.0 / own[0];
                inverse[(0, 0)] = own[0] * own[0];
            }
            Kind::Free { scale } => {
                slope[0] = own[0] / (scale * scale);
                inverse[(0, 0)] = scale * scale;
            }
        }
        for (k, [low, high]) in &group.bounds {
            for (distance, sign) in [(own[*k] - low, 1.0), (high - own[*k], -1.0)] {
                if distance.is_finite() {
                    slope[*k] -= sign / distance;
                    stiffened(&mut inverse, *k, distance);
                }
            }
        }
        blocks.push(inverse);
    }
    let groups = &unknowns.groups;
    Some((gradient, Inverse { groups, blocks }))
}

/// The inverse of a Hessian to which 1/distance² is added at one place of its diagonal.
fn stiffened(inverse: &mut Metric, place: usize, distance: f64) {
    let column: SMatrix<f64, 10, 1> = inverse.column(place).into_owned();
    let factor = 1.0 / (distance * distance + column[place]);
    *inverse -= column * column.transpose() * factor;
}
