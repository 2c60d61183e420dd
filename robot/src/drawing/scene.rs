//! What is drawn, in space and in metres.

use nalgebra::{Isometry3, Vector3};

/// A point or a direction in the base frame.
pub(super) type Point = Vector3<f64>;

/// A body's part, a joint, or what else belongs to a leg.
pub(super) enum Part {
    /// A part of the body behind the joint number `body` of its leg.
    Link { body: usize, path: Vec<Point> },
    /// A body whose length the description does not say.
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
    /// What slides on a rail.
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
    /// An end that coincides with the platform in a point.
    Ball { at: Point },
}

impl Part {
    /// The part as it stands on a body with this frame.
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

    /// The place of a joint.
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

/// What a robot's drawing shows.
pub(super) struct Scene {
    /// Parts with their leg.
    pub(super) parts: Vec<(usize, Part)>,
    /// Where each leg is held, and where its name belongs.
    pub(super) bases: Vec<Point>,
    /// Where the legs are attached to the platform.
    pub(super) attachments: Vec<Point>,
    /// The platform's frame.
    pub(super) platform: Option<Isometry3<f64>>,
    /// Radius of the sphere on which a robot without lengths is drawn.
    pub(super) sphere: Option<f64>,
}

/// Lengths below this are none, m.
pub(super) const NOTHING: f64 = 1e-9;

impl Scene {
    /// Points that the sheet has to hold.
    pub(super) fn points(&self) -> Vec<Point> {
        let mut points = self.bases.clone();
        points.extend(&self.attachments);
        points.extend(self.platform.iter().map(|frame| frame.translation.vector));
        for (_, part) in &self.parts {
            match part {
                Part::Link { path, .. } | Part::Stub { path, .. } => points.extend(path),
                Part::Revolute { at, .. }
                | Part::Slider { at, .. }
                | Part::Universal { at }
                | Part::Ball { at } => points.push(*at),
                Part::Rail { from, to } | Part::Telescope { from, to, .. } => {
                    points.extend([from, to]);
                }
            }
        }
        points
    }

    /// What should be seen apart: joints, a telescope at its middle.
    pub(super) fn landmarks(&self) -> Vec<Point> {
        let landmark = |(_, part): &(usize, Part)| match part {
            Part::Telescope { from, to, .. } => Some((from + to) / 2.0),
            part => part.place().copied(),
        };
        self.parts.iter().filter_map(landmark).collect()
    }
}
