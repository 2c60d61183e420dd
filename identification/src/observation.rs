//! One pass over a run: motion, columns, projections and decimation block by block, down to what the
//! systems of all projections keep of it.
//!
//! Evaluation goes in parallel over the samples of a block, decimation and factorisation over the
//! lines of all projections.

use overact::{Function, Model};
use rayon::prelude::*;

use crate::{
    blocks::{BLOCK, slice},
    checks,
    columns::ColumnSet,
    conditioning::{Choice, Condition, home_scales},
    data::Log,
    error::Error,
    filters::Decimator,
    identify::{
        figures::{ConditionSeries, RunFigures},
        verdict::Finding,
    },
    kinematics::{Motion, Motions},
    regression::{Observed, PartitionCondition, Projection, singular},
    settings::Settings,
    sink::{LineSink, Plan, observed},
};

/// What is observed, the same for all runs.
pub(crate) struct Observer<'a> {
    pub(crate) model: &'a dyn Model,
    pub(crate) columns: &'a ColumnSet,
    /// Columns of the base parameters.
    pub(crate) base: &'a [usize],
    pub(crate) projections: &'a [Projection],
    pub(crate) settings: &'a Settings,
}

/// What is told of a run beside its equations.
#[derive(Debug, Clone)]
pub(crate) struct Seen {
    /// Samples used.
    pub(crate) samples: usize,
    pub(crate) closure_residual: f64,
    /// Motion and conditioning at the points of the plots.
    pub(crate) figures: RunFigures,
    /// Decimated torques at these points, points x n.
    pub(crate) torques: Vec<f64>,
    /// What is suspicious in it.
    pub(crate) findings: Vec<Finding>,
}

/// Some successive samples, evaluated: for each projection and line samples x (columns + 1), Y last.
pub(crate) struct Chunk {
    pub(crate) lines: Vec<Vec<Vec<f64>>>,
    /// For each projection, the conditions of its kept actuators.
    conditions: Vec<Vec<Condition>>,
}

