//! Closes loops that a file's rounded numbers leave open by a small misfit.
//!
//! Nearly parallel axes of a loop are made parallel if the loop cannot move otherwise. Frames of
//! closures are then shifted by the remaining misfit. If loops still cannot move, dimensions are
//! changed as little as possible so that they do. All changes are at most the tolerance, and each
//! is reported.

use super::{
    fitting::{dimensions::size, redundant},
    motion::{Motion, State, gaps_of},
    nearest::nearest,
    network::Network,
    parallel::parallel_axes,
};
use crate::{
    files::Files,
    model::{ClosureKind, Misfit, Model},
};

/// Largest misfit by default: rad, and as a fraction of the mechanism's size.
pub(crate) const TOLERANCE: f64 = 2e-3;

/// Residuals below this are rounding errors, m or rad.
const ROUNDING: f64 = 1e-9;

/// Model whose loops close and move; `None` after an error.
pub(crate) fn fitted(files: &Files, model: Model, tolerance: f64) -> Option<Model> {
    let as_given = closable(&model, tolerance);
    let straight = parallel_axes(&model, tolerance);
    let straightened = straight.as_ref().and_then(|model| {
        let adjusted = closable(model, tolerance).ok()?;
        Some(adjusted.unwrap_or_else(|| model.clone()))
    });
    let closed = match (as_given, straightened) {
        (Ok(adjusted), Some(straight)) => {
            let own = adjusted.unwrap_or_else(|| model.clone());
            let is_better = motions(&straight) > motions(&own);
            if is_better { straight } else { own }
        }
        (Ok(adjusted), None) => adjusted.unwrap_or_else(|| model.clone()),
        (Err(_), Some(straight)) => straight,
        (Err(worst), None) => {
            refuse(files, &model, &worst, tolerance);
            return None;
        }
    };
    // Closed exactly, redundant loops may be in a configuration far away, in which they don't move.
    let starts = straight.as_ref().into_iter().chain([&model, &closed]);
    let fitted = starts.filter_map(|own| redundant::consistent(own, tolerance, None));
    let moving = { fitted }.find(|moving| motions(moving) > motions(&closed));
    Some(moving.unwrap_or(closed))
}

/// Whether the loops move finitely, the number of independent motions, and the number of
/// configurations in which they were counted.
///
/// Axes that rounding tilts can keep motions whose loops close only at the start.
fn motions(model: &Model) -> (bool, usize, usize) {
    Network::closed(model).map_or((false, 0, 0), |network| {
        let moves = network.mobility > 0 && network.infinitesimal.is_empty();
        (moves, network.mobility, network.states.len())
    })
}

/// Misfit of a closure that is too large.
struct Worst {
    closure: usize,
    length: f64,
    angle: f64,
    size: f64,
}

/// Model with frames of closures shifted by their misfits; `None` if its loops close as given.
fn closable(model: &Model, tolerance: f64) -> Result<Option<Model>, Worst> {
    let motion = Motion::new(model);
    let Err(open) = motion.closed(&motion.start()) else {
        return Ok(None);
    };
    // A search from the start may find a better configuration than the one at which Newton's
    // iteration ended.
    let found = [open.state, motion.start()].map(|state| nearest(&motion, &state));
    let misfit = |state: &State| {
        motion
            .closure(state)
            .0
            .iter()
            .map(|gap| gap * gap)
            .sum::<f64>()
    };
    let [ended, started] = found.each_ref().map(misfit);
    let [at_end, at_start] = found;
    let state = if started < ended { at_start } else { at_end };
    let size = size(model, &state);
    let mut worst: Option<(f64, Worst)> = None;
    for (closure, own) in model.closures.iter().enumerate() {
        let (length, angle) = gaps_of(&own.kind, &state);
        let ratio = (length / size).max(angle);
        if !ratio.is_finite() || worst.as_ref().is_none_or(|(largest, _)| ratio > *largest) {
            let own = Worst {
                closure,
                length,
                angle,
                size,
            };
            worst = Some((ratio, own));
        }
    }
    match worst {
        Some((ratio, _)) if ratio <= tolerance => Ok(Some(shifted(model, &state))),
        Some((_, worst)) => Err(worst),
        None => Ok(None),
    }
}

/// Model whose closures are satisfied in a configuration, its home.
fn shifted(model: &Model, state: &State) -> Model {
    let mut model = model.clone();
    for (at, joint) in model.joints.iter_mut().enumerate() {
        (joint.home, joint.home_turn) = (state.positions[at], state.turns[at]);
    }
    for closure in &mut model.closures {
        let (length, angle) = gaps_of(&closure.kind, state);
        if length.max(angle) < 1e-13 {
            continue;
        }
        match &mut closure.kind {
            ClosureKind::Point { bodies, at } => {
                let point = state.poses[bodies[0]] * at[0];
                at[1] = state.poses[bodies[1]].inverse_transform_point(&point);
            }
            ClosureKind::Weld { bodies, at } | ClosureKind::Pin { bodies, at } => {
                let frame = state.poses[bodies[0]] * at[0];
                at[1] = state.poses[bodies[1]].inv_mul(&frame);
            }
        }
        if length.max(angle) > ROUNDING {
            model.misfits.push(Misfit {
                name: closure.name.clone(),
                place: closure.place.clone(),
                length,
                angle,
            });
        }
    }
    model
}

fn refuse(files: &Files, model: &Model, worst: &Worst, tolerance: f64) {
    let closure = &model.closures[worst.closure];
    let Worst {
        length,
        angle,
        size,
        ..
    } = *worst;
    let message = format!(
        "the loop of `{}` can't close from this start: {} remain open, and the tolerance is {}",
        closure.name,
        amount(length, angle),
        amount(tolerance * size, tolerance),
    );
    let help = "check the frames of the closure, start closer with `--home JOINT=POSITION`, or accept the misfit with `--closure-tolerance NUMBER` (rad, and fraction of the loops' size)";
    files.report(&closure.place, message, help);
}

/// A length and an angle in words.
pub(crate) fn amount(length: f64, angle: f64) -> String {
    match (length > 1e-13, angle > 1e-13) {
        (true, false) => format!("{length:.2e} m"),
        (false, true) => format!("{angle:.2e} rad"),
        _ => format!("{length:.2e} m and {angle:.2e} rad"),
    }
}
