//! Kinematics of a tree with closures: closed configurations, twists and the closure Jacobian.

use crate::{
    geometry::exact,
    model::{ClosureKind, JointType, Model, Pose},
};
use nalgebra::{DMatrix, DVector, Point3, Rotation3, Vector3};
use std::rc::Rc;

/// Configuration of the tree.
#[derive(Debug, Clone)]
pub(crate) struct State {
    /// Joint positions in the file's convention; unused for ball joints.
    pub(crate) positions: Vec<f64>,
    /// Rotations of ball joints.
    pub(crate) turns: Vec<Rotation3<f64>>,
    /// Poses of the bodies in the world.
    pub(crate) poses: Vec<Pose>,
}

/// Result of a search for a closed configuration that found none.
#[derive(Debug, Clone)]
pub(crate) struct Open {
    /// Configuration with the smallest residuals.
    pub(crate) state: State,
    /// Largest residual, m or rad.
    pub(crate) gap: f64,
    /// Row of the largest residual.
    pub(crate) row: usize,
}

/// A coordinate of the tree: a joint, or one of the three rates of a ball joint.
///
/// Ball rates are about the axes of the body's placement.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Coordinate {
    pub(crate) joint: usize,
    pub(crate) component: usize,
}

/// Tree with its coordinates.
#[derive(Debug)]
pub(crate) struct Motion<'m> {
    pub(crate) model: &'m Model,
    pub(crate) coordinates: Vec<Coordinate>,
}

/// Twists of a body for unit rates, 6 × coordinates.
///
/// Rows: velocity of the body-fixed point at the world origin, then angular velocity.
pub(crate) type Twists = DMatrix<f64>;

/// Twists of each body; bodies that are fixed together share theirs.
pub(crate) type BodyTwists = Vec<Rc<Twists>>;

impl<'m> Motion<'m> {
    /// Kinematics of a model.
    pub(crate) fn new(model: &'m Model) -> Self {
        let mut coordinates = Vec::new();
        let carried = model.carried();
        for (joint, own) in model.joints.iter().enumerate() {
            let count = match own.kind {
                // Joints merged into a ball joint carry nothing.
                _ if own.follow.is_some() || carried[joint] == 0 => 0,
                JointType::Ball => 3,
                JointType::Revolute | JointType::Prismatic => 1,
            };
            coordinates.extend((0..count).map(|component| Coordinate { joint, component }));
        }
        Self { model, coordinates }
    }

    /// Poses of the bodies where springs of tendons have their length without force.
    ///
    /// Joints have these positions independently of couplings.
    pub(crate) fn at_rest(&self) -> Vec<Pose> {
        let joints = self.model.joints.iter();
        let mut state = State {
            positions: joints.map(|own| own.rest.unwrap_or(own.home)).collect(),
            turns: vec![Rotation3::identity(); self.model.joints.len()],
            poses: Vec::new(),
        };
        self.place_bodies(&mut state);
        state.poses
    }

    /// Home configuration of the file.
    pub(crate) fn start(&self) -> State {
        let positions = self.model.joints.iter().map(|joint| joint.home).collect();
        let joints = self.model.joints.iter();
        let turns = joints.map(|joint| joint.home_turn).collect();
        let mut state = State {
            positions,
            turns,
            poses: Vec::new(),
        };
        self.place(&mut state);
        state
    }

    /// Computes the body poses from the joint positions.
    fn place(&self, state: &mut State) {
        for (at, joint) in self.model.joints.iter().enumerate() {
            if let Some(follow) = joint.follow {
                state.positions[at] = follow.factor * state.positions[follow.joint] + follow.offset;
            }
        }
        self.place_bodies(state);
    }

    /// The same without couplings.
    fn place_bodies(&self, state: &mut State) {
        let mut poses: Vec<Pose> = Vec::with_capacity(self.model.bodies.len());
        poses.push(Pose::identity());
        for body in &self.model.bodies[1..] {
            let placed = poses[body.parent] * body.placement;
            poses.push(match body.joint {
                None => placed,
                Some(joint) => placed * self.moved(state, joint),
            });
        }
        state.poses = poses;
    }

