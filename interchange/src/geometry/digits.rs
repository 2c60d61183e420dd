//! Formats numbers with the digits of the file, despite rounding in between.

use super::exact::fifteenths;
use std::f64::consts::PI;

/// Rounding error to allow for, relative to the number's magnitude.
const ROUNDING: f64 = 4e-15;

/// Lengths and angles below this are rounding errors, m and rad.
const NOTHING: f64 = 1e-13;

/// Shortest decimal within the rounding error of a number.
#[must_use]
pub(crate) fn decimal(value: f64) -> String {
    let slack = ROUNDING * value.abs().clamp(0.05, 1e6);
    if is_zero(value) {
        return "0".to_owned();
    }
    relative(value, slack)
}

/// Shortest decimal within the rounding error relative to `scale`, for numbers of any magnitude.
///
/// A value that is not larger than the rounding error is zero.
#[must_use]
pub(crate) fn fine(value: f64, scale: f64) -> String {
    let slack = ROUNDING * scale.abs();
    if value.abs() <= slack {
        return "0".to_owned();
    }
    relative(value, slack.min(1e-15 * value.abs()))
}

fn relative(value: f64, slack: f64) -> String {
    for digits in 0..17 {
        let text = format!("{value:.digits$e}");
        let near = |read: f64| (read - value).abs() <= slack;
        if text.parse::<f64>().is_ok_and(near) {
            return plain(&text);
        }
    }
    plain(&format!("{value:e}"))
}

/// Replaces scientific notation by positional notation if that is short.
fn plain(text: &str) -> String {
    let value: f64 = text.parse().unwrap_or(0.0);
    let usual = format!("{value}");
    match (1e-5..1e7).contains(&value.abs()) {
        true if !usual.contains('.') => format!("{usual}.0"),
        true => usual,
        false => text.to_owned(),
    }
}

/// Angle as a TOML value: degrees for multiples of 15° and round degrees.
#[must_use]
pub(crate) fn angle(value: f64) -> String {
    if let Some(k) = fifteenths(value, 1e-12) {
        return format!("{} deg", 15 * k);
    }
    let degrees = decimal(value * (180.0 / PI));
    let radians = decimal(value);
    if degrees.len() <= 7 && radians.len() > degrees.len() {
        format!("{} deg", degrees.trim_end_matches(".0"))
    } else {
        radians
    }
}

/// Whether a number is zero up to rounding.
#[must_use]
pub(crate) fn is_zero(value: f64) -> bool {
    value.abs() <= NOTHING
}

#[cfg(test)]
mod tests {
    use super::{angle, decimal, fine};

    #[test]
    fn rounding_errors_are_removed_from_decimals() {
        assert_eq!(decimal(0.1 + 0.2), "0.3");
        assert_eq!(decimal(1.0 - 0.88), "0.12");
        assert_eq!(decimal(-2.775e-17), "0");
        assert_eq!(decimal(0.123_456_789_012_3), "0.1234567890123");
        assert_eq!(fine(7.20807e-8, 1e-7), "7.20807e-8");
        assert_eq!(fine(163.624_617_374_468_44, 163.0), "163.6246173744684");
    }

    #[test]
    fn round_angles_are_written_in_degrees() {
        assert_eq!(angle(-std::f64::consts::FRAC_PI_2), "-90 deg");
        assert_eq!(angle(37.5_f64.to_radians()), "37.5 deg");
        assert_eq!(angle(0.45), "0.45");
    }
}
