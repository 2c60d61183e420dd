//! Random trees and closed mechanisms with their frames at home.

use nalgebra::{Matrix3, Point3, Rotation3, Unit, UnitQuaternion, Vector3};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use std::f64::consts::PI;

/// Joint that carries a body.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum JointType {
    Hinge,
    Slide,
    Ball,
}

/// A body with the joint that carries it, which is at the origin of the body's frame.
#[derive(Debug, Clone)]
pub(crate) struct Body {
    /// Index of the body that carries it; `None` for the ground.
    pub(crate) parent: Option<usize>,
    /// Orientation and origin in the world at home.
    pub(crate) rotation: Rotation3<f64>,
    pub(crate) origin: Point3<f64>,
    pub(crate) joint: JointType,
    /// Axis of the joint in the frame of the body.
    pub(crate) axis: Vector3<f64>,
    pub(crate) mass: f64,
    /// Centre of mass in the frame of the body.
    pub(crate) centre: Vector3<f64>,
    /// Inertia about the centre of mass.
    pub(crate) inertia: Matrix3<f64>,
    pub(crate) damping: f64,
}

/// A joint at a point of the world that connects two bodies at home.
#[derive(Debug, Clone)]
pub(crate) struct Loop {
    pub(crate) bodies: [Option<usize>; 2],
    pub(crate) point: Point3<f64>,
    /// Axis of a hinge in the world; `None` for a ball joint.
    pub(crate) axis: Option<Vector3<f64>>,
}

/// Bodies in the order of a depth-first search, their loops, and the bodies whose joints have
/// motors.
#[derive(Debug, Clone, Default)]
pub(crate) struct RandomMechanism {
    pub(crate) bodies: Vec<Body>,
    pub(crate) loops: Vec<Loop>,
    pub(crate) driven: Vec<usize>,
}

impl RandomMechanism {
    /// Orientation and origin of a body at home.
    pub(crate) fn frame(&self, body: Option<usize>) -> (Rotation3<f64>, Point3<f64>) {
        match body {
            Some(at) => (self.bodies[at].rotation, self.bodies[at].origin),
            None => (Rotation3::identity(), Point3::origin()),
        }
    }

    /// Orientation and origin of a body in the frame of its parent at home.
    pub(crate) fn relative(&self, body: usize) -> (Rotation3<f64>, Vector3<f64>) {
        let own = &self.bodies[body];
        let (turn, origin) = self.frame(own.parent);
        let back = turn.inverse();
        (back * own.rotation, back * (own.origin - origin))
    }

    /// A tree of two to eight bodies with hinges and slides in any direction.
    pub(crate) fn tree(seed: u64) -> Self {
        let mut draw = Draw::new(seed);
        let mut own = Self::default();
        for _ in 0..draw.between(2, 8) {
            // The last body or one of its ancestors, so that every format has the same order.
            let mut path = vec![None];
            let mut at = own.bodies.len().checked_sub(1);
            while let Some(body) = at {
                path.push(at);
                at = own.bodies[body].parent;
            }
            let parent = path[draw.below(path.len())];
            let origin = own.frame(parent).1 + draw.vector(0.4);
            let joint = if draw.chance(0.25) {
                JointType::Slide
            } else {
                JointType::Hinge
            };
            let axis = draw.direction();
            own.add(&mut draw, parent, origin, joint, axis);
        }
        own.driven = (0..own.bodies.len()).collect();
        own
    }

    /// Driven bodies in a plane, then dyads of two hinged bodies in the plane, and rods between two
    /// ball joints in space.
    pub(crate) fn closed(seed: u64) -> Self {
        let mut draw = Draw::new(seed);
        let mut plane = Plane {
            own: Self::default(),
            rotation: draw.rotation(),
            points: vec![(None, Point3::origin())],
        };
        for _ in 0..draw.between(1, 3) {
            plane.add_driven(&mut draw);
        }
        for _ in 0..draw.between(1, 3) {
            if draw.chance(0.3) {
                plane.add_rod(&mut draw);
            } else {
                plane.add_dyad(&mut draw);
            }
        }
        plane.own
    }

    /// Adds a body with a random inertia; the axis is in the world. Returns its index.
    fn add(
        &mut self,
        draw: &mut Draw,
        parent: Option<usize>,
        origin: Point3<f64>,
        joint: JointType,
        axis: Vector3<f64>,
    ) -> usize {
        let rotation = draw.rotation();
        let mass = draw.range(0.2, 3.0);
        let sides = Vector3::from_fn(|_, _| draw.range(0.1, 0.4).powi(2));
        let moments = Vector3::repeat(sides.sum()) - sides;
        let turn = draw.rotation();
        let inertia = turn * Matrix3::from_diagonal(&(moments * (mass / 12.0))) * turn.inverse();
        self.bodies.push(Body {
            parent,
            rotation,
            origin,
            joint,
            axis: rotation.inverse() * axis,
            mass,
            centre: draw.vector(0.2),
            inertia: 0.5 * (inertia + inertia.transpose()),
            damping: if joint != JointType::Ball && draw.chance(0.5) {
                draw.range(0.1, 1.0)
            } else {
                0.0
            },
        });
        self.bodies.len() - 1
    }
}

