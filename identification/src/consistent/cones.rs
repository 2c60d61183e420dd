//! Constraints of the unknowns: cones with their multipliers.
//!
//! On the central path of weight μ, the multiplier of a body's pseudo-inertia P is Z = μ P^-1. That
//! of a distance s from a bound is z = μ/s. A step dP = G U Gᵀ uses the Nesterov-Todd scaling: P
//! and Z become the same diagonal matrix, G^-1 P G^-T = Gᵀ Z G = Λ (Nesterov, Todd 1997). The
//! curvature is then ½ |U|², and the scaled multiplier changes by μ Λ^-1 - Λ - U.
//!
//! Unlike the curvature of the barrier alone, this one knows the active constraints. Reducing μ by
//! a factor of ten needs one or two steps, and no nearly singular matrix is inverted.

use nalgebra::{Matrix4, Vector4};

use super::{
    bound::{BoundDistance, until},
    pseudo_inertia::{Inertia, Metric, inertia, pseudo_inertia},
};

/// A constraint set of a block of unknowns.
pub(super) trait Cone {
    /// Values; a block of fewer than ten unknowns uses the first entries.
    fn values(&self) -> Inertia;

    /// Matrix from step coordinates to changes of the values.
    fn scaling(&self) -> Metric;

    /// Gradient in step coordinates.
    ///
    /// It is that of `cost` times the divergence without its logarithms, and `weight` times the
    /// barrier.
    fn slope(&self, cost: f64, weight: f64) -> Inertia;

    /// Number of products of a distance and its multiplier, and their sum.
    fn products(&self) -> (usize, f64);

    /// Computes a step towards a weight; returns the largest feasible multiple.
    fn propose(&mut self, step: &Inertia, weight: f64) -> f64;

    /// Makes a fraction of the computed step; `None` if rounding leaves the cone.
    fn advance(&mut self, part: f64) -> Option<()>;
}

/// Cone of a body's pseudo-inertia.
pub(super) struct BodyCone {
    /// Inverse of the prior's pseudo-inertia.
    cost: Matrix4<f64>,
    /// G.
    scaling: Matrix4<f64>,
    /// Diagonal of Λ.
    lambda: Vector4<f64>,
    /// U and the change of the multiplier.
    proposed: [Matrix4<f64>; 2],
}

impl BodyCone {
    /// A body on the path of a weight; `None` if it or its prior is no body.
    pub(super) fn new(prior: &Inertia, own: &Inertia, weight: f64) -> Option<Self> {
        let lower = pseudo_inertia(own).cholesky()?.l();
        Some(Self {
            cost: pseudo_inertia(prior).cholesky()?.inverse(),
            scaling: lower / weight.powf(0.25),
            lambda: Vector4::repeat(weight.sqrt()),
            proposed: [Matrix4::zeros(); 2],
        })
    }
}

/// Rows and columns of a symmetric matrix in the order of step coordinates.
///
/// Off-diagonal entries are multiplied by √2, so norms are preserved.
const ENTRIES: [(usize, usize); 10] = [
    (0, 0),
    (1, 1),
    (2, 2),
    (3, 3),
    (0, 1),
    (0, 2),
    (0, 3),
    (1, 2),
    (1, 3),
    (2, 3),
];

fn coordinates(matrix: &Matrix4<f64>) -> Inertia {
    Inertia::from(ENTRIES.map(|(i, j)| {
        if i == j {
            matrix[(i, i)]
        } else {
            (matrix[(i, j)] + matrix[(j, i)]) * std::f64::consts::FRAC_1_SQRT_2
        }
    }))
}

fn matrix(coordinates: &Inertia) -> Matrix4<f64> {
    let mut matrix = Matrix4::zeros();
    for (k, (i, j)) in ENTRIES.into_iter().enumerate() {
        let factor = if i == j {
            1.0
        } else {
            std::f64::consts::FRAC_1_SQRT_2
        };
        matrix[(i, j)] = factor * coordinates[k];
        matrix[(j, i)] = matrix[(i, j)];
    }
    matrix
}

impl Cone for BodyCone {
    fn values(&self) -> Inertia {
        inertia(&(self.scaling * Matrix4::from_diagonal(&self.lambda) * self.scaling.transpose()))
    }

