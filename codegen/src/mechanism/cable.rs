//! Cables in floating point: length and direction at a configuration, for the checks at home.
//!
//! A cable reaches its pulley at the exit point, the origin of the leg's base frame, in the
//! direction of the z axis, about which the pulley swivels. In the plane of that axis and the
//! platform point P, with r the distance of P from the axis and h its height, the pulley's centre
//! is at (ρ, 0), at the distance d² = (r - ρ)² + h² from P. The straight part has the length
//! s = √(d² - ρ²) and the direction (sin β, cos β), with the wrapped angle β:
//! d² sin β = ρ h + s (r - ρ), d² cos β = s h - ρ (r - ρ). The length is s + ρ β.

use super::numeric::placement_isometry;
use super::{Cable, Leg, Mechanism};
use nalgebra::{DMatrix, Isometry3, Vector3};
use std::f64::consts::FRAC_PI_2;

/// The course of a cable.
#[derive(Debug, Clone, Copy)]
pub(super) struct CableCourse {
    /// Length from the exit point to the platform point, m.
    pub(super) length: f64,
    /// Length of the straight part, m.
    pub(super) straight: f64,
    /// Direction of the straight part in the robot's base frame.
    pub(super) direction: Vector3<f64>,
    /// Distance of the platform point from the swivel axis, m; infinite for an eyelet.
    pub(super) from_axis: f64,
}

/// The reason why a cable has no course.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum CableProblem {
    /// The platform point coincides with the exit point.
    NoLength,
    /// The platform point is closer to the pulley's centre than the radius.
    InsidePulley {
        /// Distance from the centre, m.
        distance: f64,
        /// Radius of the pulley, m.
        radius: f64,
    },
    /// The platform point is on the swivel axis.
    OnSwivelAxis,
    /// The cable would wrap in the wrong direction.
    Behind,
}

/// Length, relative to the largest one involved, below which it counts as zero.
const NOTHING: f64 = 1e-6;
/// The same of states far from singularities.
const REGULAR: f64 = 0.05;

/// The course of a leg's cable to a target.
///
/// # Errors
/// The target is the exit point, on the swivel axis, or cannot be reached over the pulley.
pub(super) fn wrap(
    leg: &Leg,
    cable: &Cable,
    target: &Isometry3<f64>,
) -> Result<CableCourse, CableProblem> {
    let base = placement_isometry(&leg.base);
    let point = base.inverse() * nalgebra::Point3::from(target.translation.vector);
    let radius = cable.pulley.value();
    let distance = point.coords.norm();
    let scale = base.translation.vector.norm() + distance;
    if distance <= NOTHING * scale {
        return Err(CableProblem::NoLength);
    }
    if radius == 0.0 {
        return Ok(CableCourse {
            length: distance,
            straight: distance,
            direction: base.rotation * point.coords / distance,
            from_axis: f64::INFINITY,
        });
    }
    let from_axis = point.x.hypot(point.y);
    let (beyond, height) = (from_axis - radius, point.z);
    let from_centre = beyond.hypot(height);
    let square = from_centre.powi(2) - radius.powi(2);
    if square <= 0.0 {
        return Err(CableProblem::InsidePulley {
            distance: from_centre,
            radius,
        });
    }
    if from_axis <= NOTHING * scale {
        return Err(CableProblem::OnSwivelAxis);
    }
    let straight = square.sqrt();
    let sine = (radius * height + straight * beyond) / from_centre.powi(2);
    let cosine = (straight * height - radius * beyond) / from_centre.powi(2);
    let wrapped = FRAC_PI_2 + (-cosine).atan2(sine);
    if wrapped <= 0.0 {
        return Err(CableProblem::Behind);
    }
    let outwards = Vector3::new(point.x, point.y, 0.0) / from_axis;
    Ok(CableCourse {
        length: straight + radius * wrapped,
        straight,
        direction: base.rotation * (outwards * sine + Vector3::z() * cosine),
        from_axis,
    })
}

/// The course of a cable, if it is far from singularities.
pub(super) fn wrap_within(
    leg: &Leg,
    cable: &Cable,
    target: &Isometry3<f64>,
) -> Option<CableCourse> {
    let found = wrap(leg, cable, target).ok()?;
    let least = REGULAR * found.length;
    (found.straight > least && found.from_axis > least).then_some(found)
}

impl Mechanism {
    /// ∂ℓ/∂P of a cable, 1 × 3, at a configuration.
    pub(super) fn cable_row(
        &self,
        leg: usize,
        pose: &[f64],
        joints: &[f64],
    ) -> Option<DMatrix<f64>> {
        let target = self.target(leg, pose, joints)?;
        let own = &self.legs[leg];
        let course = wrap(own, own.cable.as_ref()?, &target).ok()?;
        Some(DMatrix::from_row_slice(1, 3, course.direction.as_slice()))
    }
}
