//! Tests whether several known values agree with each other, if the gains were identified.

use crate::{
    assessment::{
        check::{About, Check, CheckKind, Grade},
        checks::{
            Context,
            level::{level, origin},
        },
    },
    gains::known_values::{REMEDY, RedundantValue, contradictions, words},
};
use overact_logs::Error;

/// Largest harmless difference from a known value, relative to it.
const HARMLESS: f64 = 0.02;

/// Tests each known value that the others determine, too.
pub(crate) fn check(context: &Context<'_>) -> Result<Vec<Check>, Error> {
    let values = context.redundant_values;
    let worst = { values.iter() }.max_by(|a, b| a.miss().total_cmp(&b.miss()));
    let Some(worst) = worst else {
        return Ok(Vec::new());
    };
    let tests = values.len();
    let found = contradictions(values, level(tests));
    let check = if found.is_empty() {
        let passed = format!("the known values agree with each other: {}", worst.words());
        Check::new(CheckKind::KnownValues, About::Model, passed)
    } else {
        let failed = format!("{}. {REMEDY}", words(&found));
        let check = Check::new(CheckKind::KnownValues, About::Model, failed).found();
        if found.into_iter().any(is_large) {
            check.with_grade(Grade::DoNotUse)
        } else {
            check
        }
    };
    let check = check.measured(worst.miss(), "standard deviations");
    Ok(vec![
        check.against(worst.limit(level(tests)), origin(tests)),
    ])
}

/// Whether the difference from a known value is relevant.
fn is_large(value: &RedundantValue) -> bool {
    (value.estimated - value.known).abs() > HARMLESS * value.known.abs()
}
