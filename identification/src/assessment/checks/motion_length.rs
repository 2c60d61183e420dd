//! Checks outliers, length of the motion and filters.

use super::{Context, fault_hypotheses::dry_friction, relative_error::times_the_noise};
use crate::{
    assessment::{
        check::{About, Check, CheckKind, Grade},
        hypotheses::Pace,
    },
    error::Error,
    significant,
};

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

/// Smallest ratio of filter cutoff to frequency of the motion.
///
/// On a faultless five-bar, the ratio 11 shifts dry friction by three standard deviations; the
/// ratio 22 does not.
const LEAST_CUTOFF: f64 = 12.0;

/// Largest ratio of the torques' band to the cutoff of the position filters.
const WIDEST_BAND: f64 = 3.0;

/// Runs these checks.
pub(super) fn check(context: &Context<'_>) -> Result<Vec<Check>, Error> {
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
            if peak.part <= LARGEST_PART || times_the_noise(context) <= BEYOND_NOISE {
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
    let paces = scores.paces();
    checks.extend(length(context, &paces));
    checks.extend(cutoff(context, &paces));
    checks.extend(unlike_filters(context));
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
    Some(
        check(format!(
            "the runs are short: `{name}` moves at about {frequency} Hz and completes only {periods} periods. Noise cannot be separated from motion, so neither the estimates nor their intervals are reliable; record at least {FEWEST_PERIODS:.0} periods, better ten"
        ))
        .of_actuator(name)
        .with_grade(Grade::DoNotUse),
    )
}

/// Checks that the filter cutoff lies far above the frequency of the motion.
fn cutoff(context: &Context<'_>, paces: &[Option<Pace>]) -> Option<Check> {
    let cutoff = context.settings.filter_cutoff_hz;
    let fastest = paces.iter().flatten().map(|pace| pace.frequency);
    let fastest = fastest.fold(0.0, f64::max);
    let ratio = cutoff / fastest;
    let words = format!(
        "the cutoff of the filters, {} Hz, is {} times the frequency of the fastest motion, {} Hz",
        significant(cutoff, 3),
        significant(ratio, 2),
        significant(fastest, 2)
    );
    let check = |words: String| {
        Check::new(CheckKind::Filters, About::Data, words)
            .measured(ratio, "")
            .against(
                LEAST_CUTOFF,
                "Gautier's rule, ten times the bandwidth of the motion, with a margin for reversals",
            )
    };
    if !ratio.is_finite() || ratio >= LEAST_CUTOFF {
        return Some(check(words));
    }
    let check = check(format!(
        "{words}: velocities around reversals are rounded off, which biases dry friction; raise `filter_cutoff`"
    ));
    let dry = dry_friction(context);
    Some(if dry.is_empty() {
        check.found()
    } else {
        check
            .with_grade(Grade::UseListed)
            .with_unusable_parameters(dry)
    })
}

/// Checks that regressor and torques pass the same filters.
fn unlike_filters(context: &Context<'_>) -> Option<Check> {
    let band = torque_band(context)?;
    let words = format!(
        "positions are filtered at {} Hz, but torques keep frequencies up to {} Hz: the columns are smoother than the torques, which biases friction. {}",
        significant(context.settings.filter_cutoff_hz, 3),
        significant(band, 3),
        equal_bands(context, band)
    );
    Some(Check::new(CheckKind::Filters, About::Data, words).found())
}

/// Largest frequency of the torques in the equations (Hz), if far above the position filter's.
///
/// Torques pass the filter of the decimation only, unless `filter_equations` is set.
pub(super) fn torque_band(context: &Context<'_>) -> Option<f64> {
    let settings = context.settings;
    if settings.filter_equations {
        return None;
    }
    let runs = context.dataset.runs.iter();
    let fastest = runs.map(|run| run.sampling_frequency()).fold(0.0, f64::max);
    let band = 0.5 * fastest / settings.decimation.max(1) as f64;
    let is_wide = band > WIDEST_BAND * settings.filter_cutoff_hz;
    (settings.decimation <= 1 || is_wide).then_some(band)
}

/// Settings that give positions and torques of this band the same one.
pub(super) fn equal_bands(context: &Context<'_>, band: f64) -> String {
    let settings = context.settings;
    let factor = settings.decimation.max(1) as f64 * band / settings.filter_cutoff_hz;
    if factor.is_finite() && factor >= 2.0 {
        format!(
            "Set `decimation = {}`, or `filter_equations = true`",
            factor.ceil()
        )
    } else {
        String::from("Set `decimation` to more than one, or `filter_equations = true`")
    }
}
