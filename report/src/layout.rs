//! Lines and tables of plain text, for a terminal or a file. Whatever a name holds, it stays on its line
//! and in its column.

use crate::text::{fitted, visible};

/// Characters of a cell at most; sums of parameters stand in tables without columns to their right.
const WIDEST: usize = 48;

/// Adds a line.
pub(crate) fn line(text: &mut String, words: &str) {
    text.push_str(&visible(words));
    text.push('\n');
}

/// The cells of a row as they are shown.
fn cells(row: Vec<String>) -> Vec<String> {
    let shown = |cell: String| fitted(&visible(&cell), WIDEST);
    row.into_iter().map(shown).collect()
}

/// Rows under a header: the first column to the left, the others to the right.
pub(crate) fn table(header: &[&str], rows: Vec<Vec<String>>) -> String {
    let header = header.iter().map(|cell| (*cell).to_owned());
    let mut all = vec![cells(header.collect())];
    all.extend(rows.into_iter().map(cells));
    let widths = widths(&all);
    let rule: usize = widths.iter().sum::<usize>() + 2 * widths.len().saturating_sub(1);
    let mut text = String::new();
    for (index, row) in all.iter().enumerate() {
        let cells: Vec<String> = row
            .iter()
            .zip(&widths)
            .enumerate()
            .map(|(column, (cell, &width))| {
                if column == 0 {
                    format!("{cell:<width$}")
                } else {
                    format!("{cell:>width$}")
                }
            })
            .collect();
        line(&mut text, cells.join("  ").trim_end());
        if index == 0 {
            line(&mut text, &"-".repeat(rule));
        }
    }
    text
}

/// Rows without a header, all to the left.
pub(crate) fn left_table(rows: Vec<Vec<String>>) -> String {
    let widths = widths(&rows);
    let mut text = String::new();
    for row in &rows {
        let cells: Vec<String> = row
            .iter()
            .zip(&widths)
            .map(|(cell, &width)| format!("{cell:<width$}"))
            .collect();
        line(&mut text, cells.join(" ").trim_end());
    }
    text
}

/// The widest cell of each column, in characters.
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
    use super::{line, table};

    #[test]
    fn hostile_cells_stay_in_their_columns() {
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
    fn a_line_is_one_line() {
        let mut text = String::new();
        line(&mut text, "a\nb\u{1b}[2J");
        assert_eq!(text, "a b\u{FFFD}[2J\n");
    }
}
