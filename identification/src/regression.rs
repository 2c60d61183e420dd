//! The observation system (39)-(41) of an identification model.
//!
//! Case 1 projects the inputs on the platform, Γ¹ = (J_p^inv)ᵀ τ, with the columns of IDM_red (30).
//! Case 2 projects them on r kept actuators: with J_a the kept rows of J_p^inv, Γ² = J_a^-T Γ¹, and
//! the same for every column (36). Without redundancy all actuators are kept, which is eq. (19), and
//! eq. (1) for a robot without a loop.
//!
//! Y and every column are decimated in parallel (40) and their rows sorted by line of Γ (41).

use std::ops::Range;

use nalgebra::{DMatrix, DMatrixView};
use overact::{Function, Info, Model};
use rayon::prelude::*;
use serde::{Serialize, Serializer};

use crate::{
    blocks::{BLOCK, slice},
    columns::ColumnSet,
    error::{Error, Problem},
    factor::Factor,
    filters::Decimator,
    kinematics::Motion,
    settings::{Settings, check_partition},
};

/// Numbers held at the full rate at once (256 MB); the columns are taken in groups that fit.
const LARGEST_BUFFER: usize = 1 << 25;

/// On what the inputs are projected.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Projection {
    /// Case 1: the platform.
    Platform,
    /// Case 2: these r kept actuators of a redundant robot.
    Actuators(Vec<usize>),
    /// All actuators of a robot without redundancy.
    Joints,
}

impl Projection {
    /// `platform`, `actuators` or `joints`.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Platform => "platform",
            Self::Actuators(_) => "actuators",
            Self::Joints => "joints",
        }
    }

    /// The kept actuators, or `None` on the platform.
    #[must_use]
    pub fn kept(&self, info: &Info<'_>) -> Option<Vec<usize>> {
        match self {
            Self::Platform => None,
            Self::Actuators(kept) => Some(kept.clone()),
            Self::Joints => Some((0..info.sizes.actuators).collect()),
        }
    }

    /// Names of the lines of Γ.
    #[must_use]
    pub fn line_names(&self, info: &Info<'_>) -> Vec<String> {
        let named = |names: &[&str], index: usize| {
            names
                .get(index)
                .map_or_else(|| format!("line {index}"), |name| (*name).to_owned())
        };
        match self.kept(info) {
            None => (0..info.sizes.dof)
                .map(|line| named(info.coordinates, line))
                .collect(),
            Some(kept) => kept
                .iter()
                .map(|&actuator| named(info.actuators, actuator))
                .collect(),
        }
    }
}

impl Serialize for Projection {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

/// How badly conditioned the kept rows J_a of J_p^inv get along a trajectory, and where. It depends
/// on the units of the platform's coordinates; above 30 or so case 2 suffers.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PartitionCondition {
    /// Largest condition number (2-norm).
    pub largest: f64,
    /// Name of the run in which it occurs.
    pub run: String,
    /// Sample of the log.
    pub sample: usize,
    /// Time of that sample, s from the start of the log.
    pub time: f64,
}

impl PartitionCondition {
    /// The worse one of two.
    fn worse(a: Option<Self>, b: Option<Self>) -> Option<Self> {
        match (a, b) {
            (Some(a), Some(b)) => Some(if b.largest > a.largest { b } else { a }),
            (a, b) => a.or(b),
        }
    }
}

/// The decimated equations of one run.
#[derive(Debug, Clone)]
pub struct Equations {
    /// For each line of Γ: equations x (columns + 1), Y last.
    pub lines: Vec<DMatrix<f64>>,
    /// Where actuators are kept: how well they determine the platform.
    pub partition: Option<PartitionCondition>,
}

/// The system of all runs.
#[derive(Debug, Clone)]
pub struct System {
    /// On what the inputs are projected.
    pub projection: Projection,
    /// Names of the lines of Γ.
    pub line_names: Vec<String>,
    /// R factor of each line.
    pub lines: Vec<Factor>,
    /// Where actuators are kept: how well they determine the platform.
    pub partition: Option<PartitionCondition>,
}

/// Builds the system of several runs, one after the other; `progress` is told the run's number.
///
/// # Errors
/// A partition that is not one, a sample at which the model has no value or the kept actuators are
/// singular.
pub fn system(
    model: &dyn Model,
    columns: &ColumnSet,
    projection: &Projection,
    motions: &[Motion],
    settings: &Settings,
    progress: &dyn Fn(usize),
) -> Result<System, Error> {
    let info = model.info();
    let mut system = System {
        projection: projection.clone(),
        line_names: projection.line_names(&info),
        lines: vec![Factor::new(columns.len()); info.sizes.dof],
        partition: None,
    };
    for (run, motion) in motions.iter().enumerate() {
        progress(run);
        let equations = equations(model, columns, projection, motion, settings)?;
        system
            .lines
            .par_iter_mut()
            .zip(&equations.lines)
            .for_each(|(factor, rows)| {
                factor.push(rows);
            });
        system.partition = PartitionCondition::worse(system.partition, equations.partition);
    }
    Ok(system)
}

