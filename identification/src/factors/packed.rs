//! Numbers as bytes: little-endian doubles.

use nalgebra::DMatrix;

/// Bytes of a number.
const BYTES: usize = size_of::<f64>();

/// Upper triangle of a square matrix, row by row.
pub(super) fn triangle(matrix: &DMatrix<f64>) -> Vec<u8> {
    let size = matrix.ncols();
    let places = (0..size).flat_map(|row| (row..size).map(move |column| (row, column)));
    places
        .flat_map(|place| matrix[place].to_le_bytes())
        .collect()
}

/// A matrix row by row.
pub(super) fn rows(matrix: &DMatrix<f64>) -> Vec<u8> {
    let all = matrix.row_iter();
    all.flat_map(|row| row.iter().copied().collect::<Vec<f64>>())
        .flat_map(f64::to_le_bytes)
        .collect()
}

/// A sequence of numbers.
pub(super) fn values<'a>(values: impl IntoIterator<Item = &'a f64>) -> Vec<u8> {
    values
        .into_iter()
        .flat_map(|value| value.to_le_bytes())
        .collect()
}

/// The upper triangular matrix of [`triangle`]; `None` for a wrong number of bytes.
pub(super) fn from_triangle(bytes: &[u8], size: usize) -> Option<DMatrix<f64>> {
    let mut own = numbers(bytes, size * (size + 1) / 2)?.into_iter();
    let mut matrix = DMatrix::zeros(size, size);
    for row in 0..size {
        for column in row..size {
            matrix[(row, column)] = own.next()?;
        }
    }
    Some(matrix)
}

/// The matrix of [`rows`]; `None` for a wrong number of bytes.
pub(super) fn from_rows(bytes: &[u8], count: usize, width: usize) -> Option<DMatrix<f64>> {
    let own = numbers(bytes, count.checked_mul(width)?)?;
    Some(DMatrix::from_row_slice(count, width, &own))
}

/// Decodes `count` numbers; `None` for a wrong number of bytes.
pub(super) fn numbers(bytes: &[u8], count: usize) -> Option<Vec<f64>> {
    let (own, rest) = bytes.as_chunks::<BYTES>();
    let fits = rest.is_empty() && own.len() == count;
    fits.then(|| own.iter().map(|own| f64::from_le_bytes(*own)).collect())
}
