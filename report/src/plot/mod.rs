//! Plots as SVG text: axes with round ticks, lines, bars of uncertainty.
//!
//! A plot has no colours and no fonts of its own: its classes take them from the page's style sheet,
//! which knows light and dark. Its width is [`WIDTH`] units, close to that of a telephone, so that its
//! text keeps its size there; wider screens set plots side by side.

mod axis;
mod chart;
mod forest;

pub(super) use axis::{Axis, power_of_ten};
pub(super) use chart::{Chart, Line, Look, Rule};
pub(super) use forest::{Bar, Forest};

/// Width of every plot in SVG units.
const WIDTH: f64 = 400.0;

/// A coordinate with one decimal, which is a tenth of a unit and finer than a screen.
fn short(value: f64) -> String {
    let text = format!("{value:.1}");
    let text = text.strip_suffix(".0").unwrap_or(&text);
    if text == "-0" { "0" } else { text }.to_owned()
}

/// A text of so many characters at most: what is too long loses its middle, since names differ at their
/// ends.
fn fitted(text: &str, most: usize) -> String {
    let length = text.chars().count();
    if length <= most {
        return text.to_owned();
    }
    let kept = most.max(3) - 1;
    let (first, last) = (kept.div_ceil(2), kept / 2);
    let begin = text.chars().take(first);
    let end = text.chars().skip(length - last);
    begin.chain(['…']).chain(end).collect()
}

#[cfg(test)]
mod tests {
    use super::fitted;

    #[test]
    fn a_long_name_keeps_its_ends() {
        assert_eq!(fitted("fs_1_leg1", 9), "fs_1_leg1");
        assert_eq!(fitted("fs_1_shoulder_left", 9), "fs_1…left");
        assert_eq!(fitted("αβγδεζ", 4), "αβ…ζ");
        assert_eq!(fitted("abcdef", 0), "a…f");
    }
}
