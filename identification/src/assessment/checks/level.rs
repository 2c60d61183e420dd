//! False-alarm rate of a report and its division among the tests.
//!
//! By Bonferroni's inequality, each family of tests has an equal part of the rate, and each test of
//! a family an equal part of that.

/// Fraction of reports on faultless data with a false alarm, at most.
pub(crate) const FALSE_ALARMS: f64 = 0.01;

/// Number of test families.
///
/// They are: closure, delay, smoothing, friction at reversals, clock, gains, geometry, labels,
/// missing parameters, validation runs, regressor errors, residual correlation.
const FAMILIES: f64 = 12.0;

/// Level of each test in a family of `tests`.
pub(crate) fn level(tests: usize) -> f64 {
    FALSE_ALARMS / FAMILIES / tests.max(1) as f64
}

/// States the origin of a threshold at this level.
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
