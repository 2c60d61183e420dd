//! Random legs that can follow a platform's motion, by structure.

use super::chain::Chain;
use super::{Attachment, Dice, Placed, Placement, Shape, Sketch};
use crate::reference::kinematics::leg_motion;
use crate::reference::{Frame, Joint, JointKind, Motion};
use nalgebra::{Rotation3, Vector3};
use std::f64::consts::FRAC_PI_2;

/// Structure of a leg.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Structure {
    /// Six joints anywhere; the last body is fixed to the platform.
    Serial,
    /// Three joints anywhere, to a point of the platform.
    Arm,
    /// One or two joints anywhere; their end coincides with the platform along as many axes.
    Slot,
    /// Joints that move in the plane normal to an axis: three to a rigid end, two to a point.
    InPlane(usize),
    /// Joints each followed by one that rotates back, so that the end only translates.
    ///
    /// For a platform with one rotation, there is a further joint about its axis.
    Parallelograms,
    /// Three axes through the origin.
    Wrist,
    /// One joint on the axis of a fixed-axis motion.
    Drive(usize),
    /// A serial or tree robot.
    Tree,
}

impl Structure {
    /// A structure that can follow a motion.
    pub(super) fn draw(dice: &mut Dice, motion: Motion) -> Self {
        use Structure::{Arm, Drive, InPlane, Parallelograms, Serial, Slot, Wrist};
        let any = [Arm, Arm, Slot, Serial];
        let own: Vec<Self> = match motion {
            Motion::None | Motion::Joints(_) => return Self::Tree,
            Motion::Slide { direction, .. } | Motion::Hinge { direction, .. } => {
                let axis = direction.iamax();
                if matches!(motion, Motion::Hinge { .. }) {
                    vec![Drive(axis), Slot, InPlane(axis)]
                } else {
                    let normal = (axis + 1 + dice.below(2)) % 3;
                    vec![Drive(axis), Slot, InPlane(normal), Parallelograms]
                }
            }
            Motion::Point(axis) => vec![InPlane(axis), InPlane(axis), Parallelograms],
            Motion::Planar(axis) => vec![InPlane(axis), InPlane(axis)],
            Motion::Translation | Motion::Schoenflies(_) => vec![Parallelograms],
            Motion::Spherical => vec![Wrist],
            Motion::Spatial | Motion::Parasitic(_) => any.to_vec(),
        };
        if dice.chance(0.5) {
            dice.pick(&own)
        } else {
            dice.pick(&any)
        }
    }

    /// Base frame of a placed leg.
    fn draw_base(self, dice: &mut Dice, motion: Motion) -> Placement {
        let at = std::array::from_fn(|_| dice.length(0.6));
        let axis = match (self, motion) {
            (Self::InPlane(axis) | Self::Drive(axis), _)
            | (Self::Parallelograms, Motion::Schoenflies(axis)) => Some(axis),
            _ => None,
        };
        let rotation = match axis {
            // The leg's z axis coincides with the axis that its joints are parallel to.
            Some(0) => [FRAC_PI_2, 0.0, FRAC_PI_2],
            Some(1) => [-FRAC_PI_2, 0.0, 0.0],
            Some(_) => [0.0, 0.0, dice.angle(3.0)],
            None if dice.chance(0.3) => [0.0; 3],
            None => std::array::from_fn(|_| dice.angle(1.5)),
        };
        let at = match (self, motion) {
            (Self::Wrist, _) => [0.0; 3],
            // The joint may be anywhere along the platform's rotation axis.
            (Self::Drive(axis), Motion::Hinge { point, .. }) => {
                std::array::from_fn(|i| if i == axis { at[i] } else { point[i] })
            }
            _ => at,
        };
        Placement { at, rotation }
    }
}

