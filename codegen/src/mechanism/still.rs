//! Pose coordinates that the closures of a platform with parasitic motion keep at zero.

use super::Mechanism;
use super::states::random_states;

/// Number of states at which a coordinate has to be zero.
const STATES: usize = 6;
/// Difference from home, m or of a quaternion, below which a coordinate counts as that of home.
const HOME_TOLERANCE: f64 = 1e-4;
/// Largest coordinate that counts as zero, m or of a quaternion: rounding and closure errors.
const ROUNDED: f64 = 1e-9;

/// Pose coordinates that the closures keep at zero, such as the rotation about z of a 3-RPS.
///
/// They are zero at random states that differ from home. A coordinate that depends on the pose is
/// not zero near home, except at home itself.
pub(super) fn still_coordinates(mechanism: &Mechanism) -> Vec<usize> {
    if !mechanism.is_parasitic() {
        return Vec::new();
    }
    let home = &mechanism.home.pose;
    let states = random_states(mechanism, STATES, 11).into_iter();
    let poses: Vec<Vec<f64>> = states.map(|state| state.pose).collect();
    let is_home = |pose: &Vec<f64>| {
        pose.iter()
            .zip(home)
            .all(|(a, b)| (a - b).abs() < HOME_TOLERANCE)
    };
    if poses.iter().any(is_home) {
        return Vec::new();
    }
    let is_still = |at: &usize| {
        let mut all = poses.iter().chain([home]);
        all.all(|pose| pose[*at].abs() < ROUNDED)
    };
    (0..home.len()).filter(is_still).collect()
}
