//! Assumptions that the data of a run cannot test, and detection limits of the checks.

use overact::Model;

use super::{
    check::{Check, Detectable},
    checks::{
        HARMFUL,
        torques::smoothing::{OF_MEAN, UNIT},
    },
    hypotheses::FaultHypothesis,
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
    if friction.any(|column| column.symbol.is_friction()) {
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

/// Relative sizes above 100 % are reported as 100 %.
const WHOLE: f64 = 1.0;

/// Faults that one sentence of the detection limits is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum FaultClass {
    EncoderOffset,
    EncoderScale,
    GearRatio,
    Length,
    Gain,
    Delay,
    DriveDelay,
    Smoothing,
    CommonFilter,
    Clock,
    Crosstalk,
    MissingTorque,
}

impl FaultClass {
    /// All classes, in the order of their sentences.
    const ALL: [Self; 12] = [
        Self::EncoderOffset,
        Self::EncoderScale,
        Self::GearRatio,
        Self::Length,
        Self::Gain,
        Self::Delay,
        Self::DriveDelay,
        Self::Smoothing,
        Self::CommonFilter,
        Self::Clock,
        Self::Crosstalk,
        Self::MissingTorque,
    ];

    const fn of(hypothesis: FaultHypothesis) -> Option<Self> {
        Some(match hypothesis {
            FaultHypothesis::Offset(_) => Self::EncoderOffset,
            FaultHypothesis::Scale(_) | FaultHypothesis::Scales => Self::EncoderScale,
            FaultHypothesis::Gear(_) => Self::GearRatio,
            FaultHypothesis::Length(_) => Self::Length,
            FaultHypothesis::Gain(_) => Self::Gain,
            FaultHypothesis::Delay => Self::Delay,
            FaultHypothesis::DriveDelay(_) => Self::DriveDelay,
            FaultHypothesis::Smoothing | FaultHypothesis::SmoothingWithFriction => Self::Smoothing,
            FaultHypothesis::CommonFilter => Self::CommonFilter,
            FaultHypothesis::Clock => Self::Clock,
            FaultHypothesis::Torque(..)
            | FaultHypothesis::Force(..)
            | FaultHypothesis::PotentialTerm(_) => Self::MissingTorque,
            FaultHypothesis::Crosstalk { .. } => Self::Crosstalk,
            _ => return None,
        })
    }

    const fn name(self) -> &'static str {
        match self {
            Self::EncoderOffset => "zero of an encoder",
            Self::EncoderScale => "scale of an encoder",
            Self::GearRatio => "ratio of a gear, with positions and torques of its drive",
            Self::Length => "length",
            Self::Gain => "gain of one drive",
            Self::Delay => "delay of all torques",
            Self::DriveDelay => "delay of the torque of one drive",
            Self::Smoothing => "smoothing of the torques",
            Self::CommonFilter => "equal smoothing of all signals",
            Self::Clock => "sampling frequency",
            Self::Crosstalk => "part of a neighbour's torque in the torque of one drive",
            Self::MissingTorque => "torque or force that the model lacks",
        }
    }
}

/// Detection limits: one sentence for each class of faults that passed its check, with all harmful
/// faults of the class.
///
/// The harm is the parameter shift at the smallest detectable size.
pub(crate) fn unseen(checks: &[Check]) -> Vec<String> {
    let passed = checks.iter().filter(|one| one.passed);
    let limits: Vec<&Detectable> = passed.flat_map(|one| &one.detectable).collect();
    let sentence = |class: &FaultClass| {
        let own = limits
            .iter()
            .filter(|one| FaultClass::of(one.fault) == Some(*class));
        let harmful = own.copied().filter(|one| one.shift_deviations > HARMFUL);
        let is_hidden = |one: &&Detectable| *class == FaultClass::Gain && one.size >= WHOLE;
        let (hidden, visible): (Vec<_>, Vec<_>) = harmful.partition(is_hidden);
        let names: Vec<String> = hidden.iter().map(|one| format!("`{}`", one.name)).collect();
        let never = (!names.is_empty()).then(|| format!("not detectable for {}", names.join(", ")));
        let visible = visible
            .into_iter()
            .filter(|one| one.shift_deviations.is_finite());
        let each: Vec<String> = never.into_iter().chain(visible.map(limit)).collect();
        (!each.is_empty()).then(|| format!("{}: {}", class.name(), each.join(", ")))
    };
    FaultClass::ALL.iter().filter_map(sentence).collect()
}

/// Detection limit of one fault with its harm, as in ``2 % of `left` (`zz_1` by 8 σ)``.
fn limit(one: &Detectable) -> String {
    let of = match (one.name.as_str(), one.fault) {
        (_, FaultHypothesis::PotentialTerm(_)) => {
            String::from(" of a potential, as of a constant force on a body")
        }
        (_, FaultHypothesis::Scales) => String::from(" of all drives"),
        ("", _) => String::new(),
        (name, FaultHypothesis::Crosstalk { .. }) => format!(" in `{name}`"),
        (name, fault) => match fault.shape() {
            Some(shape) => format!(" at `{name}` with {}", shape.words()),
            None => format!(" of `{name}`"),
        },
    };
    // A relative size above 100 % has no meaning.
    let most = if one.unit.is_empty() {
        WHOLE
    } else {
        f64::INFINITY
    };
    let shift_deviations = one.shift_deviations * (most / one.size).min(1.0);
    let size = match one.unit {
        "" => format!("{} %", significant(100.0 * one.size.min(most), 2)),
        "s" => format!("{} ms", significant(1e3 * one.size, 2)),
        UNIT => format!(
            "a mean over {} ms",
            significant(1e3 * (OF_MEAN * one.size).sqrt(), 2)
        ),
        unit => format!("{} {unit}", significant(one.size, 2)),
    };
    let others: Vec<String> = one
        .others
        .iter()
        .map(|other| format!("`{}`", other.parameter))
        .collect();
    let also = if others.is_empty() {
        String::new()
    } else {
        format!("; also {}", others.join(", "))
    };
    format!(
        "{size}{of} (`{}` by {shift_deviations:.0} σ{also})",
        one.parameter
    )
}

#[cfg(test)]
mod tests {
    use super::{HARMFUL, unseen};
    use crate::assessment::{
        check::{About, Check, CheckKind, Detectable, DetectableShift},
        hypotheses::{FaultHypothesis, Shape},
    };

    /// The limit of a fault at `name`, of this size and unit, and the shift that it causes.
    fn limit(
        fault: FaultHypothesis,
        name: &str,
        size: (f64, &'static str),
        shift_deviations: f64,
    ) -> Detectable {
        Detectable {
            name: name.to_owned(),
            unit: size.1,
            fault,
            deviation: size.0 / 5.0,
            size: size.0,
            parameter: String::from("zz_1"),
            shift_deviations,
            others: Vec::new(),
        }
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
            "gain of one drive: 3 % of `left` (`zz_1` by 7 σ), 10 % of `right` (`zz_1` by 86 σ)",
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
        let others = ["mx_2", "fs_1"].map(|name| DetectableShift {
            parameter: name.to_owned(),
            deviations: 4.0,
        });
        let gear = Detectable {
            others: others.into(),
            ..limit(FaultHypothesis::Gear(0), "left", (0.02, ""), 7.6)
        };
        assert_eq!(
            unseen(&[check(CheckKind::EncoderOffset, vec![gear])]),
            [
                "ratio of a gear, with positions and torques of its drive: 2 % of `left` (`zz_1` by 8 σ; also `mx_2`, `fs_1`)"
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
