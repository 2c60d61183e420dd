//! Pieces of the page: escaped text, tables, figures, sections. All of it is XML, too, so that a test
//! can parse it.

use std::fmt::Write;

use crate::{escape::escape, plot::power_of_ten};
use overact_identification::significant;

/// A cell of a table.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Cell {
    html: String,
    class: &'static str,
    span: usize,
}

impl Cell {
    /// A text.
    pub(super) fn text(text: &str) -> Self {
        Self::markup(escape(text))
    }

    /// A piece of markup.
    pub(super) const fn markup(html: String) -> Self {
        Self {
            html,
            class: "",
            span: 1,
        }
    }

    /// A number, aligned to the right.
    pub(super) fn number(text: impl AsRef<str>) -> Self {
        Self::text(&text.as_ref().replace('-', "−")).class("n")
    }

    /// A number with so many digits; a dash where there is none.
    pub(super) fn digits(value: Option<f64>, digits: usize) -> Self {
        match value {
            Some(value) => Self::number(significant(value, digits)),
            None => Self::nothing(),
        }
    }

    /// Where there is no value.
    pub(super) fn nothing() -> Self {
        Self::text("–").class("n none")
    }

    /// The same cell with another class.
    pub(super) const fn class(mut self, class: &'static str) -> Self {
        self.class = class;
        self
    }

    /// The same cell over several columns.
    pub(super) const fn over(mut self, columns: usize) -> Self {
        self.span = columns;
        self
    }

    fn element(&self, name: &str, scope: &str) -> String {
        let mut tag = format!("<{name}");
        if !scope.is_empty() {
            let _ = write!(tag, " scope=\"{scope}\"");
        }
        if !self.class.is_empty() {
            let _ = write!(tag, " class=\"{}\"", self.class);
        }
        if self.span > 1 {
            let _ = write!(tag, " colspan=\"{}\"", self.span);
        }
        format!("{tag}>{}</{name}>", self.html)
    }
}

/// A table with headers.
#[derive(Debug, Clone, Default)]
pub(super) struct Table {
    /// What it shows; the name by which assistive technology finds it.
    pub(super) caption: String,
    /// Header rows; cells over several columns head a group.
    pub(super) header: Vec<Vec<Cell>>,
    /// Rows; the first cell of each is its header.
    pub(super) rows: Vec<Vec<Cell>>,
}

impl Table {
    /// The table in a region that scrolls by itself where the screen is narrow.
    pub(super) fn html(&self) -> String {
        let caption = escape(&self.caption);
        let mut html = format!(
            "<div class=\"scroll\" role=\"region\" tabindex=\"0\" aria-label=\"{caption}\"><table><caption>{caption}</caption><thead>"
        );
        for row in &self.header {
            let cell = |cell: &Cell| {
                let scope = if cell.span > 1 { "colgroup" } else { "col" };
                cell.element("th", scope)
            };
            let _ = write!(
                html,
                "<tr>{}</tr>",
                row.iter().map(cell).collect::<String>()
            );
        }
        html.push_str("</thead><tbody>");
        for row in &self.rows {
            let cells = row.iter().enumerate().map(|(column, cell)| match column {
                0 => cell.element("th", "row"),
                _ => cell.element("td", ""),
            });
            let _ = write!(html, "<tr>{}</tr>", cells.collect::<String>());
        }
        html.push_str("</tbody></table></div>\n");
        html
    }
}

/// Plots side by side with one caption; `key` explains the lines and is empty where they explain
/// themselves.
pub(super) fn figure(id: &str, plots: &[String], key: &str, caption: &str) -> String {
    let columns = match plots.len() {
        0 | 1 => "one",
        2 | 4 => "two",
        _ => "three",
    };
    format!(
        "<figure id=\"{id}\">{key}<div class=\"plots {columns}\">{}</div><figcaption>{caption}</figcaption></figure>\n",
        plots.concat()
    )
}

