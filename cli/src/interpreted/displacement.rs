//! Moving a pose along the twist coordinates.

/// Coordinates that add.
pub(super) fn plain(pose: &mut [f64], step: &[f64]) {
    for (coordinate, step) in pose.iter_mut().zip(step) {
        *coordinate += step;
    }
}

/// A pose that ends with a unit quaternion (w, x, y, z), and a step that ends with a rotation vector
/// in the base frame: q <- exp(step/2) q, renormalised so that rounding never adds up.
pub(super) fn with_quaternion(pose: &mut [f64], step: &[f64]) {
    let (Some(translations), Some((at, turn))) =
        (pose.len().checked_sub(4), step.split_last_chunk::<3>())
    else {
        return;
    };
    plain(&mut pose[..translations], at);
    let angle = turn.iter().map(|t| t * t).sum::<f64>().sqrt();
    // sin(angle/2)/angle, by its series where the quotient loses its digits.
    let half = 0.5 * angle;
    let scale = if angle > 1e-4 {
        half.sin() / angle
    } else {
        0.5 - angle * angle / 48.0
    };
    let [x, y, z] = turn.map(|t| t * scale);
    let w = half.cos();
    let [qw, qx, qy, qz] = std::array::from_fn(|i| pose[translations + i]);
    let turned = [
        w * qw - x * qx - y * qy - z * qz,
        w * qx + x * qw + y * qz - z * qy,
        w * qy - x * qz + y * qw + z * qx,
        w * qz + x * qy - y * qx + z * qw,
    ];
    let norm = turned.iter().map(|q| q * q).sum::<f64>().sqrt();
    for (coordinate, value) in pose[translations..].iter_mut().zip(turned) {
        *coordinate = value / norm;
    }
}

#[cfg(test)]
mod tests {
    use super::with_quaternion;
    use nalgebra::{Quaternion, UnitQuaternion, Vector3};

    #[test]
    fn the_step_is_a_rotation_in_the_base_frame() {
        for size in [1.0, 1e-3, 1e-6, 0.0] {
            let start = UnitQuaternion::from_euler_angles(0.3, -0.8, 1.2);
            let turn = Vector3::new(0.4, -0.2, 0.9) * size;
            let expected = UnitQuaternion::from_scaled_axis(turn) * start;
            let mut pose = [1.0, 2.0, 3.0, start.w, start.i, start.j, start.k];
            let step = [0.1, 0.0, -0.1, turn.x, turn.y, turn.z];
            with_quaternion(&mut pose, &step);
            assert_eq!(pose[..3], [1.1, 2.0, 2.9]);
            let found = Quaternion::new(pose[3], pose[4], pose[5], pose[6]);
            assert!((found - expected.into_inner()).norm() < 1e-15);
        }
    }
}
