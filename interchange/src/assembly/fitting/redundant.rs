//! Makes redundant closures consistent: loops that close at home and would move but for rounding.
//!
//! Rounded lengths of a parallelogram with three cranks let it close in one configuration only. Its
//! closure Jacobian then has small singular values instead of zeros. Sought are the smallest
//! changes of the dimensions for which the loops close in several configurations along these
//! motions. Gauss-Newton steps: the joint positions of each configuration are eliminated, and the
//! changes are the least-norm solution of the remaining equations.

use super::dimensions::{Dimension, dimensions, report, size};
use crate::assembly::motion::{Motion, State, scaled_axis};
use crate::model::{ClosureKind, JointType, Model};
use nalgebra::{DMatrix, DVector};

/// Singular values below this fraction of the largest belong to motions that rounding may block.
const SOFT: f64 = 0.02;
/// Singular values below this fraction of the largest are zero.
const ZERO: f64 = 1e-11;
/// Largest number of blocked motions and of dimensions: the cost grows with their product.
const MOST: [usize; 2] = [20, 400];
/// Length of a step along a motion, and largest number of steps to a configuration.
const STEP: f64 = 0.05;
const STEPS: usize = 8;
/// Number of configurations for each motion, and at least. Fewer might be closed by dimensions that
/// close no others: a coupler curve meets a circle in up to six points.
const STATES: [usize; 2] = [6, 16];
/// Largest number of Gauss-Newton steps.
const ITERATIONS: usize = 30;
/// Residual of closed loops, and the one at which steps end at once.
const CLOSED: [f64; 2] = [1e-12, 1e-15];
/// Multiple of the tolerance beyond which changes do not return.
const DIVERGED: f64 = 10.0;
/// Relative tolerance of the least-norm solution.
const UNSEEN: f64 = 1e-9;
/// Change of a dimension for central differences, relative.
const DIFFERENCE: f64 = 1e-4;

/// Model whose loops move along the motions that rounding blocks; `None` if none are blocked, or
/// if no changes up to the tolerance free them.
///
/// Home must be closed within twice the tolerance; rounding may leave no other closed configuration
/// near it.
///
/// If `level` is a body, its orientation must be constant as well.
pub(crate) fn consistent(model: &Model, tolerance: f64, level: Option<usize>) -> Option<Model> {
    let home = Motion::new(model).start();
    let frame = Frame::new(model, &home, level);
    let gap = frame.gaps(model, &home).amax();
    if gap > 2.0 * tolerance {
        return None;
    }
    let (_, jacobian) = frame.system(model, &home);
    let values = jacobian.clone().singular_values();
    let below = |part: f64| {
        let counted = values.iter().filter(|value| **value > part * values.max());
        jacobian.ncols() - counted.count()
    };
    let soft = below(SOFT);
    // The Jacobian of an open loop is not that of any closed one.
    let strict = if gap > ZERO { 0 } else { below(ZERO) };
    if soft <= strict || soft > MOST[0] {
        return None;
    }
    let rank = jacobian.ncols() - soft;
    let home = closed(model, &frame, home, rank)?;
    let states = states(model, &frame, &home, rank, tolerance)?;
    [false, true].into_iter().find_map(|with_axes| {
        let dimensions = dimensions(model, with_axes);
        if dimensions.is_empty() || dimensions.len() > MOST[1] {
            return None;
        }
        let states = states.clone();
        let changes = solve(model, &frame, states, &dimensions, rank, tolerance)?;
        if changes.amax() > tolerance {
            return None;
        }
        let mut changed = applied(model, &frame, &dimensions, &changes);
        let each = dimensions.iter().zip(changes.iter());
        let sized: Vec<f64> = each.map(|(own, by)| by * frame.unit(own)).collect();
        report(&mut changed, &dimensions, &sized);
        Some(changed)
    })
}

/// Scales of a mechanism, and what its closures demand.
struct Frame {
    size: f64,
    /// Body of constant orientation, and its orientation.
    level: Option<(usize, nalgebra::Rotation3<f64>)>,
    /// Scale of each coordinate.
    columns: DVector<f64>,
    /// Scale of each residual.
    rows: DVector<f64>,
}

