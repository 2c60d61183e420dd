//! What may be done with the estimates of a model, from the checks alone.

use serde::Serialize;

use super::check::{Check, Grade};
use crate::{
    regression::projection::ModelKind,
    result::{Estimate, Estimator, Stage},
};

/// The verdict on a model: that on its recommended parameters, and on the other stages beside it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Verdict {
    /// What is judged: `case 1`, `case 2`, `joint model`.
    pub subject: String,
    /// The model.
    pub model: ModelKind,
    /// The stage that the grade is about: recommended parameters, where they are estimated.
    pub stage: Stage,
    /// What may be done with them.
    pub grade: Grade,
    /// Whether they may be used without restriction.
    pub trusted: bool,
    /// The parameters that may be used, where not all may.
    pub listed: Vec<String>,
    /// Why, in sentences: what speaks against it, most serious first; else what was checked.
    pub reasons: Vec<String>,
    /// The verdicts on all stages.
    pub stages: Vec<StageVerdict>,
}

/// The verdict on one estimate.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StageVerdict {
    /// The stage.
    pub stage: Stage,
    /// What may be done with its parameters.
    pub grade: Grade,
    /// The parameters that may be used, where not all may.
    pub listed: Vec<String>,
    /// Why, in sentences.
    pub reasons: Vec<String>,
}

/// The verdicts on all models, in the order of their estimates.
pub(crate) fn verdicts(estimates: &[Estimate], checks: &[Check]) -> Vec<Verdict> {
    let mut models: Vec<ModelKind> = estimates.iter().map(|one| one.model).collect();
    models.dedup();
    let of_model = |model: ModelKind| {
        let by_least_squares = |one: &&Estimate| one.estimator == Estimator::LeastSquares;
        let own = estimates
            .iter()
            .filter(by_least_squares)
            .filter(|one| one.model == model);
        let stages: Vec<StageVerdict> = own.map(|one| of_estimate(one, checks)).collect();
        let recommended = stages.iter().find(|one| one.stage == Stage::Recommended);
        let main = recommended.or_else(|| stages.first())?.clone();
        Some(Verdict {
            subject: model.case().to_owned(),
            model,
            stage: main.stage,
            grade: main.grade,
            trusted: main.grade == Grade::Use,
            listed: main.listed,
            reasons: main.reasons,
            stages,
        })
    };
    models.into_iter().filter_map(of_model).collect()
}

/// The verdict on one estimate.
fn of_estimate(estimate: &Estimate, checks: &[Check]) -> StageVerdict {
    let concerning = || {
        checks
            .iter()
            .filter(|check| check.concerns(estimate.model, estimate.stage))
    };
    let mut failed: Vec<&Check> = concerning().filter(|check| !check.passed).collect();
    // A stable sort: checks of one grade stay in their order.
    failed.sort_by_key(|check| std::cmp::Reverse(check.grade));
    let names = estimate.parameters.iter().map(|one| &one.name);
    let is_spoiled = |name: &String| failed.iter().any(|check| check.spoiled.contains(name));
    let listed: Vec<String> = names.filter(|name| !is_spoiled(name)).cloned().collect();
    let worst = failed.first().map_or(Grade::Use, |check| check.grade);
    // What may be used for nothing may not be used.
    let grade = if worst == Grade::UseListed && listed.is_empty() {
        Grade::DoNotUse
    } else {
        worst
    };
    let reasons = if failed.is_empty() {
        concerning().map(Check::located).collect()
    } else {
        failed.iter().map(|check| check.located()).collect()
    };
    StageVerdict {
        stage: estimate.stage,
        grade,
        listed: match grade {
            Grade::UseListed => listed,
            _ => Vec::new(),
        },
        reasons,
    }
}
