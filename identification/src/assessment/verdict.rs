//! Verdict on the estimates of a model, from the checks alone.

use serde::Serialize;

use super::check::{Check, CheckKind, Grade};
use crate::{
    regression::projection::ModelKind,
    result::{Estimate, Estimator, Stage},
};

/// Verdict on a model: on its recommended parameters, and on its other stages.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Verdict {
    /// Subject in words: `platform projection`, `actuator projection`, `joint model`.
    pub subject: String,
    /// Model.
    pub model: ModelKind,
    /// Stage of the grade: the recommended parameters, if they are estimated.
    pub stage: Stage,
    /// Grade of its parameters.
    pub grade: Grade,
    /// Whether the parameters may be used without restriction.
    pub trusted: bool,
    /// Usable parameters, if not all are usable.
    pub listed: Vec<String>,
    /// Reasons in sentences: failed checks in the order of [`FailedChecks`]; else the passed ones.
    pub reasons: Vec<String>,
    /// Assumptions of a usable result that these data cannot test, as a sentence.
    ///
    /// `None` if there are none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rests_on: Option<String>,
    /// Verdicts on all stages.
    pub stages: Vec<StageVerdict>,
}

/// Verdict on one estimate.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StageVerdict {
    /// Stage.
    pub stage: Stage,
    /// Grade of its parameters.
    pub grade: Grade,
    /// Usable parameters, if not all are usable.
    pub listed: Vec<String>,
    /// Reasons, in sentences.
    pub reasons: Vec<String>,
}

/// Verdicts on all models, in the order of their estimates; `rests_on` states assumptions.
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
            subject: model.label().to_owned(),
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

/// Verdict on one estimate.
fn of_estimate(estimate: &Estimate, checks: &[Check]) -> StageVerdict {
    let concerning = || {
        checks
            .iter()
            .filter(|check| check.concerns(estimate.model, estimate.stage))
    };
    let found = failed_checks(checks, estimate.model, estimate.stage);
    let failed: Vec<&Check> = concerning().filter(|check| !check.passed).collect();
    let names = estimate.parameters.iter().map(|one| &one.name);
    let is_spoiled = |name: &String| failed.iter().any(|check| check.spoiled.contains(name));
    let listed: Vec<String> = names.filter(|name| !is_spoiled(name)).cloned().collect();
    let worst = failed.iter().map(|check| check.grade).max();
    let worst = worst.unwrap_or_default();
    // Without a usable parameter the result is not usable.
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

/// A failed check is reported in full if it explains at least this fraction of what the best one explains.
const WORTH_TELLING: f64 = 0.5;

/// It also leaves at most this multiple of what the best one leaves.
///
/// A cause that explains nearly everything makes others that explain much less unlikely.
const LEAVES_AT_MOST: f64 = 10.0;

/// A fault that explains more than this fraction is reported before missing excitation.
const NEARLY_EVERYTHING: f64 = 0.9;

/// Failed checks of an estimate.
#[derive(Debug, Clone)]
pub struct FailedChecks<'a> {
    /// Checks to report in full, with their indices among all checks.
    ///
    /// Causes before consequences, then the most serious first, then by the explained fraction.
    pub reported: Vec<(usize, &'a Check)>,
    /// Names of the other failed checks.
    ///
    /// One fault resembles others in the torques. Checks that explain much less than the best one
    /// are only named. If the data are certainly wrong, all checks that explain a part are only
    /// named.
    pub named_only: Vec<&'static str>,
}

/// Failed checks of the estimate of a model and stage.
#[must_use]
pub fn failed_checks(checks: &[Check], model: ModelKind, stage: Stage) -> FailedChecks<'_> {
    let found = checks.iter().enumerate();
    let mut found: Vec<(usize, &Check)> = found
        .filter(|(_, check)| !check.passed && check.concerns(model, stage))
        .collect();
    let most = if found.iter().any(|(_, check)| check.kind.is_certain()) {
        f64::INFINITY
    } else {
        let parts = found.iter().filter_map(|(_, check)| check.explained);
        parts.fold(0.0, f64::max)
    };
    let explained = |check: &Check| {
        let part = check.explained.filter(|_| !check.kind.is_certain());
        part.unwrap_or(f64::INFINITY)
    };
    // A fault that explains nearly everything can make columns look undetermined.
    let rank = |check: &Check| match check.kind {
        CheckKind::Excitation => NEARLY_EVERYTHING,
        _ => explained(check),
    };
    // A stable sort keeps the order of checks that are equal in all three.
    found.sort_by(|(_, a), (_, b)| {
        let causes = a.kind.is_consequence().cmp(&b.kind.is_consequence());
        let causes = causes.then(b.grade.cmp(&a.grade));
        causes.then(rank(b).total_cmp(&rank(a)))
    });
    let (reported, named_only): (Vec<_>, Vec<_>) = found.into_iter().partition(|(_, check)| {
        let own = explained(check);
        let leaves_little = (1.0 - own) <= LEAVES_AT_MOST * (1.0 - most).max(0.0);
        own >= WORTH_TELLING * most && leaves_little
    });
    let mut named_only: Vec<&str> = named_only
        .iter()
        .map(|(_, check)| check.kind.name())
        .collect();
    named_only.dedup();
    FailedChecks {
        reported,
        named_only,
    }
}

impl FailedChecks<'_> {
    /// A sentence that names the other failed checks; `None` if there are none.
    #[must_use]
    pub fn rest(&self) -> Option<String> {
        (!self.named_only.is_empty()).then(|| {
            format!(
                "failed checks that this may explain: {}",
                self.named_only.join(", ")
            )
        })
    }

    /// All failed checks in sentences.
    fn sentences(&self) -> Vec<String> {
        let reported = self.reported.iter().map(|(_, check)| check.located());
        reported.chain(self.rest()).collect()
    }
}
