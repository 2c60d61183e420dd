//! Detection limits of the checks that passed: harmful faults that these data would not show.

use super::{
    check::Check,
    detectable::{Detectable, FaultKind},
};

/// Harmful faults below their detection limits, by kind.
///
/// The harm is the parameter shift at the smallest detectable size.
pub(crate) fn detection_limits(checks: &[Check]) -> Vec<&Detectable> {
    let passed = checks.iter().filter(|one| one.passed);
    let limits = passed.flat_map(|one| &one.detectable);
    let is_shown = |one: &&Detectable| {
        one.is_harmful() && (one.is_hidden_gain() || one.shift_deviations.is_finite())
    };
    let mut harmful: Vec<&Detectable> = limits.filter(is_shown).collect();
    harmful.sort_by_key(|one| FaultKind::ALL.iter().position(|kind| *kind == one.fault));
    harmful
}

/// Largest number of faults that a sentence names.
const NAMED: usize = 3;

/// The limits as sentences, one for each kind of faults, with the most harmful ones.
///
/// Of the torques that the model lacks, a sentence names one of each drive at most.
pub(crate) fn sentences(limits: &[&Detectable]) -> Vec<String> {
    let of_kind = limits.chunk_by(|a, b| a.fault == b.fault);
    of_kind.map(sentence).collect()
}

/// Sentence on faults of one kind.
fn sentence(limits: &[&Detectable]) -> String {
    let (hidden, visible): (Vec<&Detectable>, Vec<&Detectable>) =
        limits.iter().partition(|one| one.is_hidden_gain());
    let names: Vec<String> = hidden.iter().map(|one| format!("`{}`", one.name)).collect();
    let never = (!names.is_empty()).then(|| format!("not detectable for {}", names.join(", ")));
    let is_first = |(place, one): &(usize, &&Detectable)| {
        let before = &visible[..*place];
        one.fault != FaultKind::MissingTorque || before.iter().all(|other| other.name != one.name)
    };
    let first = visible.iter().enumerate().filter(is_first);
    let mut named: Vec<&Detectable> = first.map(|(_, one)| *one).collect();
    named.sort_by(|a, b| b.shift_deviations.total_cmp(&a.shift_deviations));
    named.truncate(NAMED);
    let count = visible.len() - named.len();
    let named = named.into_iter().map(Detectable::words);
    let more = (count > 0).then(|| format!("and {count} more"));
    let each: Vec<String> = never.into_iter().chain(named).chain(more).collect();
    let kind = limits.first().map_or("", |one| one.fault.words());
    format!("{kind}: {}", each.join(", "))
}

#[cfg(test)]
mod tests {
    use super::{detection_limits, sentences};
    use crate::assessment::{
        check::{About, Check, CheckKind},
        detectable::{Detectable, DetectableShift, HARMFUL},
        hypotheses::{FaultHypothesis, Shape},
    };