/// The key of a figure: classes of lines and their names.
pub(super) fn key(entries: &[(&str, &str)]) -> String {
    let entry = |(class, name): &(&str, &str)| {
        format!("<li><i class=\"swatch {class}\"></i>{}</li>", escape(name))
    };
    format!(
        "<ul class=\"key\">{}</ul>",
        entries.iter().map(entry).collect::<String>()
    )
}

/// A section of the page with its heading.
#[derive(Debug, Clone)]
pub(super) struct Section {
    /// Its place in links.
    pub(super) id: &'static str,
    /// Its heading.
    pub(super) title: &'static str,
    /// What is in it; a section without anything is left out.
    pub(super) body: String,
}

impl Section {
    /// The element.
    pub(super) fn html(&self) -> String {
        format!(
            "<section id=\"{}\" aria-labelledby=\"{}-title\"><h2 id=\"{}-title\">{}</h2>\n{}</section>\n",
            self.id,
            self.id,
            self.id,
            escape(self.title),
            self.body
        )
    }
}

/// A paragraph of text.
pub(super) fn paragraph(text: &str) -> String {
    format!("<p>{}</p>\n", escape(text))
}

/// What opens on demand.
pub(super) fn details(summary: &str, body: &str) -> String {
    format!(
        "<details><summary>{}</summary>\n{body}</details>\n",
        escape(summary)
    )
}

/// A value with its deviation, rounded where the deviation says: `0.04464 ± 0.00007`.
pub(super) fn with_deviation(value: f64, deviation: f64) -> String {
    let certain = value.is_finite() && deviation.is_finite() && deviation > 0.0;
    if !certain {
        return significant(value, 5).replace('-', "−");
    }
    let size = value.abs().max(deviation);
    let exponent = size.log10().floor() as i32;
    // Two digits of the deviation, no more than eight of the value.
    let last = (deviation.log10().floor() as i32 - 1).max(exponent - 7);
    let fixed = (-4..6).contains(&exponent) && last <= 0;
    let (scale, decimals) = if fixed {
        (1.0, -last)
    } else {
        (10_f64.powi(exponent), exponent - last)
    };
    let decimals = usize::try_from(decimals).unwrap_or(0);
    let (value, deviation) = (value / scale, deviation / scale);
    let text = format!("{value:.decimals$} ± {deviation:.decimals$}");
    let text = if fixed {
        text
    } else {
        format!("({text})·{}", power_of_ten(&exponent.to_string()))
    };
    text.replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::{Cell, Table, with_deviation};
    use crate::escape::escape;

    #[test]
    fn no_text_becomes_markup() {
        assert_eq!(
            escape("<script>\"a\" & 'b'\u{0}"),
            "&lt;script&gt;&quot;a&quot; &amp; &#39;b&#39;\u{FFFD}"
        );
    }

    #[test]
    fn a_value_is_rounded_by_its_deviation() {
        assert_eq!(
            with_deviation(0.044_641_2, 0.000_072),
            "0.044641 ± 0.000072"
        );
        assert_eq!(with_deviation(-5.417_766, 0.002_98), "−5.4178 ± 0.0030");
        assert_eq!(with_deviation(1.234e-6, 5.1e-8), "(1.234 ± 0.051)·10⁻⁶");
        assert_eq!(with_deviation(12.0, 300.0), "(0.1 ± 3.0)·10²");
        assert_eq!(with_deviation(1.5, 0.0), "1.5");
        assert_eq!(with_deviation(f64::NAN, 1.0), "undefined");
    }

    #[test]
    fn a_table_has_headers_and_escapes() {
        let table = Table {
            caption: String::from("a < b"),
            header: vec![vec![Cell::text("name"), Cell::text("values").over(2)]],
            rows: vec![vec![
                Cell::text("<x>"),
                Cell::digits(Some(-1.5), 3),
                Cell::nothing(),
            ]],
        };
        let html = table.html();
        let document = roxmltree::Document::parse(&html).expect("XML");
        let scopes: Vec<_> = document
            .descendants()
            .filter_map(|node| node.attribute("scope"))
            .collect();
        assert_eq!(scopes, ["col", "colgroup", "row"]);
        assert!(
            html.contains("&lt;x&gt;") && html.contains("−1.5"),
            "{html}"
        );
    }
}
