//! Spatial robots: legs of a universal and a prismatic joint with a spherical end (UPS), which
//! serve any platform motion.
//!
//! The universal joint is two crossing revolute joints; a spherical end is a point end.

use crate::reference::mechanism::{End, Joint, Leg, Mechanism};
use crate::reference::motion::Motion;
use crate::reference::placement::Frame;
use nalgebra::{Matrix3, Vector3};
use std::f64::consts::FRAC_PI_2;

/// Gough-Stewart platform, six UPS legs: not redundant.
#[must_use]
pub fn hexapod() -> Mechanism {
    let base = [-10.0, 10.0, 110.0, 130.0, 230.0, 250.0];
    let platform = [-50.0, 50.0, 70.0, 170.0, 190.0, 290.0];
    ups_robot(Motion::Spatial, &base, &platform, 0.6)
}

/// Eight UPS legs on a free platform: two actuators more than freedoms.
#[must_use]
pub fn octopod() -> Mechanism {
    let base = [-10.0, 12.0, 80.0, 101.0, 170.0, 193.0, 260.0, 281.0];
    let platform = [-41.0, 38.0, 52.0, 130.0, 140.0, 222.0, 229.0, 311.0];
    ups_robot(Motion::Spatial, &base, &platform, 0.6)
}

/// Four UPS legs on a platform that turns about a fixed point: one actuator more than freedoms.
#[must_use]
pub fn spherical_4ups() -> Mechanism {
    let base = [0.0, 85.0, 180.0, 275.0];
    let platform = [65.0, 150.0, 240.0, 340.0];
    let mut robot = ups_robot(Motion::Spherical, &base, &platform, 0.0);
    for leg in &mut robot.legs {
        // The centre is the base origin; the legs start below it.
        leg.base.position.z = -0.5;
        if let End::Point { attachment, .. } = &mut leg.end {
            attachment.z = 0.1;
        }
    }
    robot
}

/// Five UPS legs on a platform that doesn't tilt: one actuator more than freedoms.
#[must_use]
pub fn schoenflies_5ups() -> Mechanism {
    let base = [0.0, 70.0, 145.0, 216.0, 290.0];
    let platform = [50.0, 30.0, 190.0, 170.0, 330.0];
    ups_robot(Motion::Schoenflies(2), &base, &platform, 0.6)
}

/// Two UPS legs on a platform that turns about an inclined axis: one actuator more than freedoms.
#[must_use]
pub fn hinged_2ups() -> Mechanism {
    let motion = Motion::Hinge {
        point: Vector3::new(0.02, -0.03, 0.6),
        direction: Vector3::new(1.0, 0.2, 0.15).normalize(),
    };
    ups_robot(motion, &[80.0, 260.0], &[95.0, 285.0], 0.0)
}

/// UPS legs from a base circle of radius 0.5 m to a platform circle of radius 0.25 m, points at the
/// given angles in degrees, home at the given height.
fn ups_robot(motion: Motion, base: &[f64], platform: &[f64], height: f64) -> Mechanism {
    let legs = base
        .iter()
        .zip(platform)
        .map(|(b, p)| ups_leg(*b, *p))
        .collect();
    let (home, workspace) = match motion {
        Motion::Spherical => (vec![1.0, 0.0, 0.0, 0.0], vec![0.35; 3]),
        Motion::Hinge { .. } => (vec![0.1], vec![0.5]),
        Motion::Schoenflies(_) => (vec![0.0, 0.0, height, 0.0], vec![0.15, 0.15, 0.1, 0.4]),
        _ => (
            vec![0.0, 0.0, height, 1.0, 0.0, 0.0, 0.0],
            vec![0.12, 0.12, 0.1, 0.3, 0.3, 0.3],
        ),
    };
    Mechanism {
        gravity: Vector3::new(0.0, 0.0, -9.81),
        motion,
        home,
        workspace,
        legs,
        elements: Vec::new(),
        motors: Vec::new(),
    }
}

fn ups_leg(base_deg: f64, platform_deg: f64) -> Leg {
    let (base, platform) = (base_deg.to_radians(), platform_deg.to_radians());
    let radial = Vector3::new(base.cos(), base.sin(), 0.0);
    let tangential = Vector3::new(-base.sin(), base.cos(), 0.0);
    // With a tangential first axis and x upwards, an upright leg is far from the universal joint's
    // singularity.
    let up = Vector3::z();
    let rotation = Matrix3::from_columns(&[up, tangential.cross(&up), tangential]);
    Leg {
        carrier: None,
        body: None,
        base: Frame::new(rotation, 0.5 * radial),
        joints: vec![
            Joint::revolute(0, 0.0, 0.0),
            Joint::revolute(1, FRAC_PI_2, 0.0),
            Joint {
                r: 0.2,
                ..Joint::prismatic(2, FRAC_PI_2, 0.0)
            }
            .actuated(),
        ],
        end: End::Point {
            joint: 2,
            along: [true; 3],
            attachment: 0.25 * Vector3::new(platform.cos(), platform.sin(), 0.0),
        },
        start: vec![0.0, FRAC_PI_2, 0.5],
    }
}