/// Leg with one or more placements that close at home.
///
/// `None` if an end's orientation has no well-conditioned angles.
pub(super) fn draw_shape(dice: &mut Dice, sketch: &Sketch, structure: Structure) -> Option<Shape> {
    let mut shape = Shape {
        structure,
        members: Vec::new(),
        places: Vec::new(),
    };
    let end = shape.draw_chain(dice, sketch.motion);
    shape.draw_actuators(dice);
    let copies = if structure == Structure::Tree {
        1
    } else {
        dice.pick(&[1, 1, 1, 2, 3])
    };
    for _ in 0..copies {
        let placed = shape.place(dice, sketch, end)?;
        shape.places.push(placed);
    }
    Some(shape)
}

/// Type of a chain's end.
#[derive(Clone, Copy, Debug)]
enum Kind {
    Free,
    Rigid,
    Point([bool; 3]),
}

impl Shape {
    fn draw_chain(&mut self, dice: &mut Dice, motion: Motion) -> Kind {
        let mut chain = Chain::new(dice);
        let everywhere = Kind::Point([true; 3]);
        let end = match self.structure {
            Structure::Serial => {
                chain.anywhere(6);
                Kind::Rigid
            }
            Structure::Arm => {
                chain.anywhere(3);
                everywhere
            }
            Structure::Slot => {
                let along = chain.draw_axes();
                chain.anywhere(along.iter().filter(|a| **a).count());
                Kind::Point(along)
            }
            Structure::InPlane(axis) => {
                let is_rigid = chain.dice.chance(0.5);
                chain.in_plane(if is_rigid { 3 } else { 2 });
                let in_plane = std::array::from_fn(|a| a != axis);
                match (is_rigid, chain.dice.chance(0.5)) {
                    (true, _) => Kind::Rigid,
                    (false, true) => Kind::Point(in_plane),
                    (false, false) => everywhere,
                }
            }
            Structure::Parallelograms => {
                chain.parallelograms(matches!(motion, Motion::Schoenflies(_)));
                Kind::Rigid
            }
            Structure::Wrist => {
                chain.wrist();
                Kind::Rigid
            }
            Structure::Drive(_) => {
                let turns = matches!(motion, Motion::Hinge { .. });
                let joint = chain.next(if turns {
                    JointKind::Revolute
                } else {
                    JointKind::Prismatic
                });
                chain.push(joint);
                Kind::Rigid
            }
            Structure::Tree => {
                chain.tree();
                Kind::Free
            }
        };
        self.members = chain.members;
        end
    }

    /// Draws one motor, sometimes two or none; all joints of a tree are actuated.
    fn draw_actuators(&mut self, dice: &mut Dice) {
        let mut independent = self.independent();
        dice.shuffle(&mut independent);
        if self.structure != Structure::Tree {
            independent.truncate(dice.pick(&[1, 1, 1, 1, 1, 1, 2, 2, 3, 0]));
        }
        for at in independent {
            self.members[at].joint.actuated = true;
        }
    }

    fn place(&self, dice: &mut Dice, sketch: &Sketch, kind: Kind) -> Option<Placed> {
        let home = |at: usize, dice: &mut Dice| match self.members[at].joint.kind {
            JointKind::Revolute => dice.angle(3.0),
            _ => dice.distance(0.1, 0.6),
        };
        let mut placed = Placed {
            base: self.structure.draw_base(dice, sketch.motion),
            home: self
                .independent()
                .into_iter()
                .map(|at| home(at, dice))
                .collect(),
            end: Attachment::Free,
        };
        let leg = self.leg(&placed);
        let still = vec![0.0; placed.home.len()];
        let end = leg_motion(&leg, &placed.home, &still, &still).pop()?.frame;
        let platform = sketch.home.frame();
        let back = platform.rotation.transpose();
        let at: [f64; 3] = (back * (end.position - platform.position)).into();
        placed.end = match kind {
            Kind::Free => Attachment::Free,
            Kind::Point(along) => Attachment::Point(at, along),
            Kind::Rigid => {
                let rotation = angles(&Frame::new(back * end.rotation, Vector3::zeros()))?;
                Attachment::Rigid(Placement { at, rotation })
            }
        };
        Some(placed)
    }
}

/// Angles of an orientation; `None` near a pitch of a right angle.
fn angles(frame: &Frame) -> Option<[f64; 3]> {
    let (rx, ry, rz) = Rotation3::from_matrix_unchecked(frame.rotation).euler_angles();
    (ry.cos() > 0.1).then_some([rx, ry, rz])
}

