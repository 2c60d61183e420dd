//! Assumptions that the data of a run cannot test, and detection limits of the checks.

use overact::Model;

use super::{
    check::{Check, CheckKind},
    checks::{
        HARMFUL,
        torques::smoothing::{OF_MEAN, UNIT},
    },
};
use crate::{
    kinematics::conditioning::couples,
    prior::Prior,
    regression::{columns::ColumnSet, projection::ModelKind},
    settings::CheckScope,
};
use overact_logs::significant;

/// Quantities estimated before the parameters, which are therefore no assumptions.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct PreviouslyIdentified {
    /// Whether the gains of the drives were estimated.
    pub gains: bool,
    /// Whether the direction of gravity was estimated.
    pub gravity: bool,
}

/// Assumptions that these runs cannot test, one sentence each.
///
/// Violated assumptions have the same effect on the data as other parameter values. `sessions` is
/// the number of recording sessions of the runs.
pub(crate) fn assumptions(
    model: &dyn Model,
    columns: &ColumnSet,
    models: &[ModelKind],
    before: PreviouslyIdentified,
    sessions: usize,
    prior: &Prior,
) -> Vec<String> {
    let gains = if before.gains {
        "known parameters are exact: gains and all other parameters scale with them"
    } else {
        "the common scale of all torques is right: if all torques are wrong by one factor, so are all parameters"
    };
    let mut all = vec![
        String::from(gains),
        String::from(
            "the clock is right: if all times are wrong by one factor, masses and inertias are wrong by its square and viscous friction by the factor; only gravity reveals it",
        ),
        String::from(
            "time is in seconds, positions are in rad and m after `position_scale`, torques in N m and N after `torque_gain`: the motion reveals a unit of time or positions that is wrong by a factor of thirty or more; a wrong unit of all torques is certain to be found only with `torque_limit`, `[prior.values]` or a known mass",
        ),
        String::from("the common scale of all lengths is right: angles do not determine it"),
        String::from(
            "the logged torques are the complete torques of the drives: no friction or gravity compensation was subtracted, no filter of the drive smoothed them, and there is no crosstalk",
        ),
        String::from("parameters that the description leaves out are zero"),
        String::from(match sessions {
            0 | 1 => {
                "the robot is rigid and does not change: temperature, wear and load are those of the runs; intervals do not contain changes between recording days (with runs of several days: `--sessions`)"
            }
            _ => {
                "the robot is rigid, and the recording sessions show how much it changes: intervals contain the variation between them"
            }
        }),
    ];
    if !prior.held.is_empty() {
        let names: Vec<&str> = prior.held.keys().map(String::as_str).collect();
        all.push(format!(
            "{} parameters are held at their prior values ({}): their errors are part of the residual and of all estimates, but of no interval",
            names.len(),
            shortened(&names)
        ));
    }
    if lengths_are_untold(model) {
        all.push(String::from(
            "each length of the loops is right: with as many drives as degrees of freedom the closures do not test them",
        ));
    }
    if !before.gravity {
        all.push(String::from(
            "gravity points as described: the orientation of the base is not tested",
        ));
    }
    let mut friction = columns.as_slice().iter();
    if friction.any(|column| column.symbol.follows_rate()) {
        all.push(String::from(
            "friction is viscous and Coulomb friction as in the model at all speeds, also at those that the runs do not reach",
        ));
    }
    if models.contains(&ModelKind::Platform) && model.info().sizes.actuators > 1 {
        all.push(String::from(
            "internal torques, which act against each other without moving the platform (preload), are not part of the model",
        ));
    }
    all
}

/// Names of at most six parameters; the rest is counted.
fn shortened(names: &[&str]) -> String {
    const MOST: usize = 6;
    match names.len().checked_sub(MOST) {
        None | Some(0) => names.join(", "),
        Some(more) => format!("{} and {more} more", names[..MOST].join(", ")),
    }
}

/// What basic checks leave untested, as an assumption.
pub(crate) fn not_tested(checks: CheckScope) -> Vec<String> {
    match checks {
        CheckScope::All => Vec::new(),
        CheckScope::Basic => vec![String::from(
            "there are no faults that only the complete checks find, such as a wrong gain of one drive, a delay, an encoder offset, missing physics or position noise: identify once with `--checks all`",
        )],
    }
}

