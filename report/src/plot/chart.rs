//! Chart: lines over a horizontal axis.

use std::fmt::Write;

use super::{
    WIDTH,
    axis::{Axis, Scale},
    short,
};
use crate::text::{escape, fitted};

/// Number of characters that fit in one line above a chart.
const TITLE_CHARACTERS: usize = 46;

/// Height of a separate title line, used if the unit needs the line below.
const TITLE_LINE: f64 = 15.0;

/// Height of a chart in SVG units.
const HEIGHT: f64 = 230.0;

/// Position of the axes: left, right, top, bottom.
const FRAME: [f64; 4] = [50.0, WIDTH - 10.0, 26.0, HEIGHT - 40.0];

/// Height of a threshold's name, and its highest position, below the title.
const NAME: f64 = 12.0;
const HIGHEST_NAME: f64 = 28.0;

/// Look of a line; each has a class in the page's style sheet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Look {
    /// Measured series: broad, so that predicted ones can cover it.
    Measured,
    /// Predicted series: thin.
    Predicted,
    /// Residual.
    Residual,
    /// Platform projection, or the only model.
    First,
    /// Actuator projection.
    Second,
    /// A third one.
    Third,
    /// A fourth one.
    Fourth,
    /// A fifth one.
    Fifth,
    /// A sixth one.
    Sixth,
    /// A seventh one.
    Seventh,
    /// All others.
    Other,
}

impl Look {
    /// Number of distinct looks.
    pub(crate) const DISTINCT: usize = 7;

    /// Largest number of equivalent lines in a chart of the page.
    pub(crate) const EQUALS: usize = 4;

    /// Look of the n-th of several equivalent lines.
    pub(crate) const fn nth(index: usize) -> Self {
        match index {
            0 => Self::First,
            1 => Self::Second,
            2 => Self::Third,
            3 => Self::Fourth,
            4 => Self::Fifth,
            5 => Self::Sixth,
            6 => Self::Seventh,
            _ => Self::Other,
        }
    }

    /// CSS class.
    pub(crate) const fn class(self) -> &'static str {
        match self {
            Self::Measured => "measured",
            Self::Predicted => "predicted",
            Self::Residual => "residual",
            Self::First => "first",
            Self::Second => "second",
            Self::Third => "third",
            Self::Fourth => "fourth",
            Self::Fifth => "fifth",
            Self::Sixth => "sixth",
            Self::Seventh => "seventh",
            Self::Other => "other",
        }
    }
}

/// A line of a chart.
#[derive(Debug, Clone)]
pub(crate) struct Line {
    /// Look.
    pub(crate) look: Look,
    /// Label for assistive technology.
    pub(crate) label: String,
    /// Points; one that is not finite interrupts the line.
    pub(crate) points: Vec<(f64, f64)>,
    /// Whether each point has a dot.
    pub(crate) dots: bool,
    /// Whether the points are joined.
    pub(crate) joined: bool,
}

impl Line {
    /// A line without dots.
    pub(crate) fn new(look: Look, label: impl Into<String>, x: &[f64], y: &[f64]) -> Self {
        Self {
            look,
            label: label.into(),
            points: x.iter().copied().zip(y.iter().copied()).collect(),
            dots: false,
            joined: true,
        }
    }

    /// The same points as dots only.
    pub(crate) const fn dots_alone(mut self) -> Self {
        (self.dots, self.joined) = (true, false);
        self
    }

    /// The same line with dots.
    pub(crate) fn with_dots(mut self) -> Self {
        self.dots = true;
        self
    }
}

/// A dashed straight line across a chart.
#[derive(Debug, Clone)]
pub(crate) struct Rule {
    /// Position on its axis.
    pub(crate) value: f64,
    /// Name, written next to it.
    pub(crate) label: String,
    /// Whether it is vertical, at a position of the horizontal axis.
    pub(crate) is_vertical: bool,
}

impl Rule {
    /// Horizontal line at a value.
    pub(crate) fn horizontal(value: f64, label: impl Into<String>) -> Self {
        Self {
            value,
            label: label.into(),
            is_vertical: false,
        }
    }

