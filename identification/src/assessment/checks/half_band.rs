//! Whether what looks like a filter is one, told from half of the band.
//!
//! An error e of a position comes into the model as an acceleration, M ë, and so into the residual with the other sign.
//! The second derivative of what the model explains has it as M e⁗. The two agree as those of a filter do: their
//! product is -M² ë e⁗, in the mean M² times the square of the third derivative of e. So coarse encoders look like
//! torques that were smoothed, by as much as errors in the band make of it; the same is in torques with which a
//! controller answers them. That falls with the seventh power of the band, while a filter smooths by the same time in
//! any band that it passes.

use super::{Context, suspected::only};
use crate::{assessment::suspects::Suspect, error::Error};

/// Of the size in the whole band, so much is there in half of it, too, where a filter was.
const LEFT: f64 = 0.5;

/// Whether a suspect of a `size` that was found is there in half of the band, too; true where that can't be told.
pub(super) fn confirms(context: &Context<'_>, suspect: Suspect, size: f64) -> Result<bool, Error> {
    let Some(narrow) = (context.narrow)()? else {
        return Ok(true);
    };
    if context
        .scores
        .is_none_or(|own| narrow.narrower <= own.narrower)
    {
        return Ok(true);
    }
    let Some(one) = only(&narrow, suspect) else {
        return Ok(true);
    };
    Ok(remains(size, one.accused.size()))
}

/// Whether enough of a size is left in half of the band.
fn remains(size: f64, half: f64) -> bool {
    half * size.signum() >= LEFT * size.abs()
}

#[cfg(test)]
mod tests {
    use super::remains;

    #[test]
    fn a_filter_has_the_same_size_in_half_of_the_band() {
        assert!(remains(2e-6, 1.8e-6));
        assert!(remains(-2e-6, -2.5e-6));
        assert!(!remains(2e-6, 0.1e-6));
        assert!(!remains(2e-6, -2e-6));
    }
}