    /// Displacement of the body that a joint carries.
    fn moved(&self, state: &State, at: usize) -> Pose {
        let joint = &self.model.joints[at];
        let by = state.positions[at] - joint.reference;
        let rotation = match joint.kind {
            JointType::Prismatic => {
                return Pose::from_parts((joint.axis * by).into(), Rotation3::identity());
            }
            JointType::Revolute => exact::turn(&joint.axis, by),
            JointType::Ball => state.turns[at],
        };
        let centre = joint.at.coords;
        Pose::from_parts((centre - rotation * centre).into(), rotation)
    }

    /// Twists of all bodies for each coordinate.
    pub(crate) fn twists(&self, state: &State) -> BodyTwists {
        let mut all = BodyTwists::with_capacity(self.model.bodies.len());
        all.push(Rc::new(Twists::zeros(6, self.coordinates.len())));
        for (at, body) in self.model.bodies.iter().enumerate().skip(1) {
            let mut own = Rc::clone(&all[body.parent]);
            if let Some(joint) = body.joint {
                let moved = Rc::make_mut(&mut own);
                for (column, factor, twist) in self.columns(state, at, joint) {
                    let mut column = moved.column_mut(column);
                    column += twist * factor;
                }
            }
            all.push(own);
        }
        all
    }

    /// Columns and factors to which a joint contributes its twist.
    fn columns(&self, state: &State, body: usize, joint: usize) -> Vec<(usize, f64, DVector<f64>)> {
        let own = &self.model.joints[joint];
        let (leader, factor) = own.follow.map_or((joint, 1.0), |f| (f.joint, f.factor));
        let coordinates = self.coordinates.iter().enumerate();
        let coordinates = coordinates.filter(|(_, c)| c.joint == leader);
        let pose = &state.poses[body];
        let placed =
            state.poses[self.model.bodies[body].parent] * self.model.bodies[body].placement;
        let twist = |component: usize| {
            let (centre, axis) = (pose * own.at, pose.rotation * own.axis);
            match own.kind {
                JointType::Prismatic => screw(&axis, &Vector3::zeros()),
                JointType::Revolute => screw(&centre.coords.cross(&axis), &axis),
                JointType::Ball => {
                    let axis = placed.rotation * Vector3::ith(component, 1.0);
                    screw(&centre.coords.cross(&axis), &axis)
                }
            }
        };
        coordinates
            .map(|(column, c)| (column, factor, twist(c.component)))
            .collect()
    }

    /// Closure residuals, m and rad.
    pub(crate) fn gaps(&self, state: &State) -> Vec<f64> {
        let mut gaps = Vec::new();
        for closure in &self.model.closures {
            let (points, turn) = ends(&closure.kind, state);
            gaps.extend((points[1] - points[0]).iter());
            if let Some((gap, axes)) = turn {
                gaps.extend(axes.iter().map(|e| gap.dot(e)));
            }
        }
        gaps
    }

    /// Closure residuals (m, rad) and their Jacobian by coordinates.
    pub(crate) fn closure(&self, state: &State) -> (Vec<f64>, DMatrix<f64>) {
        let twists = self.twists(state);
        let mut rows = Vec::new();
        for closure in &self.model.closures {
            let [a, b] = closure.bodies();
            let relative = &*twists[b] - &*twists[a];
            let (points, turn) = ends(&closure.kind, state);
            let point = points[1].coords;
            for axis in 0..3 {
                let e = Vector3::ith(axis, 1.0);
                // Velocity of the point: velocity at the origin plus ω × p.
                rows.push(along(&relative, &e, &point.cross(&e)));
            }
            let Some((_, axes)) = turn else { continue };
            for e in axes {
                rows.push(along(&relative, &Vector3::zeros(), &e));
            }
        }
        let matrix = DMatrix::from_fn(rows.len(), self.coordinates.len(), |i, j| rows[i][j]);
        (self.gaps(state), matrix)
    }

