//! Autocorrelation of the sensor noise.
//!
//! The closure equations of sample t are e'_t = J'_t δp + noise. The noise ε is autoregressive: Σ_i
//! a_i ε_(t-i) is white with variance σ², and a_0 = 1. This approximates any stationary noise
//! (Berk, *Annals of Statistics* 2, 1974).
//!
//! Residuals underestimate the noise, since the fit removes correlated noise that resembles effects
//! of parameters. The autocovariances are therefore estimated by restricted maximum likelihood
//! (Patterson and Thompson, *Biometrika* 58, 1971), with expectation maximisation. With the current
//! noise, δp has the covariance V. The expected lagged products of the noise are those of its
//! residuals plus Σ_t tr(V J'_tᵀ J'_(t+k)). Levinson's recursion gives the coefficients. All terms
//! follow from the lagged products
//!
//! ```text
//! W_k = Σ_t [J'_t e'_t]ᵀ [J'_(t+k) e'_(t+k)],   k = 0 … p,
//! ```
//!
//! summed over the runs. Schwarz's criterion chooses the order p; it is zero for white noise.

use nalgebra::{DMatrix, DVector};

use super::elimination::Eliminated;

/// Largest number of expectation-maximisation steps, and relative change of σ² at their end.
const STEPS: usize = 300;
const SETTLED: f64 = 1e-6;

/// Largest order, by the decimal logarithm of the samples of a run.
///
/// Each coefficient also needs a number of equations.
const ORDERS_PER_DECADE: f64 = 8.0;
const EQUATIONS_PER_ORDER: usize = 10;

/// Autoregressive noise.
#[derive(Debug, Clone)]
pub(super) struct Noise {
    /// a_1 … a_p.
    pub(super) coefficients: Vec<f64>,
    /// σ².
    pub(super) variance: f64,
}

impl Noise {
    /// Noise of the residual of samples, fitted by the parameters `selected`.
    ///
    /// `equations` is their number without those of the poses.
    pub(super) fn new(
        samples: &[Eliminated],
        of_runs: &[usize],
        selected: &[usize],
        equations: usize,
    ) -> Self {
        let longest = of_runs.iter().copied().max().unwrap_or(0);
        let free = equations.saturating_sub(selected.len());
        let orders = (ORDERS_PER_DECADE * (longest.max(1) as f64).log10()) as usize;
        let orders = orders.min(free / EQUATIONS_PER_ORDER);
        let products = products(samples, of_runs, selected, orders);
        let likelihood = Likelihood {
            products: &products,
            equations: equations as f64,
        };
        let mut best: Option<(f64, Self)> = None;
        for order in 0..=orders {
            let Some((noise, badness)) = likelihood.maximised(order) else {
                continue;
            };
            let criterion = badness + (free.max(2) as f64).ln() * order as f64;
            if best.as_ref().is_none_or(|(least, _)| criterion < *least) {
                best = Some((criterion, noise));
            }
        }
        best.map_or_else(
            || Self {
                coefficients: Vec::new(),
                variance: 0.0,
            },
            |(_, noise)| noise,
        )
    }

    /// Autocovariances of the lags 0 … `count` - 1; not finite for unstable noise.
    pub(super) fn autocovariances(&self, count: usize) -> Vec<f64> {
        let mut all = first_autocovariances(&self.coefficients, self.variance);
        all.truncate(count);
        while all.len() < count {
            let before = all.iter().rev();
            let next = self.coefficients.iter().zip(before).map(|(a, c)| a * c);
            all.push(-next.sum::<f64>());
        }
        all
    }

    /// Covariance of the estimated coefficients, σ² C^-1/`equations`.
    ///
    /// C is the matrix of the first p autocovariances.
    pub(super) fn uncertainty(&self, equations: f64) -> Option<DMatrix<f64>> {
        let order = self.coefficients.len();
        let first = self.autocovariances(order);
        let matrix = DMatrix::from_fn(order, order, |i, j| first[i.abs_diff(j)]);
        let inverse = matrix.cholesky()?.inverse();
        Some(inverse * (self.variance / equations))
    }
}