    /// The limit of a fault at `name`, of this size and unit, and the shift that it causes.
    fn limit(
        hypothesis: FaultHypothesis,
        name: &str,
        size: (f64, &'static str),
        shift_deviations: f64,
    ) -> Detectable {
        Detectable {
            name: name.to_owned(),
            deviation: size.0 / 5.0,
            parameter: String::from("zz_1"),
            shift_deviations,
            ..Detectable::new(hypothesis, size.1, size.0)
        }
    }

    fn unseen(checks: &[Check]) -> Vec<String> {
        sentences(&detection_limits(checks))
    }

    fn check(kind: CheckKind, limits: Vec<Detectable>) -> Check {
        Check::new(kind, About::Model, "nothing").detecting(limits)
    }

    #[test]
    fn all_harmful_faults_of_each_class_are_reported_with_their_units() {
        let all = vec![
            limit(FaultHypothesis::Clock, "", (2.5, ""), 500.0),
            limit(FaultHypothesis::Gain(0), "left", (0.03, ""), 7.0),
            limit(FaultHypothesis::Gain(1), "right", (0.1, ""), 86.0),
            limit(FaultHypothesis::Delay, "", (2.8e-4, "s"), 5.0),
            limit(FaultHypothesis::DriveDelay(1), "right", (3e-3, "s"), 12.0),
            limit(FaultHypothesis::Smoothing, "", (6e-6, "s²"), 8.0),
            limit(FaultHypothesis::Offset(0), "left", (0.0091, "rad"), 13.0),
            limit(FaultHypothesis::Scales, "", (0.001, ""), 16.0),
            limit(FaultHypothesis::Gear(0), "left", (0.02, ""), 7.6),
            limit(
                FaultHypothesis::Torque(0, Shape::Position),
                "left",
                (0.3, "N m/rad"),
                4.0,
            ),
        ];
        let expected = [
            "zero of an encoder: 0.0091 rad of `left` (`zz_1` by 13 σ)",
            "scale of an encoder: 0.1 % of all drives (`zz_1` by 16 σ)",
            "ratio of a gear, with positions and torques of its drive: 2 % of `left` (`zz_1` by 8 σ)",
            "gain of one drive: 10 % of `right` (`zz_1` by 86 σ), 3 % of `left` (`zz_1` by 7 σ)",
            "delay of all torques: 0.28 ms (`zz_1` by 5 σ)",
            "delay of the torque of one drive: 3 ms of `right` (`zz_1` by 12 σ)",
            "smoothing of the torques: a mean over 12 ms (`zz_1` by 8 σ)",
            "sampling frequency: 100 % (`zz_1` by 200 σ)",
            "torque or force that the model lacks: 0.3 N m/rad at `left` with the position, as a spring (`zz_1` by 4 σ)",
        ];
        assert_eq!(unseen(&[check(CheckKind::Delay, all)]), expected);
    }

    #[test]
    fn all_parameters_that_an_undetected_fault_shifts_are_named() {
        let shift = |(name, deviations): (&str, f64)| DetectableShift {
            parameter: name.to_owned(),
            deviations,
        };
        let shifts = [
            ("zz_1", 7.6),
            ("mx_2", 5.0),
            ("mx_2", 4.0),
            ("fs_1", 3.1),
            ("fv_1", 2.9),
        ];
        let gear = Detectable {
            name: String::from("left"),
            ..Detectable::new(FaultHypothesis::Gear(0), "", 0.02)
        };
        let gear = gear.shifting(shifts.into_iter().map(shift));
        let all: Vec<&str> = gear.parameters().collect();
        assert_eq!(all, ["zz_1", "mx_2", "fs_1"]);
        assert_eq!(
            gear.shift_words(),
            "`zz_1` by 8 σ, `mx_2` by 5 σ, `fs_1` by 3 σ"
        );
        assert_eq!(
            unseen(&[check(CheckKind::EncoderOffset, vec![gear])]),
            [
                "ratio of a gear, with positions and torques of its drive: 2 % of `left` (`zz_1` by 8 σ, and 2 more)"
            ]
        );
    }

    #[test]
    fn the_most_harmful_faults_are_named_and_the_others_counted() {
        let gain = |number: usize| {
            let name = format!("drive{number}");
            limit(
                FaultHypothesis::Gain(number),
                &name,
                (0.1, ""),
                4.0 + number as f64,
            )
        };
        let checks = [check(CheckKind::WrongGain, (0..5).map(gain).collect())];
        assert_eq!(detection_limits(&checks).len(), 5);
        assert_eq!(
            unseen(&checks),
            [
                "gain of one drive: 10 % of `drive4` (`zz_1` by 8 σ), 10 % of `drive3` (`zz_1` by 7 σ), 10 % of `drive2` (`zz_1` by 6 σ), and 2 more"
            ]
        );
    }

    #[test]
    fn one_missing_torque_of_each_drive_is_named() {
        let torques = [
            ("left", Shape::Position),
            ("left", Shape::Drag),
            ("right", Shape::Drag),
        ];
        let torques = torques
            .map(|(name, shape)| limit(FaultHypothesis::Torque(0, shape), name, (0.3, "N m"), 4.0));
        let checks = [check(CheckKind::MissingParameter, torques.into())];
        assert_eq!(detection_limits(&checks).len(), 3);
        assert_eq!(
            unseen(&checks),
            [
                "torque or force that the model lacks: 0.3 N m at `left` with the position, as a spring (`zz_1` by 4 σ), 0.3 N m at `right` with the square of the velocity, as drag (`zz_1` by 4 σ), and 1 more"
            ]
        );
    }

    #[test]
    fn drives_with_undetectable_gain_are_listed_first() {
        let gains = vec![
            limit(FaultHypothesis::Gain(0), "left", (0.03, ""), 7.0),
            Detectable::undetectable_gain(1, "right"),
        ];
        assert_eq!(
            unseen(&[check(CheckKind::WrongGain, gains)]),
            ["gain of one drive: not detectable for `right`, 3 % of `left` (`zz_1` by 7 σ)"]
        );
    }

    #[test]
    fn harmless_or_detected_faults_are_not_listed_as_undetectable() {
        let harmless = limit(FaultHypothesis::Gain(0), "left", (0.1, ""), HARMFUL);
        let harmless = check(CheckKind::WrongGain, vec![harmless]);
        let delay = limit(FaultHypothesis::Delay, "", (1e-3, "s"), 50.0);
        let found = Check {
            passed: false,
            ..check(CheckKind::Delay, vec![delay])
        };
        let endless = limit(FaultHypothesis::Length(0), "d", (1e-3, "m"), f64::INFINITY);
        let endless = check(CheckKind::Length, vec![endless]);
        assert!(unseen(&[harmless, found, endless]).is_empty());
    }
}