    /// Configuration after a step of the coordinates.
    pub(crate) fn moved_by(&self, state: &State, step: &DVector<f64>) -> State {
        let mut moved = state.clone();
        let mut turns = vec![Vector3::zeros(); self.model.joints.len()];
        for (coordinate, by) in self.coordinates.iter().zip(step.iter()) {
            match self.model.joints[coordinate.joint].kind {
                JointType::Ball => turns[coordinate.joint][coordinate.component] = *by,
                _ => moved.positions[coordinate.joint] += by,
            }
        }
        for (turn, by) in moved.turns.iter_mut().zip(turns) {
            *turn = Rotation3::from_scaled_axis(by) * *turn;
        }
        self.place(&mut moved);
        moved
    }

    /// Step of the coordinates that leads from one configuration to another.
    pub(crate) fn step_between(&self, from: &State, to: &State) -> DVector<f64> {
        let step = self.coordinates.iter().map(|own| {
            let joint = own.joint;
            match self.model.joints[joint].kind {
                JointType::Ball => {
                    scaled_axis(&(to.turns[joint] * from.turns[joint].inverse()))[own.component]
                }
                _ => to.positions[joint] - from.positions[joint],
            }
        });
        DVector::from_iterator(self.coordinates.len(), step)
    }

    /// Projects a configuration onto the closures; it stays if only rounding errors leave them open,
    /// which would move it far near a singularity.
    ///
    /// On failure: the configuration with the smallest residuals, the largest residual and its row.
    pub(crate) fn closed(&self, start: &State) -> Result<State, Open> {
        let mut state = start.clone();
        let (mut best, mut since) = (f64::INFINITY, 0);
        for step in 0..300 {
            let (gaps, jacobian) = self.closure(&state);
            let (row, gap) = largest(&gaps);
            if gap < 1e-15 || (gap < 1e-13 && (step == 0 || step > since + 3)) {
                return Ok(state);
            }
            if gap < 0.9 * best {
                (best, since) = (gap, step);
            }
            if step > since + 30 {
                return if gap < 1e-10 {
                    Ok(state)
                } else {
                    Err(Open { state, gap, row })
                };
            }
            let mut change = match solve(&jacobian, &DVector::from_vec(gaps)) {
                Some(change) => -change,
                None => return Err(Open { state, gap, row }),
            };
            // Limit steps to half a radian, the range in which the linearisation is useful.
            let size = change.amax();
            if size > 0.5 {
                change *= 0.5 / size;
            }
            state = self.moved_by(&state, &change);
        }
        let (gaps, _) = self.closure(&state);
        let (row, gap) = largest(&gaps);
        if gap < 1e-10 {
            Ok(state)
        } else {
            Err(Open { state, gap, row })
        }
    }
}

fn largest(gaps: &[f64]) -> (usize, f64) {
    let sized = gaps.iter().map(|gap| gap.abs()).enumerate();
    sized.fold((0, 0.0), |best, now| {
        if now.1 > best.1 || now.1.is_nan() {
            now
        } else {
            best
        }
    })
}

/// Relative tolerance of singular values for ranks.
pub(crate) const RANK: f64 = 1e-7;

/// Damped least-squares step; directions with little effect stay damped until residuals are small.
fn solve(matrix: &DMatrix<f64>, right: &DVector<f64>) -> Option<DVector<f64>> {
    let svd = matrix.clone().try_svd(true, true, 1e-15, 10_000)?;
    let (u, v) = (svd.u?, svd.v_t?);
    let largest = svd.singular_values.amax();
    let damping = largest * right.amax().clamp(1e-13, 1e-2);
    let mut step = DVector::zeros(matrix.ncols());
    for (at, value) in svd.singular_values.iter().enumerate() {
        let along = u.column(at).dot(right) * value / (value * value + damping * damping);
        step += v.row(at).transpose() * along;
    }
    step.iter().all(|v| v.is_finite()).then_some(step)
}