impl Frame {
    fn new(model: &Model, home: &State, level: Option<usize>) -> Self {
        let size = size(model, home);
        let motion = Motion::new(model);
        let columns = motion.coordinates.iter().map(|own| {
            let is_slide = model.joints[own.joint].kind == JointType::Prismatic;
            if is_slide { size } else { 1.0 }
        });
        let columns = DVector::from_vec(columns.collect());
        let mut rows = Vec::new();
        for closure in &model.closures {
            rows.extend([1.0 / size; 3]);
            let angles = match closure.kind {
                ClosureKind::Point { .. } => 0,
                ClosureKind::Pin { .. } => 2,
                ClosureKind::Weld { .. } => 3,
            };
            rows.extend(vec![1.0; angles]);
        }
        let level = level.map(|body| (body, home.poses[body].rotation));
        if level.is_some() {
            rows.extend([1.0; 3]);
        }
        Self {
            size,
            level,
            columns,
            rows: DVector::from_vec(rows),
        }
    }

    /// Unit of a dimension.
    fn unit(&self, dimension: &Dimension) -> f64 {
        if dimension.is_angle { 1.0 } else { self.size }
    }

    /// Scaled residuals.
    fn gaps(&self, model: &Model, state: &State) -> DVector<f64> {
        let mut gaps = Motion::new(model).gaps(state);
        if let Some((body, home)) = &self.level {
            let turn = state.poses[*body].rotation * home.inverse();
            gaps.extend(scaled_axis(&turn).iter());
        }
        DVector::from_vec(gaps).component_mul(&self.rows)
    }

    /// Scaled residuals and their Jacobian.
    fn system(&self, model: &Model, state: &State) -> (DVector<f64>, DMatrix<f64>) {
        let motion = Motion::new(model);
        let (_, mut jacobian) = motion.closure(state);
        if let Some((body, _)) = &self.level {
            let own = motion.twists(state)[*body].rows(3, 3).into_owned();
            let count = jacobian.nrows();
            jacobian = jacobian.insert_rows(count, 3, 0.0);
            jacobian.rows_mut(count, 3).copy_from(&own);
        }
        for (mut row, scale) in jacobian.row_iter_mut().zip(self.rows.iter()) {
            row *= *scale;
        }
        for (mut column, scale) in jacobian.column_iter_mut().zip(self.columns.iter()) {
            column *= *scale;
        }
        (self.gaps(model, state), jacobian)
    }

    /// Configuration after a scaled step.
    fn moved(&self, model: &Model, state: &State, step: &DVector<f64>) -> State {
        Motion::new(model).moved_by(state, &step.component_mul(&self.columns))
    }
}

/// Parts of a closure Jacobian of given rank.
struct Split {
    /// Pseudoinverse.
    inverse: DMatrix<f64>,
    /// Basis of the motions.
    free: DMatrix<f64>,
    /// Projector onto the residuals that no motion changes.
    blocked: DMatrix<f64>,
}

impl Split {
    fn new(jacobian: &DMatrix<f64>, rank: usize) -> Option<Self> {
        let (rows, columns) = jacobian.shape();
        let padded = jacobian.clone().resize(rows.max(columns), columns, 0.0);
        let svd = padded.try_svd(true, true, 1e-15, 10_000)?;
        let (u, v) = (svd.u?, svd.v_t?);
        let mut order: Vec<usize> = (0..columns).collect();
        order.sort_by(|a, b| svd.singular_values[*b].total_cmp(&svd.singular_values[*a]));
        let (kept, rest) = order.split_at(rank);
        let mut inverse = DMatrix::zeros(columns, rows);
        let mut blocked = DMatrix::identity(rows, rows);
        for &at in kept {
            let left = u.column(at).rows(0, rows).into_owned();
            inverse += v.row(at).transpose() * left.transpose() / svd.singular_values[at];
            blocked -= &left * left.transpose();
        }
        let free = DMatrix::from_fn(columns, rest.len(), |i, j| v[(rest[j], i)]);
        Some(Self {
            inverse,
            free,
            blocked,
        })
    }
}

/// Configurations along the motions, closed but for the residuals that no motion changes.
fn states(
    model: &Model,
    frame: &Frame,
    home: &State,
    rank: usize,
    tolerance: f64,
) -> Option<Vec<State>> {
    let (_, jacobian) = frame.system(model, home);
    let count = jacobian.ncols() - rank;
    let mut all = vec![home.clone()];
    let start = Split::new(&jacobian, rank)?.free;
    let mut next = random();
    let most = (STATES[0] * count).max(STATES[1]);
    for at in 0..most {
        let weights = DVector::from_fn(count, |_, _| next());
        let direction = (&start * weights).try_normalize(1e-9)?;
        let Some(state) = followed(model, frame, home, rank, direction, 1 + at % STEPS) else {
            continue;
        };
        if frame.gaps(model, &state).amax() > 10.0 * tolerance {
            return None;
        }
        all.push(state);
    }
    (2 * all.len() > most).then_some(all)
}

