//! Columns of a line that are not zero.
//!
//! The line of an actuator of a robot without loops has no parameters of bodies nearer to the base,
//! and no friction of other joints. Products and transforms leave out these columns.

use nalgebra::{Const, DMatrixView, Dyn};

/// Places of the columns `selected` that are not zero in all `rows`.
pub(crate) fn nonzero(
    rows: &DMatrixView<'_, f64, Const<1>, Dyn>,
    selected: &[usize],
) -> Vec<usize> {
    let is_nonzero = |column: usize| rows.column(column).iter().any(|value| *value != 0.0);
    let places = selected.iter().enumerate();
    let nonzero = places.filter(|(_, column)| is_nonzero(**column));
    nonzero.map(|(place, _)| place).collect()
}

/// The entries of a list at some places.
pub(crate) fn at(all: &[usize], places: &[usize]) -> Vec<usize> {
    places.iter().map(|place| all[*place]).collect()
}
