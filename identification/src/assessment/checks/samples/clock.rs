//! Tests the sampling frequency, which gravity and friction determine.

use crate::assessment::{
    check::{About, Check, CheckKind},
    checks::{
        Context,
        fault_hypotheses::{harm, only, parabola},
        level::{level, origin},
    },
    hypotheses::FaultHypothesis,
};
use overact_logs::{Error, significant};

/// Larger relative errors are reported without a number: the first-order test is invalid there.
const LARGEST: f64 = 0.5;

/// Tests one common factor of all time stamps.
pub(crate) fn check(context: &Context<'_>) -> Result<Vec<Check>, Error> {
    let Some(scores) = context.scores else {
        return Ok(Vec::new());
    };
    let found = only(scores, FaultHypothesis::Clock);
    let level = level(1);
    let checks = found.iter().map(|one| {
        let wald = &one.wald;
        let percent = |value: f64| significant(100.0 * value, 3);
        let check = Check::new(CheckKind::Clock, About::Model, "")
            .measured(wald.size().abs() / wald.deviation, "standard deviations")
            .against(wald.quantile(level), origin(1))
            .detecting(vec![one.detectable(context, scores, "", wald.visible(level))])
            .shown_by(parabola(
                wald,
                "Residual for other sampling frequencies",
                "error of the sampling frequency",
                "%",
                100.0,
            ));
        if wald.probability >= level {
            let words = format!(
                "the sampling frequency agrees with the model; the detection limit is {} %",
                percent(wald.visible(level))
            );
            return Check { words, ..check };
        }
        let harm = harm(context, scores, one);
        let sense = if wald.size() > 0.0 { "high" } else { "low" };
        let deviation = percent(wald.deviation);
        let words = if wald.size().abs() > LARGEST { format!(
                "gravity and motion are inconsistent in the torques, as if the sampling frequency were far too {sense}; {}. Check the time column and its unit, `gravity` of the description, and whether the log contains the complete torques, including any gravity compensation by the drive",
                harm.words()
            ) } else { format!(
                "the sampling frequency looks {} % too {sense} (standard deviation {deviation} %); {}. Check the time column and its unit",
                percent(wald.size().abs()),
                harm.words()
            ) };
        Check { words, ..check }.with_harm(&harm)
    });
    Ok(checks.collect())
}
