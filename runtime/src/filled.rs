//! Matrices that a function writes number by number, handed back.

use crate::Error;
use crate::float::Float;

/// A matrix of zeros, filled by a function, without a copy of it on the way.
///
/// # Errors
/// That of the function.
#[inline(always)]
pub fn filled<T: Float, const ROWS: usize, const COLUMNS: usize>(
    fill: impl FnOnce(&mut [[T; COLUMNS]; ROWS]) -> Result<(), Error>,
) -> Result<[[T; COLUMNS]; ROWS], Error> {
    // What is given back is one value from the first line on, which is why nothing is copied.
    let mut filled = Ok([[T::ZERO; COLUMNS]; ROWS]);
    if let Ok(output) = &mut filled
        && let Err(error) = fill(output)
    {
        filled = Err(error);
    }
    filled
}
