//! Converts a sketch to the plain data of the numeric reference.

use super::{Attachment, Placed, Placement, Shape, Sketch};
use crate::reference::{End, Frame, Leg, Mechanism, Motion};
use nalgebra::{Rotation3, UnitQuaternion, Vector3};

impl Placement {
    /// Frame of the placement.
    #[must_use]
    pub fn frame(&self) -> Frame {
        let [rx, ry, rz] = self.rotation;
        let rotation = Rotation3::from_euler_angles(rx, ry, rz).into_inner();
        Frame::new(rotation, Vector3::from(self.at))
    }
}

impl Shape {
    /// The leg at one of its placements.
    #[must_use]
    pub fn leg(&self, placed: &Placed) -> Leg {
        let joint = self.members.len() - 1;
        let end = match placed.end {
            Attachment::Free => End::Free,
            Attachment::Rigid(placement) => End::Rigid {
                joint,
                attachment: placement.frame(),
            },
            Attachment::Point(at, along) => End::Point {
                joint,
                attachment: Vector3::from(at),
                along,
            },
        };
        Leg {
            carrier: None,
            body: None,
            base: placed.base.frame(),
            joints: self.members.iter().map(|m| m.joint.clone()).collect(),
            end,
            start: placed.home.clone(),
        }
    }
}

impl Sketch {
    /// The mechanism without a workspace.
    #[must_use]
    pub fn mechanism(&self) -> Mechanism {
        let of_shape = |shape: &Shape| -> Vec<Leg> {
            let legs = shape.places.iter().map(|placed| shape.leg(placed));
            legs.collect()
        };
        Mechanism {
            gravity: Vector3::from(self.gravity),
            motion: self.motion,
            home: self.pose(),
            workspace: Vec::new(),
            legs: self.shapes.iter().flat_map(of_shape).collect(),
            elements: Vec::new(),
            motors: Vec::new(),
        }
    }

    /// The home pose in the coordinates of the motion.
    fn pose(&self) -> Vec<f64> {
        let Placement { at, rotation } = self.home;
        let quaternion = || {
            let [rx, ry, rz] = rotation;
            let q = UnitQuaternion::from_euler_angles(rx, ry, rz);
            [q.w, q.i, q.j, q.k]
        };
        let plane = |axis: usize| [at[(axis + 1) % 3], at[(axis + 2) % 3]];
        match self.motion {
            Motion::None | Motion::Joints(_) => self.shapes[0].places[0].home.clone(),
            Motion::Slide { point, direction } => {
                let axis = direction.iamax();
                vec![at[axis] - point[axis]]
            }
            Motion::Hinge { direction, .. } => vec![rotation[direction.iamax()]],
            Motion::Point(axis) => plane(axis).to_vec(),
            Motion::Planar(axis) => [&plane(axis)[..], &[rotation[axis]]].concat(),
            Motion::Translation => at.to_vec(),
            Motion::Schoenflies(axis) => [&at[..], &[rotation[axis]]].concat(),
            Motion::Spherical => quaternion().to_vec(),
            Motion::Spatial | Motion::Parasitic(_) => [&at[..], &quaternion()].concat(),
        }
    }
}
