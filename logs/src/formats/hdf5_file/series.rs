//! Datasets as vectors of samples: time dimension of a matrix, and names of its columns.

use hdf5_reader::Dataset;
use overact::Code;

use super::number::is_number;
use crate::{error::Problem, problems::legible};

/// A dataset: a vector, or a matrix whose columns or rows are vectors.
pub(super) struct Series {
    /// Path, joined by points like fields of a structure.
    pub(super) name: String,
    pub(super) dataset: Dataset,
    /// Description of elements that are not numbers, to follow the name.
    pub(super) unfit: Option<&'static str>,
    /// Dimension along which samples run, and their number.
    pub(super) side: usize,
    pub(super) samples: u64,
    /// Whether MATLAB or NumPy shows samples as rows.
    is_down: bool,
    /// Number of vectors, and index of the first one among all columns.
    pub(super) count: usize,
    pub(super) first: usize,
    /// Name of the first vector of a matrix.
    pub(super) first_column: Option<String>,
}

impl std::fmt::Debug for Series {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} {:?}", self.name, self.dataset.shape())
    }
}

impl Series {
    pub(super) fn new(name: String, dataset: Dataset, is_matlab: bool) -> Self {
        let shape = dataset.shape();
        let unfit = is_number(dataset.dtype()).err().or(match shape.len() {
            0..=2 => None,
            _ => Some("has more than two dimensions"),
        });
        let (side, samples, others, is_down) = match *shape {
            [] => (0, 1, 1, true),
            [length] => (0, length, 1, true),
            [outer, inner] => {
                let (rows, columns) = if is_matlab {
                    (inner, outer)
                } else {
                    (outer, inner)
                };
                // Samples run along the longer side.
                let is_down = rows >= columns;
                let side = usize::from(is_down == is_matlab);
                (side, rows.max(columns), rows.min(columns), is_down)
            }
            _ => (0, 0, 1, true),
        };
        let count = usize::try_from(others).unwrap_or(0);
        let first_column = (count > 1).then(|| {
            if is_down {
                format!("{name}(:,1)")
            } else {
                format!("{name}(1,:)")
            }
        });
        Self {
            name,
            dataset,
            unfit,
            side,
            samples,
            is_down,
            count,
            first: 0,
            first_column,
        }
    }

    /// Index of the vector selected by the text after the dataset's name.
    pub(super) fn part(&self, part: &str) -> Option<usize> {
        let number = |number: &str| {
            let number = number.parse::<usize>().ok()?.checked_sub(1)?;
            (number < self.count).then_some(number)
        };
        let down = part
            .strip_prefix("(:,")
            .and_then(|rest| rest.strip_suffix(')'));
        let across = part
            .strip_suffix(",:)")
            .and_then(|rest| rest.strip_prefix('('));
        match (part, down, across) {
            ("", ..) => (self.count == 1).then_some(0),
            (_, Some(column), _) if self.is_down || self.count == 1 => number(column),
            (_, _, Some(row)) if !self.is_down || self.count == 1 => number(row),
            _ => None,
        }
    }
}

/// The problem of a file that cannot be opened.
pub(super) fn broken(file: &str, why: &str) -> Problem {
    let message = format!("the HDF5 file can't be read: {}", legible(why));
    Problem::new(Code::LOG_FORMAT, message).file(file).help(
        "if it was copied or its writer was stopped, copy or write it again; otherwise export CSV",
    )
}