    fn scaling(&self) -> Metric {
        let mut all = Metric::zeros();
        for k in 0..10 {
            let mut unit = Inertia::zeros();
            unit[k] = 1.0;
            let moved = self.scaling * matrix(&unit) * self.scaling.transpose();
            all.set_column(k, &inertia(&moved));
        }
        all
    }

    fn slope(&self, cost: f64, weight: f64) -> Inertia {
        let smooth = self.scaling.transpose() * self.cost * self.scaling * cost;
        let barrier = Matrix4::from_diagonal(&self.lambda.map(|value| weight / value));
        coordinates(&(smooth - barrier))
    }

    fn products(&self) -> (usize, f64) {
        (4, self.lambda.norm_squared())
    }

    fn propose(&mut self, step: &Inertia, weight: f64) -> f64 {
        let step = matrix(step);
        let wanted = self.lambda.map(|value| weight / value - value);
        self.proposed = [step, Matrix4::from_diagonal(&wanted) - step];
        let root = Matrix4::from_diagonal(&self.lambda.map(|value| value.sqrt().recip()));
        let reach = |change: &Matrix4<f64>| {
            until(1.0, (root * change * root).symmetric_eigenvalues().min())
        };
        reach(&self.proposed[0]).min(reach(&self.proposed[1]))
    }

    fn advance(&mut self, part: f64) -> Option<()> {
        let moved = self
            .proposed
            .map(|change| Matrix4::from_diagonal(&self.lambda) + change * part);
        let lower = moved[0].cholesky()?.l();
        let squares = (lower.transpose() * moved[1] * lower).symmetric_eigen();
        if !squares.eigenvalues.iter().all(|square| *square > 0.0) {
            return None;
        }
        let root = squares.eigenvalues.map(|square| square.powf(-0.25));
        self.scaling *= lower * squares.eigenvectors * Matrix4::from_diagonal(&root);
        self.lambda = squares.eigenvalues.map(f64::sqrt);
        Some(())
    }
}

/// Cone of a positive coefficient.
pub(super) struct PositiveCone {
    prior: f64,
    bound: BoundDistance,
}

impl PositiveCone {
    /// A coefficient on the path of a weight; `None` if it is not positive.
    pub(super) fn new(prior: f64, own: f64, weight: f64) -> Option<Self> {
        let bound = BoundDistance::new(0, 1.0, own, weight)?;
        Some(Self { prior, bound })
    }
}

impl Cone for PositiveCone {
    fn values(&self) -> Inertia {
        first(self.bound.distance)
    }

    fn scaling(&self) -> Metric {
        corner(self.bound.stiffness().sqrt().recip())
    }

    fn slope(&self, cost: f64, weight: f64) -> Inertia {
        let slope = cost / self.prior + self.bound.slope(weight);
        first(slope / self.bound.stiffness().sqrt())
    }

    fn products(&self) -> (usize, f64) {
        (1, self.bound.product())
    }

    fn propose(&mut self, step: &Inertia, weight: f64) -> f64 {
        self.bound
            .propose(step[0] / self.bound.stiffness().sqrt(), weight)
    }

    fn advance(&mut self, part: f64) -> Option<()> {
        self.bound.advance(part);
        Some(())
    }
}

/// An unconstrained coefficient with a quadratic cost.
pub(super) struct FreeCone {
    /// Change that costs ½.
    scale: f64,
    value: f64,
    /// Next step.
    proposed: f64,
}

impl FreeCone {
    /// A coefficient with the cost `cost` times ½ (value/`magnitude`)².
    pub(super) fn new(magnitude: f64, value: f64, cost: f64) -> Self {
        Self {
            scale: magnitude / cost.sqrt(),
            value,
            proposed: 0.0,
        }
    }
}

impl Cone for FreeCone {
    fn values(&self) -> Inertia {
        first(self.value)
    }

    fn scaling(&self) -> Metric {
        corner(self.scale)
    }

    fn slope(&self, _: f64, _: f64) -> Inertia {
        first(self.value / self.scale)
    }

    fn products(&self) -> (usize, f64) {
        (0, 0.0)
    }