/// A mechanism in a plane, with a point of each body at which others may be hinged.
struct Plane {
    own: RandomMechanism,
    /// Its z axis is the normal of the plane.
    rotation: Rotation3<f64>,
    points: Vec<(Option<usize>, Point3<f64>)>,
}

impl Plane {
    fn normal(&self) -> Vector3<f64> {
        self.rotation * Vector3::z()
    }

    /// Displacement in the plane with random components.
    fn step(&self, draw: &mut Draw, largest: f64) -> Vector3<f64> {
        let (x, y) = (draw.range(-largest, largest), draw.range(-largest, largest));
        self.rotation * Vector3::new(x, y, 0.0)
    }

    fn add_driven(&mut self, draw: &mut Draw) {
        let (parent, point) = self.points[draw.below(self.points.len())];
        let origin = point + self.step(draw, 0.3);
        let (own, normal) = (&mut self.own, self.rotation * Vector3::z());
        let body = own.add(draw, parent, origin, JointType::Hinge, normal);
        own.driven.push(body);
        let angle = draw.range(-PI, PI);
        let arm = Vector3::new(angle.cos(), angle.sin(), 0.0) * draw.range(0.2, 0.4);
        self.points.push((Some(body), origin + self.rotation * arm));
    }

    /// Two different entries of `points`.
    fn pair(&self, draw: &mut Draw) -> [(Option<usize>, Point3<f64>); 2] {
        let first = draw.below(self.points.len());
        let other = (first + 1 + draw.below(self.points.len() - 1)) % self.points.len();
        [self.points[first], self.points[other]]
    }

    fn add_dyad(&mut self, draw: &mut Draw) {
        let (a, b, start, end) = loop {
            let [(a, start), (b, end)] = self.pair(draw);
            let start = start + self.step(draw, 0.2);
            let end = end + self.step(draw, 0.2);
            if (end - start).norm() > 0.15 {
                break (a, b, start, end);
            }
        };
        let normal = self.normal();
        let side = if draw.chance(0.5) { 1.0 } else { -1.0 };
        let across = normal.cross(&(end - start)) * (side * draw.range(0.4, 0.9));
        let middle = nalgebra::center(&start, &end) + across;
        let first = self.own.add(draw, a, start, JointType::Hinge, normal);
        let second = self
            .own
            .add(draw, Some(first), middle, JointType::Hinge, normal);
        self.points.push((Some(first), middle));
        self.points
            .push((Some(second), nalgebra::center(&middle, &end)));
        self.own.loops.push(Loop {
            bodies: [Some(second), b],
            point: end,
            axis: Some(normal),
        });
    }

    /// A rod with a ball joint at each end, which drives a rocker on the ground.
    ///
    /// It is slender, because its rotation about its own line is a matter of convention.
    fn add_rod(&mut self, draw: &mut Draw) {
        let (a, start, hinge, axis, end) = loop {
            let [(a, start), _] = self.pair(draw);
            let hinge = start + draw.vector(0.6);
            let (axis, arm) = (draw.direction(), draw.vector(0.3));
            let (rod, sweep) = (hinge + arm - start, axis.cross(&arm));
            // The rod must not be perpendicular to the path of its end.
            let is_long = rod.norm() > 0.15;
            if a.is_some() && is_long && rod.normalize().dot(&sweep).abs() > 0.08 {
                break (a, start, hinge, axis, hinge + arm);
            }
        };
        let rocker = self.own.add(draw, None, hinge, JointType::Hinge, axis);
        let body = self.own.add(draw, a, start, JointType::Ball, axis);
        let rod = &mut self.own.bodies[body];
        let line = rod.rotation.inverse() * (end - start);
        let along = line.normalize();
        rod.centre = line * draw.range(0.3, 0.7);
        let across = Matrix3::identity() - along * along.transpose();
        rod.inertia = across * (rod.mass * line.norm_squared() / 12.0);
        self.own.loops.push(Loop {
            bodies: [Some(body), Some(rocker)],
            point: end,
            axis: None,
        });
    }
}

/// Random numbers, reproducible on any machine.
pub(crate) struct Draw(Pcg64);

impl Draw {
    pub(crate) fn new(seed: u64) -> Self {
        Self(Pcg64::seed_from_u64(seed))
    }

    fn below(&mut self, bound: usize) -> usize {
        self.0.random_range(0..bound)
    }

    fn between(&mut self, least: usize, most: usize) -> usize {
        self.0.random_range(least..=most)
    }

    fn chance(&mut self, probability: f64) -> bool {
        self.range(0.0, 1.0) < probability
    }

    pub(crate) fn range(&mut self, least: f64, most: f64) -> f64 {
        self.0.random_range(least..most)
    }

    fn vector(&mut self, largest: f64) -> Vector3<f64> {
        Vector3::from_fn(|_, _| self.range(-largest, largest))
    }

    fn direction(&mut self) -> Vector3<f64> {
        loop {
            let drawn = self.vector(1.0);
            if (0.1..1.0).contains(&drawn.norm()) {
                return drawn.normalize();
            }
        }
    }

    fn rotation(&mut self) -> Rotation3<f64> {
        let axis = Unit::new_unchecked(self.direction());
        let turn = UnitQuaternion::from_axis_angle(&axis, self.range(-PI, PI));
        turn.to_rotation_matrix()
    }
}
