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
use overact::Function;

use super::{
    chunk::projected,
    observer::Observer,
    projection::Projection,
    sink::{LineSink, Plan, observed},
    system::System,
    uncertainty_propagation::PropagatedUncertainty,
};
use crate::{
    blocks::{BLOCK, slice},
    kinematics::{
        Motion, Motions,
        conditioning::{KeptActuators, home_scales},
    },
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
        let (model, settings) = (observer.model, observer.settings);
        let sizes = model.info().sizes;
        let (r, n, count) = (sizes.dof, sizes.actuators, self.actuators.len());
        let mut motions = Motions::new(model, log, settings)?.unwatched();
        let samples = motions.samples();
        let decimator = settings.decimator(settings.decimation, log.sampling_frequency())?;
        let plan = Plan::new(decimator.kept(samples), 0);
        let width = observer.base.len() + count;
        let sink = |place: usize| {
            let limit = settings.standstill_velocity.get(place % r).copied();
            let stream = |width| decimator.stream(width, samples);
            LineSink::new(&plan, stream, width - 1, false, limit)
        };
        let sinks = (0..r * systems.len()).map(sink);
        let mut sinks = sinks.collect::<Result<Vec<LineSink>, Error>>()?;
        let mut failed: Vec<Option<Error>> = systems.iter().map(|_| None).collect();
        while let Some(motion) = motions.next()? {
            let blocks = motion.samples.div_ceil(BLOCK);
            let chunks = observer.chunks(&motion, 0..blocks, &mut failed)?;
            for (place, chunk) in chunks.iter().enumerate() {
                let own = self.contributions(observer, &motion, place * BLOCK)?;
                for (index, sink) in sinks.iter_mut().enumerate() {
                    let (projection, line) = (index / r, index % r);
                    if failed[projection].is_some() {
                        continue;
                    }
                    let rows = joined(
                        &chunk.lines[projection][line],
                        &own[projection][line],
                        count,
                    );
                    let velocities = motion.velocities.iter().copied();
                    let velocities = velocities.skip(place * BLOCK * n + line).step_by(n);
                    sink.push(&plan, &rows, None, velocities);
                }
            }
        }
        let mut sinks = sinks.into_iter();
        for system in systems {
            let own: Vec<LineSink> = sinks.by_ref().take(r).collect();
            system.extend(observed(number, &plan, own, None));
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
        let pose = slice(&motion.pose, info.sizes.pose, first, count);
        let torques = slice(&motion.torques, n, first, count);
        let mut jacobians = vec![0.0; count * n * r];
        observer
            .model
            .evaluate(Function::InverseJacobian, &[pose], &mut jacobians)
            .map_err(|error| motion.outside(first + error.sample, error.error))?;
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
        let scales = home_scales(observer.model);
        let lines = |projection: &Projection| match projection {
            Projection::Platform => platform.clone(),
            _ => {
                let kept = projection.kept(&info).unwrap_or_else(|| (0..n).collect());
                let choice = KeptActuators::new(kept, &scales);
                projected(&platform, &choice, &jacobians, n * r).0
            }
        };
        Ok(observer.projections.iter().map(lines).collect())
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
