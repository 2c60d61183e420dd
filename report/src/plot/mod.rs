//! Plots as SVG text: axes with round ticks, lines, intervals.
//!
//! Plots have no colours and fonts of their own but classes of the page's style sheet, which
//! supports light and dark mode. Their width is [`WIDTH`] units, close to that of a telephone, so
//! that text keeps its size there. Wider screens show plots in several columns.

mod axis;
mod chart;
mod forest;
mod heatmap;

pub(super) use axis::{Axis, power_of_ten};
pub(super) use chart::{Chart, Line, Look, Rule};
pub(super) use forest::{Bar, Forest};
pub(super) use heatmap::Heatmap;

/// Width of every plot in SVG units.
const WIDTH: f64 = 400.0;

/// Coordinate with one decimal, finer than a screen.
fn short(value: f64) -> String {
    let text = format!("{value:.1}");
    let text = text.strip_suffix(".0").unwrap_or(&text);
    if text == "-0" { "0" } else { text }.to_owned()
}
