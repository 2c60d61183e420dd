//! What several sections choose alike: the estimates that count, names in words, parts of series.

use std::ops::Range;

use crate::plot::Look;
use overact_identification::{Estimate, Identification, ModelKind, Series, Stage};

/// Points of a series that a plot can show without becoming a blot.
const READABLE: usize = 300;

/// The last estimate of each model: the essential one, or the base one where there is no other.
pub(super) fn finals(identification: &Identification) -> Vec<&Estimate> {
    let mut finals: Vec<&Estimate> = Vec::new();
    for estimate in &identification.estimates {
        match finals.iter_mut().find(|one| one.model == estimate.model) {
            Some(one) => *one = estimate,
            None => finals.push(estimate),
        }
    }
    finals
}

/// Whether an estimate is the last one of its model.
pub(super) fn is_final(identification: &Identification, model: ModelKind, stage: Stage) -> bool {
    finals(identification)
        .iter()
        .any(|one| one.model == model && one.stage == stage)
}

/// The case at the beginning of a sentence.
pub(super) const fn case_heading(model: ModelKind) -> &'static str {
    match model {
        ModelKind::Platform => "Case 1",
        ModelKind::Actuators => "Case 2",
        ModelKind::Joints => "Joint model",
    }
}

/// What a model does with the inputs.
pub(super) fn projection(estimate: &Estimate) -> String {
    match estimate.model {
        ModelKind::Platform => String::from("inputs projected on the platform"),
        ModelKind::Actuators => {
            format!("inputs projected on {}", estimate.kept_actuators.join(", "))
        }
        ModelKind::Joints => String::from("inputs of all joints"),
    }
}

/// The look of a model's lines.
pub(super) const fn look(model: ModelKind) -> Look {
    match model {
        ModelKind::Actuators => Look::Second,
        ModelKind::Platform | ModelKind::Joints => Look::First,
    }
}

/// The part of several series that a plot shows: all, where that is readable, else the part around the
/// largest residual, in units of each series' own size.
pub(super) fn worst_part(series: &[Series]) -> Range<usize> {
    let length = series.iter().map(|one| one.time.len()).min().unwrap_or(0);
    if length <= READABLE {
        return 0..length;
    }
    let worst = series
        .iter()
        .flat_map(|one| {
            let size = norm(&one.measured).max(f64::MIN_POSITIVE);
            let pairs = one.measured.iter().zip(&one.predicted).take(length);
            pairs
                .enumerate()
                .map(move |(index, (m, p))| ((m - p).abs() / size, index))
        })
        .filter(|(miss, _)| miss.is_finite())
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map_or(0, |(_, index)| index);
    let first = worst
        .saturating_sub(READABLE / 2)
        .min(length.saturating_sub(READABLE));
    first..first + READABLE
}

/// Duration of a part of a series and of the whole, s.
pub(super) fn durations(series: &Series, part: &Range<usize>) -> (f64, f64) {
    let time = &series.time;
    let at = |index: usize| time.get(index).copied().unwrap_or(0.0);
    let span = |first: usize, last: usize| at(last) - at(first);
    (
        span(part.start, part.end.saturating_sub(1)),
        span(0, time.len().saturating_sub(1)),
    )
}

/// 100 ||measured - predicted||/||measured||; none where nothing was measured.
pub(super) fn relative_error(series: &Series) -> Option<f64> {
    let pairs = series.measured.iter().zip(&series.predicted);
    let residual: Vec<f64> = pairs.map(|(m, p)| m - p).collect();
    let measured = norm(&series.measured);
    (measured > 0.0).then(|| 100.0 * norm(&residual) / measured)
}

fn norm(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum::<f64>().sqrt()
}
