//! Monitors the raw numbers of a run while it is read.
//!
//! It finds clipped and frozen torques, stuck encoders, lost samples and standstill.

use super::{
    clipping::clipping,
    lost_samples::{RepeatedRows, Steps},
    marks::{CommonSamples, Marks},
    peaks,
    position::{Position, Rest, SPEED_SAMPLES},
    roughness::Roughness,
    statistics::{Extreme, Means},
    suspicion::{DataFault, Suspicion},
    torque_rest::{TorqueRest, TorqueRests},
};
use crate::{run::log::Log, samples::Samples, significant};

/// Shortest rest of a signal (s).
const REST_SECONDS: f64 = 0.1;

/// Fraction of an actuator's range, or speed, that is certainly motion.
const CLEAR_MOTION: f64 = 0.05;

/// Fraction of steps that are no jumps.
const OF_STEPS: f64 = 0.99;

/// Range in steps between samples below which the robot stands still.
const STILL_STEPS: f64 = 15.0;

/// Smallest fraction of clipped samples, and smallest ratio of counts at the extreme and next to
/// it.
///
/// Peaks of quantised signals reach a ratio of 3.
const CLIPPED_PART: f64 = 1e-3;
const CLIPPED_RATIO: usize = 10;

/// Fewest samples at an extreme.
const FEWEST_CLIPPED: usize = 10;

/// Largest mean square of a torque by the variance of its noise, less 1, that may be noise alone.
const ONLY_NOISE: f64 = 0.25;

/// The same in standard deviations for few samples: those of the quotient of both are √(6.6/n).
///
/// Third differences of white noise have 2.3 times the relative variance of its squares.
const ONLY_NOISE_DEVIATIONS: f64 = 6.0;
const QUOTIENT_VARIANCE: f64 = 6.6;

/// Statistics of the raw positions and torques of a run.
#[derive(Debug, Clone)]
pub struct Monitor {
    frequency: f64,
    samples: usize,
    positions: Vec<Position>,
    torques: Vec<[Extreme; 2]>,
    /// Sum of the squares of each actuator's torques.
    torque_squares: Vec<f64>,
    torque_rests: Vec<TorqueRests>,
    /// Means of the torques over a few samples, at the start of the run.
    means: Means,
    /// Noise of positions and of torques.
    roughness: [Roughness; 2],
    /// Last [`SPEED_SAMPLES`] + 1 rows of positions, the newest last.
    recent: Vec<f64>,
    /// Hashes of samples, to find those of another run.
    marks: Marks,
    repeated: RepeatedRows,
    /// Whether the run was resampled from irregular times, which may be late.
    is_resampled: bool,
}

impl Monitor {
    /// A monitor for a run of `actuators` sampled at `frequency` (Hz).
    #[must_use]
    pub fn new(actuators: usize, frequency: f64) -> Self {
        Self {
            frequency,
            samples: 0,
            positions: vec![Position::default(); actuators],
            torques: vec![[Extreme::default(); 2]; actuators],
            torque_squares: vec![0.0; actuators],
            torque_rests: vec![TorqueRests::default(); actuators],
            means: Means::new(actuators, frequency),
            roughness: [Roughness::new(actuators), Roughness::new(actuators)],
            recent: Vec::new(),
            marks: Marks::default(),
            repeated: RepeatedRows::default(),
            is_resampled: false,
        }
    }

    /// A monitor for a run.
    #[must_use]
    pub fn of(log: &Log) -> Self {
        Self {
            is_resampled: log.is_resampled(),
            ..Self::new(log.actuators(), log.sampling_frequency())
        }
    }

    /// Adds the next samples.
    pub fn take(&mut self, samples: &Samples) {
        let n = self.positions.len();
        // Separate short loops let the processor overlap several samples.
        let mut rows = std::mem::take(&mut self.recent);
        let known = rows.len() / n;
        rows.extend_from_slice(&samples.positions);
        let all = rows.len() / n;
        let mut column = Vec::with_capacity(all);
        for (position, actuator) in self.positions.iter_mut().zip(0..) {
            column.clear();
            column.extend(rows.iter().skip(actuator).step_by(n));
            for row in known..all {
                let sample = self.samples + row - known;
                position.take(&column[..=row], sample, &rows[..(row + 1) * n]);
            }
        }
        rows.drain(..all.saturating_sub(SPEED_SAMPLES + 1) * n);
        self.recent = rows;
        let rows = || samples.positions.chunks_exact(n);
        let torques = || samples.torques.chunks_exact(n);
        for (positions, torques) in rows().zip(torques()) {
            self.marks.take(positions, torques);
            self.repeated.take(positions, torques);
        }
        torques().for_each(|torques| self.means.take(torques));
        self.roughness[0].take(&samples.positions);
        self.roughness[1].take(&samples.torques);
        let sums = self.torque_squares.iter_mut();
        for (([low, high], sum), actuator) in self.torques.iter_mut().zip(sums).zip(0..) {
            for torque in samples.torques[actuator..].iter().step_by(n) {
                high.take(*torque);
                low.take(-torque);
                *sum += torque * torque;
            }
        }
        for (rests, actuator) in self.torque_rests.iter_mut().zip(0..) {
            let of = |rows: &[f64]| rows[actuator];
            for (sample, (torques, positions)) in torques().zip(rows()).enumerate() {
                rests.take(self.samples + sample, of(torques), of(positions));
            }
        }
        self.samples += all - known;
    }