/// Lagged products W_k of the columns of parameters and of the residual.
fn products(
    samples: &[Eliminated],
    of_runs: &[usize],
    selected: &[usize],
    orders: usize,
) -> Vec<DMatrix<f64>> {
    let size = selected.len() + 1;
    // Columns of unit length, to be independent of units.
    let mut lengths = vec![0.0; selected.len()];
    for sample in samples {
        for (length, &place) in lengths.iter_mut().zip(selected) {
            *length += sample.columns.column(place).norm_squared();
        }
    }
    let rows = |sample: &Eliminated| {
        let mut row = DMatrix::zeros(sample.residual.len(), size);
        for (k, (&place, length)) in selected.iter().zip(&lengths).enumerate() {
            row.set_column(k, &(sample.columns.column(place) / length.sqrt()));
        }
        row.set_column(size - 1, &sample.residual);
        row
    };
    let rows: Vec<DMatrix<f64>> = samples.iter().map(rows).collect();
    let mut products = vec![DMatrix::zeros(size, size); orders + 1];
    let mut first = 0;
    for &count in of_runs {
        let run = &rows[first..first + count];
        first += count;
        for (lag, product) in products.iter_mut().enumerate() {
            for (now, later) in run.iter().zip(run.iter().skip(lag)) {
                product.gemm_tr(1.0, now, later, 1.0);
            }
        }
    }
    products
}

/// Restricted likelihood of noise of any order.
struct Likelihood<'a> {
    products: &'a [DMatrix<f64>],
    equations: f64,
}

impl Likelihood<'_> {
    /// Most likely noise of an order, and -2 log of its restricted likelihood up to a constant.
    fn maximised(&self, order: usize) -> Option<(Noise, f64)> {
        let mut noise = Noise {
            coefficients: vec![0.0; order],
            variance: self.square() / self.equations,
        };
        for _ in 0..STEPS {
            let expected = self.expected(&noise)?;
            let next = levinson(&expected[..=order])?;
            let change = (next.variance / noise.variance - 1.0).abs();
            noise = next;
            if change < SETTLED {
                break;
            }
        }
        let (normal, change) = self.filtered(&noise)?;
        let left = self.filtered_square(&noise, &change);
        let parameters = change.len() as f64;
        let determinant = normal.cholesky()?.ln_determinant();
        let badness = (self.equations - parameters) * noise.variance.ln()
            + determinant
            + left / noise.variance;
        Some((noise, badness))
    }

    /// Sum of squares of the residual.
    fn square(&self) -> f64 {
        let whole = &self.products[0];
        whole[(whole.nrows() - 1, whole.nrows() - 1)]
    }

    /// Expected autocovariances of the noise.
    fn expected(&self, noise: &Noise) -> Option<Vec<f64>> {
        let (normal, change) = self.filtered(noise)?;
        let covariance = normal.cholesky()?.inverse() * noise.variance;
        let m = change.len();
        let direction = direction(&change);
        let of_lag = |product: &DMatrix<f64>| {
            let left = direction.dot(&(product * &direction));
            let columns = product.view((0, 0), (m, m));
            let hidden = columns.component_mul(&covariance).sum();
            (left + hidden) / self.equations
        };
        Some(self.products.iter().map(of_lag).collect())
    }

    /// Products of the filtered columns and residuals, summed over t.
    fn filtered_products(&self, noise: &Noise) -> DMatrix<f64> {
        let filter: Vec<f64> = std::iter::once(1.0)
            .chain(noise.coefficients.iter().copied())
            .collect();
        let mut sum = DMatrix::zeros(self.products[0].nrows(), self.products[0].ncols());
        for (lag, product) in self.products.iter().enumerate().take(filter.len()) {
            let pairs = filter.iter().zip(filter.iter().skip(lag));
            let factor: f64 = pairs.map(|(a, b)| a * b).sum();
            if lag == 0 {
                sum += product * factor;
            } else {
                sum += (product + product.transpose()) * factor;
            }
        }
        sum
    }

    /// Normal matrix of the filtered equations, and their solution δp.
    fn filtered(&self, noise: &Noise) -> Option<(DMatrix<f64>, DVector<f64>)> {
        let all = self.filtered_products(noise);
        let m = all.nrows() - 1;
        let normal = all.view((0, 0), (m, m)).into_owned();
        let right = all.view((0, m), (m, 1)).column(0).into_owned();
        let change = normal.clone().cholesky()?.solve(&right);
        Some((normal, change))
    }

    /// Sum of squares of the residual of the filtered equations.
    fn filtered_square(&self, noise: &Noise, change: &DVector<f64>) -> f64 {
        let direction = direction(change);
        direction.dot(&(self.filtered_products(noise) * &direction))
    }
}

