//! Lengths of cables, and their derivatives by finite differences.
//!
//! A cable reaches its pulley at the exit point E in the direction z, about which the pulley
//! swivels. The pulley's rim is the circle of radius ρ that touches the z axis at E and lies in the
//! plane of that axis and the platform point. The angle at which the cable leaves the rim is found
//! by bisection: there the platform point is on the tangent. No derivative of the length is derived;
//! nine-point differences of the length give its rate and acceleration.

use super::mechanism::{End, Leg, Mechanism};
use super::placement::Frame;
use nalgebra::{DMatrix, DVector, Vector2};
use std::f64::consts::PI;

/// Step of first differences, m and rad.
const STEP: f64 = 8e-3;
/// Step of second differences, s.
const TIME: f64 = 5e-3;
/// Weights of nine-point differences of first order.
const FIRST_DIFFERENCE: [f64; 4] = [0.8, -0.2, 4.0 / 105.0, -1.0 / 280.0];
/// Weights of nine-point differences of second order.
const SECOND_DIFFERENCE: [f64; 5] = [-205.0 / 72.0, 1.6, -0.2, 8.0 / 315.0, -1.0 / 560.0];

/// Length of a cable for the platform's frame; NaN for other legs.
#[must_use]
pub fn length(leg: &Leg, platform: &Frame) -> f64 {
    let End::Cable {
        attachment, radius, ..
    } = leg.end
    else {
        return f64::NAN;
    };
    let point = platform.position + platform.rotation * attachment;
    let local = leg.base.rotation.transpose() * (point - leg.base.position);
    if radius == 0.0 {
        return local.norm();
    }
    let point = Vector2::new(local.x.hypot(local.y), local.z);
    let rim = |angle: f64| radius * Vector2::new(1.0 - angle.cos(), angle.sin());
    let outside = |angle: f64| {
        let normal = Vector2::new(-angle.cos(), angle.sin());
        normal.dot(&(point - rim(angle)))
    };
    // The point is outside of the tangent at the exit point's side, and inside on the far side.
    let centre = Vector2::new(radius, 0.0);
    let towards = point - centre;
    // The tangent point is at most a right angle before the direction to the point.
    let far = (PI - towards.y.atan2(towards.x)).rem_euclid(2.0 * PI);
    let (mut low, mut high) = (far - PI / 2.0, far);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if outside(middle) < 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    let angle = 0.5 * (low + high);
    radius * angle + (point - rim(angle)).norm()
}

/// Length at a pose.
#[must_use]
pub fn length_at(mechanism: &Mechanism, leg: &Leg, pose: &[f64]) -> f64 {
    length(leg, &mechanism.motion.placement(pose))
}

/// Derivatives of the length per twist coordinate, 1 × r.
#[must_use]
pub fn row(mechanism: &Mechanism, leg: &Leg, pose: &[f64]) -> DMatrix<f64> {
    let dof = mechanism.dof();
    let derivative = |at: usize| -> f64 {
        let moved = |steps: f64| {
            let mut displacement = DVector::zeros(dof);
            displacement[at] = steps * STEP;
            length_at(
                mechanism,
                leg,
                &mechanism.motion.displace(pose, &displacement),
            )
        };
        let parts = FIRST_DIFFERENCE.iter().enumerate().map(|(k, weight)| {
            let steps = (k + 1) as f64;
            weight * (moved(steps) - moved(-steps))
        });
        parts.sum::<f64>() / STEP
    };
    DMatrix::from_fn(1, dof, |_, at| derivative(at))
}

/// Second derivative of the length along the platform's motion.
#[must_use]
pub fn acceleration(
    mechanism: &Mechanism,
    leg: &Leg,
    pose: &[f64],
    twist: &DVector<f64>,
    acceleration: &DVector<f64>,
) -> f64 {
    let at = |t: f64| {
        let displacement = twist * t + acceleration * (0.5 * t * t);
        length_at(
            mechanism,
            leg,
            &mechanism.motion.displace(pose, &displacement),
        )
    };
    let mut sum = SECOND_DIFFERENCE[0] * at(0.0);
    for (k, weight) in SECOND_DIFFERENCE.iter().enumerate().skip(1) {
        let t = k as f64 * TIME;
        sum += weight * (at(t) + at(-t));
    }
    sum / (TIME * TIME)
}
