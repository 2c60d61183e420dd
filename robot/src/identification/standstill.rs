//! Leaves out long standstills of runs.
//!
//! While all joints stand still, dry friction is not determined by the motion, so these equations
//! have large residuals. A log mostly begins and ends with a standstill. Runs in which the robot
//! rests at many places are logs of static postures, which keep all samples.

use crate::error::Error;
use overact_identification::{Log, Settings};
use overact_logs::significant;
use std::ops::Range;

/// Most standstills between motions; runs with more are logs of static postures.
const MOST_RESTS: usize = 2;

/// Smallest fraction of a run that is motion; other runs are logs of static postures.
const LEAST_MOTION: f64 = 0.2;

/// Parts of each run without long standstills of all joints, each with a note on them.
///
/// With `standstill_velocity` of the settings, runs stay whole.
///
/// # Errors
/// A log cannot be read any more.
pub(crate) fn without_standstills(
    runs: &[Log],
    settings: &Settings,
) -> Result<Vec<Vec<Log>>, Error> {
    let parts = |run: &Log| {
        if settings.standstill_velocity.is_empty() {
            moving(run, settings)
        } else {
            Ok(vec![run.clone()])
        }
    };
    runs.iter().map(parts).collect()
}

/// Parts of a run without long standstills.
fn moving(run: &Log, settings: &Settings) -> Result<Vec<Log>, Error> {
    let rests = run.long_standstills()?;
    let parts = motions(&rests, run.samples(), settings);
    let used: usize = parts.iter().map(Range::len).sum();
    let stays = rests.is_empty() || parts.is_empty() || used == run.samples();
    if stays || is_static(&rests, run.samples()) {
        return Ok(vec![run.clone()]);
    }
    let left_out = run.samples() - used;
    let note = format!(
        "all joints stand still for long: {} s ({} % of the run) are left out; `standstill_velocity` of [identification] sets another limit",
        significant(left_out as f64 / run.sampling_frequency(), 3),
        significant(100.0 * left_out as f64 / run.samples() as f64, 2),
    );
    let is_named = parts.len() > 1;
    let parts = parts.iter().enumerate().map(|(number, range)| {
        let part = run.part(range, is_named);
        if number == 0 {
            part.with_more_notes(&note)
        } else {
            part.without_note()
        }
    });
    Ok(parts.collect())
}

/// Whether a run has static postures, whose equations have the gravity torques.
fn is_static(rests: &[Range<usize>], samples: usize) -> bool {
    let between = rests
        .iter()
        .filter(|own| own.start > 0 && own.end < samples);
    let still: usize = rests.iter().map(Range::len).sum();
    let motion = samples.saturating_sub(still) as f64;
    between.count() > MOST_RESTS || motion < LEAST_MOTION * samples as f64
}

/// Samples between long standstills, with those that are skipped at both ends of a run.
///
/// Parts that are too short for the filters are left out.
fn motions(rests: &[Range<usize>], samples: usize, settings: &Settings) -> Vec<Range<usize>> {
    let mut parts = Vec::new();
    let mut start = 0;
    for rest in rests {
        let end = (rest.start + settings.skip_end).min(samples);
        let next = rest.end.saturating_sub(settings.skip_start);
        // A standstill without samples beyond those that are skipped stays.
        if rest.start == 0 {
            start = next;
        } else if rest.end == samples || next > end {
            parts.push(start..end);
            start = next.max(end);
        }
    }
    if rests.last().is_none_or(|rest| rest.end < samples) {
        parts.push(start..samples);
    }
    parts.retain(|part| part.len() >= settings.samples_needed());
    parts
}

#[cfg(test)]
mod tests {
    use super::{is_static, motions};
    use crate::robot::Robot;
    use overact_identification::Settings;

    #[test]
    #[expect(clippy::single_range_in_vec_init, reason = "one standstill")]
    fn samples_of_standstills_are_skipped() {
        let text = include_str!("../../../robots/emps.toml");
        let robot = Robot::from_text("emps.toml", text).expect("a robot");
        let settings = Settings {
            skip_start: 30,
            skip_end: 20,
            ..robot.settings(1000.0)
        };
        let needed = settings.samples_needed();
        let parts = |rests: &[std::ops::Range<usize>]| motions(rests, 10_000, &settings);
        assert_eq!(parts(&[]), [0..10_000]);
        assert_eq!(parts(&[0..500, 9000..10_000]), [470..9020]);
        assert_eq!(parts(&[4000..5000]), [0..4020, 4970..10_000]);
        // Nothing is left between the skipped samples.
        assert_eq!(parts(&[4000..4040]), [0..10_000]);
        assert_eq!(parts(&[0..20]), [0..10_000]);
        assert!(needed < 1000);
        // A part that is too short for the filters is left out.
        assert!(needed > 50);
        assert_eq!(parts(&[0..9990]), []);
    }

    #[test]
    fn runs_with_many_standstills_are_static() {
        let rests = |count: usize| -> Vec<std::ops::Range<usize>> {
            (0..count).map(|k| 1000 * k + 100..1000 * k + 500).collect()
        };
        assert!(!is_static(&rests(2), 10_000));
        assert!(is_static(&rests(3), 10_000));
        assert!(is_static(&[0..4500, 5500..10_000], 10_000));
        assert!(!is_static(&[0..2000, 8000..10_000], 10_000));
    }
}
