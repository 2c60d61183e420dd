//! Parameters that any admissible fault shifts, if a check has found one.
//!
//! The fault that explains most of the residual need not be the true one. With the squared score
//! S = (z⊥ᵀ ρ)²/(z⊥ᵀ z⊥) of each hypothesis and the variance σ² of a score, a fault h is admissible
//! unless the best one b explains significantly more:
//!
//! ```text
//! S_b - S_h <= q² σ²,
//! ```
//!
//! where q is the quantile of Student's distribution at the level of the test. If h is true, no
//! other column exceeds it by more than that with this probability: scores of two columns with the
//! correlation c differ by (1 - c) μ + √(2 (1 - c)) σ z, and S_b - S_h is at most z² σ² for any c.
//!
//! The columns are of first order, and real faults differ from all of them. Faults that explain at
//! least half as much as the best one are therefore admissible, too.
//!
//! If the same fault is significant at several drives, it is likely to be present at all of them,
//! below the detection limit of the others. Parameters that such a fault of one drive shifts at its
//! detection limit are then unusable, too.

use super::{
    Context,
    fault_hypotheses::{Harm, LIKELY, TestedHypothesis, harm, most_significant, tested},
    level::level,
};
use crate::{
    assessment::{
        check::{Check, Grade},
        hypotheses::{FaultHypothesis, Group, Scores},
    },
    result::Stage,
};

/// Adds the parameters that admissible faults shift to the failed check that explains most.
///
/// Without a failed check of a fault, nothing changes.
pub(super) fn spoil(context: &Context<'_>, checks: &mut [Check]) {
    let Some(scores) = context.scores else {
        return;
    };
    let failed = checks.iter_mut().filter(|one| !one.passed);
    let faults = failed.filter_map(|one| one.explained.map(|part| (part, one)));
    let Some((_, leading)) = faults.max_by(|a, b| a.0.total_cmp(&b.0)) else {
        return;
    };
    let shifted = shifted(context, scores);
    let more: Vec<String> = shifted
        .into_iter()
        .filter(|name| !leading.spoiled.contains(name))
        .collect();
    if more.is_empty() {
        return;
    }
    if leading.grade < Grade::DoNotUse {
        leading.words.push_str(&format!(
            ". Other faults explain these data as well and shift {} more",
            match more.len() {
                1 => String::from("one parameter"),
                count => format!("{count} parameters"),
            }
        ));
    }
    leading.spoiled.extend(more);
    let base = context.estimates_of(Stage::Base).next();
    let count = base.map_or(0, |one| one.parameters.len());
    let grade = Harm::grade(leading.spoiled.len(), count);
    leading.grade = leading.grade.max(grade);
}

/// All parameters that an admissible fault shifts by more than their intervals.
fn shifted(context: &Context<'_>, scores: &Scores) -> Vec<String> {
    let found = tested(scores, Group::hypotheses(scores, is_complete));
    let level = level(found.len());
    let admissible = admissible(&found);
    let by_one = admissible.iter();
    let by_one = by_one.flat_map(|one| harm(context, scores, one).spoiled);
    let by_all = of_all_drives(&found, &admissible, scores);
    let by_all = by_all
        .into_iter()
        .flat_map(|one| one.shifted_at_limit(context, scores, level));
    let mut names: Vec<String> = Vec::new();
    for name in by_one.chain(by_all) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    names
}

/// Each drive's own of the faults that all drives are likely to have.
///
/// Such a fault is significant at several drives, and admissible at one of them.
fn of_all_drives<'a>(
    found: &'a [TestedHypothesis],
    admissible: &[&TestedHypothesis],
    scores: &Scores,
) -> Vec<&'a TestedHypothesis> {
    let level = level(found.len());
    let is_part =
        |one: &TestedHypothesis, all: FaultHypothesis| one.hypothesis(scores).is_joined_by(all);
    let is_likely = |all: FaultHypothesis| {
        let parts = found.iter().filter(|one| is_part(one, all));
        let significant = parts.filter(|one| one.wald.probability < level);
        significant.count() >= 2 && admissible.iter().any(|one| is_part(one, all))
    };
    let all = scores.hypotheses.iter().copied();
    let likely: Vec<FaultHypothesis> = all.filter(|all| is_likely(*all)).collect();
    let is_wanted = |one: &&TestedHypothesis| likely.iter().any(|all| is_part(one, *all));
    found.iter().filter(is_wanted).collect()
}

/// Whether the columns of a fault describe its whole effect.
fn is_complete(hypothesis: FaultHypothesis) -> bool {
    hypothesis != FaultHypothesis::Smoothing
}

/// The faults that the best one does not reject.
fn admissible(found: &[TestedHypothesis]) -> Vec<&TestedHypothesis> {
    let level = level(found.len());
    let Some(best) = most_significant(found, level) else {
        return Vec::new();
    };
    let is_admissible = |one: &&TestedHypothesis| {
        let noise = one.wald.noise.max(best.wald.noise);
        let limit = one
            .wald
            .quantile(level)
            .max(best.wald.quantile(level))
            .powi(2)
            * noise;
        let behind = best.wald.evidence() - one.wald.evidence();
        behind <= limit || one.wald.evidence() >= LIKELY * best.wald.evidence()
    };
    found.iter().filter(is_admissible).collect()
}
