//! Planar robots: legs that meet in a point, and two actuators on one slide.

use crate::reference::mechanism::{End, Joint, JointKind, Leg, Mechanism};
use crate::reference::motion::Motion;
use crate::reference::placement::Frame;
use nalgebra::Vector3;
use std::f64::consts::{FRAC_PI_2, PI};

/// Length of the proximal links, m.
const PROXIMAL: f64 = 0.30;
/// Length of the distal links, m.
const DISTAL: f64 = 0.36;

/// Two RR legs that meet in a point, y pointing up: not redundant.
#[must_use]
pub fn five_bar() -> Mechanism {
    let legs = vec![
        rr_leg([-0.15, 0.0], [130.0, -80.0]),
        rr_leg([0.15, 0.0], [50.0, 80.0]),
    ];
    point_robot(legs, vec![0.0, 0.45], [0.0, -9.81, 0.0])
}

/// Three RR legs that meet in a point, horizontal: one actuator more than freedoms.
#[must_use]
pub fn three_rr_point() -> Mechanism {
    let leg = |k: u8| {
        let direction = 90.0 + 120.0 * f64::from(k);
        let angle = direction.to_radians();
        rr_leg(
            [0.45 * angle.cos(), 0.45 * angle.sin()],
            [direction + 180.0 - 52.0, 92.0],
        )
    };
    point_robot((0..3).map(leg).collect(), vec![0.0, 0.0], [0.0, 0.0, -9.81])
}

/// Two prismatic actuators on one slide: the robot of Fig. 1, the second one inclined with a
/// passive slide across it.
#[must_use]
pub fn two_slides() -> Mechanism {
    // The z axis of the first joint is the slide's direction, x of the base.
    let along = Frame::new(
        nalgebra::Matrix3::new(0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0),
        Vector3::zeros(),
    );
    let direct = Leg {
        carrier: None,
        body: None,
        base: along,
        joints: vec![Joint::prismatic(0, 0.0, 0.0).actuated()],
        end: End::Rigid {
            joint: 0,
            attachment: Frame::new(along.rotation, Vector3::zeros()),
        },
        start: vec![0.0],
    };
    let inclined = Leg {
        carrier: None,
        body: None,
        base: along * Frame::about_x(0.3),
        joints: vec![
            Joint::prismatic(0, 0.0, 0.0).actuated(),
            Joint::prismatic(1, FRAC_PI_2, 0.0),
        ],
        end: End::Point {
            joint: 1,
            along: [true; 3],
            attachment: Vector3::zeros(),
        },
        start: vec![0.0, 0.0],
    };
    Mechanism {
        gravity: Vector3::new(0.0, 0.0, -9.81),
        motion: Motion::Slide {
            point: Vector3::zeros(),
            direction: Vector3::x(),
        },
        home: vec![0.1],
        workspace: vec![0.3],
        legs: vec![direct, inclined],
        elements: Vec::new(),
        motors: Vec::new(),
    }
}

fn rr_leg(base: [f64; 2], start_deg: [f64; 2]) -> Leg {
    let tip = Joint {
        theta: PI,
        ..Joint::revolute(2, 0.0, DISTAL)
    };
    Leg {
        carrier: None,
        body: None,
        base: Frame::at(base[0], base[1], 0.0),
        joints: vec![
            Joint::revolute(0, 0.0, 0.0).actuated(),
            Joint::revolute(1, 0.0, PROXIMAL),
            // The tip is a fixed frame, half a turn from the link to exercise its constants.
            Joint {
                kind: JointKind::Fixed,
                terms: Vec::new(),
                ..tip
            },
        ],
        end: End::Point {
            joint: 2,
            along: [true; 3],
            attachment: Vector3::zeros(),
        },
        start: start_deg
            .iter()
            .map(|angle: &f64| angle.to_radians())
            .collect(),
    }
}

fn point_robot(legs: Vec<Leg>, home: Vec<f64>, gravity: [f64; 3]) -> Mechanism {
    Mechanism {
        gravity: Vector3::from(gravity),
        motion: Motion::Point(2),
        home,
        workspace: vec![0.1, 0.1],
        legs,
        elements: Vec::new(),
        motors: Vec::new(),
    }
}
