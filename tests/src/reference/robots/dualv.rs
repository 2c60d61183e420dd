//! The DualV: four RRR legs, three freedoms in the horizontal plane.
//!
//! Table 1: legs of one actuated and two passive revolute joints, shoulders at 0.41 m from the
//! centre, both links 0.28 m. Legs 1 and 2 meet the platform at (0, +r_p), turned by half a turn;
//! legs 3 and 4 at (0, -r_p), not turned. This is (53): q1 + q2 + q3 = φ + π for legs 1 and 2 and
//! = φ for legs 3 and 4.

use crate::reference::mechanism::{End, Joint, Leg, Mechanism};
use crate::reference::motion::Motion;
use crate::reference::placement::Frame;
use nalgebra::Vector3;
use std::f64::consts::PI;

/// Directions γ of the shoulders, degrees.
pub const DUALV_GAMMA_DEG: [f64; 4] = [15.52, 164.48, -164.48, -15.52];
/// Distance of the shoulders from the centre, m.
pub const DUALV_SHOULDER: f64 = 0.41;
/// Length of both links, d_2 = d_3, m.
pub const DUALV_LINK: f64 = 0.28;
/// Half length of the platform, r_p, m.
pub const DUALV_PLATFORM_RADIUS: f64 = 0.11;

/// The DualV at its home pose x = y = φ = 0; sin q2 is +, -, +, - for legs 1 to 4.
#[must_use]
pub fn dualv() -> Mechanism {
    // Joint positions near home, degrees: both links at ±45° from the line to the platform.
    let starts = [
        [135.0, 90.0, -45.0],
        [45.0, -90.0, 225.0],
        [-45.0, 90.0, -45.0],
        [225.0, -90.0, -135.0],
    ];
    let leg = |i: usize| {
        let upper = i < 2;
        let reach = if upper {
            DUALV_PLATFORM_RADIUS
        } else {
            -DUALV_PLATFORM_RADIUS
        };
        let turn = if upper { PI } else { 0.0 };
        let gamma = DUALV_GAMMA_DEG[i].to_radians();
        let shoulder = Joint {
            gamma,
            theta: -gamma,
            ..Joint::revolute(0, 0.0, DUALV_SHOULDER)
        };
        Leg {
            carrier: None,
            body: None,
            base: Frame::identity(),
            joints: vec![
                shoulder.actuated(),
                Joint::revolute(1, 0.0, DUALV_LINK),
                Joint::revolute(2, 0.0, DUALV_LINK),
            ],
            end: End::Rigid {
                joint: 2,
                attachment: Frame::at(0.0, reach, 0.0) * Frame::about_z(turn),
            },
            start: starts[i]
                .iter()
                .map(|angle: &f64| angle.to_radians())
                .collect(),
        }
    };
    Mechanism {
        gravity: Vector3::new(0.0, 0.0, -9.81),
        motion: Motion::Planar(2),
        home: vec![0.0; 3],
        workspace: vec![0.1, 0.1, 0.4],
        legs: (0..4).map(leg).collect(),
        elements: Vec::new(),
        motors: Vec::new(),
    }
}