    /// Vertical line at a position of the horizontal axis.
    pub(crate) fn vertical(value: f64, label: impl Into<String>) -> Self {
        Self {
            is_vertical: true,
            ..Self::horizontal(value, label)
        }
    }
}

/// A chart.
#[derive(Debug, Clone)]
pub(crate) struct Chart {
    /// Title.
    pub(crate) title: String,
    /// Description for assistive technology.
    pub(crate) description: String,
    /// The horizontal axis.
    pub(crate) x: Axis,
    /// The vertical axis.
    pub(crate) y: Axis,
    /// Lines, the last one on top.
    pub(crate) lines: Vec<Line>,
    /// Thresholds.
    pub(crate) rules: Vec<Rule>,
}

impl Chart {
    /// The chart as an SVG element.
    pub(crate) fn svg(&self) -> String {
        let [left, right, top, bottom] = FRAME;
        let points = || self.lines.iter().flat_map(|line| &line.points);
        let rules = |is_vertical: bool| {
            let rules = self.rules.iter();
            let own = rules.filter(move |rule| rule.is_vertical == is_vertical);
            own.map(|rule| rule.value)
        };
        let places = points().map(|point| point.0).chain(rules(true));
        let x = self.x.scale(places, left, right, 6, true);
        let heights = points().map(|point| point.1).chain(rules(false));
        let y = self.y.scale(heights, bottom, top, 5, false);
        let size = PlotSize {
            width: WIDTH,
            height: HEIGHT,
            above: self.above(),
        };
        let mut svg = opening(size, &self.title, &self.description);
        svg.push_str(&self.axes(&x, &y));
        let across = |rule: &&Rule| !rule.is_vertical;
        for rule in &self.rules {
            svg.push_str(&if rule.is_vertical {
                drawn_vertical(rule, &x)
            } else {
                drawn_rule(rule, &y)
            });
        }
        for line in &self.lines {
            svg.push_str(&drawn_line(line, &x, &y));
        }
        let rules: Vec<&Rule> = self.rules.iter().filter(across).collect();
        svg.push_str(&rule_names(&rules, &self.lines, &y));
        svg.push_str("</svg>");
        svg
    }

    /// Extra height above the chart if title and unit do not fit in one line.
    fn above(&self) -> f64 {
        let length = |text: &str| text.chars().count();
        let label_length = length(&self.title) + length(&self.y.label);
        if label_length < TITLE_CHARACTERS || self.y.label.is_empty() {
            0.0
        } else {
            TITLE_LINE
        }
    }

    /// Grid, ticks, labels and title.
    fn axes(&self, x: &Scale, y: &Scale) -> String {
        let [left, right, _, bottom] = FRAME;
        let mut svg = format!(
            "<text class=\"head\" x=\"{}\" y=\"{}\">{}</text>",
            short(left),
            short(15.0 - self.above()),
            escape(&fitted(&self.title, TITLE_CHARACTERS))
        );
        for (value, label) in &y.ticks {
            let Some(at) = y.at(*value) else { continue };
            let _ = write!(
                svg,
                "<path class=\"grid\" d=\"M{} {at:.1}H{}\"/><text class=\"tick\" x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{label}</text>",
                short(left),
                short(right),
                short(left - 5.0),
                at + 4.0
            );
        }
        for (value, label) in &x.ticks {
            let Some(at) = x.at(*value) else { continue };
            let _ = write!(
                svg,
                "<path class=\"mark\" d=\"M{at:.1} {}v4\"/><text class=\"tick\" x=\"{at:.1}\" y=\"{}\" text-anchor=\"middle\">{label}</text>",
                short(bottom),
                short(bottom + 16.0)
            );
        }
        let _ = write!(
            svg,
            "<path class=\"axis\" d=\"M{} {}H{}\"/><text class=\"label\" x=\"{}\" y=\"{}\" text-anchor=\"end\">{}</text><text class=\"label\" x=\"{}\" y=\"15\" text-anchor=\"end\">{}</text>",
            short(left),
            short(bottom),
            short(right),
            short(right),
            short(HEIGHT - 6.0),
            escape(&self.x.label),
            short(right),
            escape(&self.y.label)
        );
        svg
    }
}

