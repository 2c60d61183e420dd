//! Formats numbers with a few significant digits.

/// A number with `digits` significant digits, without trailing zeros.
///
/// Decimal if that is short; scientific for very small and very large numbers.
#[must_use]
pub fn significant(value: f64, digits: usize) -> String {
    if !value.is_finite() {
        return String::from(if value.is_nan() {
            "undefined"
        } else {
            "infinite"
        });
    }
    if value == 0.0 {
        return String::from("0");
    }
    let digits = digits.max(1);
    let scientific = format!("{value:.*e}", digits - 1);
    // Rounding may change the power of ten, so use the exponent of the rounded number.
    let exponent: i32 = scientific
        .split_once('e')
        .and_then(|(_, exponent)| exponent.parse().ok())
        .unwrap_or(0);
    if !(-4..9).contains(&exponent) {
        return scientific;
    }
    let decimals = (digits as i32 - 1 - exponent).max(0) as usize;
    let text = format!("{value:.decimals$}");
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

#[cfg(test)]
mod tests {
    use super::significant;

    #[test]
    fn numbers_are_rounded_to_significant_digits() {
        assert_eq!(significant(95.108_935_08, 6), "95.1089");
        assert_eq!(significant(9.999_99e-3, 3), "0.01");
        assert_eq!(significant(-2.5e-7, 3), "-2.50e-7");
        assert_eq!(significant(1234.5, 3), "1234");
        assert_eq!(significant(f64::INFINITY, 3), "infinite");
    }
}
