//! One pass over a run: motion, columns, projections and decimation, block by block.
//!
//! Evaluation is parallel over the samples of a block. Decimation and factorisation are parallel
//! over the lines of all projections.

use std::ops::Range;

use overact::Function;
use rayon::prelude::*;

use super::{
    chunk::{Chunk, projected},
    instruments::InstrumentRun,
    observer::{Conditioning, Observer},
    phase_sums::Phases,
    points::Points,
    projection::Projection,
    sink::{LineSink, Plan, observed},
    states::SampledStates,
    system::{RunEquations, singular},
};
use crate::{
    blocks::{BLOCK, slice},
    filters::Decimator,
    kinematics::{
        Motion, Motions, actuator_forces,
        conditioning::{KeptActuators, home_scales},
    },
    series::RunFigures,
};
use overact_logs::{Error, Log, monitor::Monitor, periods::PeriodicMotion};

/// A run to observe.
pub(crate) struct MeasuredRun<'a> {
    /// Its number among the runs.
    pub(crate) number: usize,
    pub(crate) log: &'a Log,
    /// Its instruments, if it has some.
    pub(crate) instruments: Option<&'a Log>,
    /// Largest number of values in stretches.
    pub(crate) budget: usize,
    /// Its periodic motion, if it has one.
    pub(crate) periodic_motion: Option<PeriodicMotion>,
}

/// Other results of a pass over a run.
#[derive(Debug, Clone)]
pub(crate) struct RunObservation {
    /// Number of samples used.
    pub(crate) samples: usize,
    pub(crate) closure_residual: f64,
    /// Equations of each line excluded at standstill; empty if none are to be.
    pub(crate) still: Vec<usize>,
    /// Motion and conditioning at the plotted points.
    pub(crate) figures: RunFigures,
    /// Decimated torques at these points, points × n.
    pub(crate) torques: Vec<f64>,
    /// Statistics of its raw numbers.
    pub(crate) monitor: Monitor,
    /// Reason why its instruments are unusable, if found during the pass.
    pub(crate) unusable: Option<Error>,
}

