//! Calibration equations of all samples, with the poses eliminated.
//!
//! Sample t has n equations e_t = J_x δx_t + J_p δp, divided by the noise of the sensors. e_t is
//! the difference between the sensors and the prediction from pose and parameters. J_x are the
//! columns of the r coordinates, J_p those of the parameters. With J_x = Q R, the projection I - Q
//! Qᵀ eliminates the pose. Each sample keeps n - r independent equations for the parameters.

use nalgebra::{DMatrix, DVector};
use overact::Model;
use rayon::prelude::*;

use super::{
    geometry::{Geometry, Reached},
    samples::{Samples, difference},
};

/// Robot, samples and calibrated geometry.
#[derive(Clone, Copy)]
pub(super) struct Problem<'a> {
    pub(super) model: &'a dyn Model,
    pub(super) geometry: &'a dyn Geometry,
    pub(super) samples: &'a Samples,
}

/// Unknowns of a calibration: the parameters, and the pose of each sample.
#[derive(Debug, Clone)]
pub(super) struct State {
    /// Changes of the parameters: n encoder offsets, then those of the geometry.
    pub(super) changes: Vec<f64>,
    /// Pose of each sample.
    pub(super) poses: Vec<f64>,
    /// Memory of the geometry for each sample.
    pub(super) memory: Vec<f64>,
}

/// Equations of a sample.
#[derive(Debug, Clone)]
pub(super) struct Eliminated {
    /// (I - Q Qᵀ) e.
    pub(super) residual: DVector<f64>,
    /// (I - Q Qᵀ) J_p, n x m.
    pub(super) columns: DMatrix<f64>,
    /// e and J_p before the projection.
    whole: (DVector<f64>, DMatrix<f64>),
    /// Q and R of J_x.
    pose: (DMatrix<f64>, DMatrix<f64>),
}

impl Problem<'_> {
    /// Number of parameters, m.
    pub(super) fn parameters(&self) -> usize {
        self.samples.sensors + self.geometry.parameters().len()
    }

    /// The described robot at the poses of the samples.
    pub(super) fn start(&self) -> Result<State, overact::Error> {
        let (size, kept) = (self.model.info().sizes.pose, self.geometry.memory());
        let mut memory = vec![0.0; self.samples.count() * kept];
        if kept > 0 {
            let places = self.samples.poses.chunks_exact(size);
            for (pose, memory) in places.zip(memory.chunks_exact_mut(kept)) {
                self.geometry.remember(pose, memory)?;
            }
        }
        Ok(State {
            changes: vec![0.0; self.parameters()],
            poses: self.samples.poses.clone(),
            memory,
        })
    }

    /// Equations of all samples in a state; updates the memory to its poses.
    pub(super) fn eliminated(&self, state: &mut State) -> Result<Vec<Eliminated>, overact::Error> {
        let (size, n) = (self.model.info().sizes.pose, self.samples.sensors);
        let kept = self.geometry.memory();
        let changes = &state.changes;
        let geometry = self.geometry.changed(&changes[n..]);
        let mut nothing: Vec<[f64; 0]> = vec![[]; self.samples.count()];
        let memories: Vec<&mut [f64]> = match kept {
            0 => nothing.iter_mut().map(|one| one.as_mut_slice()).collect(),
            _ => state.memory.chunks_exact_mut(kept).collect(),
        };
        memories
            .into_par_iter()
            .zip(state.poses.par_chunks_exact(size))
            .zip(self.samples.positions.par_chunks_exact(n))
            .map_init(Reached::default, |reached, ((memory, pose), measured)| {
                geometry.evaluate(pose, memory, reached)?;
                self.sample(measured, changes, reached)
            })
            .collect()
    }

    /// Equations of a sample.
    fn sample(
        &self,
        measured: &[f64],
        changes: &[f64],
        reached: &Reached,
    ) -> Result<Eliminated, overact::Error> {
        let info = self.model.info();
        let (n, m) = (self.samples.sensors, self.parameters());
        let weight = |sensor: usize| 1.0 / self.samples.noise[sensor];
        let residual = DVector::from_fn(n, |i, _| {
            let shown = reached.positions[i] + changes[i];
            weight(i) * difference(measured[i], shown, info.actuator_is_revolute[i])
        });
        let columns = DMatrix::from_fn(n, m, |i, j| match j.checked_sub(n) {
            Some(parameter) => weight(i) * reached.by_parameter[(i, parameter)],
            None if i == j => weight(i),
            None => 0.0,
        });
        let mut by_pose = reached.by_pose.clone();
        for (i, mut row) in by_pose.row_iter_mut().enumerate() {
            row *= weight(i);
        }
        let triangle = orthonormalised(&mut by_pose)?;
        let q = by_pose;
        Ok(Eliminated {
            residual: &residual - &q * q.tr_mul(&residual),
            columns: &columns - &q * q.tr_mul(&columns),
            whole: (residual, columns),
            pose: (q, triangle),
        })
    }

    /// State after a step of the parameters, with the poses updated.
    pub(super) fn moved(
        &self,
        state: &State,
        equations: &[Eliminated],
        step: &DVector<f64>,
    ) -> State {
        let mut next = state.clone();
        for (change, step) in next.changes.iter_mut().zip(step.iter()) {
            *change += step;
        }
        let size = self.model.info().sizes.pose;
        let poses = next.poses.chunks_exact_mut(size);
        for (pose, sample) in poses.zip(equations) {
            let (residual, columns) = &sample.whole;
            let (q, triangle) = &sample.pose;
            let right = q.tr_mul(&(residual - columns * step));
            // R is regular, since the equations exist.
            if let Some(step) = triangle.solve_upper_triangular(&right) {
                self.model.displace(pose, step.as_slice());
            }
        }
        next
    }
}