impl Observer<'_> {
    /// Goes through a run. Gives, for each projection, what its system keeps, or why it has none; and
    /// what is told of the run. `budget` is the number of values that may be kept as stretches.
    ///
    /// # Errors
    /// A run that does not fit, a sample outside the workspace, a file that can't be read.
    pub(crate) fn run(
        &self,
        number: usize,
        log: &Log,
        budget: usize,
        progress: &dyn Fn(usize, usize),
    ) -> Result<(Vec<Result<Observed, Error>>, Seen), Error> {
        let info = self.model.info();
        let mut motions = Motions::new(self.model, log, self.settings)?;
        let samples = motions.samples();
        let decimator = Decimator::new(self.settings.decimation)?;
        let (lines, width) = (info.sizes.dof, self.base.len() + 1);
        let equations = decimator.kept(samples);
        let plan = Plan::new(
            equations,
            budget / (lines * width * self.projections.len()).max(1),
        );
        let mut sinks = Vec::new();
        for _ in 0..lines * self.projections.len() {
            sinks.push(LineSink::new(
                &plan,
                decimator.stream(width, samples)?,
                self.base.len(),
            ));
        }
        let mut torques = decimator.stream(info.sizes.actuators, samples)?;
        let mut decimated_torques = Vec::new();
        let mut points = Points::new(self, log, &decimator, samples, &plan);
        let mut failed: Vec<Option<Error>> = self.projections.iter().map(|_| None).collect();
        let mut closure_residual = 0.0_f64;
        while let Some(motion) = motions.next()? {
            closure_residual = closure_residual.max(motion.closure_residual);
            let chunks = self.chunks(&motion, &mut failed)?;
            sinks.par_iter_mut().enumerate().for_each(|(index, sink)| {
                let (projection, line) = (index / lines, index % lines);
                if failed[projection].is_none() {
                    chunks
                        .iter()
                        .for_each(|chunk| sink.push(&plan, &chunk.lines[projection][line]));
                }
            });
            torques.push(&motion.torques, &mut decimated_torques);
            points.take(&motion, &chunks);
            progress(motions.done(), log.samples());
        }
        progress(log.samples(), log.samples());
        let mut sinks = sinks.into_iter();
        let partitions = points.partitions(self.projections);
        let systems = failed
            .into_iter()
            .zip(partitions)
            .map(|(failure, partition)| {
                let own: Vec<LineSink> = sinks.by_ref().take(lines).collect();
                match failure {
                    Some(error) => Err(error),
                    None => Ok(observed(number, &plan, own, partition)),
                }
            })
            .collect();
        let seen = Seen {
            samples,
            closure_residual,
            figures: points.figures,
            torques: plan.at_points(&decimated_torques, info.sizes.actuators),
            findings: checks::of_run(self.model, log, motions, closure_residual)?,
        };
        Ok((systems, seen))
    }

    /// Evaluates a block in parallel. Projections whose kept actuators are singular at a sample are
    /// noted in `failed`.
    ///
    /// # Errors
    /// A sample at which the model has no value.
    pub(crate) fn chunks(
        &self,
        motion: &Motion,
        failed: &mut [Option<Error>],
    ) -> Result<Vec<Chunk>, Error> {
        let scales = home_scales(self.model);
        let wanted: Vec<bool> = failed.iter().map(Option::is_none).collect();
        let chunks: Vec<(Chunk, Vec<Option<usize>>)> = (0..motion.samples.div_ceil(BLOCK))
            .into_par_iter()
            .map(|index| self.chunk(motion, index * BLOCK, &scales, &wanted))
            .collect::<Result<_, _>>()?;
        for (projection, failed) in failed.iter_mut().enumerate() {
            let first = chunks.iter().find_map(|(_, singular)| singular[projection]);
            if let (Some(sample), None) = (first, &failed) {
                *failed = Some(singular(motion, sample).into());
            }
        }
        Ok(chunks.into_iter().map(|(chunk, _)| chunk).collect())
    }

    /// Evaluates up to [`BLOCK`] samples from number `first` of the motion on, and tells for each
    /// projection at which sample it is singular.
    fn chunk(
        &self,
        motion: &Motion,
        first: usize,
        scales: &[f64],
        wanted: &[bool],
    ) -> Result<(Chunk, Vec<Option<usize>>), Error> {
        let info = self.model.info();
        let (r, n) = (info.sizes.dof, info.sizes.actuators);
        let count = BLOCK.min(motion.samples - first);
        let at = |error: overact::SampleError| {
            Error::from(motion.outside(first + error.sample, error.error))
        };
        let pose = slice(&motion.pose, info.sizes.pose, first, count);
        let twist = slice(&motion.twist, r, first, count);
        let acceleration = slice(&motion.acceleration, r, first, count);
        let torques = slice(&motion.torques, n, first, count);
        let states = [pose, twist, acceleration];
        let mut platform = self
            .columns
            .evaluate(
                self.model,
                &states,
                (count, 1.0 / motion.sampling_frequency),
                motion.payload,
                (self.base, 1),
            )
            .map_err(at)?;
        let width = self.base.len() + 1;
        let mut y = vec![0.0; count * r];
        self.model
            .evaluate(Function::ProjectPlatform, &[pose, torques], &mut y)
            .map_err(at)?;
        for (line, rows) in platform.iter_mut().enumerate() {
            let measured = y[line..].iter().step_by(r);
            let last = rows[width - 1..].iter_mut().step_by(width);
            last.zip(measured).for_each(|(to, from)| *to = *from);
        }
        let mut jacobians = vec![0.0; count * n * r];
        self.model
            .evaluate(Function::InverseJacobian, &[pose], &mut jacobians)
            .map_err(at)?;
        let mut chunk = Chunk {
            lines: Vec::new(),
            conditions: Vec::new(),
        };
        let mut singular = Vec::new();
        for (projection, wanted) in self.projections.iter().zip(wanted) {
            let all = || (0..n).collect();
            let kept = projection.kept(&info).unwrap_or_else(all);
            let mut choice = Choice::new(kept, scales);
            chunk
                .conditions
                .push(conditions(&mut choice, &jacobians, n * r));
            if *projection == Projection::Platform {
                chunk.lines.push(platform.clone());
                singular.push(None);
            } else if *wanted {
                let (lines, failed) = projected(&platform, &mut choice, &jacobians, n * r);
                chunk.lines.push(lines);
                singular.push(failed.map(|sample| first + sample));
            } else {
                chunk.lines.push(Vec::new());
                singular.push(None);
            }
        }
        Ok((chunk, singular))
    }
}

