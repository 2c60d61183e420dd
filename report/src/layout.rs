//! Layout of plain text: lines, paragraphs and tables that are safe for any names.

use crate::text::{fitted, visible};

/// Characters per line, for narrow terminals.
pub const WIDTH: usize = 100;

/// Largest number of characters of a cell; two cells and a gap fit in a line.
const WIDEST: usize = 48;

/// Largest number of characters of a name before its wrapped definition.
const WIDEST_LEAD: usize = 60;

/// Spaces between columns.
const GAP: usize = 2;

/// Appends a line.
pub(crate) fn line(text: &mut String, words: &str) {
    text.push_str(&visible(words));
    text.push('\n');
}

/// Appends a wrapped paragraph after `lead`, indented by the length of `lead`.
pub fn paragraph(text: &mut String, lead: &str, words: &str) {
    let indent = " ".repeat(lead.chars().count());
    let mut current = lead.to_owned();
    let mut is_empty = true;
    // Do not break between a number and its percent sign.
    let words = visible(words).replace(" %", "\u{a0}%");
    for word in words.split(' ').filter(|word| !word.is_empty()) {
        let word = fitted(&word.replace('\u{a0}', " "), WIDTH);
        if !is_empty && current.chars().count() + 1 + word.chars().count() > WIDTH {
            line(text, &current);
            current.clone_from(&indent);
            is_empty = true;
        }
        if !is_empty {
            current.push(' ');
        }
        current.push_str(&word);
        is_empty = false;
    }
    line(text, &current);
}

/// Table with a header and a rule; the first column left-aligned, the others right-aligned.
///
/// Cells that are too long are shortened.
pub(crate) fn table(header: &[&str], rows: Vec<Vec<String>>) -> String {
    let header = header.iter().map(|cell| (*cell).to_owned()).collect();
    let shown = |row: Vec<String>| {
        row.iter()
            .map(|cell| fitted(&visible(cell), WIDEST))
            .collect()
    };
    let all: Vec<Vec<String>> = std::iter::once(header).chain(rows).map(shown).collect();
    in_parts(&all, &[true], true)
}

/// Rows in columns; `left` marks the left-aligned columns.
///
/// Tables that are too wide are split into parts, each with the first column.
#[must_use]
pub fn columns(rows: &[Vec<String>], left: &[bool]) -> String {
    in_parts(rows, left, false)
}

/// Columns, optionally with a rule below the first row.
fn in_parts(rows: &[Vec<String>], left: &[bool], is_ruled: bool) -> String {
    let widths = widths(rows);
    let parts = parts(&widths);
    let parts = parts.iter().map(|part| {
        let rule: usize = part.iter().map(|&column| GAP + widths[column]).sum();
        let mut text = String::new();
        for (index, row) in rows.iter().enumerate() {
            let cells = part.iter().map(|&column| {
                let (cell, width) = (row.get(column).map_or("", String::as_str), widths[column]);
                match left.get(column) {
                    Some(true) => format!("{cell:<width$}"),
                    _ => format!("{cell:>width$}"),
                }
            });
            let cells: Vec<String> = cells.collect();
            line(&mut text, cells.join(&" ".repeat(GAP)).trim_end());
            if index == 0 && is_ruled {
                line(&mut text, &"-".repeat(rule.saturating_sub(GAP)));
            }
        }
        text
    });
    parts.collect::<Vec<String>>().join("\n")
}

/// Columns of each part of a table; the first one is in all of them.
fn parts(widths: &[usize]) -> Vec<Vec<usize>> {
    let mut parts: Vec<Vec<usize>> = vec![vec![0]];
    let first = widths.first().copied().unwrap_or(0);
    let mut used = first;
    for (column, width) in widths.iter().enumerate().skip(1) {
        if used + GAP + width > WIDTH && used > first {
            parts.push(vec![0]);
            used = first;
        }
        used += GAP + width;
        if let Some(last) = parts.last_mut() {
            last.push(column);
        }
    }
    parts
}

