//! Tests for a filter common to positions and torques, and for dry friction around reversals.
//!
//! A common filter does not change a model that is linear over the time of the filter; its delay
//! cancels. With s = ½ Σ w t² about the centre of the weights w(t), a signal x is logged as x + s
//! ẍ. Nonlinear terms determine s, since τ̈ differs from the model of the motion's second
//! derivatives. The column of s contains masses that change with the pose. It also contains dry
//! friction: its logged sign is filtered, while the model has the sign of a filtered velocity.
//!
//! Presliding friction has the same effect at each reversal. The second derivative of all dry
//! friction, one column for all drives, detects it.

use super::{half_band::confirms, smoothing::harmless};
use crate::assessment::{
    check::{About, Check, CheckKind},
    checks::{
        Context,
        fault_hypotheses::{TestedHypothesis, dry_friction, harm, only, parabola},
        level::{level, origin},
    },
    detectable::{OF_MEAN, UNIT_OF_SMOOTHING},
    hypotheses::{FaultHypothesis, Scores},
};
use overact_logs::{Error, significant};

/// Tests for a filter of all signals, and for dry friction smoother than the velocity signs.
pub(crate) fn check(context: &Context<'_>) -> Result<Vec<Check>, Error> {
    let Some(scores) = context.scores else {
        return Ok(Vec::new());
    };
    // Smoothing a step w removes s Σ ẇ²/Σ w² of it, and Σ ẇ² grows with the bandwidth.
    let wider = |one: TestedHypothesis| TestedHypothesis {
        band_factor: scores.narrower as f64,
        ..one
    };
    let friction = only(scores, FaultHypothesis::FrictionSmoothing).map(wider);
    let all = only(scores, FaultHypothesis::CommonFilter).map(wider);
    let tests = friction.iter().chain(&all).count();
    let limits = TestLimits {
        tests,
        level: level(tests),
    };
    let bent = friction.filter(|one| one.wald.probability < limits.level);
    if let Some(found) = filtered(context, all.as_ref(), limits.level)? {
        let explains = |one: &TestedHypothesis| one.wald.explained;
        if bent
            .as_ref()
            .is_none_or(|one| explains(one) <= explains(found))
        {
            return Ok(vec![limits.filtered(context, scores, found)]);
        }
    }
    if let Some(bent) = &bent {
        return Ok(vec![limits.bent(context, scores, bent)]);
    }
    let shown = only(scores, FaultHypothesis::FrictionSmoothing)
        .map(wider)
        .or(all);
    let passed_check = shown.map(|one| {
        let visible = one.wald.visible(limits.level);
        limits.check(context, scores, &one, format!(
            "dry friction changes where velocities change sign; the detection limit is a mean of all signals over {} ms",
            time(visible)
        ))
    });
    Ok(passed_check.into_iter().collect())
}

/// Length of the moving average with the same smoothing, ms.
fn time(size: f64) -> String {
    significant(1e3 * (OF_MEAN * size.abs()).sqrt(), 2)
}

/// The filter of all signals, if there is one. Negative sizes have no physical meaning.
fn filtered<'a>(
    context: &Context<'_>,
    all: Option<&'a TestedHypothesis>,
    level: f64,
) -> Result<Option<&'a TestedHypothesis>, Error> {
    let Some(one) = all else {
        return Ok(None);
    };
    let (wald, harmless) = (&one.wald, harmless(context));
    let is_beyond = wald.size() > 0.0 && wald.probability_beyond(harmless) < level;
    let is_there = is_beyond && confirms(context, FaultHypothesis::CommonFilter, wald.size())?;
    Ok(is_there.then_some(one))
}

/// Number and level of the tests.
struct TestLimits {
    tests: usize,
    level: f64,
}

impl TestLimits {
    /// A check with its words.
    fn check(
        &self,
        context: &Context<'_>,
        scores: &Scores,
        one: &TestedHypothesis,
        words: String,
    ) -> Check {
        let wald = &one.wald;
        Check::new(CheckKind::Reversals, About::Model, words)
            .measured(wald.size().abs() / wald.deviation, "standard deviations")
            .against(wald.quantile(self.level), origin(self.tests))
            .detecting(vec![one.detectable(
                context,
                scores,
                UNIT_OF_SMOOTHING,
                wald.visible(self.level),
            )])
            .shown_by(parabola(
                wald,
                "Residual for smoothed dry friction",
                "half of the filter's mean square delay",
                "ms²",
                1e6,
            ))
    }

    /// The failed check of a filter that all signals passed.
    fn filtered(&self, context: &Context<'_>, scores: &Scores, one: &TestedHypothesis) -> Check {
        let mut harm = harm(context, scores, one);
        // The filter also rounds reversals.
        harm.spoil(dry_friction(context));
        let words = format!(
            "positions and torques look equally filtered, as by a mean of all signals over {} ms; {}, and rounds off dry friction at reversals. Look for a filter of the log or of the bus, or of the torques alone: log without it, or with a cutoff far above the motion",
            time(one.wald.size()),
            harm.words()
        );
        self.check(context, scores, one, words).with_harm(&harm)
    }

    /// The failed check of dry friction that differs around reversals.
    fn bent(&self, context: &Context<'_>, scores: &Scores, one: &TestedHypothesis) -> Check {
        let harm = harm(context, scores, one);
        let words = if one.wald.size() > 0.0 {
            format!(
                "dry friction is smoother than the signs of the velocities, as if all signals were means over {} ms; {}. Possible causes are one filter for positions and torques before logging, or presliding friction: log without filters, or skip equations near standstill (`standstill_velocity`)",
                time(one.wald.size()),
                harm.words()
            )
        } else {
            format!(
                "dry friction around reversals is larger than the signs of the velocities predict; {}. Check how velocities are filtered (`velocity_dead_band`, the cutoff), or skip equations near standstill (`standstill_velocity`)",
                harm.words()
            )
        };
        self.check(context, scores, one, words).with_harm(&harm)
    }
}