/// Whether no closure constrains the loop lengths: a closed chain with n = r.
fn lengths_are_untold(model: &dyn Model) -> bool {
    let sizes = model.info().sizes;
    sizes.actuators == sizes.dof && couples(model)
}

/// The assumptions that are violated most often, as sentences for the verdict.
///
/// With basic checks, these are also that the other checks would pass.
pub(crate) fn rests_on(
    model: &dyn Model,
    before: PreviouslyIdentified,
    checks: CheckScope,
) -> Option<String> {
    let what = match (lengths_are_untold(model), before.gains) {
        (true, false) => Some("lengths, units and torque constants"),
        (false, false) => Some("units and torque constants"),
        (true, true) => Some("lengths"),
        (false, true) => None,
    };
    let untestable = what.map(|what| format!("Assumption that these data cannot test: {what}."));
    let left_out = match checks {
        CheckScope::All => None,
        CheckScope::Basic => Some(String::from(
            "Only the basic checks were run: faults that `--checks all` finds may be present.",
        )),
    };
    let all: Vec<String> = left_out.into_iter().chain(untestable).collect();
    (!all.is_empty()).then(|| all.join(" "))
}

/// A fault whose detection limit is reported.
///
/// `check` looks for the fault. `is_part` says that its size is relative, with 1 as 100 %.
struct DetectableFault {
    check: CheckKind,
    is_part: bool,
    name: &'static str,
}

/// Constructs a kind of faults.
const fn kind(check: CheckKind, is_part: bool, name: &'static str) -> DetectableFault {
    DetectableFault {
        check,
        is_part,
        name,
    }
}

/// All kinds of faults whose detection limits are reported.
const KINDS: [DetectableFault; 8] = [
    kind(CheckKind::EncoderOffset, false, "zero of an encoder"),
    kind(
        CheckKind::EncoderOffset,
        true,
        "scale of an encoder or ratio of a gear",
    ),
    kind(CheckKind::Length, false, "length"),
    kind(CheckKind::WrongGain, true, "gain of one drive"),
    kind(CheckKind::Delay, false, "delay of the torques"),
    kind(CheckKind::Filters, false, "smoothing of the torques"),
    kind(
        CheckKind::Reversals,
        false,
        "equal smoothing of all signals",
    ),
    kind(CheckKind::Clock, true, "sampling frequency"),
];

/// Relative sizes above 100 % are reported as 100 %.
const WHOLE: f64 = 1.0;

/// Detection limits: for each kind of fault the most harmful one that passes its check.
///
/// The harm is the parameter shift at the smallest detectable size.
pub(crate) fn unseen(checks: &[Check]) -> Vec<String> {
    let worst_of = |kind: &DetectableFault| {
        let own = checks.iter().filter(|one| one.passed);
        // One check tests offsets and lengths; it is filed under the kind that it found.
        let geometry = [CheckKind::EncoderOffset, CheckKind::Length];
        let own = own.filter(|one| {
            one.kind == kind.check || geometry.contains(&one.kind) && geometry.contains(&kind.check)
        });
        let all = own.flat_map(|one| &one.detectable);
        let is_length = kind.check == CheckKind::Length;
        let all =
            all.filter(|one| one.unit.is_empty() == kind.is_part && one.is_length == is_length);
        let harmful =
            all.filter(|one| one.shift_deviations > HARMFUL && one.shift_deviations.is_finite());
        harmful.max_by(|a, b| a.shift_deviations.total_cmp(&b.shift_deviations))
    };
    let sentences = KINDS.iter().filter_map(|kind| {
        if let Some(never) = never(checks, kind) {
            return Some(never);
        }
        let worst = worst_of(kind)?;
        let of = match (worst.name.as_str(), kind.check) {
            ("", CheckKind::EncoderOffset) => String::from(" of all drives"),
            ("", _) => String::new(),
            (name, _) => format!(" of `{name}`"),
        };
        // A relative size above 100 % has no meaning.
        let most = if kind.is_part { WHOLE } else { f64::INFINITY };
        let shift_deviations = worst.shift_deviations * (most / worst.size).min(1.0);
        let size = match worst.unit {
            "" => format!("{} %", significant(100.0 * worst.size.min(most), 2)),
            "s" => format!("{} ms", significant(1e3 * worst.size, 2)),
            UNIT => format!(
                "a mean over {} ms",
                significant(1e3 * (OF_MEAN * worst.size).sqrt(), 2)
            ),
            unit => format!("{} {unit}", significant(worst.size, 2)),
        };
        Some(format!(
            "{}: {size}{of} would shift `{}` by {:.0} σ",
            kind.name, worst.parameter, shift_deviations
        ))
    });
    sentences.collect()
}