/// Names with their definitions in two columns; long definitions are wrapped.
#[must_use]
pub fn definitions(rows: &[(String, String)], between: &str) -> String {
    let shown = |name: &str| fitted(&visible(name), WIDEST_LEAD);
    let width = rows.iter().map(|(name, _)| shown(name).chars().count());
    let width = width.max().unwrap_or(0);
    let mut text = String::new();
    for (name, words) in rows {
        paragraph(
            &mut text,
            &format!("{:<width$}{between}", shown(name)),
            words,
        );
    }
    text
}

/// Width of each column in characters.
fn widths(rows: &[Vec<String>]) -> Vec<usize> {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    (0..columns)
        .map(|column| {
            rows.iter()
                .filter_map(|row| row.get(column))
                .map(|cell| cell.chars().count())
                .max()
                .unwrap_or(0)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::{WIDTH, columns, definitions, line, paragraph, table};

    #[test]
    fn columns_are_aligned() {
        let row = |a: &str, b: &str| vec![a.to_owned(), b.to_owned()];
        let rows = [row("name", "n"), row("x", "12")];
        assert_eq!(columns(&rows, &[true, false]), "name   n\nx     12\n");
    }

    #[test]
    fn long_and_control_character_cells_keep_columns_aligned() {
        let name = format!("a\u{1b}[31m\nb\u{202e}{}", "x".repeat(5000));
        let row = |name: &str, value: &str| vec![name.to_owned(), value.to_owned()];
        let text = table(&["name", "value"], vec![row(&name, "1"), row("m", "2")]);
        assert_eq!(text.lines().count(), 4, "{text}");
        assert!(text.lines().all(|line| line.chars().count() < 60), "{text}");
        assert!(text.chars().all(|c| c == '\n' || !c.is_control()), "{text}");
        assert!(!text.contains('\u{202e}'));
        assert!(text.lines().skip(2).all(|line| line.ends_with(['1', '2'])));
    }

    #[test]
    fn wide_tables_are_split_without_losing_cells() {
        let names: Vec<String> = (0..9).map(|column| format!("column {column:9}")).collect();
        let header: Vec<&str> = names.iter().map(String::as_str).collect();
        let row = |row: usize| (0..9).map(|column| format!("r{row}c{column}")).collect();
        let text = table(&header, vec![row(0), row(1)]);
        assert!(
            text.lines().all(|line| line.chars().count() <= WIDTH),
            "{text}"
        );
        let heads: Vec<&str> = text
            .lines()
            .filter(|line| line.contains("column"))
            .collect();
        assert_eq!(heads.len(), 2, "{text}");
        assert!(
            heads.iter().all(|line| line.starts_with(&names[0])),
            "{text}"
        );
        for (row, column) in (0..2).flat_map(|row| (1..9).map(move |column| (row, column))) {
            assert_eq!(
                text.matches(&format!("r{row}c{column}")).count(),
                1,
                "{text}"
            );
        }
    }

    #[test]
    fn line_breaks_and_control_characters_are_replaced() {
        let mut text = String::new();
        line(&mut text, "a\nb\u{1b}[2J");
        assert_eq!(text, "a b\u{FFFD}[2J\n");
    }

    #[test]
    fn paragraphs_are_wrapped_without_losing_words() {
        let words = "one two three ".repeat(30);
        let mut text = String::new();
        paragraph(&mut text, "  - ", &words);
        assert!(text.lines().count() > 3);
        assert!(text.lines().all(|line| line.chars().count() <= WIDTH));
        assert!(text.lines().skip(1).all(|line| line.starts_with("    ")));
        let wrapped: Vec<&str> = text.split_whitespace().skip(1).collect();
        assert_eq!(wrapped, words.split_whitespace().collect::<Vec<_>>());
    }

    #[test]
    fn long_sums_are_wrapped_with_indentation() {
        let sum = "m_1 + ".repeat(40);
        let rows = [("a".to_owned(), "b".to_owned()), ("longer".to_owned(), sum)];
        let text = definitions(&rows, " = ");
        assert!(text.starts_with("a      = b\nlonger = m_1 + "), "{text}");
        assert!(text.lines().all(|line| line.chars().count() <= WIDTH));
        assert!(
            text.lines()
                .skip(2)
                .all(|line| line.starts_with("         m_1"))
        );
    }
}