impl Observer<'_> {
    /// Reads a run, with its instruments if it has some.
    ///
    /// Returns the equations for each projection, or the error, and the other results.
    ///
    /// # Errors
    /// A run that does not fit, a sample outside the workspace, a file that cannot be read.
    pub(crate) fn run(
        &self,
        run: &MeasuredRun<'_>,
        progress: &dyn Fn(usize, usize),
    ) -> Result<(Vec<Result<RunEquations, Error>>, RunObservation), Error> {
        let (info, log) = (self.model.info(), run.log);
        let instrument_run =
            |own| InstrumentRun::new(self.model, own, log.samples(), self.settings);
        let mut instrument_run = run.instruments.map(instrument_run).transpose()?;
        let mut motions = Motions::new(self.model, log, self.settings)?;
        let samples = motions.samples();
        let decimator = self
            .settings
            .decimator(self.settings.decimation, log.sampling_frequency())?;
        let (lines, n) = (info.sizes.dof, info.sizes.actuators);
        // Columns and Y, and instruments if there are some.
        let width = self.base.len() * if instrument_run.is_some() { 2 } else { 1 } + 1;
        let equations = decimator.kept(samples);
        let plan = Plan::new(
            equations,
            run.budget / (lines * width * self.projections.len()).max(1),
        )
        .with_phases(
            run.periodic_motion
                .and_then(|motion| Phases::new(motion, self.settings.decimation)),
        );
        let mut sinks = self.sinks(&plan, &decimator, samples, instrument_run.is_some())?;
        let mut torques = decimator.stream(info.sizes.actuators, samples)?;
        let mut decimated_torques = Vec::new();
        let mut points = Points::new(self, log, &decimator, samples, &plan);
        let mut failed: Vec<Option<Error>> = self.projections.iter().map(|_| None).collect();
        let mut closure_residual = 0.0_f64;
        let scales = home_scales(self.model);
        let conditioning = Conditioning {
            scales: &scales,
            is_recorded: true,
        };
        while let Some(motion) = motions.next()? {
            closure_residual = closure_residual.max(motion.closure_residual);
            if let Some(own) = &mut instrument_run {
                own.advance(&motion);
            }
            let (blocks, mut conditions) = (motion.samples.div_ceil(BLOCK), Vec::new());
            // Decimate rows while they are in the cache.
            let together = rayon::current_num_threads().max(1);
            for first in (0..blocks).step_by(together) {
                let range = first..(first + together).min(blocks);
                let chunks = self.chunks_with(&motion, range.clone(), &mut failed, conditioning)?;
                let own = instrument_run.as_mut();
                let own = own.map(|own| own.chunks(self, range, &scales));
                let instrument_chunks = own.unwrap_or_default();
                sinks.par_iter_mut().enumerate().for_each(|(index, sink)| {
                    let (projection, line) = (index / lines, index % lines);
                    if failed[projection].is_some() {
                        return;
                    }
                    for (place, chunk) in chunks.iter().enumerate() {
                        let instruments = instrument_chunks.get(place);
                        let instruments = instruments.map(|own| &own.lines[projection][line][..]);
                        let velocities = motion.velocities.iter().copied();
                        let before = (first + place) * BLOCK * n;
                        let velocities = velocities.skip(before + line).step_by(n);
                        let rows = &chunk.lines[projection][line];
                        if let Some(lines) = chunk.subtracted.get(projection) {
                            sink.subtracted(&lines[line]);
                        }
                        sink.push(&plan, rows, instruments, velocities);
                    }
                });
                conditions.extend(chunks.into_iter().map(|chunk| chunk.conditions));
            }
            torques.push(&motion.torques, &mut decimated_torques);
            points.take(&motion, &conditions);
            progress(motions.done(), log.samples());
        }
        progress(log.samples(), log.samples());
        let partitions = points.partitions(self.projections);
        let unusable = instrument_run.and_then(InstrumentRun::into_failure);
        let still = sinks.iter().filter_map(LineSink::left_out).collect();
        let mut sinks = sinks.into_iter();
        let system = |(failure, partition): (Option<Error>, _)| {
            let own: Vec<LineSink> = sinks.by_ref().take(lines).collect();
            let mut observed = observed(run.number, &plan, own, partition);
            if unusable.is_some() {
                observed.instruments.clear();
            }
            failure.map_or_else(|| Ok(observed), Err)
        };
        let systems = failed.into_iter().zip(partitions).map(system).collect();
        let observation = RunObservation {
            samples,
            closure_residual,
            still,
            figures: points.figures,
            torques: plan.at_points(&decimated_torques, info.sizes.actuators),
            monitor: motions.into_monitor(),
            unusable,
        };
        Ok((systems, observation))
    }

    /// Sinks for the equations of a run, one for each line of each projection.
    fn sinks(
        &self,
        plan: &Plan,
        decimator: &Decimator,
        samples: usize,
        instruments: bool,
    ) -> Result<Vec<LineSink>, Error> {
        let (lines, parameters) = (self.model.info().sizes.dof, self.base.len());
        // The lines of a robot without redundancy are its actuators.
        let limits = &self.settings.standstill_velocity;
        let sink = |number: usize| {
            let limit = limits.get(number % lines).copied();
            let stream = |width| decimator.stream(width, samples);
            let sink = LineSink::new(plan, stream, parameters, instruments, limit)?;
            if self.settings.prior.held.is_empty() {
                return Ok(sink);
            }
            Ok(sink.with_total(stream(1)?))
        };
        (0..lines * self.projections.len()).map(sink).collect()
    }

    /// Evaluates some blocks of a motion in parallel.
    ///
    /// Projections with singular kept actuators at a sample are recorded in `failed`.
    ///
    /// # Errors
    /// A sample at which the model has no value.
    pub(crate) fn chunks(
        &self,
        motion: &Motion,
        blocks: Range<usize>,
        failed: &mut [Option<Error>],
    ) -> Result<Vec<Chunk>, Error> {
        let scales = home_scales(self.model);
        let conditioning = Conditioning {
            scales: &scales,
            is_recorded: true,
        };
        self.chunks_with(motion, blocks, failed, conditioning)
    }

    /// The same with given scales of the platform's coordinates, with or without conditions.
    ///
    /// # Errors
    /// A sample at which the model has no value.
    pub(super) fn chunks_with(
        &self,
        motion: &Motion,
        blocks: Range<usize>,
        failed: &mut [Option<Error>],
        conditioning: Conditioning<'_>,
    ) -> Result<Vec<Chunk>, Error> {
        let wanted: Vec<bool> = failed.iter().map(Option::is_none).collect();
        let chunks: Vec<(Chunk, Vec<Option<usize>>)> = blocks
            .into_par_iter()
            .map(|index| self.chunk(motion, index * BLOCK, conditioning, &wanted))
            .collect::<Result<_, _>>()?;
        for (projection, failed) in failed.iter_mut().enumerate() {
            let first = chunks.iter().find_map(|(_, singular)| singular[projection]);
            if let (Some(sample), None) = (first, &failed) {
                *failed = Some(singular(motion, sample).into());
            }
        }
        Ok(chunks.into_iter().map(|(chunk, _)| chunk).collect())
    }

    /// Evaluates up to [`BLOCK`] samples from number `first` of the motion on.
    ///
    /// It also returns the first singular sample of each projection.
    fn chunk(
        &self,
        motion: &Motion,
        first: usize,
        conditioning: Conditioning<'_>,
        wanted: &[bool],
    ) -> Result<(Chunk, Vec<Option<usize>>), Error> {
        let info = self.model.info();
        let (r, n) = (info.sizes.dof, info.sizes.actuators);
        let count = BLOCK.min(motion.samples - first);
        let platform = self.platform_rows(motion, first, count)?;
        let jacobians = motion.inverse_jacobians(self.model, first, count)?;
        let mut chunk = Chunk {
            lines: Vec::new(),
            subtracted: Vec::new(),
            conditions: Vec::new(),
        };
        let mut singular = Vec::new();
        // Chunks whose lines are those of the platform.
        let mut equal = Vec::new();
        for (projection, wanted) in self.projections.iter().zip(wanted) {
            let all = || (0..n).collect();
            let kept = projection.kept(&info).unwrap_or_else(all);
            let choice = KeptActuators::new(kept, conditioning.scales);
            if conditioning.is_recorded {
                chunk.conditions.push(choice.conditions(&jacobians, n * r));
            }
            let projected = match projection {
                Projection::Platform => None,
                _ if *wanted => projected(&platform, &choice, &jacobians, n * r),
                _ => Some(Default::default()),
            };
            equal.push(projected.is_none());
            let (lines, failed) = projected.unwrap_or_default();
            chunk.lines.push(lines);
            singular.push(failed.map(|sample| first + sample));
        }
        // Compute other projections before moving the platform's rows.
        let mut places = equal
            .iter()
            .zip(&mut chunk.lines)
            .filter(|(equal, _)| **equal);
        if let Some((_, own)) = places.next() {
            places.for_each(|(_, more)| more.clone_from(&platform));
            *own = platform;
        }
        if !motion.subtracted.is_empty() {
            let width = self.base.len() + 1;
            let lines = chunk.lines.iter_mut();
            let own = lines.map(|lines| lines.iter_mut().map(|rows| split_last(rows, width)));
            chunk.subtracted = own.map(Iterator::collect).collect();
        }
        Ok((chunk, singular))
    }

    /// Rows of Γ¹ of `count` samples from number `first` of the motion on, line by line.
    ///
    /// If parameters are held, the last column is their contribution, which was subtracted from Y.
    fn platform_rows(
        &self,
        motion: &Motion,
        first: usize,
        count: usize,
    ) -> Result<Vec<Vec<f64>>, Error> {
        let sizes = self.model.info().sizes;
        let (r, n) = (sizes.dof, sizes.actuators);
        let at = |error: overact::SampleError| {
            Error::from(motion.outside(first + error.sample, error.error))
        };
        let states = SampledStates::of_motion(motion, first, count);
        let both = [&motion.torques, &motion.subtracted].into_iter();
        let both: Vec<&Vec<f64>> = both.filter(|own| !own.is_empty()).collect();
        let mut platform = self
            .columns
            .evaluate(self.model, &states, self.base, both.len())
            .map_err(at)?;
        let width = self.base.len() + both.len();
        for (number, torques) in both.into_iter().enumerate() {
            let torques = slice(torques, n, first, count).to_vec();
            let torques = actuator_forces(self.model, torques);
            let mut y = vec![0.0; count * r];
            self.model
                .evaluate(Function::ProjectPlatform, &[states.pose, &torques], &mut y)
                .map_err(at)?;
            let place = self.base.len() + number;
            for (line, rows) in platform.iter_mut().enumerate() {
                let measured = y[line..].iter().step_by(r);
                let own = rows[place..].iter_mut().step_by(width);
                own.zip(measured).for_each(|(to, from)| *to = *from);
            }
        }
        Ok(platform)
    }
}

/// Removes the last column of rows of `width` + 1 values, and returns it.
fn split_last(rows: &mut Vec<f64>, width: usize) -> Vec<f64> {
    let last = rows
        .iter()
        .skip(width)
        .step_by(width + 1)
        .copied()
        .collect();
    let samples = rows.len() / (width + 1);
    for sample in 1..samples {
        let from = sample * (width + 1);
        rows.copy_within(from..from + width, sample * width);
    }
    rows.truncate(samples * width);
    last
}
