//! Dynamics of a mechanism whose loops are cut: Kane's equations of the tree, projected on the
//! motions that keep the loops closed.

use super::mechanism::{JointType, RandomMechanism};
use nalgebra::{DMatrix, DVector, Isometry3, Point3, Rotation3, UnitQuaternion, Vector3};

/// Acceleration of gravity, m/s².
const GRAVITY: f64 = 9.81;
/// Singular values below this one belong to redundant closures or to rods that spin.
const RANK: f64 = 1e-9;
/// Largest gap of a closed loop, m.
const CLOSED: f64 = 1e-13;

/// Position of a joint: an angle, a length, or an orientation relative to home.
#[derive(Debug, Clone, Copy)]
enum Position {
    Scalar(f64),
    Turn(Rotation3<f64>),
}

/// Motion of a body; velocity and acceleration are those of the frame's origin.
#[derive(Debug, Clone, Copy)]
struct BodyMotion {
    pose: Isometry3<f64>,
    rate: Vector3<f64>,
    acceleration: Vector3<f64>,
    linear_rate: Vector3<f64>,
    linear_acceleration: Vector3<f64>,
}

impl BodyMotion {
    fn ground() -> Self {
        Self {
            pose: Isometry3::identity(),
            rate: Vector3::zeros(),
            acceleration: Vector3::zeros(),
            linear_rate: Vector3::zeros(),
            linear_acceleration: Vector3::zeros(),
        }
    }

    /// Velocity and acceleration of a point of the body.
    fn at(&self, point: &Point3<f64>) -> (Vector3<f64>, Vector3<f64>) {
        let arm = point - Point3::from(self.pose.translation.vector);
        let centripetal = self.rate.cross(&self.rate.cross(&arm));
        let acceleration = self.linear_acceleration + self.acceleration.cross(&arm) + centripetal;
        (self.linear_rate + self.rate.cross(&arm), acceleration)
    }
}

/// Motion of coordinates: positions, rates and accelerations.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Motion<'s> {
    pub(crate) positions: &'s [f64],
    pub(crate) rates: &'s [f64],
    pub(crate) accelerations: &'s [f64],
}

/// The tree of a mechanism, in a configuration.
#[derive(Debug)]
pub(crate) struct Tree<'m> {
    own: &'m RandomMechanism,
    positions: Vec<Position>,
    /// First coordinate of each body's joint.
    first: Vec<usize>,
    coordinates: usize,
}

impl<'m> Tree<'m> {
    /// The tree at home.
    pub(crate) fn new(own: &'m RandomMechanism) -> Self {
        let (mut first, mut coordinates) = (Vec::new(), 0);
        for body in &own.bodies {
            first.push(coordinates);
            coordinates += if body.joint == JointType::Ball { 3 } else { 1 };
        }
        let position = |joint| match joint {
            JointType::Ball => Position::Turn(Rotation3::identity()),
            JointType::Hinge | JointType::Slide => Position::Scalar(0.0),
        };
        Self {
            own,
            positions: own.bodies.iter().map(|body| position(body.joint)).collect(),
            first,
            coordinates,
        }
    }