    /// Samples in common with another run.
    #[must_use]
    pub fn shared(&self, other: &Self) -> Option<CommonSamples> {
        self.marks.shared(&other.marks)
    }

    /// Ends the rests that last until the end.
    fn finish(&mut self) {
        for position in &mut self.positions {
            position.end_rest(self.samples, 0.0);
        }
        for rests in &mut self.torque_rests {
            rests.end(self.samples);
        }
    }

    /// Largest magnitude of each actuator's positions (m, rad).
    #[must_use]
    pub fn magnitudes(&self) -> Vec<f64> {
        let magnitude = |one: &Position| one.high.abs().max(one.low.abs());
        self.positions.iter().map(magnitude).collect()
    }

    /// Variances of white noise of the positions, and of the torques.
    #[must_use]
    pub fn noise(&self) -> [Vec<f64>; 2] {
        self.roughness.each_ref().map(Roughness::variances)
    }

    /// Smallest non-zero step of each actuator's positions (m, rad): possibly the resolution.
    #[must_use]
    pub fn resolutions(&self) -> Vec<f64> {
        let positions = self.positions.iter();
        positions.map(|one| one.smallest.unwrap_or(0.0)).collect()
    }

    /// Range of each actuator's positions (m, rad).
    #[must_use]
    pub fn ranges(&self) -> Vec<f64> {
        self.positions
            .iter()
            .map(|one| one.high - one.low)
            .collect()
    }

    /// Distance between each actuator's first and last position (m, rad).
    #[must_use]
    pub fn travels(&self) -> Vec<f64> {
        let travel = |one: &Position| (one.last - one.first).abs();
        self.positions.iter().map(travel).collect()
    }

    /// Smallest and largest position of each actuator (m, rad).
    #[must_use]
    pub fn bounds(&self) -> Vec<(f64, f64)> {
        let positions = self.positions.iter();
        positions.map(|one| (one.low, one.high)).collect()
    }

    /// Largest speed of each actuator over a few samples (m/s, rad/s).
    #[must_use]
    pub fn speeds(&self) -> Vec<f64> {
        let per_second = self.frequency / SPEED_SAMPLES as f64;
        self.positions
            .iter()
            .map(|one| one.speed * per_second)
            .collect()
    }

    /// Sampling frequency, Hz.
    #[must_use]
    pub const fn frequency(&self) -> f64 {
        self.frequency
    }

    /// Largest speed of each actuator (m/s, rad/s) without noise and single jumps.
    ///
    /// The smaller one of the speed over a few samples and the 99 % quantile of the steps.
    #[must_use]
    pub fn usual_speeds(&self) -> Vec<f64> {
        let positions = self.positions.iter().zip(self.speeds());
        let usual = positions.map(|(one, speed)| {
            let step = one.sizes.quantile(OF_STEPS);
            speed.min(step * self.frequency)
        });
        usual.collect()
    }

    /// Largest magnitude of each actuator's torques (N, N m).
    #[must_use]
    pub fn torque_peaks(&self) -> Vec<f64> {
        let torques = self.torques.iter();
        torques
            .map(|[low, high]| low.value.max(high.value))
            .collect()
    }

    /// Smallest torque of each actuator (N, N m): the least tension of a cable.
    #[must_use]
    pub fn least_torques(&self) -> Vec<f64> {
        self.torques.iter().map(|[low, _]| -low.value).collect()
    }

    /// Torques that are always zero.
    fn zeros(&self, names: &[&str]) -> Vec<Suspicion> {
        let is_zero = |[low, high]: &[Extreme; 2]| {
            let zero = |one: &Extreme| one.value == 0.0 && one.count == self.samples;
            zero(low) && zero(high)
        };
        let zeros = self
            .torques
            .iter()
            .zip(names)
            .filter(|(one, _)| is_zero(one));
        zeros
            .map(|(_, name)| Suspicion {
                fault: DataFault::Zero,
                actuator: Some((*name).to_owned()),
                statistic: 0.0,
                unit: "N or N m",
                threshold: 0.0,
                message: String::from(
                    "the torque is zero throughout: it was not recorded, or is in another column",
                ),
            })
            .collect()
    }

