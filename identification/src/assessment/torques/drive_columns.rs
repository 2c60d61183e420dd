//! Effects of the drives that the description or the log lacks: dry friction, drifting load cells.
//!
//! Signs of the actuators' velocities, or the time, are added to the regressor as torques of the
//! drives. If they explain most of the residual, the model lacks them. A test of a single drive
//! against its covariance has little power in short runs, in which each drive reverses once or
//! twice.

use nalgebra::DMatrix;
use overact::Model;

use super::fault_residual::Columns;
use crate::{
    blocks::{BLOCK, slice},
    kinematics::Motions,
    regression::{factor::Factor, states::SampledStates},
    settings::Settings,
};
use overact_logs::{Error, Log};

/// Relative residuals of the model, and with further columns.
#[derive(Debug, Clone)]
pub(super) struct DriveResiduals {
    /// Of the model.
    pub(super) before: f64,
    /// With dry friction of all drives.
    pub(super) with_friction: f64,
    /// With a torque of each drive that grows with the time.
    pub(super) with_drift: Vec<f64>,
}

/// Residuals of whole runs.
///
/// # Errors
/// As [`Motions::next`]; the runs have been read before.
pub(super) fn residuals(
    model: &dyn Model,
    runs: &[Log],
    settings: &Settings,
) -> Result<DriveResiduals, Error> {
    let info = model.info();
    let columns = Columns::new(model, settings)?;
    let (p, n) = (columns.len(), info.sizes.actuators);
    let width = p + 2 * n;
    let mut factors = vec![Factor::new(width); info.sizes.dof];
    for log in runs {
        add_run(model, log, settings, &columns, &mut factors)?;
    }
    // All lines share their parameters; each is divided by the norm of its inputs.
    let mut all = Factor::new(width);
    let mut lines = 0_u32;
    for factor in &factors {
        let inputs = factor.matrix().column(width).norm();
        if inputs > 0.0 {
            all.push(&(factor.matrix() / inputs));
            lines += 1;
        }
    }
    let error = |more: std::ops::Range<usize>| {
        let selected: Vec<usize> = (0..p).chain(more).collect();
        all.smallest_residual(&selected) / f64::from(lines.max(1)).sqrt()
    };
    let drift = |drive: usize| error(p + n + drive..p + n + drive + 1);
    Ok(DriveResiduals {
        before: error(0..0),
        with_friction: error(p..p + n),
        with_drift: (0..n).map(drift).collect(),
    })
}

/// Adds the equations of a run to the factor of each line: W, torques of the signs of velocities,
/// torques of the time, inputs.
fn add_run(
    model: &dyn Model,
    log: &Log,
    settings: &Settings,
    columns: &Columns,
    factors: &mut [Factor],
) -> Result<(), Error> {
    let info = model.info();
    let (n, r, p) = (info.sizes.actuators, info.sizes.dof, columns.len());
    let width = p + 2 * n + 1;
    let mut motions = Motions::new(model, log, settings)?.unwatched();
    let decimator = settings.decimator(settings.decimation, log.sampling_frequency())?;
    let mut streams = (0..r)
        .map(|_| decimator.stream(width, motions.samples()))
        .collect::<Result<Vec<_>, _>>()?;
    while let Some(motion) = motions.next()? {
        for first in (0..motion.samples).step_by(BLOCK) {
            let count = BLOCK.min(motion.samples - first);
            let at = |error: overact::SampleError| {
                Error::from(motion.outside(first + error.sample, error.error))
            };
            let states = SampledStates::of_motion(&motion, first, count);
            let mut lines = columns.evaluate(model, &states, 2 * n + 1).map_err(at)?;
            let jacobians = motion.inverse_jacobians(model, first, count)?;
            let jacobians = DMatrix::from_row_slice(count * n, r, &jacobians);
            let torques = slice(&motion.torques, n, first, count);
            let velocities = slice(&motion.velocities, n, first, count);
            // From -1 to 1 in the run.
            let time = |sample: usize| {
                let number = motion.first_sample + first + sample;
                2.0 * number as f64 / log.samples() as f64 - 1.0
            };
            for (line, rows) in lines.iter_mut().enumerate() {
                for (sample, row) in rows.chunks_exact_mut(width).enumerate() {
                    let mut inputs = 0.0;
                    for drive in 0..n {
                        let place = sample * n + drive;
                        let share = jacobians[(place, line)];
                        let velocity = velocities[place];
                        let sign = if velocity == 0.0 {
                            0.0
                        } else {
                            velocity.signum()
                        };
                        row[p + drive] = share * sign;
                        row[p + n + drive] = share * time(sample);
                        inputs += share * torques[place];
                    }
                    row[p + 2 * n] = inputs;
                }
            }
            for ((stream, rows), factor) in streams.iter_mut().zip(&lines).zip(factors.iter_mut()) {
                let mut kept = Vec::new();
                stream.push(rows, &mut kept);
                if !kept.is_empty() {
                    factor.push_rows(&kept);
                }
            }
        }
    }
    Ok(())
}
