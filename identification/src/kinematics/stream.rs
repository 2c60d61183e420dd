//! Filtered positions of a run, their derivatives, and torques, block by block.

use crate::{
    filters::{SampledSignals, ZeroPhase, butterworth},
    settings::Settings,
};
use overact_logs::{Error, Log, Reader, monitor::Monitor};

/// Largest number of samples of a block.
const BLOCK_SAMPLES: usize = 4096;

/// Some successive samples of a log; all arrays are samples × n.
pub(super) struct Derivatives {
    /// Number of the first sample in the log.
    pub(super) first: usize,
    pub(super) samples: usize,
    pub(super) positions: Vec<f64>,
    pub(super) velocities: Vec<f64>,
    pub(super) accelerations: Vec<f64>,
    pub(super) torques: Vec<f64>,
}

/// A log that is filtered and differentiated.
pub(super) struct Stream<'a> {
    reader: Reader<'a>,
    monitor: Monitor,
    /// Whether the raw numbers are monitored.
    is_watched: bool,
    filter: ZeroPhase,
    /// Filter of the velocities, if measured.
    velocity_filter: Option<ZeroPhase>,
    /// Filter of the torques, if requested.
    torque_filter: Option<ZeroPhase>,
    frequency: f64,
    samples: usize,
    width: usize,
    /// Filtered positions from sample `start` on.
    positions: Vec<f64>,
    start: usize,
    /// Filtered measured velocities from the same sample on.
    velocities: Vec<f64>,
    /// Torques from sample `next` on.
    torques: Vec<f64>,
    /// Next sample to return.
    next: usize,
    /// Reach of differences on either side, in samples.
    reach: usize,
}

impl<'a> Stream<'a> {
    /// Starts with the first sample.
    pub(super) fn new(log: &'a Log, settings: &Settings) -> Result<Self, Error> {
        let frequency = log.sampling_frequency();
        let cutoff = settings.filter_cutoff_hz * 2.0 / frequency;
        let filter = butterworth(settings.filter_order, cutoff)?;
        let zero_phase = || ZeroPhase::new(&filter, log.actuators(), log.samples());
        let velocity_filter = log.has_velocities().then(zero_phase);
        let torque_filter = settings.filter_torques.then(zero_phase);
        Ok(Self {
            filter: zero_phase()?,
            velocity_filter: velocity_filter.transpose()?,
            torque_filter: torque_filter.transpose()?,
            reader: log.reader()?,
            monitor: Monitor::of(log),
            is_watched: true,
            frequency,
            samples: log.samples(),
            width: log.actuators(),
            positions: Vec::new(),
            start: 0,
            velocities: Vec::new(),
            torques: Vec::new(),
            next: 0,
            reach: settings.difference_order / 2,
        })
    }

    /// Turns off monitoring of the raw numbers.
    pub(super) fn leave_unwatched(&mut self) {
        self.is_watched = false;
    }

    /// Statistics of the raw numbers.
    pub(super) fn into_monitor(self) -> Monitor {
        self.monitor
    }

    /// Number of samples returned so far.
    pub(super) fn done(&self) -> usize {
        self.next
    }

    /// The next block, or `None` at the end.
    pub(super) fn next(&mut self) -> Result<Option<Derivatives>, Error> {
        loop {
            let known = self.start + self.positions.len() / self.width;
            // An acceleration is a difference of differences; the end has no neighbours.
            let possible = if known == self.samples {
                known
            } else {
                known.saturating_sub(2 * self.reach)
            };
            if possible > self.next {
                let end = possible.min(self.next + BLOCK_SAMPLES);
                return Ok(Some(self.take(end)));
            }
            let Some(block) = self.reader.next()? else {
                return Ok(None);
            };
            if self.is_watched {
                self.monitor.take(&block);
            }
            self.filter.push(&block.positions, &mut self.positions);
            if let Some(filter) = &mut self.velocity_filter {
                filter.push(&block.velocities, &mut self.velocities);
            }
            match &mut self.torque_filter {
                Some(filter) => filter.push(&block.torques, &mut self.torques),
                None => self.torques.extend(block.torques),
            }
        }
    }

    /// Returns the samples up to `end`.
    fn take(&mut self, end: usize) -> Derivatives {
        let (first, n) = (self.next, self.width);
        let signals = |values, start| SampledSignals {
            values,
            width: n,
            start,
            last: self.samples - 1,
        };
        // Accelerations need additional samples on either side.
        let before = first.saturating_sub(self.reach);
        let behind = (end + self.reach).min(self.samples);
        let around: Vec<f64> = if self.velocity_filter.is_some() {
            self.velocities[(before - self.start) * n..(behind - self.start) * n].to_vec()
        } else {
            signals(&self.positions, self.start).central_differences(before..behind, self.reach)
        };
        let per_second = |mut steps: Vec<f64>| {
            steps.iter_mut().for_each(|step| *step *= self.frequency);
            steps
        };
        let around = if self.velocity_filter.is_some() {
            around
        } else {
            per_second(around)
        };
        let accelerations = signals(&around, before).central_differences(first..end, self.reach);
        let accelerations = per_second(accelerations);
        let inside = |values: &[f64], start: usize| -> Vec<f64> {
            values[(first - start) * n..(end - start) * n].to_vec()
        };
        let block = Derivatives {
            first,
            samples: end - first,
            positions: inside(&self.positions, self.start),
            velocities: inside(&around, before),
            accelerations,
            torques: self.torques.drain(..(end - first) * n).collect(),
        };
        self.next = end;
        let obsolete = end.saturating_sub(2 * self.reach).max(self.start);
        self.positions.drain(..(obsolete - self.start) * n);
        if self.velocity_filter.is_some() {
            self.velocities.drain(..(obsolete - self.start) * n);
        }
        self.start = obsolete;
        block
    }
}
