//! Coverage of confidence intervals over independent draws.
//!
//! The coverage is the mean over draws of the fraction of intervals that contain the true value.
//! Parameters of one draw are dependent, but draws are independent. The interval of the coverage is
//! therefore that of a mean of independent fractions, by Student's t distribution.

use crate::{DrawIntervals, Noise, measure::Interval};
use overact_identification::{Estimator, ModelKind, Stage};
use serde::Serialize;
use std::collections::BTreeMap;

/// Coverage in one cell of the table.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Cell {
    /// Name of the robot.
    pub robot: String,
    /// Model of the estimates.
    pub model: ModelKind,
    /// Stage of the estimates.
    pub stage: Stage,
    /// Estimator.
    pub estimator: Estimator,
    /// Percent of the draws in which position errors were found to bias least squares, if tested.
    pub flagged_percent: Option<f64>,
    /// Factors on the description's noise.
    pub noise: Noise,
    /// Number of draws.
    pub draws: usize,
    /// Mean number of parameters.
    pub parameters: f64,
    /// Percent of the intervals that contain the truth.
    pub coverage_percent: f64,
    /// 99.9 % interval of the coverage, percent.
    pub coverage_interval_percent: [f64; 2],
    /// Median width relative to the intervals of the base model.
    pub relative_width: f64,
    /// Root mean square of the errors, each divided by its interval's half width over 1.96.
    ///
    /// It is 1 for intervals of the right width with many degrees of freedom.
    pub spread: f64,
    /// Parameter with the lowest coverage, and that coverage, percent.
    pub worst: (String, f64),
    /// Coverage of each parameter.
    pub each: BTreeMap<String, ParameterCoverage>,
}

/// Coverage of one parameter's intervals.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct ParameterCoverage {
    /// Number of draws in which it was estimated.
    pub draws: usize,
    /// Number of intervals that contain the truth.
    pub covering: usize,
    /// Mean of the errors, each divided by its interval's half width over 1.96.
    pub mean: f64,
    /// Root mean square of these quotients.
    pub spread: f64,
}

impl ParameterCoverage {
    fn new(intervals: &[&Interval]) -> Self {
        let draws = intervals.len();
        let over = |of: &dyn Fn(f64) -> f64| -> f64 {
            let sum: f64 = intervals.iter().map(|one| of(1.96 * one.miss)).sum();
            sum / draws as f64
        };
        Self {
            draws,
            covering: intervals.iter().filter(|one| one.covers).count(),
            mean: over(&|miss| miss),
            spread: over(&|miss| miss * miss).sqrt(),
        }
    }
}

/// Intervals of all draws of one robot.
#[derive(Debug, Default)]
pub struct Tally {
    draws: Vec<Vec<DrawIntervals>>,
}

impl Tally {
    /// Adds a draw.
    pub fn add(&mut self, draw: Vec<DrawIntervals>) {
        self.draws.push(draw);
    }

    /// Cells of all models, stages and noises, in order of appearance.
    #[must_use]
    pub fn cells(&self, robot: &str) -> Vec<Cell> {
        let first = self.draws.first().map_or(&[][..], Vec::as_slice);
        first.iter().map(|key| self.cell(robot, key)).collect()
    }

    fn cell(&self, robot: &str, key: &DrawIntervals) -> Cell {
        let of = |one: &DrawIntervals| (one.noise, one.model, one.stage, one.estimator);
        let same = |one: &&DrawIntervals| of(one) == of(key);
        let own: Vec<&DrawIntervals> = self.draws.iter().flatten().filter(same).collect();
        let fractions: Vec<f64> = own.iter().filter_map(|one| fraction(one)).collect();
        let (coverage, half) = mean(&fractions);
        let all = || own.iter().flat_map(|one| &one.parameters);
        let squares: f64 = all().map(|one| one.miss.powi(2)).sum();
        let mut widths: Vec<f64> = all().map(|one| one.relative_width).collect();
        let mut intervals: BTreeMap<String, Vec<&Interval>> = BTreeMap::new();
        for one in all() {
            intervals.entry(one.name.clone()).or_default().push(one);
        }
        let each = intervals.into_iter();
        let each: BTreeMap<String, ParameterCoverage> = each
            .map(|(name, own)| (name, ParameterCoverage::new(&own)))
            .collect();
        // A parameter that is rarely selected has too few draws.
        let often = each.iter().filter(|(_, one)| 2 * one.draws >= own.len());
        let rates = often.map(|(name, one)| (name.clone(), one.covering as f64 / one.draws as f64));
        let worst = rates.min_by(|a, b| a.1.total_cmp(&b.1));
        let worst = worst.unwrap_or((String::new(), f64::NAN));
        Cell {
            robot: robot.to_owned(),
            model: key.model,
            stage: key.stage,
            estimator: key.estimator,
            flagged_percent: flagged(&own),
            noise: key.noise,
            draws: own.len(),
            parameters: all().count() as f64 / own.len() as f64,
            coverage_percent: 100.0 * coverage,
            coverage_interval_percent: [
                100.0 * (coverage - half).max(0.0),
                100.0 * (coverage + half).min(1.0),
            ],
            relative_width: median(&mut widths),
            spread: 1.96 * (squares / all().count() as f64).sqrt(),
            worst: (worst.0, 100.0 * worst.1),
            each,
        }
    }
}

/// Percent of the tested draws in which position errors bias least squares.
fn flagged(draws: &[&DrawIntervals]) -> Option<f64> {
    let tested: Vec<bool> = draws.iter().filter_map(|one| one.flagged).collect();
    let count = tested.iter().filter(|flagged| **flagged).count();
    (!tested.is_empty()).then(|| 100.0 * count as f64 / tested.len() as f64)
}

/// Fraction of a draw's intervals that contain the true value; `None` without intervals.
fn fraction(one: &DrawIntervals) -> Option<f64> {
    let count = one.parameters.len();
    let covering = one.parameters.iter().filter(|one| one.covers).count();
    (count > 0).then(|| covering as f64 / count as f64)
}

/// Mean of independent values, and half width of its 99.9 % interval.
fn mean(values: &[f64]) -> (f64, f64) {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    let deviation = (squares / (count - 1.0) / count).sqrt();
    (mean, quantile_999(count - 1.0) * deviation)
}

/// Two-sided 99.9 % quantile of Student's t distribution.
///
/// First terms of the expansion about the normal distribution (Abramowitz and Stegun 26.7.5),
/// accurate to 1 % from 10 degrees of freedom on.
fn quantile_999(freedom: f64) -> f64 {
    let x = 3.290_526_731_491_896_f64;
    let terms = [
        (x.powi(3) + x) / 4.0,
        (5.0 * x.powi(5) + 16.0 * x.powi(3) + 3.0 * x) / 96.0,
        (3.0 * x.powi(7) + 19.0 * x.powi(5) + 17.0 * x.powi(3) - 15.0 * x) / 384.0,
    ];
    let mut power = 1.0;
    terms.iter().fold(x, |sum, term| {
        power *= freedom;
        sum + term / power
    })
}

/// Middle value; the upper one of an even number.
fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}
