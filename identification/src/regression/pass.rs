//! One pass over a run: its rows, evaluated block by block, as decimated equations.
//!
//! The pass of `observation` does the same for the model's own equations, with their instruments,
//! conditioning and points for plots.

use overact::Model;
use rayon::prelude::*;

use super::{
    chunk::projected,
    projection::Projection,
    sink::{LineSink, Plan, observed},
    system::RunEquations,
};
use crate::{
    blocks::BLOCK,
    kinematics::{
        Motion, Motions,
        conditioning::{KeptActuators, home_scales},
    },
    settings::Settings,
};
use overact_logs::{Error, Log};

/// Rows of a block for each projection and each of its lines, samples × columns with Y at the end.
///
/// A projection that failed has no lines.
pub(crate) type BlockRows = Vec<Vec<Vec<f64>>>;

/// A run and the width of its equations.
pub(crate) struct Pass<'p> {
    pub(crate) model: &'p dyn Model,
    pub(crate) settings: &'p Settings,
    pub(crate) log: &'p Log,
    /// Number of the run.
    pub(crate) number: usize,
    /// Number of columns without Y.
    pub(crate) columns: usize,
    /// Number of projections.
    pub(crate) projections: usize,
    /// Largest number of stored values of stretches.
    pub(crate) budget: usize,
}

impl Pass<'_> {
    /// Equations of each projection from the rows of all blocks of each part of the motion, and the
    /// number of samples.
    ///
    /// # Errors
    /// Those of `rows`; a run that does not fit, or a file that cannot be read.
    pub(crate) fn equations(
        &self,
        mut rows: impl FnMut(&Motion) -> Result<Vec<BlockRows>, Error>,
        progress: &dyn Fn(&str, usize, usize),
    ) -> Result<(Vec<RunEquations>, usize), Error> {
        let (log, settings) = (self.log, self.settings);
        let sizes = self.model.info().sizes;
        let (lines, actuators) = (sizes.dof, sizes.actuators);
        let mut motions = Motions::new(self.model, log, settings)?.unwatched();
        let samples = motions.samples();
        let decimator = settings.decimator(settings.decimation, log.sampling_frequency())?;
        let values = lines * (self.columns + 1) * self.projections;
        let plan = Plan::new(decimator.kept(samples), self.budget / values.max(1));
        let sink = |place: usize| {
            let limit = settings.standstill_velocity.get(place % lines).copied();
            let stream = |width| decimator.stream(width, samples);
            LineSink::new(&plan, stream, self.columns, false, limit)
        };
        let sinks = (0..lines * self.projections).map(sink);
        let mut sinks = sinks.collect::<Result<Vec<LineSink>, Error>>()?;
        while let Some(motion) = motions.next()? {
            let blocks = rows(&motion)?;
            sinks.par_iter_mut().enumerate().for_each(|(index, sink)| {
                let (projection, line) = (index / lines, index % lines);
                for (place, block) in blocks.iter().enumerate() {
                    let Some(rows) = block[projection].get(line) else {
                        continue;
                    };
                    let velocities = motion.velocities.iter().copied();
                    let velocities = velocities.skip(place * BLOCK * actuators + line);
                    sink.push(&plan, rows, None, velocities.step_by(actuators));
                }
            });
            progress(log.name(), motions.done(), log.samples());
        }
        progress(log.name(), log.samples(), log.samples());
        let mut sinks = sinks.into_iter();
        let of_projection = |_| {
            let own: Vec<LineSink> = sinks.by_ref().take(lines).collect();
            observed(self.number, &plan, own, None)
        };
        let equations = (0..self.projections).map(of_projection).collect();
        Ok((equations, samples))
    }
}

/// Lines of the platform projection in each projection.
///
/// `jacobians` are those of [`Motion::inverse_jacobians`].
pub(crate) fn in_projections(
    model: &dyn Model,
    projections: &[Projection],
    lines: &[Vec<f64>],
    jacobians: &[f64],
) -> Vec<Vec<Vec<f64>>> {
    let info = model.info();
    let (r, n) = (info.sizes.dof, info.sizes.actuators);
    let scales = home_scales(model);
    let of = |projection: &Projection| match projection {
        Projection::Platform => lines.to_vec(),
        _ => {
            let kept = projection.kept(&info).unwrap_or_else(|| (0..n).collect());
            let choice = KeptActuators::new(kept, &scales);
            let projected = projected(lines, &choice, jacobians, n * r);
            projected.map_or_else(|| lines.to_vec(), |(lines, _)| lines)
        }
    };
    projections.iter().map(of).collect()
}
