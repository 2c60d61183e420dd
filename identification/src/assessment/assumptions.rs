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

/// What no data of these runs can show to be wrong: faults whose effect on the data is that of other
/// parameters.
pub(crate) fn assumptions(
    model: &dyn Model,
    columns: &ColumnSet,
    models: &[ModelKind],
) -> Vec<String> {
    let mut all = vec![
        String::from(
            "the gains of the drives are right as a whole: if all torques are wrong by one factor, so are all parameters, and nothing in the data tells",
        ),
        String::from(
            "the clock is right: if all times are wrong by one factor, masses and inertias are wrong by its square and viscous friction by the factor, and only gravity tells",
        ),
        String::from(
            "the lengths of the description are right as a whole: angles alone fix no scale",
        ),
        String::from(
            "the robot is rigid and stays as it was: temperature, wear and what was mounted are those of the runs",
        ),
    ];
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

/// What the checks would have missed though it spoils parameters: the zero of an encoder or the length that does most
/// harm at the size that would just have been seen.
pub(crate) fn hidden(checks: &[Check]) -> Option<String> {
    let own = |check: &&Check| {
        check.passed && matches!(check.kind, CheckKind::EncoderOffset | CheckKind::Length)
    };
    let all = checks.iter().filter(own).flat_map(|one| &one.detectable);
    let harmful = all.filter(|one| one.moves > HARMFUL && one.moves.is_finite());
    let worst = harmful.max_by(|a, b| a.moves.total_cmp(&b.moves))?;
    Some(format!(
        "zeros of encoders and lengths are right: an error of {} {} of `{}`, the least that these data would have shown, moves `{}` by {:.0} of its standard deviations, and a smaller one in proportion",
        significant(worst.size, 2),
        worst.unit,
        worst.name,
        worst.parameter,
        worst.moves
    ))
}