/// Configuration after some steps along the motions, first in a given direction.
fn followed(
    model: &Model,
    frame: &Frame,
    home: &State,
    rank: usize,
    mut direction: DVector<f64>,
    steps: usize,
) -> Option<State> {
    let mut state = home.clone();
    for _ in 0..steps {
        let (_, own) = frame.system(model, &state);
        let free = Split::new(&own, rank)?.free;
        direction = (&free * (free.transpose() * &direction)).try_normalize(1e-3)?;
        let moved = frame.moved(model, &state, &(&direction * STEP));
        state = closed(model, frame, moved, rank)?;
    }
    Some(state)
}

/// Deterministic pseudo-random numbers between −1 and 1.
fn random() -> impl FnMut() -> f64 {
    let mut random = 7_u64;
    move || {
        random = random
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        f64::from(u32::try_from(random >> 33).unwrap_or(0)) / f64::from(1_u32 << 30) - 1.0
    }
}

/// Configuration without the residuals that motions change.
fn closed(model: &Model, frame: &Frame, start: State, rank: usize) -> Option<State> {
    let mut state = start;
    for _ in 0..8 {
        let (gaps, jacobian) = frame.system(model, &state);
        let step = -(Split::new(&jacobian, rank)?.inverse * gaps);
        if !step.iter().all(|value| value.is_finite()) || step.amax() > 0.5 {
            return None;
        }
        state = frame.moved(model, &state, &step);
        if step.amax() < 1e-10 {
            break;
        }
    }
    Some(state)
}

/// Model with scaled changes of its dimensions.
fn applied(
    model: &Model,
    frame: &Frame,
    dimensions: &[Dimension],
    changes: &DVector<f64>,
) -> Model {
    let mut changed = model.clone();
    for (own, by) in dimensions.iter().zip(changes.iter()) {
        own.change(&mut changed, by * frame.unit(own));
    }
    changed
}

/// Smallest scaled changes for which all configurations close; `None` if there are none.
fn solve(
    model: &Model,
    frame: &Frame,
    mut states: Vec<State>,
    dimensions: &[Dimension],
    rank: usize,
    tolerance: f64,
) -> Option<DVector<f64>> {
    let count = dimensions.len();
    let mut changes = DVector::zeros(count);
    let mut best = f64::INFINITY;
    for _ in 0..ITERATIONS {
        let changed = applied(model, frame, dimensions, &changes);
        let mut largest = 0.0_f64;
        for state in &mut states {
            let start = frame.moved(&changed, state, &DVector::zeros(frame.columns.len()));
            *state = closed(&changed, frame, start, rank)?;
            largest = largest.max(frame.gaps(&changed, state).amax());
        }
        if largest < CLOSED[1] || largest < CLOSED[0] && largest > 0.5 * best {
            return Some(changes);
        }
        if !largest.is_finite() || largest > 100.0 * best {
            return None;
        }
        best = best.min(largest);
        let rows = frame.rows.len();
        let mut matrix = DMatrix::zeros(rows * states.len(), count);
        let mut right = DVector::zeros(rows * states.len());
        let splits: Vec<(DVector<f64>, Split)> = states
            .iter()
            .map(|state| {
                let (gaps, jacobian) = frame.system(&changed, state);
                Some((gaps, Split::new(&jacobian, rank)?))
            })
            .collect::<Option<_>>()?;
        for (column, own) in dimensions.iter().enumerate() {
            let sides = [DIFFERENCE, -DIFFERENCE].map(|by| {
                let mut other = changed.clone();
                own.change(&mut other, by * frame.unit(own));
                other
            });
            for (at, (state, (_, split))) in states.iter().zip(&splits).enumerate() {
                let [after, before] = sides.each_ref().map(|other| {
                    let placed = frame.moved(other, state, &DVector::zeros(frame.columns.len()));
                    frame.gaps(other, &placed)
                });
                let slope = &split.blocked * (after - before) / (2.0 * DIFFERENCE);
                matrix
                    .view_mut((at * rows, column), (rows, 1))
                    .copy_from(&slope);
            }
        }
        for (at, (gaps, split)) in splits.iter().enumerate() {
            right
                .rows_mut(at * rows, rows)
                .copy_from(&(&split.blocked * -gaps));
        }
        right += &matrix * &changes;
        let svd = matrix.try_svd(true, true, 1e-15, 10_000)?;
        let threshold = UNSEEN * svd.singular_values.max();
        changes = svd.solve(&right, threshold).ok()?;
        if changes.amax() > DIVERGED * tolerance {
            return None;
        }
    }
    None
}
