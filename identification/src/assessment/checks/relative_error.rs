//! How much of the inputs an estimate leaves unexplained, beside the noise of the torques.

use super::Context;
use crate::{
    assessment::check::{About, Check, CheckKind, Grade},
    error::Error,
    result::{Estimate, Stage},
    significant,
};

/// Percent of the inputs that may be left unexplained beyond noise. Published identifications leave 2 to
/// 12 % (Briot, Krut, Gautier 2015; Janot, Gautier, Brunot 2019), noise among it.
const LARGEST_PERCENT: f64 = 20.0;

/// The part of the power of white noise that decimation by one sample in d leaves, times d: its cutoff
/// lies at this part of the new Nyquist frequency.
const PASSED: f64 = 0.8;

/// Looks at all estimates.
pub(super) fn check(context: &Context<'_>) -> Result<Vec<Check>, Error> {
    let noise = noise_percent(context);
    let of_estimate = |estimate: &Estimate| {
        let error = estimate.relative_error_percent;
        // Case 2 weighs the actuators otherwise; its noise is known no better than to a factor.
        let beyond = (error * error - noise.powi(2).min(error * error)).sqrt();
        let good = beyond <= LARGEST_PERCENT;
        let words = format!(
            "{} {} parameters leave {} % of the inputs unexplained; noise of the torques, told from neighbouring samples, is {} %{}",
            estimate.parameters.len(),
            estimate.stage.name(),
            significant(error, 3),
            significant(noise, 2),
            if good {
                ""
            } else {
                ": the model does not explain the torques. Check signs, units, gains and labels"
            }
        );
        Check::new(CheckKind::RelativeError, About::Fit, words)
            .of_model(estimate.model)
            .of_stage(estimate.stage)
            .measured(beyond, "%")
            .against(
                LARGEST_PERCENT,
                "published identifications leave 2 to 12 %, noise among it",
            )
            .allowing(if good { Grade::Use } else { Grade::DoNotUse })
    };
    Ok(context.least_squares().map(of_estimate).collect())
}

/// The noise of the torques in percent of the inputs of the first model.
fn noise_percent(context: &Context<'_>) -> f64 {
    let (Some(scores), Some(base)) = (context.scores, context.estimates_of(Stage::Base).next())
    else {
        return 0.0;
    };
    let runs = context.dataset.runs.len();
    let variances: Vec<Vec<f64>> = context
        .watched
        .iter()
        .take(runs)
        .map(|watched| {
            let [_, torques] = watched.monitor.noise();
            torques
        })
        .collect();
    let passed = match context.settings.decimation {
        0 | 1 => 1.0,
        factor => PASSED / factor as f64,
    };
    let part = scores.noise(&variances, passed) / base.residual_deviation.powi(2);
    let part = if part.is_finite() { part.min(1.0) } else { 1.0 };
    base.relative_error_percent * part.sqrt()
}
