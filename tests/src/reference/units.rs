//! Condition numbers of matrices by twist coordinate, independent of the unit of length.
//!
//! Columns of translations and rotations have different units, so the ratio of singular values
//! depends on the unit of length. In metres, a platform of the size of a hand looks badly
//! conditioned although it is not: it rotates far more than it translates. Angeles divides by the
//! characteristic length, which minimises the ratio. The minimum is the same in every unit,
//! infinite at singularities, and the usual ratio for pure translations or rotations.

use super::linear::condition;
use super::motion::Motion;
use nalgebra::DMatrix;

/// Logarithms of the shortest and the longest characteristic length in the search, m.
const LENGTHS: [f64; 2] = [-7.0, 7.0];
/// Tolerance of the logarithm; the condition number is too large by at most this relative error.
const LOGARITHM_TOLERANCE: f64 = 0.01;

/// Smallest condition number over all units of length, for a matrix with one column per twist
/// coordinate.
///
/// Without a platform the columns belong to joints and are not scaled.
#[must_use]
pub fn unitless_condition(motion: &Motion, matrix: &DMatrix<f64>) -> f64 {
    let basis = motion.twist_basis();
    let is_turn = |at: usize| basis.fixed_view::<3, 1>(3, at).norm() > 0.5;
    let turns: Vec<usize> = (0..basis.ncols()).filter(|&at| is_turn(at)).collect();
    if turns.is_empty() || turns.len() == matrix.ncols() {
        return condition(matrix);
    }
    let with_length = |logarithm: f64| {
        let mut scaled = matrix.clone();
        for &turn in &turns {
            let mut column = scaled.column_mut(turn);
            column /= logarithm.exp();
        }
        condition(&scaled)
    };
    smallest(with_length)
}

/// Minimum of a function of the logarithm of a length, by golden section.
///
/// The condition number is unimodal. It is at most c where P ≤ AᵀA ≤ c² P for a P = a diag(1,
/// length²), and these P form a convex cone, so that their lengths form an interval.
fn smallest(of: impl Fn(f64) -> f64) -> f64 {
    let part = 0.5 * (5.0_f64.sqrt() - 1.0);
    let [mut low, mut high] = LENGTHS;
    let (mut left, mut right) = (high - part * (high - low), low + part * (high - low));
    let (mut at_left, mut at_right) = (of(left), of(right));
    while high - low > LOGARITHM_TOLERANCE {
        if at_left < at_right {
            (high, right, at_right) = (right, left, at_left);
            left = high - part * (high - low);
            at_left = of(left);
        } else {
            (low, left, at_left) = (left, right, at_right);
            right = low + part * (high - low);
            at_right = of(right);
        }
    }
    at_left.min(at_right)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows of rods that support a planar body: x, y, phi.
    fn rods(length: f64) -> DMatrix<f64> {
        let rod = |x: f64, y: f64, arm: f64| [x, y, arm * length];
        let rows = [
            rod(1.0, 0.0, 1.0),
            rod(-0.5, 0.8, 0.9),
            rod(-0.5, -0.8, 1.0),
        ];
        DMatrix::from_row_iterator(3, 3, rows.into_iter().flatten())
    }

    #[test]
    fn the_condition_number_is_independent_of_robot_size() {
        let planar = Motion::Planar(2);
        let metre = unitless_condition(&planar, &rods(1.0));
        assert!(metre > 1.0 && metre < 2.0, "{metre}");
        for length in [0.003, 0.03, 30.0] {
            let found = unitless_condition(&planar, &rods(length));
            assert!(
                (found / metre - 1.0).abs() < LOGARITHM_TOLERANCE,
                "{length}: {found}"
            );
            assert!(found < condition(&rods(length)), "{length}: {found}");
        }
    }

    #[test]
    fn a_singular_matrix_has_a_large_condition_number() {
        let mut matrix = rods(0.03);
        let sum = matrix.row(0) + matrix.row(1);
        matrix.set_row(2, &sum);
        let found = unitless_condition(&Motion::Planar(2), &matrix);
        assert!(found > 1e12, "{found}");
    }

    #[test]
    fn columns_of_one_unit_have_the_usual_condition_number() {
        let matrix = rods(0.03);
        for motion in [Motion::Translation, Motion::Spherical, Motion::None] {
            assert_eq!(unitless_condition(&motion, &matrix), condition(&matrix));
        }
    }
}
