//! Scene: the parts to draw, in space and in metres.

use nalgebra::{Isometry3, Vector3};

/// A point or a direction in the base frame.
pub(super) type Point = Vector3<f64>;

/// Part of a leg: a body segment, a joint or a rail.
pub(super) enum DrawnPart {
    /// Segment of the body after joint number `body` of its leg.
    Link { body: usize, path: Vec<Point> },
    /// Body whose length the description does not give.
    Stub { body: usize, path: Vec<Point> },
    /// A revolute joint.
    Revolute {
        at: Point,
        axis: Point,
        actuated: bool,
    },
    /// Two passive joints whose axes cross.
    Universal { at: Point },
    /// A fixed rail.
    Rail { from: Point, to: Point },
    /// Slider on a rail.
    Slider {
        at: Point,
        axis: Point,
        actuated: bool,
    },
    /// A prismatic joint between moving bodies: a cylinder and its rod.
    Telescope {
        from: Point,
        to: Point,
        actuated: bool,
    },
    /// Point closure on the platform.
    Ball { at: Point },
}

impl DrawnPart {
    /// Transforms the part to the frame of a body.
    pub(super) fn carry(&mut self, frame: &Isometry3<f64>) {
        let point = |at: &mut Point| *at = (frame * nalgebra::Point3::from(*at)).coords;
        match self {
            Self::Link { path, .. } | Self::Stub { path, .. } => path.iter_mut().for_each(point),
            Self::Revolute { at, axis, .. } | Self::Slider { at, axis, .. } => {
                point(at);
                *axis = frame.rotation * *axis;
            }
            Self::Universal { at } | Self::Ball { at } => point(at),
            Self::Rail { from, to } | Self::Telescope { from, to, .. } => {
                point(from);
                point(to);
            }
        }
    }

    /// Position of a joint.
    pub(super) fn place(&self) -> Option<&Point> {
        match self {
            Self::Revolute { at, .. }
            | Self::Slider { at, .. }
            | Self::Universal { at }
            | Self::Ball { at } => Some(at),
            _ => None,
        }
    }
}

/// Scene of a robot.
pub(super) struct Scene {
    /// Parts with the number of their leg.
    pub(super) parts: Vec<(usize, DrawnPart)>,
    /// Base of each leg, which is also the place of its name.
    pub(super) bases: Vec<Point>,
    /// Attachment points of the legs on the platform.
    pub(super) attachments: Vec<Point>,
    /// Frame of the platform.
    pub(super) platform: Option<Isometry3<f64>>,
    /// Radius of the sphere for robots without lengths.
    pub(super) sphere: Option<f64>,
}

/// Length below which parts are not drawn, m.
pub(super) const NOTHING: f64 = 1e-9;

impl Scene {
    /// Points that the sheet must contain.
    pub(super) fn points(&self) -> Vec<Point> {
        let mut points = self.bases.clone();
        points.extend(&self.attachments);
        points.extend(self.platform.iter().map(|frame| frame.translation.vector));
        for (_, part) in &self.parts {
            match part {
                DrawnPart::Link { path, .. } | DrawnPart::Stub { path, .. } => points.extend(path),
                DrawnPart::Revolute { at, .. }
                | DrawnPart::Slider { at, .. }
                | DrawnPart::Universal { at }
                | DrawnPart::Ball { at } => points.push(*at),
                DrawnPart::Rail { from, to } | DrawnPart::Telescope { from, to, .. } => {
                    points.extend([from, to]);
                }
            }
        }
        points
    }

    /// Points that the view should separate: joints, and the middle of telescopes.
    pub(super) fn landmarks(&self) -> Vec<Point> {
        let landmark = |(_, part): &(usize, DrawnPart)| match part {
            DrawnPart::Telescope { from, to, .. } => Some((from + to) / 2.0),
            part => part.place().copied(),
        };
        self.parts.iter().filter_map(landmark).collect()
    }
}
