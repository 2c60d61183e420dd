//! Robots whose platform only translates: the Delta with its parallelograms, and a Tripteron.

use crate::reference::kinematics::leg_motion;
use crate::reference::mechanism::{End, Joint, Leg, Mechanism};
use crate::reference::motion::Motion;
use crate::reference::placement::{Frame, exponential};
use nalgebra::{Matrix3, Vector3};
use std::f64::consts::FRAC_PI_2;

/// The Delta: three arms with parallelograms, a platform that only translates.
///
/// A parallelogram is one bar with two dependent joints at its far end: they take back the bar's
/// inclination, q4 = -q3 and q5 = -(q1 + q2), so the platform never turns.
#[must_use]
pub fn delta() -> Mechanism {
    let leg = |k: u8| {
        let angle = 2.0 * std::f64::consts::PI * f64::from(k) / 3.0;
        // Joint axes are tangential: x outwards, y up.
        let base = Frame::about_z(angle) * Frame::at(0.2, 0.0, 0.0) * Frame::about_x(FRAC_PI_2);
        let radial = Vector3::new(angle.cos(), angle.sin(), 0.0);
        Leg {
            carrier: None,
            body: None,
            joints: vec![
                Joint::revolute(0, 0.0, 0.0).actuated(),
                Joint::revolute(1, 0.0, 0.25),
                Joint::revolute(2, FRAC_PI_2, 0.0),
                Joint::revolute(3, 0.0, 0.55).dependent(&[(2, -1.0)]),
                Joint::revolute(4, -FRAC_PI_2, 0.0).dependent(&[(0, -1.0), (1, -1.0)]),
            ],
            end: End::Rigid {
                joint: 4,
                attachment: Frame::new(base.rotation, 0.08 * radial),
            },
            start: vec![-0.3, -1.5, 0.05],
            base,
        }
    };
    Mechanism {
        gravity: Vector3::new(0.0, 0.0, -9.81),
        motion: Motion::Translation,
        home: vec![0.0, 0.0, -0.5],
        workspace: vec![0.15, 0.15, 0.12],
        legs: (0..3).map(leg).collect(),
        elements: Vec::new(),
        motors: Vec::new(),
    }
}

/// The Tripteron: three PRRR legs with parallel axes in each leg and orthogonal axes between legs.
///
/// The robot is tilted, so that the one angular equation of a leg fills three dependent rows. Its
/// legs' independent rows therefore have to be searched.
#[must_use]
pub fn tilted_tripteron() -> Mechanism {
    let tilt = exponential(Vector3::new(0.2, -0.3, 0.25));
    let leg = |k: usize| {
        let axis = |shift: usize| Vector3::ith((k + shift) % 3, 1.0);
        let rotation = tilt * Matrix3::from_columns(&[axis(1), axis(2), axis(0)]);
        let attachment = Frame::new(rotation, tilt * axis(1) * 0.06);
        let mut leg = Leg {
            carrier: None,
            body: None,
            base: Frame::new(rotation, Vector3::zeros()),
            joints: vec![
                Joint::prismatic(0, 0.0, 0.0).actuated(),
                Joint::revolute(1, 0.0, 0.0),
                Joint::revolute(2, 0.0, 0.3),
                Joint::revolute(3, 0.0, 0.25),
            ],
            end: End::Rigid {
                joint: 3,
                attachment,
            },
            start: vec![0.1, 0.8, -1.7, 0.9],
        };
        // The base is where the leg's start closes the loop at home.
        let end = leg_motion(&leg, &leg.start, &[0.0; 4], &[0.0; 4])[3]
            .frame
            .position;
        leg.base.position = attachment.position - end;
        leg
    };
    Mechanism {
        gravity: Vector3::new(0.0, 0.0, -9.81),
        motion: Motion::Translation,
        home: vec![0.0; 3],
        workspace: vec![0.1; 3],
        legs: (0..3).map(leg).collect(),
        elements: Vec::new(),
        motors: Vec::new(),
    }
}
