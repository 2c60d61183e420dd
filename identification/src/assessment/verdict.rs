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
    /// What of the description and the logs a result that may be used takes for right though nothing in the data of
    /// this robot tells it, in a sentence; none where there is nothing of the kind.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rests_on: Option<String>,
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

/// The verdicts on all models, in the order of their estimates; `rests_on` is what results of this robot take for right.
pub(crate) fn verdicts(
    estimates: &[Estimate],
    checks: &[Check],
    rests_on: Option<&str>,
) -> Vec<Verdict> {
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
            rests_on: rests_on
                .filter(|_| main.grade != Grade::DoNotUse)
                .map(str::to_owned),
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
    let found = objections(checks, estimate.model, estimate.stage);
    let failed: Vec<&Check> = concerning().filter(|check| !check.passed).collect();
    let names = estimate.parameters.iter().map(|one| &one.name);
    let is_spoiled = |name: &String| failed.iter().any(|check| check.spoiled.contains(name));
    let listed: Vec<String> = names.filter(|name| !is_spoiled(name)).cloned().collect();
    let worst = failed.iter().map(|check| check.grade).max();
    let worst = worst.unwrap_or_default();
    // What may be used for nothing may not be used.
    let grade = if worst == Grade::UseListed && listed.is_empty() {
        Grade::DoNotUse
    } else {
        worst
    };
    let reasons = if failed.is_empty() {
        concerning().map(Check::located).collect()
    } else {
        found.sentences()
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

/// Of the most that a suspect explains, what another one has to explain to be told beside it.
const WORTH_TELLING: f64 = 0.5;

/// What speaks against an estimate.
#[derive(Debug, Clone)]
pub struct Objections<'a> {
    /// The checks that are to be told, most serious first and then by what they explain, with their numbers
    /// among all checks.
    pub told: Vec<(usize, &'a Check)>,
    /// What else was found. What a fault does to the torques looks in part like other faults, too: suspects that
    /// explain far less than another one are only named, and so are all where the data themselves are wrong
    /// beyond doubt.
    pub beside: Vec<&'static str>,
}

/// What speaks against the estimate of a model and stage.
#[must_use]
pub fn objections(checks: &[Check], model: ModelKind, stage: Stage) -> Objections<'_> {
    let found = checks.iter().enumerate();
    let mut found: Vec<(usize, &Check)> = found
        .filter(|(_, check)| !check.passed && check.concerns(model, stage))
        .collect();
    let most = match found.iter().any(|(_, check)| check.kind.is_certain()) {
        true => f64::INFINITY,
        false => {
            let parts = found.iter().filter_map(|(_, check)| check.explained);
            parts.fold(0.0, f64::max)
        }
    };
    let explained = |check: &Check| check.explained.unwrap_or(f64::INFINITY);
    // A stable sort: checks of one grade and weight stay in their order.
    found.sort_by(|(_, a), (_, b)| {
        let grade = b.grade.cmp(&a.grade);
        grade.then(explained(b).total_cmp(&explained(a)))
    });
    let (told, beside): (Vec<_>, Vec<_>) = found
        .into_iter()
        .partition(|(_, check)| explained(check) >= WORTH_TELLING * most);
    let mut beside: Vec<&str> = beside.iter().map(|(_, check)| check.kind.name()).collect();
    beside.dedup();
    Objections { told, beside }
}

impl Objections<'_> {
    /// What was only named, in a sentence; none where all is told.
    #[must_use]
    pub fn rest(&self) -> Option<String> {
        (!self.beside.is_empty()).then(|| {
            format!(
                "what else was found may well follow from that: {}",
                self.beside.join(", ")
            )
        })
    }

    /// All of it in sentences.
    fn sentences(&self) -> Vec<String> {
        let told = self.told.iter().map(|(_, check)| check.located());
        told.chain(self.rest()).collect()
    }
}
