//! Samples of the runs for a calibration, and the noise of their sensors.
//!
//! Positions are unfiltered. Two thousand samples over all runs suffice: their noise is small, and
//! more of them gain less than the error of any real robot's geometry.
//!
//! The noise of a sensor is estimated from fourth differences of successive samples. They are zero
//! for smooth motion, and have the standard deviation σ √70 for white noise.

use overact::Code;
use overact::{Model, math::wrap_angle};

use crate::kinematics::approach;
use overact_logs::{Error, Log, Problem};

/// Samples of all runs together.
const SAMPLES: usize = 2000;

/// Golden ratio; its multiples modulo 1 are evenly distributed and never repeat.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// Time between two samples for which poses are tracked, s; the robot moves little in it.
const FOLLOWED: f64 = 0.005;

/// Coefficients of fourth differences, and the root of their sum of squares.
const DIFFERENCES: [f64; 5] = [1.0, -4.0, 6.0, -4.0, 1.0];
const DIFFERENCES_NORM: f64 = 8.366_600_265_340_756;

/// Mean magnitude of a normal variable, in standard deviations: √(2/π).
///
/// It is robust against a few jumps and, unlike a median, not quantised by the encoder's
/// resolution.
const NORMAL_MAGNITUDE: f64 = 0.797_884_560_802_865;

/// Smallest noise of a sensor, relative to the largest one.
///
/// An encoder at rest shows no noise, but has some.
const LEAST_NOISE: f64 = 1e-3;

/// Rows of differences per run, since the noise does not change.
const DIFFERENCED: usize = 20_000;

/// Samples of runs.
#[derive(Debug, Clone)]
pub(super) struct Samples {
    /// Number of sensors, n.
    pub(super) sensors: usize,
    /// Positions, samples × n (rad, m).
    pub(super) positions: Vec<f64>,
    /// Best poses in the described geometry, samples × numbers of a pose.
    pub(super) poses: Vec<f64>,
    /// Number of samples of each run, in the order of the runs.
    pub(super) of_runs: Vec<usize>,
    /// Standard deviation of the noise of each sensor (rad, m).
    pub(super) noise: Vec<f64>,
}

impl Samples {
    /// Number of samples.
    pub(super) fn count(&self) -> usize {
        self.of_runs.iter().sum()
    }

    /// Selects samples of runs.
    ///
    /// # Errors
    /// Runs that cannot be read, do not fit the robot or leave its workspace.
    pub(super) fn new(model: &dyn Model, runs: &[Log]) -> Result<Self, Error> {
        let info = model.info();
        let n = info.sizes.actuators;
        let mut samples = Self {
            sensors: n,
            positions: Vec::new(),
            poses: Vec::new(),
            of_runs: Vec::new(),
            noise: Vec::new(),
        };
        let mut differences = vec![Vec::new(); n];
        let total: usize = runs.iter().map(Log::samples).sum();
        let stride = (total / SAMPLES).max(1);
        for log in runs {
            samples.take(model, log, stride, &mut differences)?;
        }
        samples.noise = noise(differences, info.actuator_is_revolute);
        Ok(samples)
    }

    /// Selects about one sample in `stride` of a run.
    fn take(
        &mut self,
        model: &dyn Model,
        log: &Log,
        stride: usize,
        differences: &mut [Vec<f64>],
    ) -> Result<(), Error> {
        let n = self.sensors;
        let mut way = PosePath::new(model, log, stride);
        let mut reader = log.reader()?;
        let (mut number, mut taken) = (0, 0);
        while let Some(block) = reader.next()? {
            for (sensor, all) in differences.iter_mut().enumerate() {
                let left = DIFFERENCED.saturating_sub(all.len());
                all.extend(differenced(&block.positions, n, sensor).take(left));
            }
            for row in block.positions.chunks_exact(n) {
                if let Some(pose) = way.pose(number, row)? {
                    self.positions.extend_from_slice(row);
                    self.poses.extend_from_slice(pose);
                    taken += 1;
                }
                number += 1;
            }
        }
        self.of_runs.push(taken);
        Ok(())
    }
}

