//! Collects numbers of a model's functions in the rows of a line.

/// Numbers of all samples and lines, count per line, and pairs of place in the row and number.
pub(super) type RowSource<'a> = (&'a [f64], usize, Vec<(usize, usize)>);

/// Rows of `width` values of one line for all samples; zero by default, sums for repeated places.
pub(super) fn collect_rows(
    sources: &[RowSource<'_>; 2],
    (line, lines): (usize, usize),
    (samples, width): (usize, usize),
) -> Vec<f64> {
    let mut first = vec![usize::MAX; width];
    let [(values, count, places), _] = sources;
    let mut more = Vec::new();
    for &(place, index) in places {
        match first[place] {
            usize::MAX => first[place] = index,
            _ => more.push((place, index)),
        }
    }
    let mut rows = Vec::with_capacity(samples * width);
    let of_line = |count: usize, sample: usize| {
        let start = (sample * lines + line) * count;
        start..start + count
    };
    for sample in 0..samples {
        let from = &values[of_line(*count, sample)];
        let start = rows.len();
        // Each number is written once to its final place.
        let own = first.iter().map(|k| from.get(*k).copied().unwrap_or(0.0));
        rows.extend(own);
        for &(place, index) in &more {
            rows[start + place] += from[index];
        }
    }
    let [_, (values, count, places)] = sources;
    if !values.is_empty() {
        for (sample, row) in rows.chunks_exact_mut(width).enumerate() {
            let from = &values[of_line(*count, sample)];
            for &(place, index) in places {
                row[place] += from[index];
            }
        }
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::collect_rows;

    #[test]
    fn numbers_go_to_their_places_line_by_line() {
        // Two samples of two lines: three numbers, and one of another function.
        let robot: Vec<f64> = (0..12).map(f64::from).collect();
        let more = [0.5, 0.25, -0.5, -0.25];
        let places = vec![(0, 2), (3, 0), (3, 1)];
        let sources = [(&robot[..], 3, places), (&more[..], 1, vec![(1, 0)])];
        let first = collect_rows(&sources, (0, 2), (2, 5));
        assert_eq!(first, [2.0, 0.5, 0.0, 1.0, 0.0, 8.0, -0.5, 0.0, 13.0, 0.0]);
        let second = collect_rows(&sources, (1, 2), (2, 5));
        assert_eq!(
            second,
            [5.0, 0.25, 0.0, 7.0, 0.0, 11.0, -0.25, 0.0, 19.0, 0.0]
        );
    }
}
