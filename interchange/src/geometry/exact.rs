//! Restores exact angles and rotations: 1.5707963 in a file is a right angle.

use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};
use std::f64::consts::PI;

/// Tolerance for multiples of 15°, rad; it corresponds to eight digits in a file.
pub(crate) const TOLERANCE: f64 = 5e-8;

/// Multiple of 15° that an angle equals, if there is one.
#[must_use]
pub(crate) fn fifteenths(angle: f64, tolerance: f64) -> Option<i64> {
    let steps = angle / (PI / 12.0);
    let nearest = steps.round();
    let is_near = nearest.abs() < 1e6 && (angle - nearest * (PI / 12.0)).abs() <= tolerance;
    #[allow(clippy::cast_possible_truncation, reason = "a small whole number")]
    is_near.then_some(nearest as i64)
}

/// Angle, rounded to a multiple of 15° if it is near one.
#[must_use]
pub(crate) fn angle(value: f64) -> f64 {
    #[allow(clippy::cast_precision_loss, reason = "a small whole number")]
    fifteenths(value, TOLERANCE).map_or(value, |k| k as f64 * PI / 12.0)
}

/// Sine and cosine, exact for multiples of 15°.
#[must_use]
pub(crate) fn sin_cos(value: f64) -> (f64, f64) {
    let Some(k) = fifteenths(value, 1e-14 * value.abs().max(1.0)) else {
        return value.sin_cos();
    };
    // Multiples of 90° have integer values, which a rounded π would miss.
    match (k.rem_euclid(24), k.rem_euclid(6)) {
        (0, _) => (0.0, 1.0),
        (6, _) => (1.0, 0.0),
        (12, _) => (0.0, -1.0),
        (18, _) => (-1.0, 0.0),
        _ => value.sin_cos(),
    }
}

/// Rotation about the axis x, y or z (0, 1, 2).
#[must_use]
pub(crate) fn about(axis: usize, value: f64) -> Rotation3<f64> {
    let (s, c) = sin_cos(value);
    let rows = match axis {
        0 => [[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]],
        1 => [[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]],
        _ => [[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]],
    };
    Rotation3::from_matrix_unchecked(Matrix3::from_fn(|i, j| rows[i][j]))
}

/// Rotation about a unit axis.
#[must_use]
pub(crate) fn turn(axis: &Vector3<f64>, value: f64) -> Rotation3<f64> {
    let (s, c) = sin_cos(value);
    let cross = axis.cross_matrix();
    let matrix = Matrix3::identity() * c + cross * s + axis * axis.transpose() * (1.0 - c);
    Rotation3::from_matrix_unchecked(matrix)
}

/// Unit vector of an axis with rounding errors removed; `None` for a zero vector.
#[must_use]
pub(crate) fn direction(xyz: [f64; 3]) -> Option<Vector3<f64>> {
    let clean = |v: f64| {
        if (v - v.round()).abs() < TOLERANCE {
            v.round()
        } else {
            v
        }
    };
    let found = unit(&Vector3::from(xyz), SHORTEST)?;
    Some(found.map(clean).normalize())
}

/// Shortest vector that has a direction.
pub(crate) const SHORTEST: f64 = 1e-9;

/// Unit vector; `None` if the vector is not longer than `shortest`.
///
/// Vectors with large components are scaled first, because squares above 1e154 are infinite.
#[must_use]
pub(crate) fn unit(vector: &Vector3<f64>, shortest: f64) -> Option<Vector3<f64>> {
    let largest = vector.amax();
    if largest > LARGE {
        (vector / largest).try_normalize(shortest)
    } else {
        vector.try_normalize(shortest)
    }
}

/// Magnitude above which components are scaled before they are squared.
const LARGE: f64 = 1e100;

/// Rotation of URDF's roll, pitch and yaw.
#[must_use]
pub(crate) fn roll_pitch_yaw(angles: [f64; 3]) -> Rotation3<f64> {
    let [roll, pitch, yaw] = angles;
    about(2, angle(yaw)) * about(1, angle(pitch)) * about(0, angle(roll))
}

/// Rotation of a quaternion w, x, y, z; `None` for a zero quaternion.
#[must_use]
pub(crate) fn quaternion(wxyz: [f64; 4]) -> Option<Rotation3<f64>> {
    let [w, x, y, z] = wxyz;
    let raw = nalgebra::Quaternion::new(w, x, y, z);
    let largest = raw.coords.amax();
    let raw = if largest > LARGE { raw / largest } else { raw };
    (raw.norm() > 1e-12).then(|| {
        let unit = UnitQuaternion::from_quaternion(raw);
        cleaned(&unit.to_rotation_matrix())
    })
}

/// Rotation whose entries near −1, 0 and 1 are rounded to these.
#[must_use]
pub(crate) fn cleaned(rotation: &Rotation3<f64>) -> Rotation3<f64> {
    let clean = |value: f64| {
        let whole = value.round();
        if (value - whole).abs() < 4e-15 {
            whole
        } else {
            value
        }
    };
    Rotation3::from_matrix_unchecked(rotation.matrix().map(clean))
}

#[cfg(test)]
mod tests {
    use super::{angle, direction, quaternion, roll_pitch_yaw};
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_6};

    /// Number as a file writes it with some digits.
    fn written(value: f64, digits: usize) -> f64 {
        format!("{value:.digits$}").parse().expect("a number")
    }

    #[test]
    fn rounded_right_angles_become_exact() {
        assert_eq!(angle(written(FRAC_PI_2, 7)), FRAC_PI_2);
        assert!((angle(written(FRAC_PI_6, 7)) - FRAC_PI_6).abs() < 1e-15);
        let coarse = written(FRAC_PI_2, 4);
        assert_eq!(angle(coarse), coarse);
        assert_eq!(angle(0.3), 0.3);
    }

    #[test]
    fn directions_of_huge_vectors_do_not_overflow() {
        for size in [1.0, 1e100, 1e155, 1e160, 1e308] {
            let up = direction([0.0, size, 0.0]).expect("a direction");
            assert_eq!([up.x, up.y, up.z], [0.0, 1.0, 0.0], "{size:e}");
            let across = direction([size, 0.0, size]).expect("a direction");
            assert!(
                (across.x - std::f64::consts::FRAC_1_SQRT_2).abs() < 1e-15,
                "{size:e}"
            );
            let turned = quaternion([size, 0.0, 0.0, size]).expect("a quaternion");
            assert!(turned.matrix().iter().all(|v| v.fract() == 0.0), "{turned}");
        }
        assert!(direction([0.0, 1e-10, 0.0]).is_none());
    }

    #[test]
    fn rotations_by_right_angles_are_permutations() {
        let right = written(FRAC_PI_2, 10);
        let turned = roll_pitch_yaw([right, 0.0, -right]);
        assert!(turned.matrix().iter().all(|v| v.fract() == 0.0));
        let half = written(std::f64::consts::FRAC_1_SQRT_2, 6);
        let turned = quaternion([half, 0.0, half, 0.0]).expect("a quaternion");
        assert!(turned.matrix().iter().all(|v| v.fract() == 0.0), "{turned}");
        assert!(quaternion([0.0; 4]).is_none());
    }
}
