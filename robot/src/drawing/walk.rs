//! Converts a leg to parts of the scene, joint by joint.

use super::scene::{DrawnPart, NOTHING, Point};
use nalgebra::{Isometry3, Vector3};
use overact_codegen::mechanism::{Joint, JointKind, Leg, placement_isometry};

/// Parts and base of a leg. `pixel` is the length of one pixel, m; `tree`: a serial robot.
pub(super) fn parts(
    leg: &Leg,
    positions: &[f64],
    pixel: f64,
    tree: bool,
) -> (Vec<DrawnPart>, Point) {
    let mut walk = Walk::new(leg, positions, pixel, tree);
    walk.run();
    walk.join_universals();
    (walk.parts, walk.base)
}

/// State of the conversion of a leg.
struct Walk<'m> {
    leg: &'m Leg,
    frames: Vec<Isometry3<f64>>,
    positions: Vec<f64>,
    pixel: f64,
    /// Whether the leg is a serial robot of its own.
    tree: bool,
    parts: Vec<DrawnPart>,
    base: Point,
}

/// Separation of coincident joints of a serial robot, pixels.
const APART: f64 = 34.0;

impl<'m> Walk<'m> {
    fn new(leg: &'m Leg, positions: &[f64], pixel: f64, tree: bool) -> Self {
        let independent: Vec<usize> = leg.independent().collect();
        let position = |joint: &Joint| {
            let parts = joint.variable.iter().map(|(of, factor)| {
                let at = independent.iter().position(|i| i == of);
                at.and_then(|at| positions.get(at)).copied().unwrap_or(0.0) * factor.value()
            });
            parts.sum()
        };
        Self {
            frames: leg.frames(positions),
            positions: leg.joints.iter().map(position).collect(),
            base: placement_isometry(&leg.base).translation.vector,
            leg,
            pixel,
            tree,
            parts: Vec::new(),
        }
    }

    fn run(&mut self) {
        if let Some(first) = (0..self.leg.joints.len()).next() {
            self.base = self.foot(first);
        }
        for index in 0..self.leg.joints.len() {
            self.step(index);
        }
        for index in 0..self.leg.joints.len() {
            self.leaf(index);
        }
    }

    fn axis(&self, index: usize) -> Point {
        self.frames[index] * Vector3::z()
    }

    fn origin(&self, index: usize) -> Point {
        self.frames[index].translation.vector
    }

    /// Point on a joint's axis that the preceding body reaches; for a prismatic joint, at position
    /// zero.
    fn foot(&self, index: usize) -> Point {
        let joint = &self.leg.joints[index];
        let slide = match joint.kind {
            JointKind::Prismatic => self.positions[index],
            _ => joint.r.value(),
        };
        self.origin(index) - self.axis(index) * slide
    }

    /// Adds the body from the antecedent's frame to the joint, and the joint.
    fn step(&mut self, index: usize) {
        let joint = &self.leg.joints[index];
        let foot = self.foot(index);
        if let Some(before) = joint.antecedent {
            let start = self.origin(before);
            let corner = start + self.axis(before) * joint.b.value();
            self.link(before, vec![start, corner, foot]);
        }
        match joint.kind {
            JointKind::Fixed => self.link(index, vec![foot, self.origin(index)]),
            JointKind::Revolute => {
                self.link(index, vec![foot, self.origin(index)]);
                self.revolute(index, foot);
            }
            JointKind::Prismatic => self.prismatic(index, foot),
        }
    }

    /// Adds a body segment along a path, without steps of zero length.
    fn link(&mut self, body: usize, mut path: Vec<Point>) {
        path.dedup_by(|a, b| (*a - *b).norm() < NOTHING);
        if path.len() > 1 {
            self.parts.push(DrawnPart::Link { body, path });
        }
    }

