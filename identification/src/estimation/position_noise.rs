//! Noise of measured positions from high-order differences, and runs with added noise.
//!
//! Differences of order m of white noise have the variance C(2m, m) σ². Those of a smooth motion of
//! frequency ω at intervals T decrease as (ωT)^m. The smallest estimate over some orders is
//! therefore that of the noise. Quantisation with step s has the noise variance s²/12, even if it
//! hides other noise.

use overact_logs::{Error, Log};

/// Orders of the differences.
const ORDERS: std::ops::RangeInclusive<usize> = 2..=8;

/// Variance of rounding to steps of one.
const ROUNDING: f64 = 1.0 / 12.0;

/// Noise in steps from which on the smallest step is a resolution.
const SEEN: f64 = 0.1;

/// Smallest fraction of the noise variance that depends on the speed.
///
/// For white noise, 4000 samples give about 0.05.
const BY_SPEED: f64 = 0.2;

/// Samples on either side over which a speed is measured.
const SPEED_REACH: usize = 4;

/// Variance of the noise of a signal: σ² + κ v² at the speed v, in units of the signal per sample.
///
/// Stamps that are late or rounded act as noise of the positions that vanishes at rest.
#[derive(Debug, Clone, Copy, PartialEq)]
struct NoiseVariance {
    constant: f64,
    by_speed: f64,
}

impl NoiseVariance {
    /// The variance of a signal's noise.
    fn of(signal: &[f64]) -> Self {
        let steps = signal.windows(2).map(|pair| (pair[1] - pair[0]).abs());
        let smallest = steps
            .filter(|step| *step > 0.0)
            .fold(f64::INFINITY, f64::min);
        let (white, order, differences) = white(signal);
        // The smallest step of a smooth motion is no resolution. An encoder repeats values, or its
        // step is comparable to the noise.
        let repeats = signal.windows(2).any(|pair| pair[0] == pair[1]);
        let is_rounded = smallest.is_finite() && (repeats || white.sqrt() > SEEN * smallest);
        let least = if is_rounded {
            smallest * smallest * ROUNDING
        } else {
            0.0
        };
        let all = white.max(least);
        let speeds = speeds(signal, order);
        let slope = slope(&speeds, &differences);
        let mean = speeds.iter().sum::<f64>() / speeds.len().max(1) as f64;
        let depends = slope * mean > BY_SPEED * all;
        if !depends {
            return Self {
                constant: all,
                by_speed: 0.0,
            };
        }
        let constant = (all - slope * mean).max(least);
        Self {
            constant,
            by_speed: (all - constant) / mean,
        }
    }

    /// Standard deviations of the noise of each sample of a signal.
    fn deviations(self, signal: &[f64]) -> impl Iterator<Item = f64> {
        let speed = move |sample: usize| match self.by_speed {
            0.0 => 0.0,
            _ => squared_speed(signal, sample),
        };
        (0..signal.len()).map(move |sample| (self.constant + self.by_speed * speed(sample)).sqrt())
    }
}

/// Square of the speed at a sample, by a difference over some samples.
fn squared_speed(signal: &[f64], sample: usize) -> f64 {
    let first = sample.saturating_sub(SPEED_REACH);
    let last = (sample + SPEED_REACH).min(signal.len() - 1);
    let steps = (last - first).max(1) as f64;
    ((signal[last] - signal[first]) / steps).powi(2)
}

/// Squared speeds at the centres of differences of some order.
fn speeds(signal: &[f64], order: usize) -> Vec<f64> {
    let count = signal.len().saturating_sub(order);
    (0..count)
        .map(|first| squared_speed(signal, first + order / 2))
        .collect()
}

/// Slope of the regression of `y` on `x`; 0 for a constant `x`.
fn slope(x: &[f64], y: &[f64]) -> f64 {
    let count = x.len().min(y.len()).max(1) as f64;
    let mean = |values: &[f64]| values.iter().sum::<f64>() / count;
    let (x_mean, y_mean) = (mean(x), mean(y));
    let (mut products, mut squares) = (0.0, 0.0);
    for (x, y) in x.iter().zip(y) {
        products += (x - x_mean) * (y - y_mean);
        squares += (x - x_mean).powi(2);
    }
    if squares > 0.0 {
        products / squares
    } else {
        0.0
    }
}

/// Variance of white noise in a signal, the order of the differences that gives it, and their
/// squares in units of this variance's estimate.
fn white(signal: &[f64]) -> (f64, usize, Vec<f64>) {
    let mut differences = signal.to_vec();
    let mut gain = 1.0;
    let mut least = (f64::INFINITY, 0, Vec::new());
    for order in 1..=*ORDERS.end() {
        for at in 1..differences.len() {
            differences[at - 1] = differences[at] - differences[at - 1];
        }
        if differences.pop().is_none() || differences.is_empty() {
            return (0.0, 0, Vec::new());
        }
        // C(2m, m) from C(2m - 2, m - 1).
        let m = order as f64;
        gain *= 2.0 * (2.0 * m - 1.0) / m;
        if order < *ORDERS.start() {
            continue;
        }
        let sum: f64 = differences.iter().map(|one| one * one).sum();
        let variance = sum / differences.len() as f64 / gain;
        if variance < least.0 {
            let squares = differences.iter().map(|one| one * one / gain);
            least = (variance, order, squares.collect());
        }
    }
    least
}

