//! How often a report on faultless data may raise a false alarm.
//!
//! The checks with a statistic of known distribution share one rate, by Bonferroni's inequality: each
//! family of tests has an equal part of it, and within a family each test.

/// The part of the reports on faultless data that may have a false alarm.
pub(crate) const FALSE_ALARMS: f64 = 0.01;

/// Families of tests: closure, delay, smoothing, friction at reversals, clock, gains, geometry, labels, missing parameters, held-out runs,
/// errors in the regressor, residuals that hang together.
const FAMILIES: f64 = 12.0;

/// The level of each of so many tests of a family.
pub(crate) fn level(tests: usize) -> f64 {
    FALSE_ALARMS / FAMILIES / tests.max(1) as f64
}

/// Where a threshold comes from that keeps this level.
pub(crate) fn origin(tests: usize) -> String {
    let rate = 100.0 * FALSE_ALARMS;
    let tests = match tests {
        1 => String::from("one test"),
        count => format!("{count} tests"),
    };
    format!(
        "false alarms in {rate} % of all reports, shared by {FAMILIES} families of checks, this one of {tests} (Bonferroni)"
    )
}