/// Poses along a run.
struct PosePath<'a> {
    model: &'a dyn Model,
    log: &'a Log,
    /// One of this number of samples is selected.
    stride: usize,
    /// Poses are tracked every this number of samples.
    followed: usize,
    pose: Vec<f64>,
}

impl<'a> PosePath<'a> {
    fn new(model: &'a dyn Model, log: &'a Log, stride: usize) -> Self {
        let followed = (FOLLOWED * log.sampling_frequency()) as usize;
        Self {
            pose: model.info().home_pose.to_vec(),
            followed: followed.max(1),
            model,
            log,
            stride,
        }
    }

    /// Tracks the next sample; returns its pose if it is selected.
    fn pose(&mut self, number: usize, row: &[f64]) -> Result<Option<&[f64]>, Error> {
        if number == 0 {
            approach(self.model, row, &mut self.pose);
        }
        let taken = is_taken(number, self.stride);
        if !taken && !number.is_multiple_of(self.followed) {
            return Ok(None);
        }
        let found = self.model.pose_from_actuators(row, &mut self.pose);
        found.map_err(|error| {
            let time = number as f64 / self.log.sampling_frequency();
            Problem::new(Code::OUTSIDE_WORKSPACE, format!(
                "sample {number} (t = {time:.4} s) is outside the workspace: {error}"
            ))
            .file(self.log.name())
            .help("calibration requires positions and geometry that are correct to some degrees and some percent: check units, signs and the order of the columns")
        })?;
        Ok(taken.then_some(self.pose.as_slice()))
    }
}

/// Whether a sample is selected: one in each `stride`, at a varying place.
///
/// Encoder errors repeat with periodic motion. Equally spaced samples would always meet the same
/// ones.
fn is_taken(number: usize, stride: usize) -> bool {
    let place = (number / stride) as f64 * GOLDEN;
    number % stride == (place.fract() * stride as f64) as usize
}

/// Magnitudes of the fourth differences of a sensor's successive positions.
fn differenced(positions: &[f64], n: usize, sensor: usize) -> impl Iterator<Item = f64> + '_ {
    let count = (positions.len() / n).saturating_sub(DIFFERENCES.len() - 1);
    (0..count).map(move |first| {
        let terms = DIFFERENCES.iter().enumerate();
        // Differences to the first position, which keep precision for large angles.
        let start = positions[first * n + sensor];
        let sum = terms.map(|(k, factor)| {
            let step = positions[(first + k) * n + sensor] - start;
            factor * step
        });
        sum.sum::<f64>().abs()
    })
}

/// Standard deviations of the sensors' noise from their differences.
fn noise(differences: Vec<Vec<f64>>, revolute: &[bool]) -> Vec<f64> {
    let deviation = |all: Vec<f64>| {
        let mean = all.iter().sum::<f64>() / all.len().max(1) as f64;
        mean / (NORMAL_MAGNITUDE * DIFFERENCES_NORM)
    };
    let own: Vec<f64> = differences.into_iter().map(deviation).collect();
    let floor = |kind: bool| {
        let alike = own.iter().zip(revolute).filter(|(_, one)| **one == kind);
        let largest = alike.map(|(own, _)| *own).fold(0.0, f64::max);
        if largest > 0.0 {
            LEAST_NOISE * largest
        } else {
            f64::EPSILON
        }
    };
    let pairs = own.iter().zip(revolute);
    pairs.map(|(own, kind)| own.max(floor(*kind))).collect()
}

/// Difference of two positions; modulo a turn for angles.
pub(super) fn difference(measured: f64, reached: f64, revolute: bool) -> f64 {
    if revolute {
        wrap_angle(measured - reached)
    } else {
        measured - reached
    }
}
