//! Flat peaks of noisy torques: a drive that saturates before its torque is measured.
//!
//! Consider the band of one hundredth of the range below the extreme. A smooth peak of duration T
//! is a parabola, which falls by three further bands within T/2 on either side. A clipped peak
//! falls with the slope of its approach.

use super::{clipping::clipping, suspicion::Suspicion};
use crate::significant;

/// Width of the band, by the range.
const BAND: f64 = 0.01;

/// Bands by which a clipped peak falls within half its duration.
const FALL: f64 = 10.0;

/// Fewest samples of a flat peak.
const FEWEST: usize = 8;

/// Fraction of the run in flat peaks.
const PART: f64 = 0.02;

/// Finds flat peaks in torques at a moderate rate, rows of one value per actuator.
pub(crate) fn suspicions(names: &[&str], torques: &[f64]) -> Vec<Suspicion> {
    let n = names.len().max(1);
    let column = |actuator: usize| -> Vec<f64> {
        torques.iter().skip(actuator).step_by(n).copied().collect()
    };
    let suspicion = |(actuator, name): (usize, &&str)| {
        let own = column(actuator);
        let mirrored: Vec<f64> = own.iter().map(|torque| -torque).collect();
        let (high, low) = (flat_part(&own), flat_part(&mirrored));
        if high + low < PART {
            return None;
        }
        let extreme = |values: &[f64]| values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let ends = [(low, -extreme(&mirrored)), (high, extreme(&own))];
        let levels = ends.iter().filter(|(part, _)| *part > 0.0);
        let levels: Vec<String> = levels
            .map(|(_, level)| format!("about {}", significant(*level, 3)))
            .collect();
        Some(clipping(name, high + low, PART, &levels))
    };
    names.iter().enumerate().filter_map(suspicion).collect()
}

/// Fraction of a signal in flat peaks at its maximum.
fn flat_part(signal: &[f64]) -> f64 {
    let (low, high) = signal
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &x| {
            (l.min(x), h.max(x))
        });
    let band = BAND * (high - low);
    if band.is_nan() || band <= 0.0 {
        return 0.0;
    }
    let is_high = |index: usize| signal[index] >= high - band;
    let mut flat = 0;
    let mut index = 0;
    while index < signal.len() {
        if !is_high(index) {
            index += 1;
            continue;
        }
        let end = (index..signal.len())
            .find(|&k| !is_high(k))
            .unwrap_or(signal.len());
        let duration = end - index;
        let reach = duration.div_ceil(2);
        // Peaks at the ends of the run are incomplete.
        let falls = |place: Option<usize>| {
            place
                .and_then(|place| signal.get(place))
                .is_some_and(|x| *x < high - FALL * band)
        };
        if duration >= FEWEST && falls(index.checked_sub(reach)) && falls(Some(end - 1 + reach)) {
            flat += duration;
        }
        index = end;
    }
    flat as f64 / signal.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::flat_part;

    #[test]
    fn only_clipped_peaks_are_flat() {
        let signal = |limit: f64, noise: f64| -> Vec<f64> {
            (0..1000)
                .map(|k| {
                    let t = k as f64 * 0.02;
                    let wiggle = noise * (37.0 * t).sin();
                    (t.sin() + 0.4 * (2.3 * t).cos()).min(limit) + wiggle
                })
                .collect()
        };
        for noise in [0.0, 0.003] {
            assert_eq!(flat_part(&signal(f64::INFINITY, noise)), 0.0);
            assert!(flat_part(&signal(0.8, noise)) > 0.1);
        }
        assert_eq!(flat_part(&[1.0; 50]), 0.0);
        assert_eq!(flat_part(&[]), 0.0);
    }
}