/// Names the drives whose gain error these data cannot detect, or only beyond 100 %.
fn never(checks: &[Check], kind: &DetectableFault) -> Option<String> {
    let own = checks
        .iter()
        .filter(|one| one.kind == kind.check && one.passed);
    let hidden = own
        .filter(|one| one.kind == CheckKind::WrongGain)
        .flat_map(|one| &one.detectable)
        .filter(|one| one.size >= WHOLE && one.shift_deviations > HARMFUL);
    let names: Vec<String> = hidden.map(|one| format!("`{}`", one.name)).collect();
    (!names.is_empty()).then(|| format!("{}: not detectable for {}", kind.name, names.join(", ")))
}

#[cfg(test)]
mod tests {
    use super::{HARMFUL, unseen};
    use crate::assessment::check::{About, Check, CheckKind, Detectable};

    fn check(kind: CheckKind, faults: &[(&str, &'static str, f64, f64)]) -> Check {
        let fault =
            |&(name, unit, size, shift_deviations): &(&str, &'static str, f64, f64)| Detectable {
                name: name.to_owned(),
                unit,
                deviation: size / 5.0,
                size,
                parameter: String::from("zz_1"),
                shift_deviations,
                is_length: false,
            };
        let all = faults.iter().map(fault).collect();
        Check::new(kind, About::Model, "nothing").detecting(all)
    }

    #[test]
    fn the_worst_of_each_kind_is_reported_with_its_unit() {
        let gains = [("left", "", 0.03, 7.0), ("right", "", 0.1, 86.0)];
        let sentences = unseen(&[
            check(CheckKind::Clock, &[("", "", 2.5, 500.0)]),
            check(CheckKind::WrongGain, &gains),
            check(CheckKind::Delay, &[("", "s", 2.8e-4, 5.0)]),
            check(CheckKind::Filters, &[("", "s²", 6e-6, 8.0)]),
            check(
                CheckKind::EncoderOffset,
                &[("left", "rad", 0.0091, 13.0), ("", "", 0.001, 16.0)],
            ),
        ]);
        let expected = [
            "zero of an encoder: 0.0091 rad of `left` would shift `zz_1` by 13 σ",
            "scale of an encoder or ratio of a gear: 0.1 % of all drives would shift `zz_1` by 16 σ",
            "gain of one drive: 10 % of `right` would shift `zz_1` by 86 σ",
            "delay of the torques: 0.28 ms would shift `zz_1` by 5 σ",
            "smoothing of the torques: a mean over 12 ms would shift `zz_1` by 8 σ",
            "sampling frequency: 100 % would shift `zz_1` by 200 σ",
        ];
        assert_eq!(sentences, expected);
    }

    #[test]
    fn a_drive_whose_gain_nothing_tells_is_named_before_all_others() {
        let mut gains = check(CheckKind::WrongGain, &[("left", "", 0.03, 7.0)]);
        gains.detectable.push(Detectable::never("right"));
        assert_eq!(
            unseen(&[gains]),
            ["gain of one drive: not detectable for `right`"]
        );
    }

    #[test]
    fn what_is_harmless_or_was_found_is_not_told() {
        let harmless = check(CheckKind::WrongGain, &[("left", "", 0.1, HARMFUL)]);
        let found = Check {
            passed: false,
            ..check(CheckKind::Delay, &[("", "s", 1e-3, 50.0)])
        };
        let endless = check(CheckKind::Length, &[("d", "m", 1e-3, f64::INFINITY)]);
        assert!(unseen(&[harmless, found, endless]).is_empty());
    }
}
