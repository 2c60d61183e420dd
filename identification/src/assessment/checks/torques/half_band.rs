//! Distinguishes a filter from position noise by a test in half the band.
//!
//! A position error e enters the model as an acceleration, M ë, and the residual with opposite
//! sign. The second derivative of the model's torques contains it as M e⁗. Their product is -M² ë
//! e⁗, with the mean M² times the mean square of the third derivative of e.
//!
//! Coarse encoders therefore look like smoothed torques, and so do torques with which a controller
//! answers encoder noise. That effect falls with the seventh power of the bandwidth. A filter has
//! the same size in every band that it passes.

use crate::assessment::{
    checks::{Context, fault_hypotheses::only},
    hypotheses::{FaultHypothesis, Scores},
};
use overact_logs::Error;

/// Fraction of the size that must remain in half the band if there is a filter.
const REMAINING: f64 = 0.5;

/// Scores in half the band; `None` if it cannot be tested.
pub(crate) fn scores_in_half_the_band(context: &Context<'_>) -> Result<Option<Scores>, Error> {
    let is_narrower = |narrow: &Scores| {
        let own = context.scores;
        own.is_some_and(|own| narrow.narrower > own.narrower)
    };
    Ok((context.narrow)()?.filter(is_narrower))
}

/// Whether a fault of `size` is also found in half the band.
///
/// True if half the band cannot be tested.
pub(crate) fn confirms(
    context: &Context<'_>,
    hypothesis: FaultHypothesis,
    size: f64,
) -> Result<bool, Error> {
    let Some(narrow) = scores_in_half_the_band(context)? else {
        return Ok(true);
    };
    let Some(one) = only(&narrow, hypothesis) else {
        return Ok(true);
    };
    Ok(remains(size, one.wald.size()))
}

/// Whether enough of the size remains in half the band.
fn remains(size: f64, half: f64) -> bool {
    half * size.signum() >= REMAINING * size.abs()
}

#[cfg(test)]
mod tests {
    use super::remains;

    #[test]
    fn filter_estimates_must_agree_in_half_of_the_band() {
        assert!(remains(2e-6, 1.8e-6));
        assert!(remains(-2e-6, -2.5e-6));
        assert!(!remains(2e-6, 0.1e-6));
        assert!(!remains(2e-6, -2e-6));
    }
}