/// Orthonormalises columns by the modified Gram-Schmidt process, and returns R.
///
/// Each column is projected twice, for nearly dependent columns.
fn orthonormalised(columns: &mut DMatrix<f64>) -> Result<DMatrix<f64>, overact::Error> {
    let r = columns.ncols();
    let mut triangle = DMatrix::zeros(r, r);
    for k in 0..r {
        let mut own = columns.column(k).clone_owned();
        let size = own.norm();
        for _ in 0..2 {
            for before in 0..k {
                let along = columns.column(before).dot(&own);
                own.axpy(-along, &columns.column(before), 1.0);
                triangle[(before, k)] += along;
            }
        }
        let left = own.norm();
        // Also false for columns that are not finite.
        let regular = left > SINGULAR * size;
        if !regular {
            return Err(overact::Error::SingularPlatform {
                actuators: overact::ActuatorGroup::All,
                condition: size / left,
            });
        }
        triangle[(k, k)] = left;
        columns.set_column(k, &(own / left));
    }
    Ok(triangle)
}

/// Smallest independent fraction of a column of J_x; below it the pose is undetermined.
const SINGULAR: f64 = 1e-10;

/// Normal equations of all parameters, N δp = g, and the sum of squared residuals.
#[derive(Debug, Clone)]
pub(super) struct Normal {
    pub(super) matrix: DMatrix<f64>,
    pub(super) right: DVector<f64>,
    pub(super) square: f64,
}

impl Normal {
    /// Normal equations of all samples.
    pub(super) fn new(equations: &[Eliminated], parameters: usize) -> Self {
        let zero = || Self {
            matrix: DMatrix::zeros(parameters, parameters),
            right: DVector::zeros(parameters),
            square: 0.0,
        };
        // Chunks of fixed length and order give equal sums on every machine.
        let parts: Vec<Self> = equations
            .par_chunks(CHUNK)
            .map(|samples| Self::of_chunk(samples, parameters))
            .collect();
        parts.into_iter().fold(zero(), |mut sum, part| {
            sum.matrix += part.matrix;
            sum.right += part.right;
            sum.square += part.square;
            sum
        })
    }

    /// Normal equations of some samples.
    ///
    /// Their equations are concatenated: one large matrix product is faster than many small ones.
    fn of_chunk(samples: &[Eliminated], parameters: usize) -> Self {
        let count = samples.iter().map(|one| one.residual.len()).sum();
        let mut transposed = DMatrix::zeros(parameters, count);
        let mut residual = DVector::zeros(count);
        let mut at = 0;
        for one in samples {
            let n = one.residual.len();
            one.columns.transpose_to(&mut transposed.columns_mut(at, n));
            residual.rows_mut(at, n).copy_from(&one.residual);
            at += n;
        }
        Self {
            matrix: &transposed * transposed.transpose(),
            right: &transposed * &residual,
            square: residual.norm_squared(),
        }
    }
}

/// Samples per product.
const CHUNK: usize = 128;