    fn propose(&mut self, step: &Inertia, _: f64) -> f64 {
        self.proposed = self.scale * step[0];
        f64::INFINITY
    }

    fn advance(&mut self, part: f64) -> Option<()> {
        self.value += self.proposed * part;
        Some(())
    }
}

fn first(value: f64) -> Inertia {
    let mut all = Inertia::zeros();
    all[0] = value;
    all
}

fn corner(value: f64) -> Metric {
    let mut all = Metric::zeros();
    all[(0, 0)] = value;
    all
}

#[cfg(test)]
mod tests {
    use super::{BodyCone, Cone, PositiveCone};
    use crate::consistent::pseudo_inertia::{Inertia, divergence};

    /// Two bodies.
    fn bodies() -> [Inertia; 2] {
        let moments = [0.05, 0.01, -0.02, 0.06, 0.005, 0.04];
        let body = |mass: f64, centre: [f64; 3]| {
            let [x, y, z] = centre.map(|value| value * mass);
            let [xx, xy, xz, yy, yz, zz] = moments;
            Inertia::from([xx, xy, xz, yy, yz, zz, x, y, z, mass])
        };
        [
            body(1.5, [0.05, -0.02, 0.03]),
            body(2.5, [0.01, 0.04, -0.03]),
        ]
    }

    #[test]
    fn the_gradient_is_that_of_the_divergence() -> Result<(), &'static str> {
        let [prior, own] = bodies();
        let cone = BodyCone::new(&prior, &own, 1.0).ok_or("no body")?;
        let (slope, scaling) = (cone.slope(1.0, 1.0), cone.scaling());
        for k in 0..10 {
            let at = |factor: f64| {
                let moved = own + scaling.column(k) * factor * 1e-5;
                divergence(&moved, &prior).ok_or("no body")
            };
            let (up, here, down) = (at(1.0)?, at(0.0)?, at(-1.0)?);
            assert!(((up - down) / 2e-5 - slope[k]).abs() < 1e-6, "{k}");
            // On the path of weight 1, the curvature in step coordinates is 1.
            assert!(((up - 2.0 * here + down) / 1e-10 - 1.0).abs() < 1e-3, "{k}");
        }
        Ok(())
    }

    #[test]
    fn steps_move_bodies_by_the_proposed_change() -> Result<(), &'static str> {
        let [prior, own] = bodies();
        let mut cone = BodyCone::new(&prior, &own, 0.3).ok_or("no body")?;
        for (weight, part) in [(0.1, 0.5), (0.02, 0.9), (0.01, 1.0)] {
            let step = Inertia::from_fn(|k, _| 0.01 * (k as f64 + weight).sin());
            let before = cone.values();
            let change = cone.scaling() * step;
            let reach = cone.propose(&step, weight);
            assert!(reach > 1.0, "{reach}");
            cone.advance(part).ok_or("outside")?;
            assert!((cone.values() - before - change * part).norm() < 1e-12);
        }
        Ok(())
    }

    #[test]
    fn newton_steps_without_data_converge_to_the_prior() -> Result<(), &'static str> {
        let [prior, own] = bodies();
        let mut cone = BodyCone::new(&prior, &own, 1.0).ok_or("no body")?;
        for _ in 0..12 {
            let step = -cone.slope(1.0, 1.0);
            let reach = cone.propose(&step, 1.0);
            cone.advance((0.9 * reach).min(1.0)).ok_or("outside")?;
        }
        assert!((cone.values() - prior).norm() < 1e-10);
        let (count, sum) = cone.products();
        assert!((sum - count as f64).abs() < 1e-10);
        Ok(())
    }

    #[test]
    fn coefficient_steps_end_at_zero() -> Result<(), &'static str> {
        let mut cone = PositiveCone::new(2.0, 2.0, 1.0).ok_or("not positive")?;
        // On the path of weight 1, the scaling of a coefficient is its value.
        let step = Inertia::from_fn(|k, _| if k == 0 { -4.0 } else { 0.0 });
        assert!((cone.propose(&step, 1.0) - 0.25).abs() < 1e-12);
        assert!(PositiveCone::new(2.0, 0.0, 1.0).is_none());
        Ok(())
    }
}