/// The decimated equations of one run.
///
/// # Errors
/// As [`system`].
pub fn equations(
    model: &dyn Model,
    columns: &ColumnSet,
    projection: &Projection,
    motion: &Motion,
    settings: &Settings,
) -> Result<Equations, Error> {
    let info = model.info();
    if let Projection::Actuators(kept) = projection
        && let Some(problem) = check_partition(kept, &info)
    {
        return Err(problem.into());
    }
    let decimator = Decimator::new(settings.decimation)?;
    let r = info.sizes.dof;
    let width = columns.len() + 1;
    let kept_samples = (motion
        .samples
        .saturating_sub(decimator.first(motion.samples)))
    .div_ceil(decimator.factor());
    let mut lines = vec![DMatrix::zeros(kept_samples, width); r];
    let mut partition = None;
    let group = (LARGEST_BUFFER / (motion.samples * r).max(1)).clamp(1, width);
    for first in (0..width).step_by(group) {
        let range = first..(first + group).min(width);
        let blocks = full_rate(model, columns, projection, motion, range.clone())?;
        for block in &blocks {
            partition = PartitionCondition::worse(partition, block.condition(motion));
        }
        let decimated = decimate_group(&blocks, r * range.len(), motion.samples, &decimator)?;
        for (index, column) in decimated.into_iter().enumerate() {
            let (line, column_index) = (index / range.len(), first + index % range.len());
            if let Some(line) = lines.get_mut(line) {
                line.column_mut(column_index).copy_from_slice(&column);
            }
        }
    }
    Ok(Equations { lines, partition })
}

/// Some columns of [W Y] of a block of samples at the full rate.
struct Block {
    /// Samples x r x columns of the group.
    values: Vec<f64>,
    /// The worst condition of J_a, with the sample of the motion.
    worst: Option<(f64, usize)>,
}

impl Block {
    /// The worst condition, with its place.
    fn condition(&self, motion: &Motion) -> Option<PartitionCondition> {
        self.worst.map(|(largest, sample)| PartitionCondition {
            largest,
            run: motion.run.clone(),
            sample: motion.first_sample + sample,
            time: motion.time(sample),
        })
    }
}

/// Evaluates the columns `range` of [W Y] at all samples, in parallel blocks.
fn full_rate(
    model: &dyn Model,
    columns: &ColumnSet,
    projection: &Projection,
    motion: &Motion,
    range: Range<usize>,
) -> Result<Vec<Block>, Error> {
    let info = model.info();
    let sizes = info.sizes;
    let r = sizes.dof;
    let width = columns.len() + 1;
    let scales = home_scales(model);
    (0..motion.samples.div_ceil(BLOCK))
        .into_par_iter()
        .map(|index| {
            let first = index * BLOCK;
            let count = BLOCK.min(motion.samples - first);
            let at = |error: overact::SampleError| {
                Error::from(motion.outside(first + error.sample, error.error))
            };
            let pose = slice(&motion.pose, sizes.pose, first, count);
            let twist = slice(&motion.twist, r, first, count);
            let acceleration = slice(&motion.acceleration, r, first, count);
            let torques = slice(&motion.torques, sizes.actuators, first, count);
            let w = columns
                .evaluate(model, &[pose, twist, acceleration], count, motion.payload)
                .map_err(at)?;
            let mut y = vec![0.0; count * r];
            model
                .evaluate(Function::ProjectPlatform, &[pose, torques], &mut y)
                .map_err(at)?;
            let mut values = Vec::with_capacity(count * r * range.len());
            for (w, y) in w.chunks_exact((width - 1).max(1)).zip(&y) {
                let last = (range.end == width).then_some(*y);
                values.extend(
                    w.iter()
                        .take(range.end)
                        .skip(range.start)
                        .copied()
                        .chain(last),
                );
            }
            let mut block = Block {
                values,
                worst: None,
            };
            if let Some(kept) = projection.kept(&info) {
                let mut jacobians = vec![0.0; count * sizes.actuators * r];
                model
                    .evaluate(Function::InverseJacobian, &[pose], &mut jacobians)
                    .map_err(at)?;
                keep_actuators(
                    &mut block,
                    &jacobians,
                    &kept,
                    &scales,
                    sizes.actuators,
                    first,
                )
                .map_err(|sample| singular(motion, sample))?;
            }
            Ok(block)
        })
        .collect()
}

