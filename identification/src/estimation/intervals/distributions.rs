//! Tails and quantiles of Student's, Fisher's and the chi-squared distribution.

/// Largest number of terms of a series or a continued fraction; far fewer are needed.
const TERMS: usize = 500;

/// Relative size of a negligible term.
const SMALL: f64 = 1e-15;

/// Largest number of Newton steps for a quantile; far fewer are needed.
const STEPS: usize = 200;

/// Degrees of freedom that count as infinite.
const LARGEST_FREEDOM: f64 = 1e7;

/// Two-sided quantile of Student's distribution.
#[must_use]
pub(crate) fn student_quantile(probability: f64, freedom: f64) -> f64 {
    let freedom = freedom.clamp(1.0, LARGEST_FREEDOM);
    let constant = log_gamma(0.5 * (freedom + 1.0)) - log_gamma(0.5 * freedom);
    let constant = constant - 0.5 * (std::f64::consts::PI * freedom).ln();
    let mut value = 0.0;
    // The tail is convex, so Newton steps from zero approach the quantile from below.
    for _ in 0..STEPS {
        let shape = (value * value / freedom).ln_1p();
        let density = (constant - 0.5 * (freedom + 1.0) * shape).exp();
        let step = 0.5 * (student_tail(value, freedom) - probability) / density;
        if step.is_nan() || step <= SMALL * value {
            break;
        }
        value += step;
    }
    value
}

/// Two-sided tail probability of Student's distribution.
#[must_use]
pub fn student_tail(value: f64, freedom: f64) -> f64 {
    fisher_tail(value * value, 1.0, freedom)
}

/// Hotelling's test of dᵀ V^-1 d in `rank` directions, with `freedom` degrees of freedom of V.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Hotelling {
    /// F.
    pub(crate) statistic: f64,
    /// Second degrees of freedom of F.
    pub(crate) rest: f64,
    /// p-value.
    pub(crate) probability: f64,
}

impl Hotelling {
    pub(crate) fn new(distance: f64, rank: f64, freedom: f64) -> Self {
        let rest = freedom - rank + 1.0;
        // A known covariance has infinite degrees of freedom.
        let part = if freedom.is_infinite() {
            1.0
        } else {
            rest / freedom
        };
        let statistic = part / rank * distance;
        Self {
            statistic,
            rest,
            probability: fisher_tail(statistic, rank, rest),
        }
    }
}

/// Noncentrality with which Hotelling's test at `level` is passed with probability `missed`.
///
/// The tail of the noncentral distribution of Fisher is that of a central one (Patnaik 1949):
/// F'(k, f, λ) ≈ (1 + λ/k) F(h, f) with h = (k + λ)²/(k + 2 λ). The error is a few percent.
pub(crate) fn detectable_noncentrality(level: f64, missed: f64, rank: f64, freedom: f64) -> f64 {
    let rest = (freedom - rank + 1.0).max(1.0);
    let critical = bisected(|value| fisher_tail(value, rank, rest) > level);
    bisected(|noncentrality| {
        let sum = rank + noncentrality;
        let equivalent = sum * sum / (sum + noncentrality);
        fisher_tail(critical * rank / sum, equivalent, rest) < 1.0 - missed
    })
}

/// Largest positive value with the property `is_below`, which larger values lack.
fn bisected(is_below: impl Fn(f64) -> bool) -> f64 {
    let mut high = 1.0;
    while is_below(high) && high < f64::MAX.sqrt() {
        high *= 2.0;
    }
    let mut low = 0.0;
    for _ in 0..STEPS {
        let middle = 0.5 * (low + high);
        if middle == low || middle == high {
            break;
        }
        *(if is_below(middle) {
            &mut low
        } else {
            &mut high
        }) = middle;
    }
    low
}

/// Tail probability of Fisher's distribution.
///
/// It is zero for NaN, so that a missing statistic never passes a test.
#[must_use]
pub(crate) fn fisher_tail(value: f64, numerator: f64, denominator: f64) -> f64 {
    if value.is_nan() || numerator.is_nan() || denominator.is_nan() {
        return 0.0;
    }
    let denominator = denominator.min(LARGEST_FREEDOM);
    if value <= 0.0 {
        return 1.0;
    }
    // Both x and 1 - x are passed, to keep precision near 1.
    let sum = denominator + numerator * value;
    incomplete_beta(
        denominator / sum,
        numerator * value / sum,
        0.5 * denominator,
        0.5 * numerator,
    )
}

