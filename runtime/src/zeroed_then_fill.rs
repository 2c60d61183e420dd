//! Returns matrices that a function writes number by number.
//!
//! This costs zeros and a copy, which callers save by passing a matrix of their own.

use crate::Error;
use crate::float::Float;

/// Creates a zero matrix and fills it by a function.
///
/// # Errors
/// The error of the function.
#[inline(always)]
pub fn zeroed_then_fill<T: Float, const ROWS: usize, const COLUMNS: usize>(
    fill: impl FnOnce(&mut [[T; COLUMNS]; ROWS]) -> Result<(), Error>,
) -> Result<[[T; COLUMNS]; ROWS], Error> {
    // A single value from the start, so that there is one copy and not two.
    let mut filled = Ok([[T::ZERO; COLUMNS]; ROWS]);
    if let Ok(output) = &mut filled
        && let Err(error) = fill(output)
    {
        filled = Err(error);
    }
    filled
}
