//! Effect of uncertain corrections of the measured torques on estimates.
//!
//! A previous identification, as of gains or of friction in gears, corrects the torques by
//! coefficients with errors δ. Least squares is linear in the torques. P_j is the estimate from the
//! change of the torques with coefficient j, with the same columns and weights. The error of the
//! estimate is then P δ. With the covariance C of δ, its covariance increases by P C Pᵀ.
//!
//! The coefficients depend on the part of the torques that the unknown columns do not explain, and
//! the estimate on the part that they explain. White noise thus makes both errors independent.
//! Parameters that were known exactly are an exception: this covariance is too large for them.

use nalgebra::DMatrix;

use super::{
    Chunk,
    observer::Observer,
    pass::{BlockRows, Pass, in_projections},
    projection::Projection,
    system::System,
    uncertainty_propagation::PropagatedUncertainty,
};
use crate::{
    blocks::{BLOCK, slice},
    kinematics::Motion,
};
use overact_logs::{Error, Log};

/// Coefficients of a correction of the torques.
pub(crate) struct TorqueCorrection<'a> {
    /// Actuator of each coefficient.
    pub(crate) actuators: Vec<usize>,
    /// Covariance of the coefficients.
    pub(crate) covariance: DMatrix<f64>,
    /// Derivative of the actuator's torque with respect to a coefficient.
    ///
    /// For the number of the coefficient, the torque (N m, N) and the velocity of the actuator.
    pub(crate) derivative: &'a dyn Fn(usize, f64, f64) -> f64,
}

impl TorqueCorrection<'_> {
    /// Reads runs whose torques have been corrected.
    ///
    /// # Errors
    /// As [`Motions::next`]; the runs have been read before.
    pub(crate) fn propagated(
        &self,
        observer: &Observer<'_>,
        runs: &[Log],
    ) -> Result<PropagatedUncertainty, Error> {
        let info = observer.model.info();
        let (parameters, count) = (observer.base.len(), self.actuators.len());
        let new = |projection: &Projection| {
            System::new(projection.clone(), &info, parameters + count - 1)
        };
        let mut systems: Vec<System> = observer.projections.iter().map(new).collect();
        for (number, log) in runs.iter().enumerate() {
            self.run(observer, number, log, &mut systems)?;
        }
        let lines = systems.into_iter().map(|own| own.lines).collect();
        let covariance = self.covariance.clone();
        Ok(PropagatedUncertainty::new(lines, parameters, covariance))
    }

    /// Adds the equations of a run.
    fn run(
        &self,
        observer: &Observer<'_>,
        number: usize,
        log: &Log,
        systems: &mut [System],
    ) -> Result<(), Error> {
        let count = self.actuators.len();
        let pass = Pass {
            model: observer.model,
            settings: observer.settings,
            log,
            number,
            columns: observer.base.len() + count - 1,
            projections: systems.len(),
            budget: 0,
        };
        let mut failed: Vec<Option<Error>> = systems.iter().map(|_| None).collect();
        let rows = |motion: &Motion| {
            let blocks = motion.samples.div_ceil(BLOCK);
            let chunks = observer.chunks(motion, 0..blocks, &mut failed)?;
            let block = |(place, chunk): (usize, &Chunk)| {
                let own = self.contributions(observer, motion, place * BLOCK)?;
                let of_projection = |(projection, own): (usize, Vec<Vec<f64>>)| {
                    if failed[projection].is_some() {
                        return Vec::new();
                    }
                    let lines = chunk.lines[projection].iter().zip(&own);
                    lines.map(|(rows, own)| joined(rows, own, count)).collect()
                };
                Ok(own.into_iter().enumerate().map(of_projection).collect())
            };
            let blocks = chunks.iter().enumerate().map(block);
            blocks.collect::<Result<Vec<BlockRows>, Error>>()
        };
        let (equations, _) = pass.equations(rows, &|_, _, _| {})?;
        for (system, own) in systems.iter_mut().zip(equations) {
            system.extend(own);
        }
        Ok(())
    }

    /// Contributions of the coefficients to the lines of all projections, samples × coefficients.
    ///
    /// For up to [`BLOCK`] samples from number `first` of the motion on.
    fn contributions(
        &self,
        observer: &Observer<'_>,
        motion: &Motion,
        first: usize,
    ) -> Result<Vec<Vec<Vec<f64>>>, Error> {
        let info = observer.model.info();
        let (r, n) = (info.sizes.dof, info.sizes.actuators);
        let count = BLOCK.min(motion.samples - first);
        let torques = slice(&motion.torques, n, first, count);
        let jacobians = motion.inverse_jacobians(observer.model, first, count)?;
        let velocities = slice(&motion.velocities, n, first, count);
        let of_line = |line: usize| -> Vec<f64> {
            let entry = |sample: usize, number: usize| {
                let place = sample * n + self.actuators[number];
                let change = (self.derivative)(number, torques[place], velocities[place]);
                jacobians[place * r + line] * change
            };
            let samples = 0..count;
            samples
                .flat_map(|sample| (0..self.actuators.len()).map(move |number| (sample, number)))
                .map(|(sample, number)| entry(sample, number))
                .collect()
        };
        let platform: Vec<Vec<f64>> = (0..r).map(of_line).collect();
        let projections = observer.projections;
        Ok(in_projections(
            observer.model,
            projections,
            &platform,
            &jacobians,
        ))
    }
}

/// Rows of a line, with `count` contributions instead of Y.
fn joined(rows: &[f64], own: &[f64], count: usize) -> Vec<f64> {
    let width = rows.len() / (own.len() / count).max(1);
    let mut all = Vec::with_capacity(rows.len() + own.len());
    for (row, own) in rows.chunks_exact(width).zip(own.chunks_exact(count)) {
        all.extend_from_slice(&row[..width - 1]);
        all.extend_from_slice(own);
    }
    all
}