/// A copy of a run in memory, with noise added to positions and measured velocities.
///
/// The added noise is white and has the size of the noise already present, also if that depends on
/// the speed. It is the same for the same run.
///
/// # Errors
/// A file cannot be read any more.
pub(crate) fn with_added_noise(log: &Log) -> Result<Log, Error> {
    let n = log.actuators();
    let (mut positions, mut velocities, mut torques) = (Vec::new(), Vec::new(), Vec::new());
    let mut reader = log.reader()?;
    while let Some(block) = reader.next()? {
        positions.extend(block.positions);
        velocities.extend(block.velocities);
        torques.extend(block.torques);
    }
    let mut noise = Noise::default();
    for signals in [&mut positions, &mut velocities] {
        for actuator in 0..n {
            let own: Vec<f64> = signals.iter().skip(actuator).step_by(n).copied().collect();
            let deviations = NoiseVariance::of(&own).deviations(&own);
            let values = signals.iter_mut().skip(actuator).step_by(n);
            for (value, deviation) in values.zip(deviations) {
                *value += deviation * noise.next();
            }
        }
    }
    let (name, frequency) = (log.name(), log.sampling_frequency());
    let noisy = Log::new(name, frequency, n, positions, torques, log.payload())?;
    let noisy = noisy.with_velocities(velocities);
    Ok(match log.payload_name() {
        Some(name) => noisy.with_payload_name(name),
        None => noisy,
    })
}

/// Normal pseudo-random numbers (Box-Muller, linear congruential generator).
struct Noise {
    state: u64,
    spare: Option<f64>,
}

impl Default for Noise {
    fn default() -> Self {
        Self {
            state: 0x9E37_79B9_7F4A_7C15,
            spare: None,
        }
    }
}

impl Noise {
    fn uniform(&mut self) -> f64 {
        self.state = self
            .state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        ((self.state >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
    }

    fn next(&mut self) -> f64 {
        if let Some(spare) = self.spare.take() {
            return spare;
        }
        let radius = (-2.0 * self.uniform().ln()).sqrt();
        let (sine, cosine) = (std::f64::consts::TAU * self.uniform()).sin_cos();
        self.spare = Some(radius * sine);
        radius * cosine
    }
}

#[cfg(test)]
mod tests {
    use super::{Noise, NoiseVariance};

    /// Standard deviation of a signal's noise at rest.
    fn deviation(signal: &[f64]) -> f64 {
        NoiseVariance::of(signal).constant.sqrt()
    }

    #[test]
    fn timestamp_jitter_noise_vanishes_at_rest() {
        let mut noise = Noise::default();
        let resolution = 1e-4;
        let signal: Vec<f64> = (0..5000)
            .map(|sample| {
                let time = f64::from(sample) / 100.0;
                let late = time + 3e-4 * noise.next();
                resolution * ((1.5 * late).sin() / resolution).round()
            })
            .collect();
        let found = NoiseVariance::of(&signal);
        let rest = found.constant.sqrt();
        assert!(rest < 1.5 * resolution, "{rest}");
        let deviations: Vec<f64> = found.deviations(&signal).collect();
        // The speed is 1.5 per s at sample 0.
        assert!(
            (deviations[4] / 4.5e-4 - 1.0).abs() < 0.2,
            "{}",
            deviations[4]
        );
        // Noise of an encoder does not depend on the speed.
        let white: Vec<f64> = (0..5000)
            .map(|sample| (0.015 * f64::from(sample)).sin() + 1e-4 * noise.next())
            .collect();
        assert_eq!(NoiseVariance::of(&white).by_speed, 0.0);
    }

    #[test]
    fn noise_is_distinguished_from_motion_and_from_encoders() {
        let mut noise = Noise::default();
        // Thirty samples in a period of the motion.
        let motion = |sample: usize| (0.21 * sample as f64).sin();
        let noisy: Vec<f64> = (0..5000)
            .map(|sample| motion(sample) + 1e-5 * noise.next())
            .collect();
        let found = deviation(&noisy);
        assert!((found / 1e-5 - 1.0).abs() < 0.1, "{found}");
        let step = 1e-3;
        let steps: Vec<f64> = (0..5000)
            .map(|sample| step * (motion(sample) / step).round())
            .collect();
        let found = deviation(&steps) / (step / 12_f64.sqrt());
        assert!((0.9..1.3).contains(&found), "{found}");
        assert_eq!(deviation(&[0.25; 100]), 0.0);
        // A rotation at constant speed has equal steps, which are no quantisation.
        let steady: Vec<f64> = (0..5000).map(|sample| 0.01 * f64::from(sample)).collect();
        let found = deviation(&steady);
        assert!(found < 1e-9, "{found}");
    }
}
