//! What every result rests on, since no data can show it.

use overact::Model;

use super::{
    check::{Check, CheckKind},
    checks::HARMFUL,
};
use crate::{
    regression::{columns::ColumnSet, projection::ModelKind},
    significant,
};

/// What was identified before everything else, so that it is no assumption.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Found {
    /// Gains of the drives.
    pub gains: bool,
    /// The direction of gravity.
    pub gravity: bool,
}

/// What no data of these runs can show to be wrong: faults whose effect on the data is that of other
/// parameters.
pub(crate) fn assumptions(
    model: &dyn Model,
    columns: &ColumnSet,
    models: &[ModelKind],
    before: Found,
) -> Vec<String> {
    let gains = match before.gains {
        true => {
            "the parameters that are stated as known are exact: gains and all other parameters are in proportion to them"
        }
        false => {
            "the gains of the drives are right as a whole: if all torques are wrong by one factor, so are all parameters, and nothing in the data tells"
        }
    };
    let mut all = vec![
        String::from(gains),
        String::from(
            "the clock is right: if all times are wrong by one factor, masses and inertias are wrong by its square and viscous friction by the factor, and only gravity tells",
        ),
        String::from(
            "the lengths of the description are right as a whole: angles alone fix no scale",
        ),
        String::from(
            "the torques of the logs are the whole torques of the drives: nothing was subtracted, as a friction or gravity compensation, and no filter of the drive smoothed them",
        ),
        String::from("parameters that the description leaves out are zero"),
        String::from(
            "the robot is rigid and stays as it was: temperature, wear and what was mounted are those of the runs",
        ),
    ];
    if !before.gravity {
        all.push(String::from(
            "gravity points as described: how the base stands is not looked for",
        ));
    }
    let mut friction = columns.as_slice().iter();
    if friction.any(|column| column.symbol.follows_rate()) {
        all.push(String::from(
            "friction is viscous and Coulomb friction as in the model, at speeds that the runs do not reach, too",
        ));
    }
    if models.contains(&ModelKind::Platform) && model.info().sizes.actuators > 1 {
        all.push(String::from(
            "torques that work against each other without moving the platform (a preload) are no part of the model",
        ));
    }
    all
}

/// Faults of one kind, and what such a fault is of.
const KINDS: [(&[CheckKind], &str); 3] = [
    (
        &[CheckKind::EncoderOffset, CheckKind::Length],
        "zeros and lengths",
    ),
    (&[CheckKind::WrongGain], "single gains"),
    (&[CheckKind::Delay], "delay of the torques"),
];

/// What the checks would have missed though it spoils parameters: of each kind the fault that does most harm at the
/// size that would just have been seen.
pub(crate) fn unseen(checks: &[Check]) -> Vec<String> {
    let worst_of = |kinds: &[CheckKind]| {
        let own = checks
            .iter()
            .filter(|one| one.passed && kinds.contains(&one.kind));
        let all = own.flat_map(|one| &one.detectable);
        let harmful = all.filter(|one| one.moves > HARMFUL && one.moves.is_finite());
        harmful.max_by(|a, b| a.moves.total_cmp(&b.moves))
    };
    let told = KINDS.iter().filter_map(|(kinds, what)| {
        let worst = worst_of(kinds)?;
        let of = match worst.name.as_str() {
            "" => String::new(),
            name => format!(" of `{name}`"),
        };
        let size = match worst.unit {
            "" => format!("{} %", significant(100.0 * worst.size, 2)),
            "s" => format!("{} ms", significant(1e3 * worst.size, 2)),
            unit => format!("{} {unit}", significant(worst.size, 2)),
        };
        Some(format!(
            "{what}: {size}{of} would move `{}` by {:.0} deviations",
            worst.parameter, worst.moves
        ))
    });
    told.collect()
}
