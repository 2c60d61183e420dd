//! Coordinates that the closures of a platform with parasitic motion keep at zero.

use super::Mechanism;
use super::states::random_states;

/// States at which a coordinate has to be zero to be so everywhere.
const STATES: usize = 6;
/// A coordinate that differs from that at home by less, m or of a quaternion, may be at home.
const BESIDE: f64 = 1e-4;
/// Largest coordinate, m or of a quaternion, that is zero but for rounding and for what closures miss.
const ROUNDED: f64 = 1e-9;

/// The coordinates of the pose that the closures of a platform with parasitic motion keep at zero: that of the turn
/// about z of a 3-RPS, for instance. They are zero at random states that differ from home, which a coordinate
/// that depends on the pose is nowhere near home but at home itself.
pub(super) fn still_coordinates(mechanism: &Mechanism) -> Vec<usize> {
    if !mechanism.is_parasitic() {
        return Vec::new();
    }
    let home = &mechanism.home.pose;
    let states = random_states(mechanism, STATES, 11).into_iter();
    let poses: Vec<Vec<f64>> = states.map(|state| state.pose).collect();
    let is_home = |pose: &Vec<f64>| pose.iter().zip(home).all(|(a, b)| (a - b).abs() < BESIDE);
    if poses.iter().any(is_home) {
        return Vec::new();
    }
    let is_still = |at: &usize| {
        let mut all = poses.iter().chain([home]);
        all.all(|pose| pose[*at].abs() < ROUNDED)
    };
    (0..home.len()).filter(is_still).collect()
}