/// Size of a plot in SVG units.
#[derive(Clone, Copy)]
pub(super) struct PlotSize {
    pub(super) width: f64,
    pub(super) height: f64,
    /// Extra height above the plot.
    pub(super) above: f64,
}

/// Opening tag of a plot, and names for assistive technology.
pub(super) fn opening(size: PlotSize, title: &str, description: &str) -> String {
    format!(
        "<svg class=\"plot\" viewBox=\"0 {} {} {}\" role=\"img\" xmlns=\"http://www.w3.org/2000/svg\" aria-label=\"{}: {}\"><title>{}</title>",
        short(-size.above),
        short(size.width),
        short(size.height + size.above),
        escape(title),
        escape(description),
        escape(description)
    )
}

/// A threshold.
fn drawn_rule(rule: &Rule, y: &Scale) -> String {
    let [left, right, ..] = FRAME;
    let drawn = |at: f64| {
        let (left, right) = (short(left), short(right));
        format!("<path class=\"rule\" d=\"M{left} {at:.1}H{right}\"/>")
    };
    y.at(rule.value).map_or_else(String::new, drawn)
}

/// Names of thresholds, each at the end of its line with more space, above or below it.
///
/// If another name or the title is already there, the next free position is taken.
fn rule_names(rules: &[&Rule], lines: &[Line], y: &Scale) -> String {
    let [left, right, _, bottom] = FRAME;
    let mut taken: Vec<(bool, f64)> = Vec::new();
    let mut svg = String::new();
    for rule in rules {
        let Some(at) = y.at(rule.value) else { continue };
        let first = is_named_left(at, lines, y);
        let places = [first, !first].map(|side| [(side, at - 4.0), (side, at + NAME)]);
        let is_free = |place: &(bool, f64)| {
            let apart =
                |other: &(bool, f64)| other.0 != place.0 || (other.1 - place.1).abs() >= NAME;
            (HIGHEST_NAME..bottom).contains(&place.1) && taken.iter().all(apart)
        };
        let free = places.as_flattened().iter().find(|place| is_free(place));
        let place = *free.unwrap_or(&places[0][0]);
        taken.push(place);
        let (x, anchor) = if place.0 {
            (left + 2.0, "start")
        } else {
            (right - 2.0, "end")
        };
        let _ = write!(
            svg,
            "<text class=\"tick rule-name\" x=\"{}\" y=\"{:.1}\" text-anchor=\"{anchor}\">{}</text>",
            short(x),
            place.1,
            escape(&rule.label)
        );
    }
    svg
}

/// Whether lines are farther from a threshold at the left end than at the right end.
fn is_named_left(at: f64, lines: &[Line], y: &Scale) -> bool {
    let nearest = |end: fn(&Line) -> Option<&(f64, f64)>| {
        let heights = lines.iter().filter_map(|line| y.at(end(line)?.1));
        heights
            .map(|height| (height - at).abs())
            .fold(f64::INFINITY, f64::min)
    };
    nearest(|line| line.points.first()) > nearest(|line| line.points.last())
}

/// Vertical mark with its name on the side with more space.
fn drawn_vertical(rule: &Rule, x: &Scale) -> String {
    let [left, right, top, bottom] = FRAME;
    let Some(at) = x.at(rule.value) else {
        return String::new();
    };
    let (place, anchor) = if at < 0.5 * (left + right) {
        (at + 4.0, "start")
    } else {
        (at - 4.0, "end")
    };
    format!(
        "<path class=\"rule\" d=\"M{at:.1} {}V{}\"/><text class=\"tick rule-name\" x=\"{}\" y=\"{}\" text-anchor=\"{anchor}\">{}</text>",
        short(top),
        short(bottom),
        short(place),
        short(top + 11.0),
        escape(&rule.label)
    )
}