    /// Adds a revolute joint.
    ///
    /// If joints of a serial robot coincide, those with axes pointing outwards are moved along
    /// their axes.
    fn revolute(&mut self, index: usize, foot: Point) {
        let axis = self.axis(index);
        let outwards = self.origin(index) - foot;
        let crowd = |other: usize| {
            other < self.leg.joints.len()
                && self.leg.joints[other].kind == JointKind::Revolute
                && (self.foot(other) - foot).norm() < NOTHING
        };
        let (before, after) = (index > 0 && crowd(index - 1), crowd(index + 1));
        let last = index + 1 == self.leg.joints.len();
        let shift = if !self.tree {
            Point::zeros()
        } else if before && outwards.norm() > NOTHING {
            outwards.normalize() * APART
        } else if before && last {
            axis * APART
        } else if after && !before {
            let incoming = match self.leg.joints[index].antecedent {
                Some(a) if (self.foot(a) - foot).norm() > NOTHING => self.foot(a) - foot,
                _ => -axis,
            };
            axis * (APART * incoming.dot(&axis).signum())
        } else {
            Point::zeros()
        };
        let at = foot + shift * self.pixel;
        self.link(index, vec![foot, at]);
        if index == 0 {
            self.base = at;
        }
        let actuated = self.leg.joints[index].actuated;
        self.parts.push(DrawnPart::Revolute { at, axis, actuated });
    }

    fn prismatic(&mut self, index: usize, foot: Point) {
        let joint = &self.leg.joints[index];
        let (axis, at, actuated) = (self.axis(index), self.origin(index), joint.actuated);
        let moving = joint.antecedent.is_some();
        if moving && (at - foot).norm() > NOTHING {
            self.parts.push(DrawnPart::Telescope {
                from: foot,
                to: at,
                actuated,
            });
            return;
        }
        let beyond = (at - foot).norm() * 0.35 + 45.0 * self.pixel;
        let along = if self.positions[index] < 0.0 {
            -axis
        } else {
            axis
        };
        let (from, to) = (foot - along * (40.0 * self.pixel), at + along * beyond);
        self.parts.push(DrawnPart::Rail { from, to });
        self.parts.push(DrawnPart::Slider { at, axis, actuated });
    }

    /// Adds a body that no other joint continues.
    ///
    /// The bar of a parallelogram ends like the bar that it is coupled to. The last body of a
    /// serial robot has unknown length.
    fn leaf(&mut self, index: usize) {
        let joints = &self.leg.joints;
        let children =
            |of: usize| (0..joints.len()).filter(move |i| joints[*i].antecedent == Some(of));
        if children(index).next().is_some() || joints[index].kind == JointKind::Fixed {
            return;
        }
        let twin = match joints[index].variable.as_slice() {
            [(of, factor)] if *of != index && (factor.value() - 1.0).abs() < NOTHING => Some(*of),
            _ => None,
        };
        let parallel_bar = twin.filter(|t| joints[*t].antecedent == joints[index].antecedent);
        if let Some((bar, next)) = parallel_bar.and_then(|bar| Some((bar, children(bar).next()?))) {
            let (start, far) = (self.origin(index), self.foot(next));
            let end = start + far - self.origin(bar);
            self.link(index, vec![start, end]);
            self.link(next, vec![end, far]);
            let axis = self.axis(index);
            self.parts.push(DrawnPart::Revolute {
                at: end,
                axis,
                actuated: false,
            });
        } else if self.tree && joints[index].kind == JointKind::Revolute {
            self.stub(index);
        }
    }

    /// Merges two coincident passive revolute joints into a universal joint.
    fn join_universals(&mut self) {
        let passive = |part: &DrawnPart| match part {
            DrawnPart::Revolute {
                at,
                actuated: false,
                ..
            } => Some(*at),
            _ => None,
        };
        let mut index = 0;
        while index + 1 < self.parts.len() {
            let next = (index + 1..self.parts.len()).find(|&i| self.parts[i].place().is_some());
            let pair = next.and_then(|i| {
                let (a, b) = (passive(&self.parts[index])?, passive(&self.parts[i])?);
                ((a - b).norm() < NOTHING).then_some((a, i))
            });
            if let Some((at, other)) = pair.filter(|_| !self.tree) {
                self.parts[index] = DrawnPart::Universal { at };
                self.parts.remove(other);
            }
            index += 1;
        }
    }

    /// Adds a last body of unknown length, which points away from the preceding body.
    ///
    /// It points along the x axis in a planar arm, and along the joint axis at the end of a wrist.
    fn stub(&mut self, index: usize) {
        let wrist = index > 0 && (self.foot(index - 1) - self.foot(index)).norm() < NOTHING;
        let direction = if wrist {
            self.axis(index)
        } else {
            self.frames[index] * Vector3::x()
        };
        let from = self.origin(index);
        let to = from + direction * (95.0 * self.pixel);
        self.parts.push(DrawnPart::Stub {
            body: index,
            path: vec![from, to],
        });
    }
}
