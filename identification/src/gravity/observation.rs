//! One pass over the runs: decimated equations in the independent columns, for each projection.

use rayon::prelude::*;

use nalgebra::DMatrix;
use overact::{Function, Model};

use super::{Fields, columns::Extended};
use crate::{
    blocks::{BLOCK, slice},
    kinematics::{
        self, Motion, Motions,
        conditioning::{KeptActuators, home_scales},
    },
    regression::{
        chunk::projected,
        observer,
        projection::Projection,
        sink::{LARGEST_STRETCHES, LineSink, Plan, observed},
        states::SampledStates,
        system::System,
    },
    settings::Settings,
};
use overact_logs::{Error, Log};

/// Options of the observation, the same for all runs.
pub(super) struct Observer<'a> {
    pub(super) model: &'a dyn Model,
    pub(super) fields: &'a Fields<'a>,
    pub(super) extended: &'a Extended,
    pub(super) settings: &'a Settings,
}

/// Rows of the field columns: for each projection and line, samples × columns.
type FieldRows = Vec<Vec<Vec<f64>>>;

impl Observer<'_> {
    /// Equations of all runs for each projection, or the reason why it has none.
    ///
    /// # Errors
    /// The problems of all runs together.
    pub(super) fn systems(
        &self,
        runs: &[Log],
        progress: &dyn Fn(&str, usize, usize),
    ) -> Result<Vec<Result<System, Error>>, Error> {
        let checked = runs
            .iter()
            .filter_map(|log| kinematics::check(self.model, log, self.settings).err());
        Error::check(checked.flat_map(|error| error.problems).collect())?;
        let info = self.model.info();
        let projections = Projection::usual(&info, &self.settings.kept_actuators);
        let observer = observer::Observer {
            model: self.model,
            columns: &self.extended.own.columns,
            base: &self.extended.own.picked,
            projections: &projections,
            settings: self.settings,
        };
        let new = |one: &Projection| Ok(System::new(one.clone(), &info, self.extended.len()));
        let mut systems: Vec<Result<System, Error>> = projections.iter().map(new).collect();
        let mut problems = Vec::new();
        for number in 0..runs.len() {
            if let Err(error) = self.run(&observer, runs, number, &mut systems, progress) {
                problems.extend(error.problems);
            }
        }
        Error::check(problems)?;
        Ok(systems)
    }

    /// Adds the equations of a run.
    fn run(
        &self,
        observer: &observer::Observer<'_>,
        runs: &[Log],
        number: usize,
        systems: &mut [Result<System, Error>],
        progress: &dyn Fn(&str, usize, usize),
    ) -> Result<(), Error> {
        let (log, budget) = (&runs[number], LARGEST_STRETCHES / runs.len());
        let sizes = self.model.info().sizes;
        let (r, n) = (sizes.dof, sizes.actuators);
        let mut motions = Motions::new(self.model, log, self.settings)?.unwatched();
        let samples = motions.samples();
        let decimator = self
            .settings
            .decimator(self.settings.decimation, log.sampling_frequency())?;
        let columns = self.extended.len();
        let values = r * (columns + 1) * systems.len();
        let plan = Plan::new(decimator.kept(samples), budget / values.max(1));
        let sink = |place: usize| {
            let limit = self.settings.standstill_velocity.get(place % r).copied();
            let stream = |width| decimator.stream(width, samples);
            LineSink::new(&plan, stream, columns, false, limit)
        };
        let sinks = (0..r * systems.len()).map(sink);
        let mut sinks = sinks.collect::<Result<Vec<LineSink>, Error>>()?;
        let mut failed: Vec<Option<Error>> = systems.iter().map(|_| None).collect();
        while let Some(motion) = motions.next()? {
            let blocks = motion.samples.div_ceil(BLOCK);
            let chunks = observer.chunks(&motion, 0..blocks, &mut failed)?;
            let fields: Vec<FieldRows> = (0..chunks.len())
                .into_par_iter()
                .map(|place| self.field_rows(observer, &motion, place * BLOCK))
                .collect::<Result<_, Error>>()?;
            sinks.par_iter_mut().enumerate().for_each(|(index, sink)| {
                let (projection, line) = (index / r, index % r);
                if failed[projection].is_some() {
                    return;
                }
                for (place, (chunk, fields)) in chunks.iter().zip(&fields).enumerate() {
                    let (rows, fields) =
                        (&chunk.lines[projection][line], &fields[projection][line]);
                    let rows = joined(rows, fields, chunk.samples());
                    let velocities = motion.velocities.iter().copied();
                    let velocities = velocities.skip(place * BLOCK * n + line).step_by(n);
                    sink.push(&plan, &rows, None, velocities);
                }
            });
            progress(log.name(), motions.done(), log.samples());
        }
        progress(log.name(), log.samples(), log.samples());
        let mut sinks = sinks.into_iter();
        for (system, failure) in systems.iter_mut().zip(failed) {
            let own: Vec<LineSink> = sinks.by_ref().take(r).collect();
            match (system.as_mut(), failure) {
                (Ok(_), Some(failure)) => *system = Err(failure),
                (Ok(system), None) => system.extend(observed(number, &plan, own, None)),
                (Err(_), _) => {}
            }
        }
        Ok(())
    }

    /// Field columns of up to [`BLOCK`] samples from number `first` of the motion on.
    fn field_rows(
        &self,
        observer: &observer::Observer<'_>,
        motion: &Motion,
        first: usize,
    ) -> Result<FieldRows, Error> {
        let info = self.model.info();
        let (r, n) = (info.sizes.dof, info.sizes.actuators);
        let count = BLOCK.min(motion.samples - first);
        let outside =
            |error: overact::SampleError| motion.outside(first + error.sample, error.error);
        let pose = slice(&motion.pose, info.sizes.pose, first, count);
        let rest = vec![0.0; count * r];
        let mut lines: Vec<Vec<f64>> = vec![Vec::new(); r];
        let mut parts: Vec<(usize, Vec<Vec<f64>>)> = Vec::new();
        for (field, own) in self.fields.along.iter().zip(&self.extended.along) {
            let states = SampledStates {
                twist: &rest,
                acceleration: &rest,
                ..SampledStates::of_motion(motion, first, count)
            };
            let rows = own
                .columns
                .evaluate(*field, &states, &own.picked, 0)
                .map_err(outside)?;
            parts.push((own.picked.len(), rows));
        }
        for (line, all) in lines.iter_mut().enumerate() {
            for sample in 0..count {
                for (width, rows) in &parts {
                    all.extend_from_slice(&rows[line][sample * width..(sample + 1) * width]);
                }
            }
        }
        let mut jacobians = vec![0.0; count * n * r];
        self.model
            .evaluate(Function::InverseJacobian, &[pose], &mut jacobians)
            .map_err(outside)?;
        let scales = home_scales(self.model);
        let of = |projection: &Projection| match projection {
            Projection::Platform => lines.clone(),
            _ => {
                let kept = projection.kept(&info).unwrap_or_else(|| (0..n).collect());
                let choice = KeptActuators::new(kept, &scales);
                projected(&lines, &choice, &jacobians, n * r).0
            }
        };
        Ok(observer.projections.iter().map(of).collect())
    }
}

/// Rows of a line, with the field columns before Y.
fn joined(rows: &[f64], fields: &[f64], samples: usize) -> Vec<f64> {
    let (width, more) = (rows.len() / samples, fields.len() / samples);
    let mut all = Vec::with_capacity(rows.len() + fields.len());
    for sample in 0..samples {
        let (y, own) = rows[sample * width..(sample + 1) * width]
            .split_last()
            .unwrap_or((&0.0, &[]));
        all.extend_from_slice(own);
        all.extend_from_slice(&fields[sample * more..(sample + 1) * more]);
        all.push(*y);
    }
    all
}

/// A system in combinations of its columns.
pub(super) fn combined(system: &System, coefficients: &DMatrix<f64>) -> System {
    System {
        lines: system
            .lines
            .iter()
            .map(|line| line.combined(coefficients))
            .collect(),
        parts: Vec::new(),
        stretches: Vec::new(),
        phase_sums: Vec::new(),
        instruments: Vec::new(),
        ..system.clone()
    }
}
