//! Dry friction of the drives that the description lacks.
//!
//! Signs of the actuators' velocities are added to the regressor, one column for each drive. If
//! they explain most of the residual, dry friction is missing. A test of a single drive has little
//! power in short runs, in which each drive reverses once or twice.

use nalgebra::DMatrix;
use overact::{Function, Model};

use super::fault_residual::Columns;
use crate::{
    blocks::{BLOCK, slice},
    kinematics::Motions,
    regression::{factor::Factor, states::SampledStates},
    settings::Settings,
};
use overact_logs::{Error, Log};

/// Relative residuals of the model, and with dry friction of all drives.
///
/// `None` if the model has dry friction.
///
/// # Errors
/// As [`Motions::next`]; the runs have been read before.
pub(super) fn residuals(
    model: &dyn Model,
    runs: &[Log],
    settings: &Settings,
) -> Result<Option<(f64, f64)>, Error> {
    let info = model.info();
    let has_friction = info.parameters.iter().any(|one| one.symbol.has_sign());
    if has_friction {
        return Ok(None);
    }
    let columns = Columns::new(model, settings)?;
    let (p, n) = (columns.len(), info.sizes.actuators);
    let mut factors = vec![Factor::new(p + n); info.sizes.dof];
    for log in runs {
        add_run(model, log, settings, &columns, &mut factors)?;
    }
    // All lines share their parameters; each is divided by the norm of its inputs.
    let mut all = Factor::new(p + n);
    let mut lines = 0_u32;
    for factor in &factors {
        let inputs = factor.matrix().column(p + n).norm();
        if inputs > 0.0 {
            all.push(&(factor.matrix() / inputs));
            lines += 1;
        }
    }
    let error = |count: usize| {
        let selected: Vec<usize> = (0..count).collect();
        all.smallest_residual(&selected) / f64::from(lines.max(1)).sqrt()
    };
    Ok(Some((error(p), error(p + n))))
}

/// Adds the equations of a run to the factor of each line: W, signs of the velocities, inputs.
fn add_run(
    model: &dyn Model,
    log: &Log,
    settings: &Settings,
    columns: &Columns,
    factors: &mut [Factor],
) -> Result<(), Error> {
    let info = model.info();
    let (n, r, p) = (info.sizes.actuators, info.sizes.dof, columns.len());
    let width = p + n + 1;
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
            let mut lines = columns.evaluate(model, &states, n + 1).map_err(at)?;
            let pose = slice(&motion.pose, info.sizes.pose, first, count);
            let mut jacobians = vec![0.0; count * n * r];
            model
                .evaluate(Function::InverseJacobian, &[pose], &mut jacobians)
                .map_err(at)?;
            let jacobians = DMatrix::from_row_slice(count * n, r, &jacobians);
            let torques = slice(&motion.torques, n, first, count);
            let velocities = slice(&motion.velocities, n, first, count);
            for (line, rows) in lines.iter_mut().enumerate() {
                for (sample, row) in rows.chunks_exact_mut(width).enumerate() {
                    let mut inputs = 0.0;
                    for drive in 0..n {
                        let place = sample * n + drive;
                        let share = jacobians[(place, line)];
                        let velocity = velocities[place];
                        row[p + drive] = share
                            * if velocity == 0.0 {
                                0.0
                            } else {
                                velocity.signum()
                            };
                        inputs += share * torques[place];
                    }
                    row[p + n] = inputs;
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
