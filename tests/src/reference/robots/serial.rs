//! Serial and tree robots: no platform, no closure, the model is (1).

use crate::reference::mechanism::{End, Joint, JointKind, Leg, Mechanism};
use crate::reference::motion::Motion;
use crate::reference::placement::Frame;
use nalgebra::Vector3;
use std::f64::consts::FRAC_PI_2;

/// A spatial arm with three revolute joints: waist, shoulder, elbow.
#[must_use]
pub fn serial_3r() -> Mechanism {
    let joints = vec![
        Joint {
            r: 0.35,
            theta: 0.2,
            ..Joint::revolute(0, 0.0, 0.0)
        }
        .actuated(),
        Joint {
            r: 0.12,
            ..Joint::revolute(1, -FRAC_PI_2, 0.05)
        }
        .actuated(),
        Joint {
            r: -0.08,
            gamma: 0.3,
            b: 0.02,
            ..Joint::revolute(2, 0.4, 0.4)
        }
        .actuated(),
    ];
    Mechanism {
        gravity: Vector3::new(0.0, 0.0, -9.81),
        motion: Motion::None,
        home: vec![0.3, -0.4, 0.7],
        workspace: vec![2.0; 3],
        legs: vec![Leg {
            carrier: None,
            body: None,
            base: Frame::identity(),
            joints,
            end: End::Free,
            start: vec![0.3, -0.4, 0.7],
        }],
        elements: Vec::new(),
        motors: Vec::new(),
    }
}

/// A tree: a rotating column with a two-joint arm, and a slide with a fixed bracket.
#[must_use]
pub fn branched_arm() -> Mechanism {
    let bracket = Joint {
        gamma: 0.4,
        b: 0.1,
        ..Joint::new(JointKind::Fixed, 4)
    };
    let joints = vec![
        Joint {
            r: 0.2,
            ..Joint::revolute(0, 0.0, 0.0)
        },
        Joint::revolute(1, FRAC_PI_2, 0.1),
        Joint {
            r: 0.05,
            ..Joint::revolute(2, -0.7, 0.3)
        },
        Joint {
            antecedent: Some(0),
            gamma: 2.0,
            r: 0.1,
            ..Joint::prismatic(3, 1.1, 0.15)
        },
        bracket,
    ];
    let start = vec![0.1, -0.5, 0.8, 0.05];
    Mechanism {
        gravity: Vector3::new(0.5, 0.3, -9.7),
        motion: Motion::None,
        home: start.clone(),
        workspace: vec![2.0, 2.0, 2.0, 0.3],
        legs: vec![Leg {
            carrier: None,
            body: None,
            base: Frame::at(0.1, -0.2, 0.3) * Frame::about_x(0.5),
            joints,
            end: End::Free,
            start,
        }],
        elements: Vec::new(),
        motors: Vec::new(),
    }
}