/// Draws a line with gaps at missing values.
fn drawn_line(line: &Line, x: &Scale, y: &Scale) -> String {
    let place = |point: &(f64, f64)| Some((x.at(point.0)?, y.at(point.1)?));
    let mut path = String::new();
    let mut dots = String::new();
    let mut pen = 'M';
    for point in &line.points {
        let Some((x, y)) = place(point) else {
            pen = 'M';
            continue;
        };
        let (x, y) = (short(x), short(y));
        if line.joined {
            let _ = write!(path, "{pen}{x} {y}");
            pen = 'L';
        }
        if line.dots {
            let _ = write!(dots, "<circle cx=\"{x}\" cy=\"{y}\" r=\"3\"/>");
        }
    }
    format!(
        "<g class=\"line {}\"><title>{}</title><path d=\"{path}\"/>{dots}</g>",
        line.look.class(),
        escape(&line.label)
    )
}

#[cfg(test)]
mod tests {
    use super::{Axis, Chart, Line, Look, Rule};

    fn chart(points: Vec<(f64, f64)>) -> Chart {
        let mut line = Line::new(Look::First, "a <line>", &[], &[]).with_dots();
        line.points = points;
        Chart {
            title: String::from("τ & <b>"),
            description: String::from("what \"it\" shows"),
            x: Axis::linear("t (s)"),
            y: Axis::logarithmic("y (1)"),
            lines: vec![line],
            rules: vec![
                Rule::horizontal(30.0, "limit"),
                Rule::vertical(1.5, "<here>"),
            ],
        }
    }

    #[test]
    fn a_chart_is_well_formed_and_skips_missing_points() {
        let svg = chart(vec![(0.0, 1.0), (1.0, 10.0), (2.0, f64::NAN), (3.0, 4.0)]).svg();
        let document = roxmltree::Document::parse(&svg).expect("XML");
        let path = document
            .descendants()
            .filter(|node| node.attribute("class") == Some("line first"))
            .flat_map(|node| node.descendants())
            .find_map(|node| node.attribute("d"))
            .expect("a line");
        assert_eq!(path.matches('M').count(), 2, "{path}");
        let dots = document
            .descendants()
            .filter(|n| n.has_tag_name(("http://www.w3.org/2000/svg", "circle")));
        assert_eq!(dots.count(), 3);
        let name = document.root_element().attribute("aria-label");
        assert_eq!(name, Some("τ & <b>: what \"it\" shows"));
    }

    #[test]
    fn threshold_labels_do_not_overlap() {
        let mut chart = chart(vec![(0.0, 1.0), (1.0, 1000.0)]);
        let close = [999.0, 10.0, 10.5, 10.9, 11.0];
        chart.rules = close.map(|value| Rule::horizontal(value, "name")).to_vec();
        let svg = chart.svg();
        let document = roxmltree::Document::parse(&svg).expect("XML");
        let names = document
            .descendants()
            .filter(|node| node.attribute("class") == Some("tick rule-name"));
        let places: Vec<(&str, f64)> = names
            .filter_map(|node| Some((node.attribute("x")?, node.attribute("y")?.parse().ok()?)))
            .collect();
        assert_eq!(places.len(), close.len());
        for (index, (side, height)) in places.iter().enumerate() {
            assert!(*height >= super::HIGHEST_NAME, "{places:?}");
            let mut others = places.iter().skip(index + 1);
            assert!(
                !others.any(|(other, own)| other == side && (own - height).abs() < 11.9),
                "{places:?}"
            );
        }
    }

    #[test]
    fn long_titles_are_placed_above_the_unit() {
        let mut chart = chart(vec![(0.0, 1.0), (1.0, 10.0)]);
        assert!(chart.svg().contains("viewBox=\"0 0 400 230\""));
        chart.title = String::from("Residual of the validation run and of others");
        let svg = chart.svg();
        assert!(svg.contains("viewBox=\"0 -15 400 245\""), "{svg}");
        assert!(svg.contains("y=\"0\">Residual of the validation run and of others</text>"));
    }

    #[test]
    fn a_chart_without_data_is_well_formed() {
        let svg = chart(vec![(f64::NAN, f64::INFINITY)]).svg();
        assert!(roxmltree::Document::parse(&svg).is_ok(), "{svg}");
    }
}