impl Chain<'_> {
    fn draw_axes(&mut self) -> [bool; 3] {
        let axis = self.dice.below(3);
        let two = self.dice.chance(0.5);
        std::array::from_fn(|at| (at == axis) != two)
    }

    /// Joints anywhere, some with intermediate or branch bodies.
    fn anywhere(&mut self, count: usize) {
        for at in 0..count {
            if at > 0 {
                self.maybe_follow();
                self.maybe_branch();
            }
            let kind = self.draw_kind();
            let joint = self.draw_joint(kind);
            self.push(joint);
        }
        if self.dice.chance(0.5) {
            // A fixed last body moves the end away from the last joint's axis.
            let joint = self.draw_joint(JointKind::Fixed);
            self.push(joint);
        }
    }

    /// Joints that move in the plane normal to the leg's z axis.
    fn in_plane(&mut self, count: usize) {
        // Whether the last z axis is in the plane, that of a prismatic joint.
        let mut lies = false;
        for _ in 0..count {
            self.maybe_branch();
            let kind = self.draw_kind();
            let slides = kind == JointKind::Prismatic;
            let alpha = match (lies, slides) {
                (false, true) => FRAC_PI_2,
                (true, false) => -FRAC_PI_2,
                _ => 0.0,
            };
            let joint = self.next(kind);
            let dice = &mut *self.dice;
            let joint = Joint {
                // The frame of a slide can only rotate about its axis, out of the plane.
                gamma: if lies { 0.0 } else { dice.angle(3.0) },
                alpha,
                d: dice.length(0.5),
                r: if slides { 0.0 } else { dice.length(0.2) },
                ..joint
            };
            self.push(joint);
            lies = slides;
        }
        if !lies {
            let arm = Joint {
                d: self.dice.distance(0.2, 0.5),
                ..self.next(JointKind::Fixed)
            };
            self.push(arm);
        }
    }

    /// Three joints that keep the orientation, and optionally one about the leg's z axis.
    fn parallelograms(&mut self, turns: bool) {
        let first = self.dice.chance(0.5);
        if turns && first {
            self.turn(0.0);
        }
        let mut tilt = 0.0;
        for _ in 0..3 {
            self.maybe_branch();
            let alpha = self.dice.twist();
            tilt += alpha;
            let kind = self.draw_kind();
            let joint = Joint {
                alpha,
                d: self.dice.length(0.4),
                ..self.next(kind)
            };
            let own = self.members.len();
            self.push(joint);
            if kind == JointKind::Revolute {
                let back = Joint {
                    d: self.dice.distance(0.2, 0.6),
                    r: self.dice.length(0.1),
                    ..self.next(JointKind::Revolute)
                };
                self.push(back.dependent(&[(own, -1.0)]));
            }
        }
        if turns && !first {
            self.turn(-tilt);
        }
    }

    fn turn(&mut self, alpha: f64) {
        let joint = Joint {
            alpha,
            d: self.dice.length(0.3),
            ..self.next(JointKind::Revolute)
        };
        self.push(joint);
    }

    /// Three axes through the base's origin; the frames' origins stay on their axes.
    fn wrist(&mut self) {
        let mut r = 0.0;
        for _ in 0..3 {
            self.maybe_branch();
            let joint = Joint {
                b: -r,
                alpha: self.dice.twist(),
                theta: self.dice.angle(1.0),
                r: self.dice.length(0.2),
                ..self.next(JointKind::Revolute)
            };
            r = joint.r;
            self.push(joint);
        }
    }

    /// Up to six joints, branching anywhere.
    fn tree(&mut self) {
        let count = 1 + self.dice.below(6);
        let branches = self.dice.chance(0.5);
        for at in 0..count {
            if at > 0 {
                self.maybe_follow();
                self.maybe_branch();
                if branches && self.dice.chance(0.4) {
                    self.jump();
                }
            }
            let kind = self.draw_kind();
            let joint = self.draw_joint(kind);
            self.push(joint);
        }
    }
}
