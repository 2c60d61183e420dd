//! Pseudo-inertia of a rigid body, and divergence between two bodies.
//!
//! P = ∫ [p; 1] [p; 1]ᵀ dm is linear in the ten inertial parameters. P is positive definite if and
//! only if they belong to a body of positive mass density (Wensing, Kim, Slotine 2018). The
//! divergence tr(P_0^-1 P) - log det(P_0^-1 P) - 4 is a distance from a prior P_0. It is
//! independent of frames and units, and infinite at the boundary of positive definite P (Lee,
//! Wensing, Park 2020).

use nalgebra::{Matrix4, SMatrix, SVector};
use overact::StandardParameter;

/// The ten inertial parameters in the order of [`StandardParameter::INERTIA`].
pub(super) type Inertia = SVector<f64, 10>;

/// A matrix over the ten inertial parameters.
pub(super) type Metric = SMatrix<f64, 10, 10>;

/// Rows and columns of P that contain each parameter, with its factors.
const PLACES: [&[(usize, usize, f64)]; 10] = [
    // xx: ∫x² = (yy + zz - xx)/2, and cyclic permutations.
    &[(0, 0, -0.5), (1, 1, 0.5), (2, 2, 0.5)],
    // xy = -∫x y, and cyclic permutations.
    &[(0, 1, -1.0), (1, 0, -1.0)],
    &[(0, 2, -1.0), (2, 0, -1.0)],
    // yy
    &[(0, 0, 0.5), (1, 1, -0.5), (2, 2, 0.5)],
    &[(1, 2, -1.0), (2, 1, -1.0)],
    // zz
    &[(0, 0, 0.5), (1, 1, 0.5), (2, 2, -0.5)],
    // First moments and mass.
    &[(0, 3, 1.0), (3, 0, 1.0)],
    &[(1, 3, 1.0), (3, 1, 1.0)],
    &[(2, 3, 1.0), (3, 2, 1.0)],
    &[(3, 3, 1.0)],
];

/// ∂P/∂χ for the ten parameters.
fn directions() -> [Matrix4<f64>; 10] {
    PLACES.map(|places| {
        let mut direction = Matrix4::zeros();
        for &(row, column, factor) in places {
            direction[(row, column)] = factor;
        }
        direction
    })
}

/// ∂χ/∂P: each parameter is the trace of its matrix times P.
fn duals() -> [Matrix4<f64>; 10] {
    use StandardParameter as P;
    let entries: [&[(usize, usize, f64)]; 10] = StandardParameter::INERTIA.map(|p| match p {
        P::Xx => &[(1, 1, 1.0), (2, 2, 1.0)][..],
        P::Yy => &[(0, 0, 1.0), (2, 2, 1.0)],
        P::Zz => &[(0, 0, 1.0), (1, 1, 1.0)],
        P::Xy => &[(0, 1, -0.5), (1, 0, -0.5)],
        P::Xz => &[(0, 2, -0.5), (2, 0, -0.5)],
        P::Yz => &[(1, 2, -0.5), (2, 1, -0.5)],
        P::Mx => &[(0, 3, 0.5), (3, 0, 0.5)],
        P::My => &[(1, 3, 0.5), (3, 1, 0.5)],
        P::Mz => &[(2, 3, 0.5), (3, 2, 0.5)],
        _ => &[(3, 3, 1.0)],
    });
    entries.map(|entries| {
        let mut dual = Matrix4::zeros();
        for &(row, column, factor) in entries {
            dual[(row, column)] = factor;
        }
        dual
    })
}

/// P of ten parameters.
pub(super) fn pseudo_inertia(inertia: &Inertia) -> Matrix4<f64> {
    let terms = directions();
    let terms = terms.iter().zip(inertia.iter());
    terms.map(|(direction, value)| direction * *value).sum()
}

/// Divergence of a body from its prior; `None` if the parameters belong to no body.
pub(super) fn divergence(inertia: &Inertia, prior: &Inertia) -> Option<f64> {
    let lower = pseudo_inertia(prior).cholesky()?;
    let pseudo = pseudo_inertia(inertia);
    let log_determinant = |factor: &Matrix4<f64>| -> f64 {
        let diagonal = factor.diagonal();
        2.0 * diagonal.iter().map(|value| value.ln()).sum::<f64>()
    };
    let own = pseudo.cholesky()?;
    let log = log_determinant(&own.l()) - log_determinant(&lower.l());
    Some(lower.solve(&pseudo).trace() - log - 4.0)
}

/// The ten parameters of P.
pub(super) fn inertia(pseudo: &Matrix4<f64>) -> Inertia {
    Inertia::from(duals().map(|dual| (dual * pseudo).trace()))
}

/// Smallest eigenvalue of P divided by its trace, for a mean square radius scaled to 1.
///
/// Dimensionless; positive for a body, at most 0.25.
pub(super) fn definiteness(inertia: &Inertia) -> f64 {
    let mut pseudo = pseudo_inertia(inertia);
    let second: f64 = pseudo.view((0, 0), (3, 3)).trace();
    let mass = pseudo[(3, 3)];
    let length = (second / mass).abs().sqrt();
    if !(length.is_finite() && length > 0.0) {
        return f64::NAN;
    }
    for k in 0..3 {
        pseudo.row_mut(k).scale_mut(1.0 / length);
        pseudo.column_mut(k).scale_mut(1.0 / length);
    }
    pseudo.symmetric_eigenvalues().min() / pseudo.trace()
}

#[cfg(test)]
mod tests {
    use super::{Inertia, definiteness, directions, divergence, duals, inertia, pseudo_inertia};
    use nalgebra::Matrix4;

    /// A box of 2 kg whose centre is not the origin.
    fn body() -> Inertia {
        let (mass, centre, half) = (2.0, [0.1, -0.2, 0.3], [0.1, 0.05, 0.2]);
        let mut pseudo = Matrix4::zeros();
        for i in 0..3 {
            for j in 0..3 {
                pseudo[(i, j)] = mass * centre[i] * centre[j];
            }
            pseudo[(i, i)] += mass * half[i] * half[i] / 3.0;
            pseudo[(i, 3)] = mass * centre[i];
            pseudo[(3, i)] = mass * centre[i];
        }
        pseudo[(3, 3)] = mass;
        inertia(&pseudo)
    }

    #[test]
    fn parameters_and_pseudo_inertia_convert_both_ways() {
        for (k, direction) in directions().iter().enumerate() {
            for (l, dual) in duals().iter().enumerate() {
                let expected = f64::from(u8::from(k == l));
                assert!(((direction * dual).trace() - expected).abs() < 1e-15);
            }
        }
        let own = body();
        assert!((inertia(&pseudo_inertia(&own)) - own).norm() < 1e-15);
        // Steiner's theorem: xx of the box about the origin.
        assert!(
            (own[0] - 2.0 * (0.2_f64.powi(2) + 0.3_f64.powi(2) + (0.0025 + 0.04) / 3.0)).abs()
                < 1e-15
        );
    }

    #[test]
    fn divergence_is_zero_for_equal_and_undefined_for_invalid_bodies() {
        assert!(divergence(&body(), &body()).is_some_and(|distance| distance.abs() < 1e-12));
        assert!(definiteness(&body()) > 0.0);
        let mut impossible = body();
        // xx + yy < zz.
        impossible[5] = impossible[0] + impossible[3] + 0.01;
        assert!(divergence(&impossible, &body()).is_none());
        assert!(definiteness(&impossible) < 0.0);
    }
}