    /// Projected inverse dynamics: for each unit rate of the joints of `bodies`, the power of the
    /// tree's torques minus that of motors with the given torques; `None` if the loops stay open.
    ///
    /// The motion is that of the joints of `bodies`; `torques` are those of driven bodies.
    pub(crate) fn residual(
        mut self,
        bodies: &[usize],
        motion: Motion<'_>,
        torques: &[(usize, f64)],
    ) -> Option<Projected> {
        for (&body, &position) in bodies.iter().zip(motion.positions) {
            self.positions[body] = Position::Scalar(position);
        }
        let given: Vec<usize> = bodies.iter().map(|&body| self.first[body]).collect();
        let free: Vec<usize> = (0..self.coordinates)
            .filter(|at| !given.contains(at))
            .collect();
        self.close(&free)?;
        let units = self.units();
        let (_, rows) = self.gaps(&units);
        let inverse = pseudo_inverse(rows.select_columns(&free));
        // Rates of all coordinates for unit rates of the given ones.
        let mut motions = DMatrix::zeros(self.coordinates, given.len());
        let dependent = -(&inverse * rows.select_columns(&given));
        for (column, &at) in given.iter().enumerate() {
            motions[(at, column)] = 1.0;
            for (row, &own) in free.iter().enumerate() {
                motions[(own, column)] = dependent[(row, column)];
            }
        }
        if (&rows * &motions).amax() > 1e-9 {
            return None;
        }
        let rates = &motions * DVector::from_column_slice(motion.rates);
        let still = DVector::zeros(self.coordinates);
        let bias = self.gap_accelerations(&self.moved(&rates, &still));
        let mut accelerations = &motions * DVector::from_column_slice(motion.accelerations);
        let correction = -(&inverse * bias);
        for (row, &own) in free.iter().enumerate() {
            accelerations[own] += correction[row];
        }
        let mut forces = self.forces(&units, &rates, &accelerations);
        let whole = motions.transpose() * &forces;
        for &(body, torque) in torques {
            forces[self.first[body]] -= torque;
        }
        Some(Projected {
            difference: motions.transpose() * forces,
            whole,
        })
    }

    /// Newton's method for the free coordinates.
    fn close(&mut self, free: &[usize]) -> Option<()> {
        for _ in 0..30 {
            let (gaps, rows) = self.gaps(&self.units());
            if gaps.is_empty() || gaps.amax() < CLOSED {
                return Some(());
            }
            let step = -(pseudo_inverse(rows.select_columns(free)) * gaps);
            let mut whole = DVector::zeros(self.coordinates);
            for (&at, own) in free.iter().zip(&step) {
                whole[at] = *own;
            }
            for (body, position) in self.positions.iter_mut().enumerate() {
                let first = self.first[body];
                match position {
                    Position::Scalar(value) => *value += whole[first],
                    Position::Turn(turn) => {
                        let step = whole.fixed_rows::<3>(first).into_owned();
                        *turn = Rotation3::new(step) * *turn;
                    }
                }
            }
        }
        None
    }

    /// Motions of all bodies for coordinate rates and accelerations.
    fn moved(&self, rates: &DVector<f64>, accelerations: &DVector<f64>) -> Vec<BodyMotion> {
        let mut all: Vec<BodyMotion> = Vec::new();
        for (at, body) in self.own.bodies.iter().enumerate() {
            let parent = body.parent.map_or_else(BodyMotion::ground, |on| all[on]);
            let (turn, origin) = self.own.relative(at);
            let first = self.first[at];
            let before = parent.pose.rotation.to_rotation_matrix();
            let (relative, slid) = match (self.positions[at], body.joint) {
                (Position::Scalar(value), JointType::Slide) => (turn, turn * body.axis * value),
                (Position::Scalar(value), _) => {
                    (turn * Rotation3::new(body.axis * value), Vector3::zeros())
                }
                (Position::Turn(own), _) => (own * turn, Vector3::zeros()),
            };
            let rotation = before * relative;
            let point = parent.pose * Point3::from(origin + slid);
            let pose = Isometry3::from_parts(
                point.coords.into(),
                UnitQuaternion::from_rotation_matrix(&rotation),
            );
            let (linear_rate, linear_acceleration) = parent.at(&point);
            let mut moved = BodyMotion {
                pose,
                linear_rate,
                linear_acceleration,
                ..parent
            };
            let axis = rotation * body.axis;
            match body.joint {
                JointType::Hinge => {
                    moved.turn(&(axis * rates[first]), &(axis * accelerations[first]))
                }
                JointType::Ball => {
                    // Rates are in the frame of the parent.
                    let of = |own: &DVector<f64>| before * own.fixed_rows::<3>(first).into_owned();
                    moved.turn(&of(rates), &of(accelerations));
                }
                JointType::Slide => {
                    let velocity = axis * rates[first];
                    moved.linear_rate += velocity;
                    moved.linear_acceleration +=
                        axis * accelerations[first] + 2.0 * parent.rate.cross(&velocity);
                }
            }
            all.push(moved);
        }
        all
    }

