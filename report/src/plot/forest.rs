//! Forest plot: one row per quantity, its estimates with their intervals.

use std::fmt::Write;

use super::{
    WIDTH,
    axis::{Axis, Scale},
    chart::{Look, PlotSize, opening},
    short,
};
use crate::text::{escape, fitted};

/// Left and right end of the rows.
const LEFT: f64 = 112.0;
const RIGHT: f64 = WIDTH - 10.0;

/// Largest number of characters of a row's name.
const NAME_CHARACTERS: usize = 16;

/// Heights of the title, of one estimate, of the gap between quantities, and of the axis.
const HEAD: f64 = 26.0;
const BAR: f64 = 13.0;
const GAP: f64 = 7.0;
const FOOT: f64 = 40.0;

/// One estimate of a quantity.
#[derive(Debug, Clone)]
pub(crate) struct Bar {
    /// Look.
    pub(crate) look: Look,
    /// Value.
    pub(crate) value: f64,
    /// Ends of the interval.
    pub(crate) interval: [f64; 2],
    /// Another estimate of the same quantity, drawn as a cross.
    pub(crate) other: Option<f64>,
    /// Description for assistive technology and as a tooltip.
    pub(crate) label: String,
}

impl Bar {
    /// All values that it shows.
    fn values(&self) -> impl Iterator<Item = f64> {
        let [low, high] = self.interval;
        [self.value, low, high].into_iter().chain(self.other)
    }

    /// Largest magnitude of its values; infinite if one is not finite.
    pub(crate) fn reach(&self) -> f64 {
        self.values().fold(0.0, |reach, value| {
            if value.is_finite() {
                value.abs().max(reach)
            } else {
                f64::INFINITY
            }
        })
    }
}

/// A forest plot.
#[derive(Debug, Clone)]
pub(crate) struct Forest {
    /// Title.
    pub(crate) title: String,
    /// Description for assistive technology.
    pub(crate) description: String,
    /// The horizontal axis.
    pub(crate) x: Axis,
    /// Name of the quantity and its estimates.
    pub(crate) rows: Vec<(String, Vec<Bar>)>,
}

impl Forest {
    /// The plot as an SVG element.
    pub(crate) fn svg(&self) -> String {
        let bars = self.rows.iter().flat_map(|(_, bars)| bars);
        let ends = bars.flat_map(Bar::values);
        let x = self.x.scale(ends, LEFT, RIGHT, 5, false);
        let height: f64 = self.rows.iter().map(|(_, bars)| row_height(bars)).sum();
        let bottom = HEAD + height;
        let size = PlotSize {
            width: WIDTH,
            height: bottom + FOOT,
            above: 0.0,
        };
        let mut svg = opening(size, &self.title, &self.description);
        svg.push_str(&self.axes(&x, bottom));
        let mut top = HEAD;
        for (name, bars) in &self.rows {
            let middle = top + row_height(bars) / 2.0;
            let _ = write!(
                svg,
                "<text class=\"name\" x=\"{}\" y=\"{}\" text-anchor=\"end\">{}</text>",
                short(LEFT - 8.0),
                short(middle + 4.0),
                escape(&fitted(name, NAME_CHARACTERS))
            );
            for (index, bar) in bars.iter().enumerate() {
                let y = top + GAP / 2.0 + BAR * (index as f64 + 0.5);
                svg.push_str(&drawn(bar, &x, y));
            }
            top += row_height(bars);
        }
        svg.push_str("</svg>");
        svg
    }

    /// Grid, ticks, label and title.
    fn axes(&self, x: &Scale, bottom: f64) -> String {
        let mut svg = format!(
            "<text class=\"head\" x=\"4\" y=\"15\">{}</text>",
            escape(&self.title)
        );
        for (value, label) in &x.ticks {
            let Some(at) = x.at(*value) else { continue };
            let class = if *value == 0.0 { "axis" } else { "grid" };
            let _ = write!(
                svg,
                "<path class=\"{class}\" d=\"M{at:.1} {}V{}\"/><text class=\"tick\" x=\"{at:.1}\" y=\"{}\" text-anchor=\"middle\">{label}</text>",
                short(HEAD),
                short(bottom),
                short(bottom + 16.0)
            );
        }
        let _ = write!(
            svg,
            "<text class=\"label\" x=\"{}\" y=\"{}\" text-anchor=\"end\">{}</text>",
            short(RIGHT),
            short(bottom + FOOT - 6.0),
            escape(&self.x.label)
        );
        svg
    }
}

/// Height of one quantity.
fn row_height(bars: &[Bar]) -> f64 {
    GAP + BAR * bars.len().max(1) as f64
}

/// Draws one estimate; empty if it has no value.
fn drawn(bar: &Bar, x: &Scale, y: f64) -> String {
    let [low, high] = bar.interval;
    let (Some(at), Some(low), Some(high)) = (x.at(bar.value), x.at(low), x.at(high)) else {
        return String::new();
    };
    let height = short(y);
    let mut svg = format!(
        "<g class=\"bar {}\"><title>{}</title><path d=\"M{} {height}H{}\"/><circle cx=\"{}\" cy=\"{height}\" r=\"3.5\"/>",
        bar.look.class(),
        escape(&bar.label),
        short(low),
        short(high),
        short(at)
    );
    if let Some(other) = bar.other.and_then(|value| x.at(value)) {
        let _ = write!(
            svg,
            "<path class=\"cross\" d=\"M{} {}l7 7m0 -7l-7 7\"/>",
            short(other - 3.5),
            short(y - 3.5)
        );
    }
    svg + "</g>"
}

#[cfg(test)]
mod tests {
    use super::{Axis, Bar, Forest, Look};

    #[test]
    fn forest_plots_with_extreme_values_are_well_formed() {
        let bar = |value: f64, half: f64| Bar {
            look: Look::First,
            value,
            interval: [value - half, value + half],
            other: Some(value + 2.0 * half),
            label: String::from("1 < 2 & 3"),
        };
        let forest = Forest {
            title: String::from("Parameters"),
            description: String::from("error bars"),
            x: Axis::linear("%"),
            rows: vec![
                (
                    String::from("<m>"),
                    vec![bar(1.0, 2.0), bar(f64::NAN, f64::INFINITY)],
                ),
                (String::from("empty"), Vec::new()),
            ],
        };
        let svg = forest.svg();
        let document = roxmltree::Document::parse(&svg).expect("XML");
        let drawn = document
            .descendants()
            .filter(|node| node.attribute("class") == Some("bar first"));
        assert_eq!(drawn.count(), 1);
    }
}
