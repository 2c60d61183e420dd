//! Whether dry friction changes its direction where the velocities change their signs.
//!
//! A filter that positions and torques have passed alike does nothing to a model that is linear in them over the time of
//! the filter. Dry friction is not: what was logged of it is a sign that was filtered, F(sign q̇), and the model has the
//! sign of what was filtered, sign(F q̇). The delay of the filter falls out, since both have it, and what is left is
//! s d²/dt² of dry friction with s = ½ Σ w t² about the middle of the weights w(t). Friction that bends before it slides
//! does the same at each reversal. So one column for all drives, the second derivative of all dry friction, tells both.

use super::{
    Context,
    level::{level, origin},
    smoothing::{OF_MEAN, UNIT},
    suspected::{Tested, harm, only, parabola},
};
use crate::{
    assessment::{
        check::{About, Check, CheckKind},
        suspects::Suspect,
    },
    error::Error,
    significant,
};

/// Looks for dry friction that is smoother than the signs of the velocities.
pub(super) fn check(context: &Context<'_>) -> Result<Vec<Check>, Error> {
    let Some(scores) = context.scores else {
        return Ok(Vec::new());
    };
    let Some(one) = only(scores, Suspect::Dulled) else {
        return Ok(Vec::new());
    };
    // A step w that is smoothed loses the part s Σ ẇ²/Σ w² of itself, and Σ ẇ² grows with the band.
    let one = Tested {
        more: scores.narrower as f64,
        ..one
    };
    let (accused, level) = (&one.accused, level(1));
    let time = |size: f64| significant(1e3 * (OF_MEAN * size.abs()).sqrt(), 2);
    let check = |words: String| {
        Check::new(CheckKind::Reversals, About::Model, words)
            .measured(
                accused.size().abs() / accused.deviation,
                "standard deviations",
            )
            .against(accused.quantile(level), origin(1))
            .detecting(vec![one.detectable(
                (context, scores),
                (String::new(), UNIT),
                accused.visible(level),
            )])
            .shown_by(parabola(
                accused,
                "Residual for dry friction that is smoothed",
                ("half of the mean square of the filter's time", "ms²", 1e6),
            ))
    };
    if accused.probability >= level {
        return Ok(vec![check(format!(
            "dry friction changes where velocities change their signs; a mean of all signals over {} ms would have been seen",
            time(accused.visible(level))
        ))]);
    }
    let harm = harm(context, scores, &one);
    let how = match accused.size() > 0.0 {
        true => format!(
            "dry friction is smoother than the signs of the velocities, as if all signals were means over {} ms; {}. So it is where positions and torques have passed the same filter before they were logged, or where friction bends before it slides: log without filters, or leave out equations near standstill (`standstill_velocity`)",
            time(accused.size()),
            harm.words()
        ),
        false => format!(
            "dry friction is larger around reversals than the signs of the velocities make it; {}. Look at how velocities are filtered (`velocity_dead_band`, the cutoff), or leave out equations near standstill (`standstill_velocity`)",
            harm.words()
        ),
    };
    Ok(vec![check(how).because(&harm)])
}
