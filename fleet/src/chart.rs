//! Control charts: tests whether a parameter of a robot drifts.
//!
//! Each robot has one estimate of each parameter per day. Their scatter from day to day contains
//! all disturbances, so no noise model is needed. A line χ = a + b t is fitted to the days so far,
//! and b is tested with Student's t distribution with n − 2 degrees of freedom.
//!
//! The false alarm rate is divided by the number of looks and of parameters (Bonferroni). It thus
//! bounds the probability that a robot without drift raises any alarm, if its days are independent
//! and normal.

use overact_identification::factors::student_tail;
use serde::Serialize;
use std::collections::BTreeMap;

/// Estimate of a robot on a day.
#[derive(Debug, Clone, PartialEq)]
pub struct Point {
    /// Serial number of the robot.
    pub serial: String,
    /// Days since the first day of the fleet.
    pub day: f64,
    /// Parameters by name.
    pub values: BTreeMap<String, f64>,
}

/// Settings of the control charts.
#[derive(Debug, Clone, PartialEq)]
pub struct Rule {
    /// Bound on the probability of any alarm for a robot without drift.
    pub false_alarms: f64,
    /// Parameters to watch; all if empty.
    pub parameters: Vec<String>,
    /// Days between looks.
    pub every: f64,
}

impl Default for Rule {
    fn default() -> Self {
        Self {
            false_alarms: 0.01,
            parameters: Vec::new(),
            every: 7.0,
        }
    }
}

impl Rule {
    /// End of each look, in days.
    #[must_use]
    pub fn looks(&self, points: &[Point]) -> Vec<f64> {
        let last = points.iter().map(|own| own.day).fold(0.0, f64::max);
        let looks = (0..).map(|look| f64::from(look + 1) * self.every - 0.5);
        let mut looks: Vec<f64> = looks.take_while(|look| *look < last).collect();
        looks.push(last);
        looks
    }
}

/// Parameter of a robot over the days.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Chart {
    /// Serial number of the robot.
    pub serial: String,
    /// The parameter.
    pub parameter: String,
    /// Days and values.
    pub days: Vec<(f64, f64)>,
    /// Change of the fitted line over all days, in percent of its mean.
    pub change_percent: f64,
    /// Smallest p-value of the slope over all looks.
    pub probability: f64,
    /// End of the first look with an alarm, in days.
    pub alarm: Option<f64>,
}

/// Slope of a line through the days, and its two-sided p-value.
fn slope(days: &[(f64, f64)]) -> Option<(f64, f64)> {
    let count = days.len() as f64;
    if days.len() < 4 {
        return None;
    }
    let mean = |of: fn(&(f64, f64)) -> f64| days.iter().map(of).sum::<f64>() / count;
    let (t, y) = (mean(|own| own.0), mean(|own| own.1));
    let spread: f64 = days.iter().map(|own| (own.0 - t).powi(2)).sum();
    let slope = days
        .iter()
        .map(|own| (own.0 - t) * (own.1 - y))
        .sum::<f64>()
        / spread;
    let rest = |own: &(f64, f64)| (own.1 - y - slope * (own.0 - t)).powi(2);
    let variance = days.iter().map(rest).sum::<f64>() / (count - 2.0);
    let deviation = (variance / spread).sqrt();
    let ratio = slope / deviation;
    ratio
        .is_finite()
        .then(|| (slope, student_tail(ratio, count - 2.0)))
}

/// Charts of all robots, sorted by alarm and then by p-value.
#[must_use]
pub fn charts(points: &[Point], rule: &Rule) -> Vec<Chart> {
    let mut series: BTreeMap<(&str, &str), Vec<(f64, f64)>> = BTreeMap::new();
    for point in points {
        for (name, value) in &point.values {
            if rule.parameters.is_empty() || rule.parameters.contains(name) {
                let own = series.entry((&point.serial, name)).or_default();
                own.push((point.day, *value));
            }
        }
    }
    let parameters = series.keys().map(|(_, name)| *name);
    let parameters = parameters.collect::<std::collections::BTreeSet<_>>().len();
    let looks = rule.looks(points);
    let limit = rule.false_alarms / (looks.len() * parameters.max(1)) as f64;
    let mut charts: Vec<Chart> = { series.into_iter() }
        .map(|((serial, parameter), days)| chart(serial, parameter, days, &looks, limit))
        .collect();
    let order = |own: &Chart| (own.alarm.is_none(), own.probability);
    charts.sort_by(|a, b| {
        let (a, b) = (order(a), order(b));
        a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
    });
    charts
}

/// Chart of one parameter; a p-value below `limit` at one of the `looks` is an alarm.
fn chart(
    serial: &str,
    parameter: &str,
    mut days: Vec<(f64, f64)>,
    looks: &[f64],
    limit: f64,
) -> Chart {
    days.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (mut probability, mut alarm) = (1.0_f64, None);
    for look in looks {
        let so_far = days.iter().take_while(|own| own.0 <= *look).count();
        if let Some((_, own)) = slope(&days[..so_far]) {
            probability = probability.min(own);
            if own < limit && alarm.is_none() {
                alarm = Some(*look);
            }
        }
    }
    let mean = days.iter().map(|own| own.1).sum::<f64>() / days.len().max(1) as f64;
    let span = days.last().map_or(0.0, |own| own.0) - days.first().map_or(0.0, |own| own.0);
    let change = slope(&days).map_or(0.0, |(slope, _)| slope * span);
    Chart {
        serial: serial.to_owned(),
        parameter: parameter.to_owned(),
        days,
        change_percent: 100.0 * change / mean.abs(),
        probability,
        alarm,
    }
}

