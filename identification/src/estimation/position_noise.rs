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

/// Standard deviation of the noise of a signal.
pub(crate) fn deviation(signal: &[f64]) -> f64 {
    let steps = signal.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    let smallest = steps
        .filter(|step| *step > 0.0)
        .fold(f64::INFINITY, f64::min);
    let white = white(signal);
    // The smallest step of a smooth motion is no resolution. An encoder repeats values, or its step
    // is comparable to the noise.
    let repeats = signal.windows(2).any(|pair| pair[0] == pair[1]);
    let is_rounded = smallest.is_finite() && (repeats || white > SEEN * smallest);
    if is_rounded {
        white.max(smallest * ROUNDING.sqrt())
    } else {
        white
    }
}

/// Standard deviation of white noise in a signal.
fn white(signal: &[f64]) -> f64 {
    let mut differences = signal.to_vec();
    let (mut gain, mut order) = (1.0, 0.0);
    let mut least = f64::INFINITY;
    for _ in 1..=*ORDERS.end() {
        for at in 1..differences.len() {
            differences[at - 1] = differences[at] - differences[at - 1];
        }
        if differences.pop().is_none() || differences.is_empty() {
            return 0.0;
        }
        order += 1.0;
        // C(2m, m) from C(2m - 2, m - 1).
        gain *= 2.0 * (2.0 * order - 1.0) / order;
        if order < *ORDERS.start() as f64 {
            continue;
        }
        let sum: f64 = differences.iter().map(|one| one * one).sum();
        least = least.min(sum / differences.len() as f64 / gain);
    }
    least.sqrt()
}

/// A copy of a run in memory, with noise added to positions and measured velocities.
///
/// The added white noise has the size of the noise already present. It is the same for the same
/// run.
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
            let deviation = deviation(&own);
            let own = signals.iter_mut().skip(actuator).step_by(n);
            own.for_each(|value| *value += deviation * noise.next());
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
    use super::{Noise, deviation};

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