/// Regularised incomplete beta function I_x(a, b) with y = 1 - x.
///
/// Lentz's continued fraction (Abramowitz and Stegun 26.5.8).
fn incomplete_beta(x: f64, y: f64, a: f64, b: f64) -> f64 {
    if x <= 0.0 {
        return 0.0;
    }
    if y <= 0.0 {
        return 1.0;
    }
    if x > (a + 1.0) / (a + b + 2.0) {
        return 1.0 - incomplete_beta(y, x, b, a);
    }
    let front = (log_gamma(a + b) - log_gamma(a) - log_gamma(b) + a * x.ln() + b * y.ln()).exp();
    let guard = |value: f64| if value.abs() < 1e-300 { 1e-300 } else { value };
    let mut c = 1.0;
    let mut d = 1.0 / guard(1.0 - (a + b) * x / (a + 1.0));
    let mut fraction = d;
    for m in 1..TERMS {
        let m = m as f64;
        let even = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
        let odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
        for coefficient in [even, odd] {
            d = 1.0 / guard(1.0 + coefficient * d);
            c = guard(1.0 + coefficient / c);
            fraction *= c * d;
        }
        if (c * d - 1.0).abs() < SMALL {
            break;
        }
    }
    front * fraction / a
}

/// ln Γ(x) for positive x, by Stirling's series after a shift to large x.
fn log_gamma(x: f64) -> f64 {
    let (mut x, mut shift) = (x, 0.0);
    while x < 12.0 {
        shift -= x.ln();
        x += 1.0;
    }
    let square = x * x;
    let series = 1.0 / 12.0
        - (1.0 / 360.0
            - (1.0 / 1260.0 - (1.0 / 1680.0 - 1.0 / (1188.0 * square)) / square) / square)
            / square;
    shift + (x - 0.5) * x.ln() - x + 0.5 * std::f64::consts::TAU.ln() + series / x
}

#[cfg(test)]
mod tests {
    use super::{
        Hotelling, detectable_noncentrality, fisher_tail, log_gamma, student_quantile, student_tail,
    };

    #[test]
    fn detectable_noncentralities_match_published_tables() {
        // Chi-squared distribution, level 5 %, power 90 % (Haynam and others 1970).
        for (rank, table) in [(2.0, 12.654), (4.0, 15.405), (16.0, 24.125)] {
            let found = detectable_noncentrality(0.05, 0.1, rank, f64::INFINITY);
            assert!((found / table - 1.0).abs() < 0.05, "{rank}: {found}");
        }
        // Noncentral distribution of Fisher, by SciPy 1.16.
        let found = detectable_noncentrality(4e-6, 0.1, 16.0, 100.0);
        assert!((found / 80.736 - 1.0).abs() < 0.01, "{found}");
    }

    #[test]
    fn undefined_statistics_have_probability_zero() {
        assert_eq!(fisher_tail(f64::NAN, 2.0, 10.0), 0.0);
        assert_eq!(fisher_tail(1.0, 2.0, f64::NAN), 0.0);
        assert_eq!(student_tail(f64::NAN, 10.0), 0.0);
        assert_eq!(fisher_tail(f64::INFINITY, 2.0, 10.0), 0.0);
    }

    #[test]
    fn known_covariance_is_the_limit_of_many_degrees_of_freedom() {
        let known = Hotelling::new(20.0, 9.0, f64::INFINITY);
        let many = Hotelling::new(20.0, 9.0, 1e6);
        assert!((known.statistic - 20.0 / 9.0).abs() < 1e-12);
        assert!((known.probability - many.probability).abs() < 1e-5);
        // 5 % point of chi-squared with 9 degrees of freedom.
        let found = Hotelling::new(16.918_98, 9.0, f64::INFINITY).probability;
        assert!((found - 0.05).abs() < 1e-5, "{found}");
    }

    #[test]
    fn quantiles_match_published_tables() {
        for (probability, freedom, table) in [
            (0.05, 1.0, 12.706_204_736),
            (0.05, 10.0, 2.228_138_852),
            (0.05, 1e9, 1.959_963_985),
            (0.001, 29.0, 3.659_405_019),
        ] {
            let found = student_quantile(probability, freedom);
            assert!((found / table - 1.0).abs() < 1e-6, "{freedom}: {found}");
        }
        // 5 % points of Fisher's distribution.
        for (value, numerator, denominator) in [
            (4.964_603, 1.0, 10.0),
            (2.710_890, 5.0, 20.0),
            (1.534_314, 60.0, 60.0),
        ] {
            let found = fisher_tail(value, numerator, denominator);
            assert!((found - 0.05).abs() < 1e-5, "{found}");
        }
        assert!((log_gamma(0.5) - std::f64::consts::PI.sqrt().ln()).abs() < 1e-13);
    }
}
