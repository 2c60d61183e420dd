//! Choices shared by several sections: looks of models, ranges of series.

use std::ops::Range;

use crate::plot::Look;
use overact_identification::{ModelKind, Series};

/// Largest readable number of points in a plot.
const READABLE: usize = 300;

/// Look of a model's lines.
pub(crate) const fn look(model: ModelKind) -> Look {
    match model {
        ModelKind::Actuators => Look::Second,
        ModelKind::Platform | ModelKind::Joints => Look::First,
    }
}

/// Range of several series to plot: all if readable, else around the largest residual.
///
/// Residuals are scaled by each series' own size.
pub(crate) fn worst_part(series: &[Series]) -> Range<usize> {
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

/// Duration of a range and of the whole series, s.
pub(crate) fn durations(series: &Series, part: &Range<usize>) -> (f64, f64) {
    let time = &series.time;
    let at = |index: usize| time.get(index).copied().unwrap_or(0.0);
    let span = |first: usize, last: usize| at(last) - at(first);
    (
        span(part.start, part.end.saturating_sub(1)),
        span(0, time.len().saturating_sub(1)),
    )
}

/// 100 ||measured - predicted||/||measured||; `None` if nothing was measured.
pub(crate) fn relative_error(series: &Series) -> Option<f64> {
    let pairs = series.measured.iter().zip(&series.predicted);
    let residual: Vec<f64> = pairs.map(|(m, p)| m - p).collect();
    let measured = norm(&series.measured);
    (measured > 0.0).then(|| 100.0 * norm(&residual) / measured)
}

fn norm(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum::<f64>().sqrt()
}
