//! Collects numbers of a model's functions in the rows of a line.

/// Numbers of a function of the model, with their places in the rows.
pub(super) struct RowSource<'a> {
    /// Numbers, samples × lines × count.
    pub(super) numbers: &'a [f64],
    /// Numbers of a line at a sample.
    pub(super) count: usize,
    /// Pairs of place in the row and index of the number.
    pub(super) places: Vec<(usize, usize)>,
}

impl RowSource<'_> {
    /// Numbers of a line, numbered among all `lines`, at a sample.
    fn row(&self, line: usize, lines: usize, sample: usize) -> &[f64] {
        let start = (sample * lines + line) * self.count;
        &self.numbers[start..start + self.count]
    }
}

/// Rows of `width` values of one line for all samples; zero by default, sums for repeated places.
///
/// The line has the number `line` among all `lines`.
pub(super) fn collect_rows(
    sources: &[RowSource<'_>; 2],
    line: usize,
    lines: usize,
    samples: usize,
    width: usize,
) -> Vec<f64> {
    let [robot, payload] = sources;
    let mut first = vec![usize::MAX; width];
    let mut more = Vec::new();
    for &(place, index) in &robot.places {
        match first[place] {
            usize::MAX => first[place] = index,
            _ => more.push((place, index)),
        }
    }
    let mut rows = Vec::with_capacity(samples * width);
    for sample in 0..samples {
        let from = robot.row(line, lines, sample);
        let start = rows.len();
        // Each number is written once to its final place.
        let own = first.iter().map(|k| from.get(*k).copied().unwrap_or(0.0));
        rows.extend(own);
        for &(place, index) in &more {
            rows[start + place] += from[index];
        }
    }
    if !payload.numbers.is_empty() {
        for (sample, row) in rows.chunks_exact_mut(width).enumerate() {
            let from = payload.row(line, lines, sample);
            for &(place, index) in &payload.places {
                row[place] += from[index];
            }
        }
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::{RowSource, collect_rows};

    #[test]
    fn numbers_are_collected_into_rows_line_by_line() {
        // Two samples of two lines: three numbers, and one of another function.
        let robot: Vec<f64> = (0..12).map(f64::from).collect();
        let more = [0.5, 0.25, -0.5, -0.25];
        let sources = [
            RowSource {
                numbers: &robot,
                count: 3,
                places: vec![(0, 2), (3, 0), (3, 1)],
            },
            RowSource {
                numbers: &more,
                count: 1,
                places: vec![(1, 0)],
            },
        ];
        let first = collect_rows(&sources, 0, 2, 2, 5);
        assert_eq!(first, [2.0, 0.5, 0.0, 1.0, 0.0, 8.0, -0.5, 0.0, 13.0, 0.0]);
        let second = collect_rows(&sources, 1, 2, 2, 5);
        assert_eq!(
            second,
            [5.0, 0.25, 0.0, 7.0, 0.0, 11.0, -0.25, 0.0, 19.0, 0.0]
        );
    }
}
