//! How well the estimates predict runs that were held out.

use super::Context;
use crate::{
    assessment::check::{About, Check, CheckKind, Grade},
    error::Error,
    result::CrossValidation,
    significant,
    thresholds::Thresholds,
};

/// Looks at all estimates on all runs that were held out.
pub(super) fn check(context: &Context<'_>) -> Result<Vec<Check>, Error> {
    let limit = Thresholds::default().relative_error_percent;
    let of_one = |one: &CrossValidation| {
        let error = one.relative_error_percent;
        let words = format!(
            "of the run, which was held out, the {} parameters leave {} % unexplained",
            one.stage.name(),
            significant(error, 3)
        );
        Check::new(CheckKind::HeldOut, About::Extrapolation, words)
            .in_run(&one.run)
            .of_model(one.model)
            .of_stage(one.stage)
            .measured(error, "%")
            .against(limit, "the model has to explain most of the inputs")
            .allowing(if error <= limit {
                Grade::Use
            } else {
                Grade::DoNotUse
            })
    };
    Ok(context.cross_validation.iter().map(of_one).collect())
}