/// The conditions of a choice of actuators sample by sample.
fn conditions(choice: &mut Choice, jacobians: &[f64], size: usize) -> Vec<Condition> {
    let one = |jacobian: &[f64]| {
        if choice.is_identity(jacobian) {
            Condition::PERFECT
        } else {
            choice.condition(jacobian)
        }
    };
    jacobians.chunks_exact(size).map(one).collect()
}

/// Rows of Γ² = J_a^-T Γ¹ from rows of Γ¹, line by line, and the first sample at which J_a is singular.
fn projected(
    platform: &[Vec<f64>],
    choice: &mut Choice,
    jacobians: &[f64],
    size: usize,
) -> (Vec<Vec<f64>>, Option<usize>) {
    let r = platform.len();
    let samples = jacobians.len() / size;
    let width = platform
        .first()
        .map_or(0, |rows| rows.len() / samples.max(1));
    let mut lines = vec![vec![0.0; samples * width]; r];
    for (sample, jacobian) in jacobians.chunks_exact(size).enumerate() {
        let range = sample * width..(sample + 1) * width;
        if choice.is_identity(jacobian) {
            for (line, rows) in lines.iter_mut().zip(platform) {
                line[range.clone()].copy_from_slice(&rows[range.clone()]);
            }
            continue;
        }
        let Some(inverse) = choice.inverse(jacobian) else {
            return (lines, Some(sample));
        };
        for (line, target) in lines.iter_mut().enumerate() {
            let target = &mut target[range.clone()];
            for (j, rows) in platform.iter().enumerate() {
                // Entry (line, j) of the transposed inverse.
                let factor = inverse[j * r + line];
                let rows = &rows[range.clone()];
                target
                    .iter_mut()
                    .zip(rows)
                    .for_each(|(to, from)| *to += factor * from);
            }
        }
    }
    (lines, None)
}

/// Collects what is plotted of a run's motion, and the worst conditions.
pub(crate) struct Points<'a> {
    pub(crate) figures: RunFigures,
    tracks: Vec<Track>,
    /// Sample of the motion at the first point, and distance of the points.
    first: usize,
    stride: usize,
    /// The last point.
    last: usize,
    settings: &'a Settings,
    frequency: f64,
}

/// The conditioning of one projection along a run.
struct Track {
    series: ConditionSeries,
    /// The worst condition and its sample.
    worst: Option<(f64, usize)>,
    /// The last determinant that was not zero.
    determinant: f64,
    crossings: usize,
}

impl<'a> Points<'a> {
    /// Points of a run of `samples` that are used, by the plan for its equations.
    pub(crate) fn new(
        observer: &Observer<'a>,
        log: &Log,
        decimator: &Decimator,
        samples: usize,
        plan: &Plan,
    ) -> Self {
        let info = observer.model.info();
        let settings = observer.settings;
        let tracks = observer.projections.iter().map(|projection| {
            let all = || (0..info.sizes.actuators).collect();
            let kept: Vec<usize> = projection.kept(&info).unwrap_or_else(all);
            let names = kept
                .iter()
                .filter_map(|&actuator| info.actuators.get(actuator));
            Track {
                series: ConditionSeries {
                    kept_actuators: names.map(|name| (*name).to_owned()).collect(),
                    ..ConditionSeries::default()
                },
                worst: None,
                determinant: 0.0,
                crossings: 0,
            }
        });
        Self {
            figures: RunFigures {
                run: log.name().to_owned(),
                payload: log.payload(),
                coordinates: pose_names(info.coordinates, info.sizes.pose),
                pose: vec![Vec::new(); info.sizes.pose],
                ..RunFigures::default()
            },
            tracks: tracks.collect(),
            first: decimator.first(samples),
            stride: plan.stride() * decimator.factor(),
            last: plan.points().saturating_sub(1),
            settings,
            frequency: log.sampling_frequency(),
        }
    }

