//! Properties of the 95 % interval of a parameter.

use overact_identification::ParameterEstimate;

/// Whether there is an interval; without one, both ends equal the estimate.
fn is_known(one: &ParameterEstimate) -> bool {
    let [low, high] = one.interval_95;
    low.is_finite() && high.is_finite() && low < high
}

/// Whether the estimate is outside its own interval.
///
/// The interval is that of the model with all base parameters; elimination may have moved the
/// estimate.
pub(crate) fn is_outside(one: &ParameterEstimate) -> bool {
    is_known(one) && !contains(one, one.value)
}

/// Whether the interval excludes the true value, if that is known.
pub(crate) fn misses_truth(one: &ParameterEstimate) -> bool {
    is_known(one) && one.true_value.is_some_and(|truth| !contains(one, truth))
}

/// Whether the interval excludes zero.
pub(crate) fn excludes_zero(one: &ParameterEstimate) -> bool {
    is_known(one) && !contains(one, 0.0)
}

/// Half width of the interval in percent of the estimate; `None` without interval or value.
pub(crate) fn half_width_percent(one: &ParameterEstimate) -> Option<f64> {
    let [low, high] = one.interval_95;
    let percent = 50.0 * (high - low) / one.value.abs();
    (is_known(one) && percent.is_finite()).then_some(percent)
}

/// Whether the interval of a parameter contains a value.
fn contains(one: &ParameterEstimate, value: f64) -> bool {
    let [low, high] = one.interval_95;
    (low..=high).contains(&value)
}

#[cfg(test)]
mod tests {
    use super::{excludes_zero, half_width_percent, is_outside, misses_truth};
    use overact_identification::ParameterEstimate;

    fn parameter(value: f64, interval_95: [f64; 2], true_value: Option<f64>) -> ParameterEstimate {
        ParameterEstimate {
            name: String::from("m"),
            unit: String::from("kg"),
            column: 0,
            value,
            standard_deviation: 0.1,
            relative_standard_deviation_percent: 10.0,
            correlated_standard_deviation: 0.1,
            interval_95,
            outside: false,
            true_value,
            error_percent: None,
        }
    }

    #[test]
    fn intervals_are_compared_with_estimate_truth_and_zero() {
        let inside = parameter(2.0, [1.5, 2.5], Some(1.5));
        assert!(!is_outside(&inside) && !misses_truth(&inside));
        assert!(excludes_zero(&inside));
        assert_eq!(half_width_percent(&inside), Some(25.0));
        let outside = parameter(-2.0, [-1.9, -1.5], Some(-1.4));
        assert!(is_outside(&outside) && misses_truth(&outside));
        let unknown = parameter(1.0, [1.0, 1.0], Some(2.0));
        assert!(!is_outside(&unknown) && !misses_truth(&unknown));
        assert_eq!(half_width_percent(&unknown), None);
        let zero = parameter(0.0, [-1.0, 1.0], None);
        assert!(!excludes_zero(&zero));
        assert_eq!(half_width_percent(&zero), None);
    }
}
