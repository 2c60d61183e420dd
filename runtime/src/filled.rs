//! Matrices that a function writes number by number, handed back: at the price of zeros and of a copy, which who hands a
//! matrix in saves.

use crate::Error;
use crate::float::Float;

/// A matrix of zeros, filled by a function.
///
/// # Errors
/// That of the function.
#[inline(always)]
pub fn filled<T: Float, const ROWS: usize, const COLUMNS: usize>(
    fill: impl FnOnce(&mut [[T; COLUMNS]; ROWS]) -> Result<(), Error>,
) -> Result<[[T; COLUMNS]; ROWS], Error> {
    // One value from the first line on, so that there is one copy and not two.
    let mut filled = Ok([[T::ZERO; COLUMNS]; ROWS]);
    if let Ok(output) = &mut filled
        && let Err(error) = fill(output)
    {
        filled = Err(error);
    }
    filled
}
