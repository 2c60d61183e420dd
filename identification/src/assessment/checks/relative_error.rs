//! How much of the inputs an estimate leaves unexplained.

use super::Context;
use crate::{
    assessment::check::{About, Check, CheckKind, Grade},
    error::Error,
    result::Estimate,
    significant,
    thresholds::Thresholds,
};

/// Looks at all estimates.
pub(super) fn check(context: &Context<'_>) -> Result<Vec<Check>, Error> {
    let limit = Thresholds::default().relative_error_percent;
    let of_estimate = |estimate: &Estimate| {
        let error = estimate.relative_error_percent;
        let good = error <= limit;
        let words = format!(
            "{} {} parameters leave {} % of the inputs unexplained, {} than {limit} %",
            estimate.parameters.len(),
            estimate.stage.name(),
            significant(error, 3),
            if good { "less" } else { "more" },
        );
        Check::new(CheckKind::RelativeError, About::Fit, words)
            .of_model(estimate.model)
            .of_stage(estimate.stage)
            .measured(error, "%")
            .against(limit, "the model has to explain most of the inputs")
            .allowing(if good { Grade::Use } else { Grade::DoNotUse })
    };
    let all = context.estimates.iter().map(|(_, one)| one);
    Ok(all.map(of_estimate).collect())
}
