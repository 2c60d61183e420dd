//! Checks outliers and the length of the motion.

use crate::assessment::{
    check::{About, Check, CheckKind, Grade},
    checks::{Context, residuals::relative_error::times_the_noise},
    hypotheses::{Pace, is_quasi_static},
};
use overact_logs::{Error, significant};

/// Largest fraction of the squared residual in the worst 1 % of the samples.
///
/// White noise has 8 % of its square there.
const LARGEST_PART: f64 = 0.5;

/// Outliers count only if the residual exceeds this multiple of the torque noise.
///
/// Friction at reversals causes peaks in faultless data, too, but their residual is near the noise.
const BEYOND_NOISE: f64 = 2.0;

/// Fewest samples for the outlier check.
const FEWEST_INSTANTS: usize = 300;

/// Fewest periods of motion of the slowest actuator.
const FEWEST_PERIODS: f64 = 2.0;

/// Fewest periods of a quasi-static motion, in which forces depend on positions and directions.
///
/// Each actuator then moves back and forth over most of its range, and the residual is not a
/// function of time.
const FEWEST_QUASI_STATIC_PERIODS: f64 = 0.75;

/// Runs these checks.
pub(crate) fn check(context: &Context<'_>) -> Result<Vec<Check>, Error> {
    let Some(scores) = context.scores else {
        return Ok(Vec::new());
    };
    let mut checks: Vec<Check> = scores
        .peak(FEWEST_INSTANTS)
        .map(|peak| {
            let percent = significant(100.0 * peak.part, 2);
            let check = |words: String| {
                Check::new(CheckKind::Outliers, About::Data, words)
                    .measured(100.0 * peak.part, "%")
                    .against(
                        100.0 * LARGEST_PART,
                        "a hundredth of the instants have 8 % of the square of white noise",
                    )
            };
            let is_noise = times_the_noise(context).is_none_or(|ratio| ratio <= BEYOND_NOISE);
            if peak.part <= LARGEST_PART || is_noise {
                return check(format!(
                    "no few instants dominate: one in a hundred has {percent} % of the squared residual"
                ));
            }
            let run = context.dataset.runs.get(peak.run);
            check(format!(
                "one instant in a hundred has {percent} % of the squared residual, most of it at {} s: look there for a collision, spikes, a frozen or lost signal, or steps of a coarse encoder, and remove that time",
                significant(peak.time, 4)
            ))
            .in_run(run.map_or("", |log| log.name()))
            .found()
        })
        .into_iter()
        .collect();
    checks.extend(length(context, &context.paces(scores)));
    Ok(checks)
}

/// Checks that every actuator moves through enough periods.
fn length(context: &Context<'_>, paces: &[Option<Pace>]) -> Option<Check> {
    let moving = paces.iter().enumerate();
    let moving = moving.filter_map(|(actuator, pace)| Some((actuator, (*pace)?)));
    let (actuator, pace) = moving.min_by(|a, b| a.1.periods.total_cmp(&b.1.periods))?;
    let name = context.model.info().actuators.get(actuator).copied()?;
    let [periods, frequency] = [pace.periods, pace.frequency].map(|x| significant(x, 2));
    let check = |words: String| {
        Check::new(CheckKind::ShortMotion, About::Data, words)
            .measured(pace.periods, "periods")
            .against(
                FEWEST_PERIODS,
                "noise is estimated from what does not repeat",
            )
    };
    if pace.periods >= FEWEST_PERIODS {
        return Some(check(format!(
            "the motion is long enough: each actuator moves back and forth at least {periods} times"
        )));
    }
    if pace.periods >= FEWEST_QUASI_STATIC_PERIODS && is_quasi_static(paces) {
        return Some(
            check(format!(
                "the motion is quasi-static and short: `{name}` completes {periods} periods. Weights and friction depend on positions and directions only, but effects that repeat with the motion are not separated from noise; a second period would show them"
            ))
            .of_actuator(name)
            .found(),
        );
    }
    Some(
        check(format!(
            "the runs are short: `{name}` moves at about {frequency} Hz and completes only {periods} periods. Noise cannot be separated from motion, so neither the estimates nor their intervals are reliable; record at least {FEWEST_PERIODS:.0} periods, better ten"
        ))
        .of_actuator(name)
        .with_grade(Grade::DoNotUse),
    )
}
