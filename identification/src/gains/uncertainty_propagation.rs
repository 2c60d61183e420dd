//! Effect of the gains' uncertainty on estimates that use them.
//!
//! Torques multiplied by gains g have the relative errors δ_j = δg_j/g_j. Least squares is linear
//! in the torques. P_j is the estimate from the torque of drive j alone, with the same columns and
//! weights. The error of the estimate is then P δ. With the covariance C of δ, its covariance
//! increases by P C Pᵀ.
//!
//! The gains depend on the part of the torques that the unknown columns do not explain, and the
//! estimate on the part that they explain. White noise thus makes both errors independent.
//! Parameters that were known exactly are an exception: this covariance is too large for them.

use overact::Function;

use super::result::Gains;
use crate::{
    blocks::{BLOCK, slice},
    kinematics::{
        Motion, Motions,
        conditioning::{KeptActuators, home_scales},
    },
    regression::{
        chunk::projected,
        observer::Observer,
        projection::Projection,
        sink::{LineSink, Plan, observed},
        system::System,
        uncertainty_propagation::PropagatedUncertainty,
    },
};
use overact_logs::{Error, Log};

/// Reads runs whose torques have been multiplied by gains.
///
/// # Errors
/// As [`Motions::next`]; the runs have been read before.
pub(crate) fn propagate_gain_uncertainty(
    observer: &Observer<'_>,
    runs: &[Log],
    gains: &Gains,
) -> Result<PropagatedUncertainty, Error> {
    let info = observer.model.info();
    let (parameters, drives) = (observer.base.len(), info.sizes.actuators);
    let new =
        |projection: &Projection| System::new(projection.clone(), &info, parameters + drives - 1);
    let mut systems: Vec<System> = observer.projections.iter().map(new).collect();
    for (number, log) in runs.iter().enumerate() {
        run(observer, number, log, &mut systems)?;
    }
    let lines = systems.into_iter().map(|own| own.lines).collect();
    Ok(PropagatedUncertainty::new(
        lines,
        parameters,
        gains.relative_covariance(),
    ))
}

/// Adds the equations of a run.
fn run(
    observer: &Observer<'_>,
    number: usize,
    log: &Log,
    systems: &mut [System],
) -> Result<(), Error> {
    let (model, settings) = (observer.model, observer.settings);
    let sizes = model.info().sizes;
    let (r, n) = (sizes.dof, sizes.actuators);
    let mut motions = Motions::new(model, log, settings)?.unwatched();
    let samples = motions.samples();
    let decimator = settings.decimator(settings.decimation, log.sampling_frequency())?;
    let plan = Plan::new(decimator.kept(samples), 0);
    let width = observer.base.len() + n;
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
            let drives = drives(observer, &motion, place * BLOCK)?;
            for (index, sink) in sinks.iter_mut().enumerate() {
                let (projection, line) = (index / r, index % r);
                if failed[projection].is_some() {
                    continue;
                }
                let rows = joined(&chunk.lines[projection][line], &drives[projection][line], n);
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

/// Rows of a line, with the contributions of `n` drives instead of Y.
fn joined(rows: &[f64], drives: &[f64], n: usize) -> Vec<f64> {
    let width = rows.len() / (drives.len() / n).max(1);
    let mut all = Vec::with_capacity(rows.len() + drives.len());
    for (row, own) in rows.chunks_exact(width).zip(drives.chunks_exact(n)) {
        all.extend_from_slice(&row[..width - 1]);
        all.extend_from_slice(own);
    }
    all
}

/// Contributions of the drives to the lines of all projections, samples × n each.
///
/// For up to [`BLOCK`] samples from number `first` of the motion on.
fn drives(
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
    let platform: Vec<Vec<f64>> = (0..r)
        .map(|line| {
            let entries = jacobians.iter().skip(line).step_by(r);
            entries
                .zip(torques)
                .map(|(share, own)| share * own)
                .collect()
        })
        .collect();
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
