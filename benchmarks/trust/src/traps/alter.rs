//! Applies faults to faultless records.

use overact_simulation::Record;

/// Delays the torques by some seconds; negative values advance them.
pub(super) fn late(record: &mut Record, seconds: f64) {
    let n = record.actuators.len();
    let shift = (seconds.abs() * record.sampling_hz).round() as usize;
    let (moved, still) = if seconds > 0.0 {
        (&mut record.torques, &mut record.positions)
    } else {
        (&mut record.positions, &mut record.torques)
    };
    // The first samples of one have no counterpart in the other.
    moved.truncate(moved.len() - shift * n);
    still.drain(..shift * n);
    record.time.truncate(record.time.len() - shift);
}

/// Passes the torques through a first-order lag.
pub(super) fn lag(record: &mut Record, seconds: f64) {
    let n = record.actuators.len();
    let part = 1.0 - (-1.0 / (seconds * record.sampling_hz)).exp();
    let mut state = record.torques[..n].to_vec();
    for row in record.torques.chunks_exact_mut(n) {
        for (state, torque) in state.iter_mut().zip(row) {
            *state += part * (*torque - *state);
            *torque = *state;
        }
    }
}

/// Replaces the torques by moving averages over some seconds.
pub(super) fn smooth(record: &mut Record, seconds: f64) {
    let n = record.actuators.len();
    let reach = (0.5 * seconds * record.sampling_hz).round() as usize;
    let samples = record.torques.len() / n;
    let own = record.torques.clone();
    for sample in 0..samples {
        let around = sample.saturating_sub(reach)..(sample + reach + 1).min(samples);
        for i in 0..n {
            let sum: f64 = around.clone().map(|near| own[near * n + i]).sum();
            record.torques[sample * n + i] = sum / around.len() as f64;
        }
    }
}

/// Keeps torques at intervals of some seconds, and interpolates linearly in between.
pub(super) fn interpolate(record: &mut Record, seconds: f64) {
    let n = record.actuators.len();
    let step = ((seconds * record.sampling_hz).round() as usize).max(1);
    let samples = record.torques.len() / n;
    let own = record.torques.clone();
    for sample in 0..samples {
        let before = sample / step * step;
        let behind = (before + step).min(samples - 1);
        let part = (sample - before) as f64 / (behind - before).max(1) as f64;
        for i in 0..n {
            let [a, b] = [before, behind].map(|place| own[place * n + i]);
            record.torques[sample * n + i] = a + part * (b - a);
        }
    }
}

/// Drops a fraction of the samples, evenly scattered, without adapting the time.
pub(super) fn drop_samples(record: &mut Record, part: f64) {
    let n = record.actuators.len();
    let kept = |sample: usize| {
        // Low-discrepancy sequence: multiples of the golden ratio.
        let place = (sample as f64 * 0.618_033_988_749_895).fract();
        place >= part
    };
    for values in [&mut record.positions, &mut record.torques] {
        let rows = values.chunks_exact(n).enumerate();
        let rows = rows.filter(|(sample, _)| kept(*sample));
        *values = rows.flat_map(|(_, row)| row.iter().copied()).collect();
    }
    let samples = record.positions.len() / n;
    record.time.truncate(samples);
}

/// Delays the torque of one actuator by some seconds; it starts with its first value.
pub(super) fn late_drive(record: &mut Record, actuator: usize, seconds: f64) {
    let n = record.actuators.len();
    let shift = (seconds * record.sampling_hz).round() as usize;
    let own: Vec<f64> = record.torques[actuator..]
        .iter()
        .step_by(n)
        .copied()
        .collect();
    let places = record.torques[actuator..].iter_mut().step_by(n);
    for (sample, place) in places.enumerate() {
        *place = own[sample.saturating_sub(shift)];
    }
}

/// Changes the torque of an actuator as a function of the elapsed fraction of the run.
pub(super) fn torque_in_time(
    record: &mut Record,
    actuator: usize,
    change: impl Fn(f64, f64) -> f64,
) {
    let n = record.actuators.len();
    let samples = record.torques.len() / n;
    let own = record.torques[actuator..].iter_mut().step_by(n);
    for (sample, torque) in own.enumerate() {
        *torque = change(*torque, sample as f64 / samples as f64);
    }
}

/// Changes the torque of an actuator.
pub(super) fn torque(record: &mut Record, actuator: usize, change: impl Fn(f64) -> f64) {
    let n = record.actuators.len();
    let own = record.torques[actuator..].iter_mut().step_by(n);
    own.for_each(|torque| *torque = change(*torque));
}

/// Changes the position of an actuator.
pub(super) fn position(record: &mut Record, actuator: usize, change: impl Fn(f64) -> f64) {
    let n = record.actuators.len();
    let own = record.positions[actuator..].iter_mut().step_by(n);
    own.for_each(|q| *q = change(*q));
}

/// Saturates the torque of an actuator at a fraction of its peak.
pub(super) fn saturate(record: &mut Record, actuator: usize, part: f64) {
    let limit = part * peak(record, actuator);
    torque(record, actuator, |torque| torque.clamp(-limit, limit));
}

