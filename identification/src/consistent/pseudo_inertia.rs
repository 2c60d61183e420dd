//! The pseudo-inertia of a rigid body, and distances between two of them.
//!
//! P = ∫ [p; 1] [p; 1]ᵀ dm is linear in the ten inertial parameters, and these are those of a body of
//! positive mass density exactly if P is positive definite (Wensing, Kim, Slotine 2018). The divergence
//! tr(P_0^-1 P) - log det(P_0^-1 P) - 4 is a distance from a prior P_0 that does not depend on frames and
//! units, and it grows without bound where P ceases to be positive definite (Lee, Wensing, Park 2020).

use nalgebra::{Matrix4, SMatrix, SVector};
use overact::StandardParameter;

/// The ten inertial parameters in the order of [`StandardParameter::INERTIA`].
pub(super) type Inertia = SVector<f64, 10>;

/// A matrix over the ten inertial parameters.
pub(super) type Metric = SMatrix<f64, 10, 10>;

/// Rows and columns of P in which a parameter stands, with its factors.
fn places(parameter: StandardParameter) -> &'static [(usize, usize, f64)] {
    use StandardParameter as P;
    match parameter {
        // ∫x² = (yy + zz - xx)/2, and so on.
        P::Xx => &[(0, 0, -0.5), (1, 1, 0.5), (2, 2, 0.5)],
        P::Yy => &[(0, 0, 0.5), (1, 1, -0.5), (2, 2, 0.5)],
        P::Zz => &[(0, 0, 0.5), (1, 1, 0.5), (2, 2, -0.5)],
        // xy = -∫x y, and so on.
        P::Xy => &[(0, 1, -1.0), (1, 0, -1.0)],
        P::Xz => &[(0, 2, -1.0), (2, 0, -1.0)],
        P::Yz => &[(1, 2, -1.0), (2, 1, -1.0)],
        P::Mx => &[(0, 3, 1.0), (3, 0, 1.0)],
        P::My => &[(1, 3, 1.0), (3, 1, 1.0)],
        P::Mz => &[(2, 3, 1.0), (3, 2, 1.0)],
        P::M => &[(3, 3, 1.0)],
        P::Ia | P::Fv | P::Fs | P::Off | P::K => &[],
    }
}

/// ∂P/∂χ of the ten parameters.
fn directions() -> [Matrix4<f64>; 10] {
    StandardParameter::INERTIA.map(|parameter| {
        let mut direction = Matrix4::zeros();
        for &(row, column, factor) in places(parameter) {
            direction[(row, column)] = factor;
        }
        direction
    })
}

/// ∂χ/∂P: the matrices whose product with P has the parameters for a trace.
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

/// The divergence of a body from its prior, none where no body has these parameters.
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

/// The gradient of the divergence and the inverse of its Hessian, by the ten parameters.
pub(super) fn curvature(inertia: &Inertia, prior: &Inertia) -> Option<(Inertia, Metric)> {
    let pseudo = pseudo_inertia(inertia);
    let own = pseudo.cholesky()?.inverse();
    let difference = pseudo_inertia(prior).cholesky()?.inverse() - own;
    let gradient = Inertia::from(directions().map(|one| (one * difference).trace()));
    // The Hessian is tr(P^-1 E_k P^-1 E_l), so its inverse is that of the dual matrices with P.
    let products = duals().map(|dual| dual * pseudo);
    let inverse = Metric::from_fn(|k, l| (products[k] * products[l]).trace());
    Some((gradient, inverse))
}

/// How many times a step can be made before there is no such body any more; infinite where it leads nowhere
/// of that kind, none where there is no body at the start.
pub(super) fn reach(inertia: &Inertia, step: &Inertia) -> Option<f64> {
    let lower = pseudo_inertia(inertia).cholesky()?.l();
    let half = lower.solve_lower_triangular(&pseudo_inertia(step))?;
    let scaled = lower.solve_lower_triangular(&half.transpose())?;
    let smallest = scaled.symmetric_eigenvalues().min();
    Some(if smallest < 0.0 {
        -1.0 / smallest
    } else {
        f64::INFINITY
    })
}

/// The smallest eigenvalue of P by its trace, after scaling lengths so that the body's mean square radius
/// is 1: a number without units, positive for a body, 0.25 at most.
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
    use super::{
        Inertia, curvature, definiteness, directions, divergence, duals, pseudo_inertia, reach,
    };
    use nalgebra::Matrix4;

    /// The ten parameters of a P.
    fn parameters(pseudo: &Matrix4<f64>) -> Inertia {
        Inertia::from(duals().map(|dual| (dual * pseudo).trace()))
    }

    /// A box of 2 kg whose centre is off the origin.
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
        parameters(&pseudo)
    }

    #[test]
    fn parameters_and_pseudo_inertia_are_inverse() {
        for (k, direction) in directions().iter().enumerate() {
            for (l, dual) in duals().iter().enumerate() {
                let expected = f64::from(u8::from(k == l));
                assert!(((direction * dual).trace() - expected).abs() < 1e-15);
            }
        }
        let own = body();
        assert!((parameters(&pseudo_inertia(&own)) - own).norm() < 1e-15);
        // Steiner: xx of the box about the origin.
        assert!(
            (own[0] - 2.0 * (0.2_f64.powi(2) + 0.3_f64.powi(2) + (0.0025 + 0.04) / 3.0)).abs()
                < 1e-15
        );
    }

    #[test]
    fn the_gradient_is_that_of_the_divergence() -> Result<(), &'static str> {
        let (prior, mut own) = (body(), body() * 1.3);
        own[7] += 0.05;
        own[2] -= 0.01;
        let (gradient, inverse) = curvature(&own, &prior).ok_or("no body")?;
        let hessian = inverse.try_inverse().ok_or("singular")?;
        let step = 1e-5;
        for k in 0..10 {
            let at = |factor: f64| {
                let mut moved = own;
                moved[k] += factor * step;
                divergence(&moved, &prior).ok_or("no body")
            };
            let (up, here, down) = (at(1.0)?, at(0.0)?, at(-1.0)?);
            let slope = (up - down) / (2.0 * step);
            let bend = (up - 2.0 * here + down) / (step * step);
            assert!((slope - gradient[k]).abs() < 1e-4 * gradient.norm(), "{k}");
            assert!((bend / hessian[(k, k)] - 1.0).abs() < 1e-2, "{k}");
        }
        Ok(())
    }

    #[test]
    fn a_step_reaches_to_where_a_body_degenerates() -> Result<(), &'static str> {
        let mut step = Inertia::zeros();
        step[5] = 1.0;
        let far = reach(&body(), &step).ok_or("no body")?;
        let definite = |factor: f64| definiteness(&(body() + step * far * factor));
        assert!(definite(0.999) > 0.0 && definite(1.001) < 0.0);
        assert_eq!(reach(&body(), &body()), Some(f64::INFINITY));
        Ok(())
    }

    #[test]
    fn a_body_is_nearest_to_itself_and_no_body_has_no_distance() {
        assert!(divergence(&body(), &body()).is_some_and(|distance| distance.abs() < 1e-12));
        assert!(definiteness(&body()) > 0.0);
        let mut impossible = body();
        // xx + yy < zz.
        impossible[5] = impossible[0] + impossible[3] + 0.01;
        assert!(divergence(&impossible, &body()).is_none());
        assert!(definiteness(&impossible) < 0.0);
    }
}
