//! Tables of the page.
//!
//! On narrow screens, the style sheet turns each row into a card, with the column's heading in each
//! cell. Each cell therefore carries that heading. Each element has an explicit role, because some
//! browsers drop roles with such a layout.

use std::fmt::Write;

use super::markup::prose;
use crate::text::escape;
use overact_identification::significant;

/// Number of columns from which a table is set narrower on small screens and in print.
const MANY_COLUMNS: usize = 8;

/// Largest number of characters of a name that is not broken.
const SHORT_NAME: usize = 24;

/// A cell of a table.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Cell {
    html: String,
    class: &'static str,
    span: usize,
}

impl Cell {
    /// A text.
    pub(crate) fn text(text: &str) -> Self {
        Self::markup(escape(text))
    }

    /// A sentence; backticks mark code.
    pub(crate) fn prose(text: &str) -> Self {
        Self::markup(prose(text)).class("prose")
    }

    /// Markup.
    pub(crate) const fn markup(html: String) -> Self {
        Self {
            html,
            class: "",
            span: 1,
        }
    }

    /// A number, aligned to the right.
    pub(crate) fn number(text: impl AsRef<str>) -> Self {
        Self::text(&text.as_ref().replace('-', "−")).class("n")
    }

    /// A number with `digits` digits; a dash if there is none.
    pub(crate) fn digits(value: Option<f64>, digits: usize) -> Self {
        match value {
            Some(value) => Self::number(significant(value, digits)),
            None => Self::nothing(),
        }
    }

    /// A missing value.
    pub(crate) fn nothing() -> Self {
        Self::text("–").class("n none")
    }

    /// Sets the class.
    pub(crate) const fn class(mut self, class: &'static str) -> Self {
        self.class = class;
        self
    }

    /// Spans several columns.
    pub(crate) const fn over(mut self, columns: usize) -> Self {
        self.span = columns;
        self
    }

    /// Header cell.
    fn head(&self) -> String {
        if self.html.is_empty() {
            return self.element("td", "role=\"cell\"");
        }
        let scope = if self.span > 1 { "colgroup" } else { "col" };
        self.element("th", &format!("scope=\"{scope}\" role=\"columnheader\""))
    }

    /// Header cell of a row; short names are not broken.
    fn row_head(&self) -> String {
        let attributes = "scope=\"row\" role=\"rowheader\"";
        if self.class.is_empty() && self.html.chars().count() <= SHORT_NAME {
            return self.clone().class("short").element("th", attributes);
        }
        self.element("th", attributes)
    }

    fn element(&self, name: &str, attributes: &str) -> String {
        let mut tag = format!("<{name} {attributes}");
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
pub(crate) struct Table {
    /// Caption; also the name for assistive technology.
    pub(crate) caption: String,
    /// Header rows; cells that span columns head a group.
    pub(crate) header: Vec<Vec<Cell>>,
    /// Rows; the first cell of each is its header.
    pub(crate) rows: Vec<Vec<Cell>>,
}

impl Table {
    /// Table in a region that scrolls if it does not fit.
    pub(crate) fn html(&self) -> String {
        let caption = escape(&self.caption);
        let (labels, starts) = (self.labels(), self.starts());
        let class = if labels.len() >= MANY_COLUMNS {
            " class=\"many\""
        } else {
            ""
        };
        let mut html = format!(
            "<div class=\"scroll\" role=\"region\" tabindex=\"0\" aria-label=\"{caption}\"><table role=\"table\"{class}><caption>{caption}</caption><thead role=\"rowgroup\">"
        );
        for row in &self.header {
            let cells: String = row.iter().map(Cell::head).collect();
            let _ = write!(html, "<tr role=\"row\">{cells}</tr>");
        }
        html.push_str("</thead><tbody role=\"rowgroup\">");
        for row in &self.rows {
            let cells = row.iter().enumerate().map(|(column, cell)| match column {
                0 => cell.row_head(),
                _ => {
                    let label = labels.get(column).map_or("", String::as_str);
                    let group = if starts.contains(&column) {
                        " data-start=\"\""
                    } else {
                        ""
                    };
                    cell.element(
                        "td",
                        &format!("role=\"cell\" data-label=\"{label}\"{group}"),
                    )
                }
            });
            let cells: String = cells.collect();
            let _ = write!(html, "<tr role=\"row\">{cells}</tr>");
        }
        html.push_str("</tbody></table></div>\n");
        html
    }

    /// First column of each group.
    fn starts(&self) -> Vec<usize> {
        let groups = self.header.first().filter(|_| self.header.len() > 1);
        let mut column = 0;
        let starts = groups.into_iter().flatten().map(|cell| {
            column += cell.span;
            column - cell.span
        });
        starts.collect()
    }

    /// Heading of each column, with that of its group.
    fn labels(&self) -> Vec<String> {
        let mut labels: Vec<String> = Vec::new();
        for row in &self.header {
            let spread = row.iter().flat_map(|cell| {
                let heading = if cell.html.contains('<') {
                    ""
                } else {
                    cell.html.as_str()
                };
                std::iter::repeat_n(heading, cell.span)
            });
            for (column, heading) in spread.enumerate() {
                match labels.get_mut(column) {
                    Some(label) if label.is_empty() => heading.clone_into(label),
                    Some(label) if heading.is_empty() => label.push_str(heading),
                    Some(label) => {
                        label.push_str(": ");
                        label.push_str(heading);
                    }
                    None => labels.push(heading.to_owned()),
                }
            }
        }
        labels
    }
}

#[cfg(test)]
mod tests {
    use super::{Cell, Table};

    #[test]
    fn tables_have_header_scopes_and_escaped_cells() {
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

    #[test]
    fn cells_are_labelled_with_their_column_and_group() {
        let table = Table {
            caption: String::from("two groups"),
            header: vec![
                vec![Cell::text("").over(2), Cell::text("Case <1>").over(2)],
                ["name", "unit", "estimate", "error"]
                    .map(Cell::text)
                    .to_vec(),
            ],
            rows: vec![["m", "kg", "1", "2"].map(Cell::text).to_vec()],
        };
        let html = table.html();
        let document = roxmltree::Document::parse(&html).expect("XML");
        let labels: Vec<_> = document
            .descendants()
            .filter_map(|node| node.attribute("data-label"))
            .collect();
        assert_eq!(labels, ["unit", "Case <1>: estimate", "Case <1>: error"]);
    }
}
