//! Groups of columns that have numbers in the same rows, as PlotJuggler exports several topics.
//!
//! Each group is then read as a table of its own, with the columns that every row has, such as the
//! time, and joined to the others by time.

use csv::StringRecord;

/// Fewest rows of a group.
const FEWEST: usize = 2;

/// Groups of columns by the rows in which they have cells; empty if all rows have the same.
///
/// Columns that every row has are in no group, and neither are those beyond the first `columns`.
pub(super) fn of<'r>(
    rows: impl Iterator<Item = &'r StringRecord>,
    columns: usize,
) -> Vec<Vec<usize>> {
    let rows: Vec<&StringRecord> = rows.collect();
    let mut groups: Vec<(Vec<bool>, Vec<usize>)> = Vec::new();
    for column in 0..columns {
        let filled: Vec<bool> = { rows.iter() }
            .map(|row| row.get(column).is_some_and(|cell| !cell.is_empty()))
            .collect();
        if filled.iter().all(|is_filled| *is_filled) {
            continue;
        }
        match groups.iter_mut().find(|(rows, _)| *rows == filled) {
            Some((_, own)) => own.push(column),
            None => groups.push((filled, vec![column])),
        }
    }
    // A column without any cell, and a few empty cells, make no group.
    groups.retain(|(rows, _)| rows.iter().filter(|is_filled| **is_filled).count() >= FEWEST);
    let apart = |(first, _): &(Vec<bool>, Vec<usize>)| {
        let others = groups.iter().filter(|(other, _)| other != first);
        { others }.any(|(other, _)| {
            let both = first.iter().zip(other).filter(|(a, b)| **a && **b).count();
            let least = first
                .iter()
                .filter(|a| **a)
                .count()
                .min(other.iter().filter(|b| **b).count());
            2 * both <= least
        })
    };
    if groups.len() < 2 || !groups.iter().all(apart) {
        return Vec::new();
    }
    groups.into_iter().map(|(_, columns)| columns).collect()
}

#[cfg(test)]
mod tests {
    use super::of;
    use csv::StringRecord;

    fn groups(rows: &[[&str; 4]]) -> Vec<Vec<usize>> {
        let rows: Vec<StringRecord> = rows.iter().map(|row| row.iter().collect()).collect();
        of(rows.iter(), 4)
    }

    #[test]
    fn columns_with_values_in_the_same_rows_form_a_group() {
        let rows = [
            ["0", "1", "2", ""],
            ["1", "", "", "3"],
            ["2", "1", "2", ""],
            ["3", "", "", "3"],
        ];
        assert_eq!(groups(&rows), [vec![1, 2], vec![3]]);
    }

    #[test]
    fn isolated_missing_cells_form_no_group() {
        let rows = [
            ["0", "1", "2", "3"],
            ["1", "", "2", "3"],
            ["2", "1", "2", ""],
            ["3", "1", "2", "3"],
        ];
        assert_eq!(groups(&rows), [[0; 0]; 0]);
    }
}