    /// Motions for unit rates of each coordinate.
    fn units(&self) -> Vec<Vec<BodyMotion>> {
        let still = DVector::zeros(self.coordinates);
        let unit = |at| {
            let mut rates = still.clone();
            rates[at] = 1.0;
            self.moved(&rates, &still)
        };
        (0..self.coordinates).map(unit).collect()
    }

    /// Gaps of the loops' points, and their Jacobian by all coordinates.
    fn gaps(&self, units: &[Vec<BodyMotion>]) -> (DVector<f64>, DMatrix<f64>) {
        let size = 3 * self.own.loops.len();
        let (mut gaps, mut rows) = (DVector::zeros(size), DMatrix::zeros(size, self.coordinates));
        let still = DVector::zeros(self.coordinates);
        let home = self.moved(&still, &still);
        for (at, closure) in self.own.loops.iter().enumerate() {
            for (body, sign) in closure.bodies.iter().zip([1.0, -1.0]) {
                let (turn, origin) = self.own.frame(*body);
                let local = Point3::from(turn.inverse() * (closure.point - origin));
                let pose = body.map_or_else(Isometry3::identity, |body| home[body].pose);
                let point = pose * local;
                let mut gap = gaps.fixed_rows_mut::<3>(3 * at);
                gap += sign * point.coords;
                let Some(body) = *body else { continue };
                for (column, unit) in units.iter().enumerate() {
                    let mut velocity = rows.fixed_view_mut::<3, 1>(3 * at, column);
                    velocity += sign * unit[body].at(&point).0;
                }
            }
        }
        (gaps, rows)
    }

    /// Accelerations of the gaps for a motion of the bodies.
    fn gap_accelerations(&self, motion: &[BodyMotion]) -> DVector<f64> {
        let mut all = DVector::zeros(3 * self.own.loops.len());
        for (at, closure) in self.own.loops.iter().enumerate() {
            for (body, sign) in closure.bodies.iter().zip([1.0, -1.0]) {
                let Some(body) = *body else { continue };
                let (turn, origin) = self.own.frame(Some(body));
                let local = Point3::from(turn.inverse() * (closure.point - origin));
                let own = &motion[body];
                let mut acceleration = all.fixed_rows_mut::<3>(3 * at);
                acceleration += sign * own.at(&(own.pose * local)).1;
            }
        }
        all
    }

    /// Torques of the tree without loops.
    fn forces(
        &self,
        units: &[Vec<BodyMotion>],
        rates: &DVector<f64>,
        accelerations: &DVector<f64>,
    ) -> DVector<f64> {
        let motion = self.moved(rates, accelerations);
        let mut forces = DVector::zeros(self.coordinates);
        for (at, body) in self.own.bodies.iter().enumerate() {
            let own = &motion[at];
            let centre = own.pose * Point3::from(body.centre);
            let force = body.mass * (own.at(&centre).1 + Vector3::z() * GRAVITY);
            let turn = own.pose.rotation.to_rotation_matrix();
            let inertia = turn * body.inertia * turn.inverse();
            let torque = inertia * own.acceleration + own.rate.cross(&(inertia * own.rate));
            for (coordinate, unit) in units.iter().enumerate() {
                let unit = &unit[at];
                forces[coordinate] += force.dot(&unit.at(&centre).0) + torque.dot(&unit.rate);
            }
            forces[self.first[at]] += body.damping * rates[self.first[at]];
        }
        forces
    }
}

impl BodyMotion {
    /// Adds a rotation relative to the body that carries this one, in the world.
    fn turn(&mut self, rate: &Vector3<f64>, acceleration: &Vector3<f64>) {
        self.acceleration += acceleration + self.rate.cross(rate);
        self.rate += rate;
    }
}

/// Powers per unit rate of the given joints, N m or N.
#[derive(Debug)]
pub(crate) struct Projected {
    /// Of the tree's torques minus the motors' torques.
    pub(crate) difference: DVector<f64>,
    /// Of the tree's torques.
    pub(crate) whole: DVector<f64>,
}

fn pseudo_inverse(matrix: DMatrix<f64>) -> DMatrix<f64> {
    if matrix.is_empty() {
        return matrix.transpose();
    }
    matrix.pseudo_inverse(RANK).expect("a tolerance above zero")
}