    /// Torques that are white noise around zero while their actuator moves.
    fn noise_torques(&self, names: &[&str]) -> Vec<Suspicion> {
        let [_, noise] = self.noise();
        let samples = self.samples.max(1) as f64;
        let deviation = (QUOTIENT_VARIANCE / samples).sqrt();
        let limit = ONLY_NOISE.min(ONLY_NOISE_DEVIATIONS * deviation);
        let found = |(actuator, at_rest): (usize, bool)| {
            let (sum, noise) = (self.torque_squares.get(actuator)?, noise.get(actuator)?);
            let quotient = sum / samples / noise;
            (!at_rest && (quotient - 1.0).abs() <= limit).then(|| Suspicion {
                fault: DataFault::Zero,
                actuator: names.get(actuator).map(|name| (*name).to_owned()),
                statistic: quotient,
                unit: "times the variance of its noise",
                threshold: limit,
                message: String::from(
                    "the torque is noise around zero, while the actuator moves: it was not recorded, or is in another column",
                ),
            })
        };
        let at_rest = self.at_rest().into_iter().enumerate();
        at_rest.filter_map(found).collect()
    }

    /// Torques that do not change while their actuator moves, except for those of `known`.
    fn frozen_torques(&self, names: &[&str], known: &[Suspicion]) -> Vec<Suspicion> {
        let is_known = |name: &str| {
            known
                .iter()
                .any(|one| one.actuator.as_deref() == Some(name))
        };
        let rest = |actuator: usize| -> Option<(f64, TorqueRest)> {
            let position = self.positions.get(actuator)?;
            let rest = self.torque_rests.get(actuator)?.unusual()?;
            let seconds = rest.samples as f64 / self.frequency;
            let moves = rest.moved > CLEAR_MOTION * (position.high - position.low);
            (moves && seconds >= REST_SECONDS).then_some((seconds, rest))
        };
        let found = |(actuator, name): (usize, &&str)| {
            let (seconds, rest) = rest(actuator).filter(|_| !is_known(name))?;
            let torque = significant(rest.torque, 4);
            let time = if rest.samples == self.samples {
                String::from("throughout")
            } else {
                let first = rest.first as f64 / self.frequency;
                format!("from t = {first:.3} s on for {seconds:.3} s")
            };
            Some(Suspicion {
                fault: DataFault::FrozenTorque,
                actuator: Some((*name).to_owned()),
                statistic: seconds,
                unit: "s",
                threshold: REST_SECONDS,
                message: format!(
                    "the torque stays at {torque} {time}, while the actuator moves: its signal is frozen, or another quantity is in its column; record the run again, or cut that time out"
                ),
            })
        };
        names.iter().enumerate().filter_map(found).collect()
    }

    /// Equal columns. Loops may move two actuators in proportion; then they must be equal.
    fn duplicates(&self, names: &[&str], coupled: bool) -> Vec<Suspicion> {
        let of = |what: &str, roughness: &Roughness| -> Vec<Suspicion> {
            let name = |index: usize| names.get(index).copied().unwrap_or_default();
            let one = |&(i, j): &(usize, usize)| Suspicion {
                fault: DataFault::Duplicate,
                actuator: Some(name(j).to_owned()),
                statistic: 0.0,
                unit: "",
                threshold: 0.0,
                message: format!(
                    "the {what} equals that of `{}` in each sample up to scale and offset: one column was used twice; check the names of the columns in the table [data]",
                    name(i)
                ),
            };
            roughness.twins(!coupled).iter().map(one).collect()
        };
        let [positions, torques] = &self.roughness;
        let mut all = of("position", positions);
        let zero = |actuator: usize| self.torques[actuator][1].value == 0.0;
        let mut torques = torques.clone();
        torques.forget(zero);
        all.extend(of("torque", &torques));
        all
    }

