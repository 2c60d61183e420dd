//! Assumptions that the data of a run cannot test.

use overact::Model;

use crate::{
    kinematics::conditioning::couples,
    prior::Prior,
    regression::{columns::ColumnSet, projection::ModelKind},
    settings::CheckScope,
};

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
