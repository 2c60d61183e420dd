//! Checks the cutoff of the filters, and that positions and torques keep the same frequencies.

use crate::assessment::{
    check::{About, Check, CheckKind, Grade},
    checks::{Context, fault_hypotheses::dry_friction},
    hypotheses::Pace,
};
use overact_logs::{Error, significant};

/// Smallest ratio of filter cutoff to frequency of the motion.
///
/// On a faultless five-bar, the ratio 11 shifts dry friction by three standard deviations; the
/// ratio 22 does not.
const LEAST_CUTOFF: f64 = 12.0;

/// Largest ratio of the torques' band to the cutoff of the position filters.
const WIDEST_BAND: f64 = 3.0;

/// Runs these checks.
pub(crate) fn check(context: &Context<'_>) -> Result<Vec<Check>, Error> {
    let Some(scores) = context.scores else {
        return Ok(Vec::new());
    };
    let checks = [
        cutoff(context, &context.paces(scores)),
        unlike_filters(context),
    ];
    Ok(checks.into_iter().flatten().collect())
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
pub(crate) fn torque_band(context: &Context<'_>) -> Option<f64> {
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
pub(crate) fn equal_bands(context: &Context<'_>, band: f64) -> String {
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
