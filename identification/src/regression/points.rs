//! Motion data for plots, and the worst condition of the kept actuators along a run.

use super::{observer::Observer, projection::Projection, sink::Plan, system::PartitionCondition};
use crate::{
    blocks::BLOCK,
    filters::Decimator,
    kinematics::{Motion, conditioning::Condition},
    series::{ConditionSeries, RunFigures, VelocitySeries},
    settings::Settings,
};
use overact_logs::Log;

/// Relative difference of conditions that are equal up to rounding.
const SAME: f64 = 1e-9;

/// Collects motion data for plots, and the worst conditions.
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
    /// Velocities of the last sample.
    before: Vec<f64>,
}

/// Conditioning of one projection along a run.
struct Track {
    series: ConditionSeries,
    /// Worst condition and its sample.
    worst: Option<(f64, usize)>,
    /// Last non-zero determinant.
    determinant: f64,
    crossings: usize,
}

impl<'a> Points<'a> {
    /// Points of a run with `samples` used samples, by the plan for its equations.
    pub(crate) fn new(
        observer: &Observer<'a>,
        log: &Log,
        decimator: &Decimator,
        samples: usize,
        plan: &Plan,
    ) -> Self {
        let info = observer.model.info();
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
                velocities: { info.actuators.iter() }
                    .map(|name| VelocitySeries {
                        actuator: (*name).to_owned(),
                        ..VelocitySeries::default()
                    })
                    .collect(),
                ..RunFigures::default()
            },
            tracks: tracks.collect(),
            first: decimator.first(samples),
            stride: plan.stride() * decimator.factor(),
            last: plan.points().saturating_sub(1),
            settings: observer.settings,
            frequency: log.sampling_frequency(),
            before: Vec::new(),
        }
    }

    /// Adds the next samples, with the conditions of each projection block by block.
    pub(crate) fn take(&mut self, motion: &Motion, blocks: &[Vec<Vec<Condition>>]) {
        let poses = motion.pose.chunks_exact(self.figures.pose.len().max(1));
        let start = motion.first_sample - self.settings.skip_start;
        self.take_velocities(motion, start);
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
            let conditions = blocks.iter().enumerate().flat_map(|(index, block)| {
                let first = start + index * BLOCK;
                (first..).zip(&block[projection])
            });
            for (sample, condition) in conditions {
                let point = sample.saturating_sub(self.first) / self.stride;
                track.take(sample, point.min(self.last), *condition);
            }
        }
    }

    /// Adds the velocities of the next samples, the first of which has the number `start`.
    fn take_velocities(&mut self, motion: &Motion, start: usize) {
        let width = self.figures.velocities.len().max(1);
        for (index, now) in motion.velocities.chunks_exact(width).enumerate() {
            let sample = start + index;
            let is_point =
                sample >= self.first && (sample - self.first).is_multiple_of(self.stride);
            for (actuator, (series, value)) in
                self.figures.velocities.iter_mut().zip(now).enumerate()
            {
                if is_point {
                    series.velocity.push(*value);
                }
                series.largest_velocity = series.largest_velocity.max(value.abs());
                if let Some(before) = self.before.get(actuator) {
                    let acceleration = (value - before).abs() * self.frequency;
                    series.largest_acceleration = series.largest_acceleration.max(acceleration);
                }
            }
            now.clone_into(&mut self.before);
        }
    }

    /// Worst conditions of the projections on actuators; plots keep conditions that vary.
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
            // Without a loop, all conditions are 1.
            if series.condition.iter().any(|condition| *condition != 1.0) {
                self.figures.conditions.push(series);
            }
        }
        partitions
    }
}

impl Track {
    /// Adds the condition at a sample, which belongs to a point of the plots.
    fn take(&mut self, sample: usize, point: usize, condition: Condition) {
        // For equal conditions up to rounding, as in periodic motion, keep the first sample.
        let is_worse = |(worst, _)| condition.number > worst * (1.0 + SAME);
        if self.worst.is_none_or(is_worse) {
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