    /// Takes the next samples.
    pub(crate) fn take(&mut self, motion: &Motion, chunks: &[Chunk]) {
        let poses = motion.pose.chunks_exact(self.figures.pose.len().max(1));
        let start = motion.first_sample - self.settings.skip_start;
        for (index, pose) in poses.enumerate() {
            let sample = start + index;
            if sample >= self.first && (sample - self.first).is_multiple_of(self.stride) {
                let time = (self.settings.skip_start + sample) as f64 / self.frequency;
                self.figures.time.push(time);
                let coordinates = self.figures.pose.iter_mut().zip(pose);
                coordinates.for_each(|(series, value)| series.push(*value));
            }
        }
        for (projection, track) in self.tracks.iter_mut().enumerate() {
            let conditions = chunks.iter().enumerate().flat_map(|(index, chunk)| {
                let first = start + index * BLOCK;
                (first..).zip(&chunk.conditions[projection])
            });
            for (sample, condition) in conditions {
                let point = sample.saturating_sub(self.first) / self.stride;
                track.take(sample, point.min(self.last), *condition);
            }
        }
    }

    /// The worst conditions of the projections on actuators; the plots keep the conditions that vary.
    pub(crate) fn partitions(
        &mut self,
        projections: &[Projection],
    ) -> Vec<Option<PartitionCondition>> {
        let mut partitions = Vec::new();
        for (track, projection) in std::mem::take(&mut self.tracks)
            .into_iter()
            .zip(projections)
        {
            let platform = *projection == Projection::Platform;
            partitions.push(track.worst.filter(|_| !platform).map(|(largest, sample)| {
                PartitionCondition {
                    largest,
                    run: self.figures.run.clone(),
                    sample: self.settings.skip_start + sample,
                    time: (self.settings.skip_start + sample) as f64 / self.frequency,
                    crossings: track.crossings,
                }
            }));
            let mut series = track.series;
            if platform {
                series.determinant.clear();
            }
            // Without a loop there is nothing to see.
            if series.condition.iter().any(|condition| *condition != 1.0) {
                self.figures.conditions.push(series);
            }
        }
        partitions
    }
}

impl Track {
    /// Takes the condition at a sample, which belongs to a point of the plots.
    fn take(&mut self, sample: usize, point: usize, condition: Condition) {
        if self.worst.is_none_or(|(worst, _)| condition.number > worst) {
            self.worst = Some((condition.number, sample));
        }
        if condition.determinant != 0.0 {
            self.crossings += usize::from(self.determinant * condition.determinant < 0.0);
            self.determinant = condition.determinant;
        }
        match self.series.condition.get_mut(point) {
            Some(worst) => *worst = worst.max(condition.number),
            None => {
                self.series.condition.resize(point + 1, condition.number);
                self.series
                    .determinant
                    .resize(point + 1, condition.determinant);
            }
        }
    }
}

/// Names of the pose coordinates: those of the platform, with a quaternion for free rotation.
fn pose_names(coordinates: &[&str], size: usize) -> Vec<String> {
    let quaternion = ["w", "x", "y", "z"].map(|part| format!("quaternion {part}"));
    let names = coordinates.iter().map(|name| (*name).to_owned());
    if size == coordinates.len() {
        names.collect()
    } else {
        let linear = size.saturating_sub(quaternion.len());
        names.take(linear).chain(quaternion).collect()
    }
}
