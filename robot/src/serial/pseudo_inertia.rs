//! Pseudo-inertia ∫ [p; 1] [p; 1]ᵀ dm of a body from its ten parameters, and back.
//!
//! The parameters are xx, xy, xz, yy, yz, zz, mx, my, mz, m about the frame's origin.

use super::tree::INERTIAL;
use nalgebra::{Isometry3, Matrix4};

/// Pseudo-inertia of ten parameters.
pub(super) fn pseudo_inertia(p: &[f64]) -> Matrix4<f64> {
    let [xx, xy, xz, yy, yz, zz, mx, my, mz, m] = std::array::from_fn(|at| p[at]);
    let half = 0.5 * (xx + yy + zz);
    Matrix4::new(
        half - xx,
        -xy,
        -xz,
        mx, //
        -xy,
        half - yy,
        -yz,
        my, //
        -xz,
        -yz,
        half - zz,
        mz, //
        mx,
        my,
        mz,
        m,
    )
}

/// Ten parameters of a pseudo-inertia.
pub(super) fn parameters(j: &Matrix4<f64>) -> [f64; INERTIAL] {
    [
        j[(1, 1)] + j[(2, 2)],
        -j[(0, 1)],
        -j[(0, 2)],
        j[(0, 0)] + j[(2, 2)],
        -j[(1, 2)],
        j[(0, 0)] + j[(1, 1)],
        j[(0, 3)],
        j[(1, 3)],
        j[(2, 3)],
        j[(3, 3)],
    ]
}

/// Ten parameters in a frame in which their own frame has a placement.
pub(super) fn moved(inertia: &[f64; INERTIAL], place: &Isometry3<f64>) -> [f64; INERTIAL] {
    let transform = place.to_homogeneous();
    parameters(&(transform * pseudo_inertia(inertia) * transform.transpose()))
}

#[cfg(test)]
mod tests {
    use super::moved;
    use nalgebra::Isometry3;

    #[test]
    fn a_point_mass_moves_with_its_frame() {
        let point = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 2.0];
        let found = moved(&point, &Isometry3::translation(0.5, 0.0, -1.0));
        let expected = [2.0, 0.0, 1.0, 2.5, 0.0, 0.5, 1.0, 0.0, -2.0, 2.0];
        assert!(
            found
                .iter()
                .zip(expected)
                .all(|(a, b)| (a - b).abs() < 1e-15)
        );
    }
}
