//! Transposes rows of numbers to a column-major matrix.

use nalgebra::DMatrix;

/// Number of rows transposed together, to use the cache.
const TOGETHER: usize = 16;

/// The matrix of successive rows of `width` numbers.
pub(super) fn transpose(rows: &[f64], width: usize) -> DMatrix<f64> {
    let count = rows.len() / width;
    let mut matrix = DMatrix::zeros(count, width);
    for (number, rows) in rows.chunks(TOGETHER * width).enumerate() {
        let columns = matrix.as_mut_slice().chunks_exact_mut(count);
        for (place, column) in columns.enumerate() {
            let from = rows[place..].iter().step_by(width);
            let to = column[number * TOGETHER..].iter_mut();
            to.zip(from).for_each(|(to, from)| *to = *from);
        }
    }
    matrix
}

#[cfg(test)]
mod tests {
    use super::transpose;
    use nalgebra::DMatrix;

    #[test]
    fn transposed_rows_equal_the_matrix() {
        for count in [0, 1, 16, 37] {
            let rows: Vec<f64> = (0..5 * count).map(|k| k as f64).collect();
            assert_eq!(
                transpose(&rows, 5),
                DMatrix::from_row_slice(count, 5, &rows)
            );
        }
    }
}