/// [-δp, 1], which converts [J' e'] to the residual after a change δp.
fn direction(change: &DVector<f64>) -> DVector<f64> {
    let mut direction = -change.clone().insert_row(change.len(), 0.0);
    direction[change.len()] = 1.0;
    direction
}

/// Autoregressive noise with the autocovariances c_0 … c_p, by Levinson's recursion.
fn levinson(autocovariances: &[f64]) -> Option<Noise> {
    let mut coefficients: Vec<f64> = Vec::new();
    let mut variance = *autocovariances.first()?;
    for lag in 1..autocovariances.len() {
        let earlier = autocovariances[1..lag].iter().rev();
        let sum: f64 = coefficients.iter().zip(earlier).map(|(a, c)| a * c).sum();
        let reflection = -(autocovariances[lag] + sum) / variance;
        // Also false for NaN.
        let stable = variance > 0.0 && reflection.abs() < 1.0;
        if !stable {
            return None;
        }
        let reversed: Vec<f64> = coefficients.iter().rev().copied().collect();
        for (own, mirrored) in coefficients.iter_mut().zip(reversed) {
            *own += reflection * mirrored;
        }
        coefficients.push(reflection);
        variance *= 1.0 - reflection * reflection;
    }
    (variance > 0.0).then_some(Noise {
        coefficients,
        variance,
    })
}

/// Autocovariances c_0 … c_p of autoregressive noise.
///
/// Levinson's recursion backwards gives the reflection coefficients, then forwards the result.
fn first_autocovariances(coefficients: &[f64], variance: f64) -> Vec<f64> {
    let mut orders = vec![coefficients.to_vec()];
    let mut power = variance;
    while let Some(last) = orders.last().filter(|last| !last.is_empty()) {
        let (reflection, rest) = (last[last.len() - 1], &last[..last.len() - 1]);
        let scale = 1.0 - reflection * reflection;
        // Unstable noise has no finite variance.
        power = if scale > 0.0 {
            power / scale
        } else {
            f64::INFINITY
        };
        let mirrored = rest.iter().rev();
        let smaller = rest.iter().zip(mirrored);
        let smaller = smaller.map(|(own, mirrored)| (own - reflection * mirrored) / scale);
        orders.push(smaller.collect());
    }
    let mut all = vec![power];
    for order in orders.iter().rev().skip(1) {
        // The last Yule-Walker equation of this order gives the next autocovariance.
        let before = all.iter().rev();
        let next: f64 = order.iter().zip(before).map(|(a, c)| a * c).sum();
        all.push(-next);
    }
    all
}

#[cfg(test)]
mod tests {
    use super::{Noise, levinson};

    #[test]
    fn autocovariances_and_ar_coefficients_are_inverse() {
        let noise = Noise {
            coefficients: vec![-1.2, 0.6, -0.1],
            variance: 2.0,
        };
        let first = noise.autocovariances(6);
        // Σ_i a_i c_(k-i) = 0 for k > 0, σ² for k = 0.
        for k in 0..6_usize {
            let terms = noise.coefficients.iter().enumerate();
            let sum: f64 = terms.map(|(i, a)| a * first[k.abs_diff(i + 1)]).sum();
            let wanted = if k == 0 { 2.0 } else { 0.0 };
            assert!((first[k] + sum - wanted).abs() < 1e-12, "{k}: {first:?}");
        }
        let found = levinson(&first[..4]).expect("stable noise");
        assert!((found.variance - 2.0).abs() < 1e-12);
        for (own, wanted) in found.coefficients.iter().zip(&noise.coefficients) {
            assert!((own - wanted).abs() < 1e-12, "{found:?}");
        }
    }
}