/// Basis of the null space of a matrix.
pub(crate) fn null_space(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    let n = matrix.ncols();
    let square = DMatrix::from_fn(matrix.nrows().max(n), n, |i, j| {
        if i < matrix.nrows() {
            matrix[(i, j)]
        } else {
            0.0
        }
    });
    let Some(svd) = square.try_svd(false, true, 1e-15, 10_000) else {
        return DMatrix::zeros(n, 0);
    };
    let threshold = svd.singular_values.amax().max(1e-6) * RANK;
    let Some(v) = svd.v_t else {
        return DMatrix::zeros(n, 0);
    };
    let kept: Vec<usize> = (0..n)
        .filter(|&i| svd.singular_values[i] <= threshold)
        .collect();
    DMatrix::from_fn(n, kept.len(), |i, j| v[(kept[j], i)])
}

/// Rank of a matrix, and the ratio of its largest to its smallest singular value.
pub(crate) fn rank(matrix: &DMatrix<f64>) -> (usize, f64) {
    if matrix.is_empty() {
        return (0, 1.0);
    }
    let values = matrix.clone().singular_values();
    let (largest, smallest) = (values.amax(), values.amin());
    let count = values
        .iter()
        .filter(|v| **v > largest * RANK && **v > 1e-12)
        .count();
    (
        count,
        if smallest > 0.0 {
            largest / smallest
        } else {
            f64::INFINITY
        },
    )
}

fn screw(velocity: &Vector3<f64>, rate: &Vector3<f64>) -> DVector<f64> {
    DVector::from_iterator(6, velocity.iter().chain(rate.iter()).copied())
}

/// Component of each twist along a direction of velocity and of angular velocity.
fn along(twists: &Twists, velocity: &Vector3<f64>, rate: &Vector3<f64>) -> Vec<f64> {
    let weights = screw(velocity, rate);
    twists
        .column_iter()
        .map(|column| column.dot(&weights))
        .collect()
}

/// Orientation residual and the directions in which it is constrained.
type Turn = Option<(Vector3<f64>, Vec<Vector3<f64>>)>;

/// Closure points, and the orientation residual if the closure has one.
fn ends(kind: &ClosureKind, state: &State) -> ([Point3<f64>; 2], Turn) {
    let both = |bodies: &[usize; 2], at: &[Pose; 2]| [0, 1].map(|i| state.poses[bodies[i]] * at[i]);
    let origins = |frames: &[Pose; 2]| frames.map(|f| Point3::from(f.translation.vector));
    match kind {
        ClosureKind::Point { bodies, at } => ([0, 1].map(|i| state.poses[bodies[i]] * at[i]), None),
        ClosureKind::Weld { bodies, at } => {
            let frames = both(bodies, at);
            let gap = scaled_axis(&(frames[1].rotation * frames[0].rotation.inverse()));
            let axes = (0..3).map(|axis| Vector3::ith(axis, 1.0)).collect();
            (origins(&frames), Some((gap, axes)))
        }
        ClosureKind::Pin { bodies, at } => {
            let frames = both(bodies, at);
            let [za, zb] = frames.map(|f| f.rotation * Vector3::z());
            let x = frames[0].rotation * Vector3::x();
            (
                origins(&frames),
                Some((za.cross(&zb), vec![x, za.cross(&x)])),
            )
        }
    }
}

/// Distance between the points of a closure, m, and angle between its frames or axes, rad.
pub(crate) fn gaps_of(kind: &ClosureKind, state: &State) -> (f64, f64) {
    let (points, turn) = ends(kind, state);
    let angle = turn.map_or(0.0, |(gap, _)| gap.norm());
    ((points[1] - points[0]).norm(), angle)
}

/// Rotation vector, also accurate for small angles.
pub(crate) fn scaled_axis(rotation: &Rotation3<f64>) -> Vector3<f64> {
    let m = rotation.matrix();
    let sine = Vector3::new(
        m[(2, 1)] - m[(1, 2)],
        m[(0, 2)] - m[(2, 0)],
        m[(1, 0)] - m[(0, 1)],
    ) * 0.5;
    let size = sine.norm();
    let angle = size.atan2((m.trace() - 1.0) * 0.5);
    if size > 1e-9 {
        sine * (angle / size)
    } else {
        sine
    }
}
