//! A forest plot: one row per quantity, its estimates with their uncertainty.

use std::fmt::Write;

use super::{
    WIDTH,
    axis::{Axis, Scale},
    chart::{Look, opening},
    short,
};
use crate::escape::escape;

/// Where the rows begin at the left, and where they end.
const LEFT: f64 = 112.0;
const RIGHT: f64 = WIDTH - 10.0;

/// Heights of the title, of one estimate, of the space between two quantities, and of the axis.
const HEAD: f64 = 26.0;
const BAR: f64 = 13.0;
const GAP: f64 = 7.0;
const FOOT: f64 = 40.0;

/// One estimate of a quantity.
#[derive(Debug, Clone)]
pub(crate) struct Bar {
    /// Whose it is.
    pub(crate) look: Look,
    /// Its value.
    pub(crate) value: f64,
    /// Half the length of the inner, bold bar.
    pub(crate) inner: f64,
    /// Half the length of the outer, thin bar.
    pub(crate) outer: f64,
    /// What it says, for those who can't see it or point at it.
    pub(crate) label: String,
}

/// A forest plot.
#[derive(Debug, Clone)]
pub(crate) struct Forest {
    /// Written above it.
    pub(crate) title: String,
    /// What it shows, for those who can't see it.
    pub(crate) description: String,
    /// The horizontal axis.
    pub(crate) x: Axis,
    /// Name of the quantity and its estimates.
    pub(crate) rows: Vec<(String, Vec<Bar>)>,
}

impl Forest {
    /// The plot as an SVG element.
    pub(crate) fn svg(&self) -> String {
        let bars = || self.rows.iter().flat_map(|(_, bars)| bars);
        let ends = bars().flat_map(|bar| [bar.value - bar.outer, bar.value + bar.outer]);
        let x = self.x.scale(ends, (LEFT, RIGHT), 5, false);
        let height: f64 = self.rows.iter().map(|(_, bars)| row_height(bars)).sum();
        let bottom = HEAD + height;
        let mut svg = opening(WIDTH, bottom + FOOT, &self.title, &self.description);
        svg.push_str(&self.axes(&x, bottom));
        let mut top = HEAD;
        for (name, bars) in &self.rows {
            let middle = top + row_height(bars) / 2.0;
            let _ = write!(
                svg,
                "<text class=\"name\" x=\"{}\" y=\"{}\" text-anchor=\"end\">{}</text>",
                short(LEFT - 8.0),
                short(middle + 4.0),
                escape(name)
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

/// One estimate; nothing where it has no value.
fn drawn(bar: &Bar, x: &Scale, y: f64) -> String {
    let span = |half: f64| Some((x.at(bar.value - half)?, x.at(bar.value + half)?));
    let (Some(at), Some(outer), Some(inner)) = (x.at(bar.value), span(bar.outer), span(bar.inner))
    else {
        return String::new();
    };
    let y = short(y);
    format!(
        "<g class=\"bar {}\"><title>{}</title><path class=\"outer\" d=\"M{} {y}H{}\"/><path class=\"inner\" d=\"M{} {y}H{}\"/><circle cx=\"{}\" cy=\"{y}\" r=\"3.5\"/></g>",
        bar.look.class(),
        escape(&bar.label),
        short(outer.0),
        short(outer.1),
        short(inner.0),
        short(inner.1),
        short(at)
    )
}

#[cfg(test)]
mod tests {
    use super::{Axis, Bar, Forest, Look};

    #[test]
    fn a_forest_is_well_formed_whatever_the_values() {
        let bar = |value, outer| Bar {
            look: Look::First,
            value,
            inner: outer / 2.0,
            outer,
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
