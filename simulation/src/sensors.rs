//! Sensors: delayed and quantised positions, noisy torques.
//!
//! An encoder of resolution δ reports δ round(q / δ). Its error is uniform in ±δ/2, with standard
//! deviation δ/√12. The torque measurement adds white Gaussian noise. Each pair of run and actuator
//! has its own random stream, which the run's name selects. The noise of a run therefore does not
//! depend on the other runs or their order.

use std::collections::VecDeque;

use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;

use crate::experiment::Experiment;

/// The sensors of one run.
pub(crate) struct Sensors<'a> {
    /// Resolution of each encoder (rad, m); 0 or empty for ideal encoders.
    resolution: &'a [f64],
    /// Standard deviation of each torque (N m, N); empty without noise.
    deviation: &'a [f64],
    /// Random stream of each actuator.
    streams: Vec<Pcg64>,
    /// Positions that are not yet reported, oldest first.
    delayed: VecDeque<Vec<f64>>,
    /// Delay of the encoders in samples.
    delay: usize,
}

impl<'a> Sensors<'a> {
    /// Sensors of a run with `actuators` actuators.
    pub(crate) fn new(experiment: &'a Experiment, actuators: usize, run: &str) -> Self {
        let name = u128::from(fnv1a(run.as_bytes()));
        let streams = (0..actuators)
            .map(|i| Pcg64::new(u128::from(experiment.seed), (name << 32) | i as u128))
            .collect();
        Self {
            resolution: &experiment.encoder_resolution,
            deviation: &experiment.torque_noise,
            streams,
            delayed: VecDeque::new(),
            // The experiment is validated: the product is small and not negative.
            delay: (experiment.encoder_delay_s * experiment.sampling_hz).round() as usize,
        }
    }

    /// Replaces positions by those of `delay` samples ago; call it once per sample.
    ///
    /// Before the first sample, the robot is at rest at its first positions.
    pub(crate) fn delay(&mut self, positions: &mut [f64]) {
        while self.delayed.len() < self.delay {
            self.delayed.push_back(positions.to_vec());
        }
        if let Some(mut oldest) = self.delayed.pop_front() {
            oldest.as_mut_slice().swap_with_slice(positions);
            self.delayed.push_back(oldest);
        }
    }

    /// Rounds positions to the resolution of their encoders.
    pub(crate) fn encode(&self, positions: &mut [f64]) {
        for (position, resolution) in positions.iter_mut().zip(self.resolution) {
            if *resolution > 0.0 {
                *position = (*position / resolution).round() * resolution;
            }
        }
    }

    /// Adds noise to torques; call it once per sample.
    pub(crate) fn disturb(&mut self, torques: &mut [f64]) {
        for ((torque, deviation), stream) in torques
            .iter_mut()
            .zip(self.deviation)
            .zip(&mut self.streams)
        {
            let normal: f64 = StandardNormal.sample(stream);
            *torque += deviation * normal;
        }
    }
}

/// FNV-1a hash; unlike hashes of `std`, it is the same in all versions of Rust.
fn fnv1a(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mean and standard deviation.
    fn statistics(values: &[f64]) -> (f64, f64) {
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let square = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>();
        (mean, (square / (values.len() - 1) as f64).sqrt())
    }

    #[test]
    fn the_noise_is_white_with_the_given_deviation() {
        const N: usize = 200_000;
        let experiment = Experiment {
            torque_noise: vec![0.5, 2.0],
            seed: 7,
            ..Experiment::default()
        };
        let mut sensors = Sensors::new(&experiment, 2, "a");
        let samples: Vec<[f64; 2]> = (0..N)
            .map(|_| {
                let mut torques = [0.0, 0.0];
                sensors.disturb(&mut torques);
                torques
            })
            .collect();
        for (i, deviation) in [0.5, 2.0].into_iter().enumerate() {
            let values: Vec<f64> = samples.iter().map(|s| s[i] / deviation).collect();
            let (mean, spread) = statistics(&values);
            // Four standard errors of mean and standard deviation.
            assert!(mean.abs() < 4.0 / (N as f64).sqrt(), "{mean}");
            assert!(
                (spread - 1.0).abs() < 4.0 / (2.0 * N as f64).sqrt(),
                "{spread}"
            );
            let beyond = values.iter().filter(|v| v.abs() > 2.0).count() as f64 / N as f64;
            assert!(
                (beyond - 0.0455).abs() < 4.0 * (0.0455_f64 / N as f64).sqrt(),
                "{beyond}"
            );
            let lag = values.windows(2).map(|w| w[0] * w[1]).sum::<f64>() / N as f64;
            assert!(lag.abs() < 4.0 / (N as f64).sqrt(), "{lag}");
        }
        let cross = samples.iter().map(|s| s[0] * s[1]).sum::<f64>() / N as f64;
        assert!(cross.abs() < 4.0 / (N as f64).sqrt(), "{cross}");
    }

    #[test]
    fn the_encoder_error_is_uniform_within_half_a_step() {
        const N: usize = 100_000;
        let experiment = Experiment {
            encoder_resolution: vec![1e-3],
            ..Experiment::default()
        };
        let sensors = Sensors::new(&experiment, 1, "a");
        let errors: Vec<f64> = (0..N)
            .map(|k| {
                let mut q = [1e-3 * (k as f64 * 0.618_033_988_75)];
                let exact = q[0];
                sensors.encode(&mut q);
                q[0] - exact
            })
            .collect();
        let (mean, spread) = statistics(&errors);
        assert!(errors.iter().all(|e| e.abs() <= 0.5e-3 + 1e-12));
        assert!(mean.abs() < 1e-6);
        assert!((spread / (1e-3 / 12.0_f64.sqrt()) - 1.0).abs() < 1e-3);
    }

    #[test]
    fn positions_are_delayed_by_whole_samples() {
        let experiment = Experiment {
            encoder_delay_s: 4e-4,
            ..Experiment::default()
        };
        let mut sensors = Sensors::new(&experiment, 1, "a");
        let reported: Vec<f64> = (0..5)
            .map(|k| {
                let mut q = [f64::from(k)];
                sensors.delay(&mut q);
                q[0]
            })
            .collect();
        assert_eq!(reported, [0.0, 0.0, 0.0, 1.0, 2.0]);
    }

    #[test]
    fn streams_differ_by_run_actuator_and_seed() {
        let first = |seed, run: &str| {
            let mut torques = [0.0, 0.0];
            let experiment = Experiment {
                torque_noise: vec![1.0; 2],
                seed,
                ..Experiment::default()
            };
            Sensors::new(&experiment, 2, run).disturb(&mut torques);
            torques
        };
        let base = first(1, "a");
        assert_eq!(base, first(1, "a"));
        assert_ne!(base[0], base[1]);
        assert_ne!(base, first(2, "a"));
        assert_ne!(base, first(1, "b"));
    }
}