fn peak(record: &Record, actuator: usize) -> f64 {
    let n = record.actuators.len();
    let own = record.torques[actuator..].iter().step_by(n);
    own.fold(0.0, |peak, torque| peak.max(torque.abs()))
}

/// Adds backlash to an encoder: it moves only after the motor has crossed it.
pub(super) fn backlash(record: &mut Record, actuator: usize, width: f64) {
    let n = record.actuators.len();
    let mut seen = record.positions[actuator];
    for q in record.positions[actuator..].iter_mut().step_by(n) {
        seen = seen.clamp(*q - 0.5 * width, *q + 0.5 * width);
        *q = seen;
    }
}

/// Holds the first positions and torques, with noise of their last digits.
pub(super) fn stand_still(record: &mut Record) {
    let n = record.actuators.len();
    let step = 1e-5;
    for values in [&mut record.positions, &mut record.torques] {
        let held = values[..n].to_vec();
        for (k, row) in values.chunks_exact_mut(n).enumerate() {
            for (i, (value, held)) in row.iter_mut().zip(&held).enumerate() {
                let noise = (7.3 * (k * (i + 1)) as f64).sin();
                *value = held + if noise > 0.5 { step } else { 0.0 };
            }
        }
    }
}

/// Motion of an actuator at a sample.
pub(super) struct Moment {
    pub(super) position: f64,
    pub(super) velocity: f64,
    pub(super) time: f64,
}

/// Adds a motion-dependent torque, scaled to a fraction of the actuator's root mean square torque.
pub(super) fn add(
    records: &mut [Record],
    actuator: usize,
    shape: impl Fn(&Moment) -> f64,
    part: f64,
) {
    let added: Vec<Vec<f64>> = records
        .iter()
        .map(|record| shaped(record, actuator, &shape))
        .collect();
    let size = |values: &mut dyn Iterator<Item = f64>| -> f64 {
        let (sum, count) = values.fold((0.0, 0), |(sum, count), x| (sum + x * x, count + 1));
        (sum / f64::from(count)).sqrt()
    };
    let torques = records.iter().flat_map(|record| {
        let n = record.actuators.len();
        record.torques[actuator..].iter().step_by(n).copied()
    });
    let whole = size(&mut { torques });
    let scale = part * whole / size(&mut added.iter().flatten().copied());
    for (record, added) in records.iter_mut().zip(added) {
        let n = record.actuators.len();
        let own = record.torques[actuator..].iter_mut().step_by(n);
        own.zip(added)
            .for_each(|(torque, added)| *torque += scale * added);
    }
}

/// Shape at all samples of a record.
fn shaped(record: &Record, actuator: usize, shape: &impl Fn(&Moment) -> f64) -> Vec<f64> {
    let n = record.actuators.len();
    let own = record.positions[actuator..].iter().step_by(n);
    let positions: Vec<f64> = own.copied().collect();
    // Over a few milliseconds, so that the encoder resolution does not matter.
    let reach = ((2e-3 * record.sampling_hz) as usize).max(1);
    let last = positions.len() - 1;
    (0..positions.len())
        .map(|k| {
            let (before, behind) = (k.saturating_sub(reach), (k + reach).min(last));
            let span = (behind - before) as f64 / record.sampling_hz;
            shape(&Moment {
                position: positions[k],
                velocity: (positions[behind] - positions[before]) / span,
                time: k as f64 / record.sampling_hz,
            })
        })
        .collect()
}

/// Measures torques with a constant that falls by `part` at the peak.
///
/// The true torque is τ (1 - part |τ|/peak) for the measured τ.
pub(super) fn saturating_constant(record: &mut Record, actuator: usize, part: f64) {
    let curvature = part / peak(record, actuator).max(f64::MIN_POSITIVE);
    // The smaller root of τ - c τ² = true torque.
    torque(record, actuator, |own| {
        let root = (1.0 - 4.0 * curvature * own.abs()).max(0.0).sqrt();
        own.signum() * (1.0 - root) / (2.0 * curvature)
    });
}

/// Adds a fraction of the torque of the second actuator of each pair to that of the first.
pub(super) fn crosstalk(record: &mut Record, pairs: &[(usize, usize)], part: f64) {
    let n = record.actuators.len();
    for row in record.torques.chunks_exact_mut(n) {
        let own = row.to_vec();
        pairs
            .iter()
            .for_each(|(to, from)| row[*to] += part * own[*from]);
    }
}

/// Changes the torque of an actuator as a function of its position.
pub(super) fn torque_at_position(
    record: &mut Record,
    actuator: usize,
    change: impl Fn(f64, f64) -> f64,
) {
    let n = record.actuators.len();
    let positions = record.positions[actuator..].iter().step_by(n);
    let torques = record.torques[actuator..].iter_mut().step_by(n);
    torques
        .zip(positions)
        .for_each(|(torque, position)| *torque = change(*torque, *position));
}

/// Adds friction of a fraction of the magnitude of the torque.
pub(super) fn load_friction(record: &mut Record, actuator: usize, part: f64) {
    let n = record.actuators.len();
    let signs = shaped(record, actuator, &|at: &Moment| at.velocity.signum());
    let torques = record.torques[actuator..].iter_mut().step_by(n);
    torques
        .zip(signs)
        .for_each(|(torque, sign)| *torque += part * torque.abs() * sign);
}
