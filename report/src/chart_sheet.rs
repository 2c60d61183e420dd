//! Several charts in one SVG file, for plots of the documentation that examples generate.

use std::fmt::Write;

use crate::{
    plot::{Axis, Chart, Line, Look, Rule},
    text::escape,
};

/// Style sheet of the page, from which colours and plot rules are taken.
const STYLE: &str = include_str!("page/style.css");

/// Size of a chart, height of a key entry, and gap between charts.
const WIDTH: f64 = 400.0;
const HEIGHT: f64 = 230.0;
const ENTRY: f64 = 16.0;
const GAP: f64 = 12.0;

/// A chart of a sheet.
#[derive(Debug, Clone, Default)]
pub struct Plot {
    /// Title.
    pub title: String,
    /// Labels of the horizontal and the vertical axis.
    pub axes: [String; 2],
    /// Whether the vertical axis is logarithmic.
    pub logarithmic: bool,
    /// Lines with name, x and y values; seven have distinct colours.
    pub curves: Vec<(String, Vec<f64>, Vec<f64>)>,
    /// Whether lines are dots only.
    pub dots: bool,
    /// Thresholds: value and name.
    pub rules: Vec<(f64, String)>,
}

impl Plot {
    fn svg(&self) -> String {
        let line = |(index, (name, x, y)): (usize, &(String, Vec<f64>, Vec<f64>))| {
            let line = Line::new(Look::nth(index), name.as_str(), x, y);
            if self.dots { line.dots_alone() } else { line }
        };
        let rules = self.rules.iter();
        let [x, y] = &self.axes;
        let chart = Chart {
            title: self.title.clone(),
            description: self.title.clone(),
            x: Axis::linear(x.as_str()),
            y: if self.logarithmic {
                Axis::logarithmic(y.as_str())
            } else {
                Axis::linear(y.as_str())
            },
            lines: self.curves.iter().enumerate().map(line).collect(),
            rules: rules
                .map(|(height, name)| Rule::horizontal(*height, name.as_str()))
                .collect(),
        };
        chart.svg()
    }
}

/// SVG file with plots in `side_by_side` columns, each with a key if it has several lines.
#[must_use]
pub fn chart_sheet(plots: &[Plot], side_by_side: usize) -> String {
    let entries = plots.iter().map(|plot| plot.curves.len()).max();
    let entries = entries.filter(|count| *count > 1).unwrap_or(0);
    let columns = side_by_side.clamp(1, plots.len().max(1));
    let cell = HEIGHT + ENTRY * entries as f64 + GAP;
    let rows = plots.len().div_ceil(columns);
    let (width, height) = ((WIDTH + GAP) * columns as f64, cell * rows as f64);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\"><style>{}</style><rect width=\"{width}\" height=\"{height}\" fill=\"var(--paper)\"/>",
        style()
    );
    for (number, plot) in plots.iter().enumerate() {
        let x = (WIDTH + GAP) * (number % columns) as f64;
        let y = cell * (number / columns) as f64;
        let place = format!("<svg x=\"{x}\" y=\"{y}\" width=\"{WIDTH}\" height=\"{HEIGHT}\" ");
        svg.push_str(&plot.svg().replacen("<svg ", &place, 1));
        if plot.curves.len() > 1 {
            svg.push_str(&key(plot, x, y + HEIGHT));
        }
    }
    svg + "</svg>\n"
}

/// Key of a plot, one entry per line.
fn key(plot: &Plot, x: f64, y: f64) -> String {
    let mut svg = format!("<g class=\"plot\" transform=\"translate({x} {y})\">");
    for (index, (name, ..)) in plot.curves.iter().enumerate() {
        let (look, height) = (Look::nth(index).class(), ENTRY * (index as f64 + 0.75));
        let middle = height - 4.0;
        let _ = write!(
            svg,
            "<g class=\"line {look}\"><path d=\"M50 {middle}h18\"/></g><text class=\"name\" x=\"74\" y=\"{height}\">{}</text>",
            escape(name)
        );
    }
    svg + "</g>"
}

/// Colours and the rules that concern plots.
fn style() -> String {
    let end = STYLE.find("* {").unwrap_or(0);
    let (colours, rest) = STYLE.split_at(end);
    let plots = rest.lines().filter(|line| line.starts_with(".plot "));
    let plots: Vec<&str> = plots.collect();
    format!("{colours}{}", plots.join("\n"))
}

#[cfg(test)]
mod tests {
    use super::{Plot, chart_sheet};

    #[test]
    fn a_chart_sheet_is_well_formed_and_contains_its_plots() {
        let curve = |name: &str| (name.to_owned(), vec![0.0, 1.0], vec![2.0, f64::NAN]);
        let plot = Plot {
            title: String::from("a < b"),
            curves: vec![curve("one & all"), curve("two")],
            rules: vec![(1.0, String::from("limit"))],
            ..Plot::default()
        };
        let svg = chart_sheet(&[plot.clone(), plot.clone(), plot], 2);
        let document = roxmltree::Document::parse(&svg).expect("XML");
        let plots = document
            .root_element()
            .children()
            .filter(|node| node.has_tag_name(("http://www.w3.org/2000/svg", "svg")));
        assert_eq!(plots.count(), 3);
        assert!(roxmltree::Document::parse(&chart_sheet(&[], 2)).is_ok());
    }
}