    /// Suspicions about a run of actuators with these names.
    ///
    /// If loops couple all actuators (`coupled`), one that rests while others move is stuck.
    /// Without loops it may be at rest.
    #[must_use]
    pub fn suspicions(mut self, names: &[&str], coupled: bool) -> Vec<Suspicion> {
        self.finish();
        let mut suspicions = self.clipped(names);
        for suspicion in peaks::suspicions(names, &self.means.rows) {
            if suspicions
                .iter()
                .all(|other| other.actuator != suspicion.actuator)
            {
                suspicions.push(suspicion);
            }
        }
        suspicions.extend(self.zeros(names));
        if self.travel() <= STILL_STEPS {
            suspicions.push(Suspicion {
                fault: DataFault::Standstill,
                actuator: None,
                statistic: self.travel(),
                unit: "steps",
                threshold: STILL_STEPS,
                message: String::from(
                    "the robot stands still: the positions change by no more than their noise, so the run does not determine inertia; leave it out",
                ),
            });
            return suspicions;
        }
        suspicions.extend(self.noise_torques(names));
        suspicions.extend(self.frozen_torques(names, &suspicions));
        suspicions.extend(self.duplicates(names, coupled));
        let stuck: Vec<Option<(f64, String)>> = (0..names.len())
            .map(|actuator| self.stuck(actuator, coupled))
            .collect();
        for (name, stuck) in names.iter().zip(&stuck) {
            suspicions.extend(stuck.iter().map(|(seconds, message)| Suspicion {
                fault: DataFault::Stuck,
                actuator: Some((*name).to_owned()),
                statistic: *seconds,
                unit: "s",
                threshold: REST_SECONDS,
                message: message.clone(),
            }));
        }
        if stuck.iter().all(Option::is_none) {
            let steps = Steps {
                positions: &self.positions,
                repeated: &self.repeated,
                frequency: self.frequency,
                is_resampled: self.is_resampled,
            };
            suspicions.extend(steps.suspicion(names));
        }
        suspicions
    }

    /// Largest range of a position by its RMS step; the step is noise at standstill.
    fn travel(&self) -> f64 {
        self.travels_in_steps().fold(0.0, f64::max)
    }

    /// Range of each actuator's positions by its RMS step.
    fn travels_in_steps(&self) -> impl Iterator<Item = f64> {
        let steps = self.samples.saturating_sub(1).max(1) as f64;
        self.positions.iter().map(move |one| {
            let step = (one.steps / steps).sqrt();
            let range = one.high - one.low;
            if range > 0.0 { range / step } else { 0.0 }
        })
    }

    /// Whether each actuator's position changes by no more than its noise.
    #[must_use]
    pub fn at_rest(&self) -> Vec<bool> {
        let travels = self.travels_in_steps();
        travels.map(|travel| travel <= STILL_STEPS).collect()
    }

    /// Duration for which an encoder is stuck (s), with a description.
    fn stuck(&self, actuator: usize, coupled: bool) -> Option<(f64, String)> {
        let own = &self.positions[actuator];
        let long = |rest: &&Rest| rest.samples as f64 >= REST_SECONDS * self.frequency;
        let rest = own.rest.as_ref().filter(long)?;
        let others = rest.moved.iter().zip(&self.positions).enumerate();
        let others_move =
            others
                .filter(|(other, _)| *other != actuator)
                .any(|(_, (moved, position))| {
                    *moved > CLEAR_MOTION * (position.high - position.low).max(0.0)
                });
        // A joint needs time to stop; a signal does not.
        let stops_dead = rest.speed_before > 4.0 * CLEAR_MOTION * own.speed && own.speed > 0.0;
        // A drive with dry friction may rest where its motion reverses, while others move. It stops
        // gently and goes on from the same place; a reading that was stuck jumps to the true one, or
        // never changes again.
        let goes_on = 0.0 < rest.step_after && rest.step_after <= own.sizes.quantile(OF_STEPS);
        let pauses = !stops_dead && goes_on;
        ((coupled && others_move && !pauses) || stops_dead).then(|| {
            let seconds = rest.samples as f64 / self.frequency;
            let message = format!(
                "the position does not change from t = {:.3} s on for {:.3} s, {}; the encoder or its reading is stuck: repair it, or leave the run out",
                rest.first as f64 / self.frequency,
                seconds,
                if others_move {
                    "while other actuators move"
                } else {
                    "from one sample to the next in full motion"
                }
            );
            (seconds, message)
        })
    }

    /// Torques that are too often at an extreme.
    fn clipped(&self, names: &[&str]) -> Vec<Suspicion> {
        let clipped = |extreme: &Extreme| {
            let enough = FEWEST_CLIPPED.max((CLIPPED_PART * self.samples as f64) as usize);
            extreme.count >= enough && extreme.count > CLIPPED_RATIO * extreme.next_count
                // A torque that never changes is no peak.
                && extreme.count < self.samples
        };
        let mut suspicions = Vec::new();
        for ([low, high], name) in self.torques.iter().zip(names) {
            let ends = [(low, -1.0), (high, 1.0)];
            let found: Vec<(usize, f64)> = ends
                .iter()
                .filter(|(extreme, _)| clipped(extreme))
                .map(|(extreme, sign)| (extreme.count, sign * extreme.value))
                .collect();
            if found.is_empty() {
                continue;
            }
            let samples: usize = found.iter().map(|(count, _)| count).sum();
            let levels: Vec<String> = found
                .iter()
                .map(|(_, value)| significant(*value, 5))
                .collect();
            suspicions.push(clipping(
                name,
                samples as f64 / self.samples as f64,
                CLIPPED_PART,
                &levels,
            ));
        }
        suspicions
    }
}
