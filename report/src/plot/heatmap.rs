//! Heat map: the lower triangle of a symmetric matrix of numbers from -1 to 1.

use std::fmt::Write;

use super::{
    WIDTH,
    chart::{PlotSize, opening},
    short,
};
use crate::text::{escape, fitted};

/// Left end of the cells, and their right end.
const LEFT: f64 = 112.0;
const RIGHT: f64 = WIDTH - 10.0;

/// Height above the cells and below them.
const HEAD: f64 = 26.0;
const FOOT: f64 = 10.0;

/// Largest side of a cell, and largest size of a name.
const LARGEST_CELL: f64 = 40.0;
const LARGEST_NAME: f64 = 11.5;

/// Largest number of characters of a name.
const NAME_CHARACTERS: usize = 16;

/// Magnitude below which a cell is empty.
const FAINT: f64 = 0.05;

/// A heat map.
#[derive(Debug, Clone)]
pub(crate) struct Heatmap<'a> {
    /// Title.
    pub(crate) title: String,
    /// Description for assistive technology.
    pub(crate) description: String,
    /// Names of rows and columns.
    pub(crate) names: &'a [String],
    /// Rows of the matrix.
    pub(crate) rows: &'a [Vec<f64>],
}

impl Heatmap<'_> {
    /// The plot as an SVG element.
    pub(crate) fn svg(&self) -> String {
        let count = self.names.len().max(1) as f64;
        let cell = ((RIGHT - LEFT) / count).min(LARGEST_CELL);
        let size = PlotSize {
            width: WIDTH,
            height: HEAD + cell * count + FOOT,
            above: 0.0,
        };
        let mut svg = opening(size, &self.title, &self.description);
        let _ = write!(
            svg,
            "<text class=\"head\" x=\"4\" y=\"15\">{}</text>",
            escape(&self.title)
        );
        for (index, (name, row)) in self.names.iter().zip(self.rows).enumerate() {
            let top = HEAD + cell * index as f64;
            let font = (0.9 * cell).min(LARGEST_NAME);
            let _ = write!(
                svg,
                "<text class=\"name\" style=\"font-size:{}px\" x=\"{}\" y=\"{}\" text-anchor=\"end\">{}</text>",
                short(font),
                short(LEFT - 6.0),
                short(top + cell / 2.0 + 0.35 * font),
                escape(&fitted(name, NAME_CHARACTERS))
            );
            for (column, value) in row.iter().enumerate().take(index + 1) {
                svg.push_str(&self.cell(name, column, *value, [top, cell]));
            }
        }
        svg + "</svg>"
    }

    /// A cell; `place` is its top and its side. Faint ones are empty.
    fn cell(&self, name: &str, column: usize, value: f64, place: [f64; 2]) -> String {
        let [top, side] = place;
        if !value.is_finite() || value.abs() < FAINT {
            return String::new();
        }
        let other = self.names.get(column).map_or("", String::as_str);
        let class = if value > 0.0 { "positive" } else { "negative" };
        format!(
            "<rect class=\"{class}\" x=\"{:.1}\" y=\"{top:.1}\" width=\"{:.1}\" height=\"{:.1}\" fill-opacity=\"{:.2}\"><title>{}, {}: {value:.2}</title></rect>",
            LEFT + side * column as f64,
            0.92 * side,
            0.92 * side,
            value.abs().min(1.0),
            escape(name),
            escape(other)
        )
    }
}

#[cfg(test)]
mod tests {
    use super::Heatmap;

    #[test]
    fn a_heat_map_is_well_formed_and_has_the_lower_triangle() {
        let names = ["<a>", "b"].map(String::from);
        let rows = vec![vec![1.0, -0.7], vec![-0.7, f64::NAN]];
        let svg = Heatmap {
            title: String::from("correlation"),
            description: String::from("of & all"),
            names: &names,
            rows: &rows,
        }
        .svg();
        let document = roxmltree::Document::parse(&svg).expect("XML");
        let classes: Vec<String> = { document.descendants() }
            .filter(|node| node.tag_name().name() == "rect")
            .filter_map(|node| node.attribute("class").map(str::to_owned))
            .collect();
        assert_eq!(classes, ["positive", "negative"]);
    }
}
