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