/// Inverse norms of the columns of J_p^inv at home, which make metres and radians comparable; ones
/// where the model has no value at home.
fn home_scales(model: &dyn Model) -> Vec<f64> {
    let info = model.info();
    let (n, r) = (info.sizes.actuators, info.sizes.dof);
    let mut jacobian = vec![0.0; n * r];
    let evaluated = model.evaluate(Function::InverseJacobian, &[info.home_pose], &mut jacobian);
    let norm = |column: usize| {
        let squares = (0..n).map(|row| jacobian[row * r + column].powi(2));
        squares.sum::<f64>().sqrt()
    };
    let scale = |norm: f64| {
        if evaluated.is_ok() && norm > 0.0 {
            1.0 / norm
        } else {
            1.0
        }
    };
    (0..r).map(norm).map(scale).collect()
}

/// Turns rows of Γ¹ into rows of Γ² = J_a^-T Γ¹, sample by sample, and tracks the condition of
/// J_a. The error is the sample at which J_a is singular.
fn keep_actuators(
    block: &mut Block,
    jacobians: &[f64],
    kept: &[usize],
    scales: &[f64],
    actuators: usize,
    first: usize,
) -> Result<(), usize> {
    let r = scales.len();
    let count = jacobians.len() / (actuators * r).max(1);
    let width = block.values.len() / (count * r).max(1);
    let samples = block
        .values
        .chunks_exact_mut((r * width).max(1))
        .zip(jacobians.chunks_exact(actuators * r));
    for (index, (rows, jacobian)) in samples.enumerate() {
        let transposed = DMatrix::from_fn(r, r, |i, j| jacobian[kept[j] * r + i]);
        let is_identity = transposed.is_identity(0.0);
        let condition = if is_identity {
            1.0
        } else {
            // Columns of J_a in units that compare metres with radians.
            condition_number(&DMatrix::from_fn(r, r, |i, j| {
                transposed[(i, j)] * scales[i]
            }))
        };
        if !condition.is_finite() {
            return Err(first + index);
        }
        if block.worst.is_none_or(|(worst, _)| condition > worst) {
            block.worst = Some((condition, first + index));
        }
        if is_identity {
            continue;
        }
        // A row-major r x width array is the transpose of a column-major width x r matrix.
        let mut solved = DMatrixView::from_slice(rows, width, r).transpose();
        if !transposed.lu().solve_mut(&mut solved) {
            return Err(first + index);
        }
        for (row, values) in rows.chunks_exact_mut(width).enumerate() {
            for (value, solved) in values.iter_mut().zip(solved.row(row).iter()) {
                *value = *solved;
            }
        }
    }
    Ok(())
}

/// Ratio of the largest to the smallest singular value; infinite for a singular matrix.
pub(crate) fn condition_number(matrix: &DMatrix<f64>) -> f64 {
    if matrix.is_empty() {
        return 1.0;
    }
    if matrix.iter().any(|value| !value.is_finite()) {
        return f64::INFINITY;
    }
    let values = matrix.singular_values();
    if values.min() > 0.0 {
        values.max() / values.min()
    } else {
        f64::INFINITY
    }
}

/// The problem of kept actuators that are singular at a sample.
fn singular(motion: &Motion, sample: usize) -> Error {
    Problem::new(format!(
        "sample {} (t = {:.4} s): the kept actuators do not determine the platform's motion",
        motion.first_sample + sample,
        motion.time(sample)
    ))
    .file(motion.run.as_str())
    .help("keep other actuators, or identify with the inputs projected on the platform")
    .into()
}

/// Decimates every column of a group in parallel.
fn decimate_group(
    blocks: &[Block],
    width: usize,
    samples: usize,
    decimator: &Decimator,
) -> Result<Vec<Vec<f64>>, Error> {
    (0..width)
        .into_par_iter()
        .map(|index| {
            let mut column = Vec::with_capacity(samples);
            for block in blocks {
                column.extend(block.values.iter().skip(index).step_by(width));
            }
            if column.iter().all(|value| *value == 0.0) {
                // Columns of the payload and of one direction are often all zero: nothing to filter.
                column.truncate((samples - decimator.first(samples)).div_ceil(decimator.factor()));
                return Ok(column);
            }
            decimator.apply(&column)
        })
        .collect()
}
