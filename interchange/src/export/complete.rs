//! Completes inertial parameters that the motion does not determine to a consistent body.
//!
//! A body is physically consistent if its pseudo-inertia [Σ, h; hᵀ, m] with Σ = ½ tr(I) 1 − I is
//! positive definite (Wensing et al. 2018). Among the free parameters, the values nearest to the
//! file's are sought. The algorithm alternates projections onto the given parameters and onto
//! positive definite matrices.

use nalgebra::{DMatrix, DVector, Matrix4, SymmetricEigen};

/// Largest number of projections.
const ROUNDS: usize = 20_000;
/// Smallest eigenvalue to reach, relative to the mean eigenvalue.
const FLOOR: f64 = 1e-4;
/// Indices of the ten independent entries of the pseudo-inertia.
const ENTRIES: [(usize, usize); 10] = [
    (0, 0),
    (0, 1),
    (0, 2),
    (1, 1),
    (1, 2),
    (2, 2),
    (0, 3),
    (1, 3),
    (2, 3),
    (3, 3),
];

/// Changes the parameters that are not fixed so that the body is physically consistent.
///
/// The order is xx, xy, xz, yy, yz, zz, mx, my, mz, m. `None` if no such values were found.
pub(super) fn completed(values: &[f64; 10], is_fixed: [bool; 10]) -> Option<[f64; 10]> {
    // Scale lengths by the body's own size, so that all entries have similar magnitude.
    let trace = values[0].abs() + values[3].abs() + values[5].abs();
    let first = values[6..9]
        .iter()
        .copied()
        .map(f64::abs)
        .fold(0.0, f64::max);
    let mass = values[9]
        .abs()
        .max(first * first / trace.max(f64::MIN_POSITIVE));
    if trace <= 0.0 || mass <= 0.0 {
        return None;
    }
    let length = (trace / mass).sqrt();
    let unit = |at: usize| match at {
        0..6 => mass * length * length,
        6..9 => mass * length,
        _ => mass,
    };
    let fixed: Vec<usize> = (0..10).filter(|&at| is_fixed[at]).collect();
    // Each fixed parameter as a sum of entries; off-diagonal entries count twice in the norm.
    let rows = DMatrix::from_fn(fixed.len(), 10, |i, j| row(fixed[i])[j] / weight(j));
    let right = DVector::from_fn(fixed.len(), |i, _| values[fixed[i]] / unit(fixed[i]));
    let inverse = rows.clone().pseudo_inverse(1e-12).ok()?;
    let start: [f64; 10] = std::array::from_fn(|at| values[at] / unit(at));
    let mut matrix = pseudo_inertia(&start);
    for _ in 0..ROUNDS {
        let entries = DVector::from_fn(10, |at, _| matrix[ENTRIES[at]] * weight(at));
        let entries = &entries - &inverse * (&rows * &entries - &right);
        for (at, place) in ENTRIES.iter().enumerate() {
            let value = entries[at] / weight(at);
            matrix[*place] = value;
            matrix[(place.1, place.0)] = value;
        }
        let eigen = SymmetricEigen::new(matrix);
        let floor = FLOOR * matrix.trace().abs() / 4.0;
        if eigen.eigenvalues.min() >= 0.5 * floor {
            let found = parameters(&matrix);
            return Some(std::array::from_fn(|at| {
                if is_fixed[at] {
                    values[at]
                } else {
                    found[at] * unit(at)
                }
            }));
        }
        let raised = eigen.eigenvalues.map(|value| value.max(floor));
        matrix =
            eigen.eigenvectors * Matrix4::from_diagonal(&raised) * eigen.eigenvectors.transpose();
    }
    None
}

/// Weight of an entry in the Frobenius norm: off-diagonal entries occur twice.
fn weight(entry: usize) -> f64 {
    let (i, j) = ENTRIES[entry];
    if i == j {
        1.0
    } else {
        std::f64::consts::SQRT_2
    }
}

/// Coefficients of a parameter in the entries of the pseudo-inertia.
fn row(parameter: usize) -> [f64; 10] {
    let mut row = [0.0; 10];
    match parameter {
        0 => (row[3], row[5]) = (1.0, 1.0),
        3 => (row[0], row[5]) = (1.0, 1.0),
        5 => (row[0], row[3]) = (1.0, 1.0),
        1 | 2 | 4 => row[parameter] = -1.0,
        _ => row[parameter] = 1.0,
    }
    row
}

fn pseudo_inertia(p: &[f64; 10]) -> Matrix4<f64> {
    let [xx, xy, xz, yy, yz, zz, mx, my, mz, m] = *p;
    let half = 0.5 * (xx + yy + zz);
    Matrix4::new(
        half - xx,
        -xy,
        -xz,
        mx,
        -xy,
        half - yy,
        -yz,
        my,
        -xz,
        -yz,
        half - zz,
        mz,
        mx,
        my,
        mz,
        m,
    )
}

fn parameters(matrix: &Matrix4<f64>) -> [f64; 10] {
    let entries = ENTRIES.map(|place| matrix[place]);
    std::array::from_fn(|at| {
        row(at)
            .iter()
            .zip(entries)
            .map(|(factor, entry)| factor * entry)
            .sum()
    })
}

#[cfg(test)]
mod tests {
    use super::{completed, parameters, pseudo_inertia};

    #[test]
    fn pseudo_inertia_and_parameters_round_trip() {
        let values = [0.3, 0.01, -0.02, 0.4, 0.03, 0.5, 0.1, -0.2, 0.3, 2.0];
        let again = parameters(&pseudo_inertia(&values));
        assert!(values.iter().zip(again).all(|(a, b)| (a - b).abs() < 1e-15));
    }

    #[test]
    fn undetermined_parameters_are_completed_to_a_valid_body() {
        // A moment about z that exceeds the sum of the file's other two moments, which the motion
        // does not determine.
        let values = [1e-3, 0.0, 0.0, 1e-3, 0.0, 5e-3, 0.02, 0.01, 0.0, 0.05];
        let mut is_fixed = [false; 10];
        for at in [5, 6, 7] {
            is_fixed[at] = true;
        }
        let found = completed(&values, is_fixed).expect("a body");
        assert_eq!([found[5], found[6], found[7]], [5e-3, 0.02, 0.01]);
        let eigenvalues = pseudo_inertia(&found).symmetric_eigenvalues();
        assert!(eigenvalues.min() > 0.0, "{eigenvalues}");
        assert!(
            completed(
                &[-1.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
                [true; 10]
            )
            .is_none()
        );
    }
}