/// Parameter of a robot that differs from that of the others.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Outlier {
    /// Serial number of the robot.
    pub serial: String,
    /// The parameter.
    pub parameter: String,
    /// Median over the days.
    pub value: f64,
    /// Median over all robots.
    pub fleet: f64,
    /// Distance from that in robust standard deviations of the fleet (median absolute deviation).
    pub deviations: f64,
}

fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    match values.len() {
        0 => f64::NAN,
        count if count % 2 == 1 => values[middle],
        _ => 0.5 * (values[middle - 1] + values[middle]),
    }
}

/// Median absolute deviation of the standard normal distribution.
const MAD: f64 = 0.674_489_750_196_082;

/// Robots farther than `beyond` robust standard deviations from the fleet's median, the farthest
/// first.
#[must_use]
pub fn outliers(charts: &[Chart], beyond: f64) -> Vec<Outlier> {
    let mut of: BTreeMap<&str, Vec<(&str, f64)>> = BTreeMap::new();
    for chart in charts {
        let mut values: Vec<f64> = chart.days.iter().map(|own| own.1).collect();
        let own = of.entry(&chart.parameter).or_default();
        own.push((&chart.serial, median(&mut values)));
    }
    let mut found = Vec::new();
    for (parameter, robots) in of {
        let fleet = median(&mut robots.iter().map(|own| own.1).collect::<Vec<_>>());
        let mut off: Vec<f64> = robots.iter().map(|own| (own.1 - fleet).abs()).collect();
        let deviation = median(&mut off) / MAD;
        for (serial, value) in robots {
            let deviations = (value - fleet) / deviation;
            if deviations.is_finite() && deviations.abs() > beyond {
                found.push(Outlier {
                    serial: serial.to_owned(),
                    parameter: parameter.to_owned(),
                    value,
                    fleet,
                    deviations,
                });
            }
        }
    }
    found.sort_by(|a, b| b.deviations.abs().total_cmp(&a.deviations.abs()));
    found
}

#[cfg(test)]
mod tests {
    use super::{Point, Rule, charts, outliers};
    use std::collections::BTreeMap;

    /// Robots with one value per day: 1 with a standard deviation of 2 %, times a given drift.
    fn fleet(robots: usize, drift: &dyn Fn(usize, usize) -> f64) -> Vec<Point> {
        let mut state = 12345_u64;
        let mut uniform = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        let mut normal = || (0..12).map(|_| uniform()).sum::<f64>() - 6.0;
        let days = (0..robots).flat_map(|robot| (0..30).map(move |day| (robot, day)));
        days.map(|(robot, day)| {
            let value = |drift: f64, noise: f64| (1.0 + drift) * (1.0 + 0.02 * noise);
            let values = [
                ("a", value(drift(robot, day), normal())),
                ("b", value(0.0, normal())),
            ];
            Point {
                serial: format!("R{robot:04}"),
                day: day as f64,
                values: BTreeMap::from(values.map(|(name, value)| (name.to_owned(), value))),
            }
        })
        .collect()
    }

    #[test]
    fn false_alarms_have_the_stated_rate() {
        let points = fleet(2000, &|_, _| 0.0);
        let rule = Rule {
            false_alarms: 0.05,
            ..Rule::default()
        };
        let alarmed = charts(&points, &rule)
            .iter()
            .filter(|own| own.alarm.is_some())
            .count();
        // At most 100 of 2000 on average; looks share days and are dependent, so fewer.
        assert!((30..=125).contains(&alarmed), "{alarmed}");
    }

    #[test]
    fn drifts_are_detected_and_listed_first() {
        let drift = |robot: usize, day: usize| match robot {
            0..10 => 0.10 * day.saturating_sub(10).min(10) as f64 / 10.0,
            _ => 0.0,
        };
        let found = charts(&fleet(100, &drift), &Rule::default());
        assert_eq!(found.len(), 200);
        for own in &found[..10] {
            assert!(
                own.serial.as_str() < "R0010" && own.parameter == "a",
                "{own:?}"
            );
            assert!(own.alarm.is_some_and(|day| day > 12.0), "{own:?}");
            assert!((5.0..20.0).contains(&own.change_percent), "{own:?}");
        }
    }

    #[test]
    fn outlying_robots_are_reported() {
        let points = fleet(50, &|robot, _| if robot == 7 { 0.2 } else { 0.0 });
        let found = outliers(&charts(&points, &Rule::default()), 6.0);
        assert_eq!(found.len(), 1, "{found:?}");
        assert_eq!(
            (found[0].serial.as_str(), found[0].parameter.as_str()),
            ("R0007", "a")
        );
    }
}
