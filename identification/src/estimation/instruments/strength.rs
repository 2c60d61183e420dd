//! Strength of the instruments.
//!
//! An instrument that is weakly correlated with its column gives an imprecise, biased estimate with
//! wrong intervals. Shea's partial R² is the part of a column, outside the other columns, that the
//! instruments reproduce (J. Shea, *Instrument relevance in multivariate linear models*, Review of
//! Economics and Statistics 79, 1997). It equals the ratio of the variances of least squares and of
//! instrumental variables for the same residual (L. Godfrey, same review 81, 1999). With as many
//! instruments as columns,
//!
//! ```text
//! R_i² = [(Wᵀ Λ² W)^-1]_ii / [(R_zwᵀ R_zw)^-1]_ii,   F_i = R_i²/(1 - R_i²) (N - 2 p),
//! ```
//!
//! and an F below 10 is called weak (D. Staiger, J. Stock, *Econometrica* 65, 1997).

use super::Instrumental;

/// F below which an instrument is weak.
pub(crate) const WEAK: f64 = 10.0;

/// Strength of the instruments for one column.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Strength {
    /// R_i².
    pub(crate) partial_r2: f64,
    /// F_i; infinite for a column without errors.
    pub(crate) f: f64,
}

/// Strength of the instruments for each parameter.
pub(crate) fn strengths(found: &Instrumental) -> Vec<Strength> {
    let estimation = &found.estimation;
    let p = estimation.values.len();
    let freedom = estimation.equations.saturating_sub(2 * p).max(1) as f64;
    let own = estimation.inverse.row_iter().map(|row| row.norm_squared());
    let square = estimation.residual_deviation.powi(2);
    let deviations = estimation.standard_deviations.iter();
    own.zip(deviations)
        .map(|(own, deviation)| {
            let ratio = own * square / (deviation * deviation);
            // Rounding can make it exceed one; an exact fit gives NaN.
            let partial_r2 = if ratio.is_nan() { 1.0 } else { ratio.min(1.0) };
            Strength {
                partial_r2,
                f: freedom * partial_r2 / (1.0 - partial_r2),
            }
        })
        .collect()
}
