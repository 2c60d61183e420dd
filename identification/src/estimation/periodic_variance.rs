//! Variance of weighted residual sums for periodic motion.
//!
//! A sum Σ_t z_t ρ_t over a periodic motion whose residual ρ also repeats is equal in every period.
//! Its variance does not decrease with the number of periods. It is estimated from the means over
//! all periods. With the Fourier transform over the M phases,
//!
//! ```text
//! V = 1/M² Σ_f z_f* S_f z_f,   S_f = mean of ρ_g ρ_g*/(1 - h_g) over g near f.
//! ```
//!
//! z_f and ρ_f contain all lines, and h is the leverage of the fit. The means also contain the
//! averaged noise, so V is the total variance.

use nalgebra::{DMatrix, DVector};

use super::fourier::Fourier;
use crate::regression::phase_sums::PhaseSums;

/// Neighbouring harmonics on either side that are averaged.
const NEIGHBOURS: usize = 4;

/// Smallest fraction of the residual after the fit that is corrected.
const LEAST_LEFT: f64 = 0.2;

/// Mean period of a motion, over its harmonics.
#[derive(Debug, Clone)]
pub(crate) struct Mean {
    phases: usize,
    lines: Vec<Line>,
}

/// Columns and residual of a line; real and imaginary parts, harmonics × columns.
#[derive(Debug, Clone)]
struct Line {
    columns: [DMatrix<f64>; 2],
    residual: [DVector<f64>; 2],
}

/// Variance estimate of a weighted residual sum, with its degrees of freedom.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct SumVariance {
    /// V.
    pub(crate) variance: f64,
    /// Σ z² over the motion.
    pub(crate) square: f64,
    /// V²/ν, with ν the degrees of freedom of V.
    scatter: f64,
}

impl Mean {
    /// Mean period of a motion; `None` if phases have no equations.
    ///
    /// `split` converts the mean rows of a line to weighted columns and residual.
    pub(crate) fn new(
        phase_sums: &[PhaseSums],
        split: impl Fn(usize, DMatrix<f64>) -> (DMatrix<f64>, DVector<f64>),
    ) -> Option<Self> {
        let (mut lines, mut phases) = (Vec::new(), 0);
        for (number, sums) in phase_sums.iter().enumerate() {
            let (columns, residual) = split(number, sums.means()?);
            phases = columns.nrows();
            let fourier = Fourier::circular(phases);
            let columns = fourier.whole(&columns);
            let rest = fourier.whole(&DMatrix::from_columns(&[residual]));
            let residual = rest.map(|part| part.column(0).clone_owned());
            lines.push(Line { columns, residual });
        }
        (!lines.is_empty()).then_some(Self { phases, lines })
    }

    /// 1 - h of each harmonic, for an estimate of the columns `selected` with this A^-1.
    pub(crate) fn left(&self, selected: &[usize], inverse: &DMatrix<f64>) -> Vec<f64> {
        let share = (self.phases * self.lines.len()) as f64;
        let mut taken = vec![0.0; self.phases / 2 + 1];
        for part in self.lines.iter().flat_map(|line| &line.columns) {
            let own = part.select_columns(selected);
            let product = &own * inverse;
            for (harmonic, sum) in taken.iter_mut().enumerate() {
                *sum += product.row(harmonic).dot(&own.row(harmonic)) / share;
            }
        }
        let left = taken.iter().map(|part| (1.0 - part).clamp(0.0, 1.0));
        left.collect()
    }

    /// Variances of residual sums weighted by combinations of the columns, columns × sums.
    ///
    /// `left` is 1 - h of each harmonic. `sizes` of the combinations are first subtracted from the
    /// residual.
    pub(crate) fn sum_variances(
        &self,
        combinations: &DMatrix<f64>,
        left: &[f64],
        sizes: Option<&DVector<f64>>,
    ) -> Vec<SumVariance> {
        let combined = |line: &Line| {
            let columns = line.columns.each_ref().map(|part| part * combinations);
            let rest = |part: usize| match sizes {
                Some(sizes) => &line.residual[part] - &columns[part] * sizes,
                None => line.residual[part].clone(),
            };
            let residual = [rest(0), rest(1)];
            Line { columns, residual }
        };
        let lines: Vec<Line> = self.lines.iter().map(combined).collect();
        let sums = 0..combinations.ncols();
        sums.map(|sum| self.sum_variance(&lines, left, sum))
            .collect()
    }

    /// Variance of Σ_t ρ_k ρ_l of two lines with independent periodic residuals, Σ_f |ρ_k|²
    /// |ρ_l|²/M².
    ///
    /// The second value is its square by its degrees of freedom.
    pub(crate) fn product(&self, first: usize, second: usize) -> [f64; 2] {
        let square = |line: &Line, f: usize| {
            let [real, imaginary] = &line.residual;
            real[f].powi(2) + imaginary[f].powi(2)
        };
        let (Some(a), Some(b)) = (self.lines.get(first), self.lines.get(second)) else {
            return [0.0; 2];
        };
        let last = self.phases / 2;
        let weight = |f: usize| if f == 0 || f == last { 1.0 } else { 2.0 };
        let scale = (self.phases as f64).powi(2);
        let each = (0..=last).map(|f| weight(f) * square(a, f) * square(b, f) / scale);
        // For normal ρ, the squared product has four times the mean's square on average, and its
        // variance is three times that.
        each.fold([0.0; 2], |[sum, scatter], one| {
            [sum + one, scatter + 0.5 * 0.75 * one * one]
        })
    }

    /// Variance of sum number `sum`, for lines whose columns belong to the sums.
    fn sum_variance(&self, lines: &[Line], left: &[f64], sum: usize) -> SumVariance {
        let last = left.len() - 1;
        let mut sum_variance = SumVariance::default();
        // Coefficient of the squared residual at each harmonic and line, for independent lines.
        let mut counts = vec![0.0; (last + 1) * lines.len()];
        let twice = |harmonic: usize| {
            if harmonic == 0 || harmonic == last {
                1.0
            } else {
                2.0
            }
        };
        let reach = NEIGHBOURS as isize;
        let least = LEAST_LEFT * (2 * NEIGHBOURS + 1) as f64;
        for f in 0..=last {
            let near = || (f as isize - reach..=f as isize + reach).map(|g| folded(g, last));
            let z = |line: &Line| line.columns.each_ref().map(|part| part[(f, sum)]);
            let weight: f64 = near().map(|(g, _)| left[g]).sum();
            let factor = twice(f) / weight.max(least) / (self.phases as f64).powi(2);
            for (g, sign) in near() {
                let (mut real, mut imaginary) = (0.0, 0.0);
                for (number, line) in lines.iter().enumerate() {
                    let ([a, b], [rest, other]) = (z(line), &line.residual);
                    let (c, d) = (rest[g], sign * other[g]);
                    real += a * c + b * d;
                    imaginary += a * d - b * c;
                    counts[g * lines.len() + number] += factor * (a * a + b * b);
                }
                sum_variance.variance += factor * (real * real + imaginary * imaginary);
            }
            for [a, b] in lines.iter().map(z) {
                sum_variance.square += twice(f) * (a * a + b * b) / self.phases as f64;
            }
        }
        let total: f64 = counts.iter().sum();
        let squares = counts.iter().enumerate();
        let squares = squares.map(|(place, count)| count * count / twice(place / lines.len()));
        let scatter = squares.sum::<f64>() / (total * total).max(f64::MIN_POSITIVE);
        sum_variance.scatter = scatter * sum_variance.variance.powi(2);
        sum_variance
    }
}

/// Harmonic of a place on the circle of frequencies, and the sign of its imaginary part.
fn folded(place: isize, last: usize) -> (usize, f64) {
    let last = last as isize;
    if place < 0 {
        (place.unsigned_abs().min(last.unsigned_abs()), -1.0)
    } else if place > last {
        ((2 * last - place).max(0).unsigned_abs(), -1.0)
    } else {
        (place.unsigned_abs(), 1.0)
    }
}

/// Estimated ratio of two variances.
#[derive(Debug, Clone, Copy)]
pub(crate) struct VarianceRatio {
    pub(crate) ratio: f64,
    /// Its degrees of freedom.
    pub(crate) freedom: f64,
}

impl VarianceRatio {
    /// Ratio of equal variances.
    pub(crate) const ONE: Self = Self {
        ratio: 1.0,
        freedom: f64::INFINITY,
    };
}

impl SumVariance {
    /// Sum over independent motions.
    pub(crate) fn and(self, other: Self) -> Self {
        Self {
            variance: self.variance + other.variance,
            square: self.square + other.square,
            scatter: self.scatter + other.scatter,
        }
    }

    /// Ratio of the variance to `other`, and its degrees of freedom.
    ///
    /// `other` is the variance estimate of all equations, and `total` their Σ z². The part of the
    /// equations without periodic motion keeps the variance `other`.
    pub(crate) fn by(self, other: f64, total: f64) -> VarianceRatio {
        let rest = (1.0 - self.square / total).clamp(0.0, 1.0);
        VarianceRatio {
            ratio: self.variance / other + rest,
            freedom: self.variance.powi(2) / self.scatter,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Mean, SumVariance};
    use crate::regression::phase_sums::{PhaseSums, Phases};
    use nalgebra::{DMatrix, DVector};
    use overact_logs::periods::PeriodicMotion;
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64;

    const PERIOD: usize = 128;
    const DRAWS: u64 = 400;

    /// Variance estimate of Σ z ρ over `periods`, and the sum itself.
    ///
    /// z is the sine of the fifth harmonic. The residual has noise of variance 1, and a periodic
    /// error of variance `returning`.
    fn drawn(seed: u64, periods: usize, returning: f64) -> (SumVariance, f64) {
        let mut generator = Pcg64::seed_from_u64(seed);
        let mut white = || {
            let all = (0..12).map(|_| generator.random_range(-0.5..0.5));
            all.sum::<f64>()
        };
        let error: Vec<f64> = (0..PERIOD).map(|_| returning.sqrt() * white()).collect();
        let motion = PeriodicMotion {
            samples: PERIOD,
            motion: 0,
        };
        let mut sums = PhaseSums::new(Phases::new(motion, 1).expect("long"), 2);
        let mut sum = 0.0;
        for equation in 0..periods * PERIOD {
            let angle = 5.0 * std::f64::consts::TAU * equation as f64 / PERIOD as f64;
            let (z, rest) = (angle.sin(), error[equation % PERIOD] + white());
            sum += z * rest;
            sums.add(equation, [z, rest].iter());
        }
        let split = |_, rows: DMatrix<f64>| {
            let columns = rows.columns(0, 1).clone_owned();
            (columns, DVector::from(rows.column(1)))
        };
        let mean = Mean::new(&[sums], split).expect("every phase");
        let all = vec![1.0; PERIOD / 2 + 1];
        (
            mean.sum_variances(&DMatrix::identity(1, 1), &all, None)[0],
            sum,
        )
    }

    #[test]
    fn the_sum_variance_includes_noise_and_periodic_residuals() {
        for (periods, returning) in [(1, 0.0), (10, 0.0), (10, 1.0), (40, 0.5)] {
            let (mut estimated, mut squares, mut freedom) = (0.0, 0.0, 0.0);
            for seed in 0..DRAWS {
                let (sum_variance, sum) = drawn(seed, periods, returning);
                estimated += sum_variance.variance / DRAWS as f64;
                squares += sum * sum / DRAWS as f64;
                freedom = sum_variance.by(1.0, sum_variance.square).freedom;
            }
            // Σ z² over all periods with independent noise; the periodic error adds up before
            // squaring.
            let half = 0.5 * (periods * PERIOD) as f64;
            let expected = half * (1.0 + periods as f64 * returning);
            assert!(
                (estimated / expected - 1.0).abs() < 0.05,
                "{estimated} {expected}"
            );
            assert!(
                (squares / expected - 1.0).abs() < 0.25,
                "{squares} {expected}"
            );
            // Nine harmonics of two numbers each.
            assert!((freedom - 18.0).abs() < 0.5, "{freedom}");
        }
    }

    #[test]
    fn explained_residuals_are_excluded_from_the_variance() {
        let (sum_variance, _) = drawn(1, 10, 0.0);
        let half = 0.5 * (10 * PERIOD) as f64;
        assert!((sum_variance.square - half).abs() < 1e-9 * half);
        // The same with the sine itself in the residual; subtracting its size removes it.
        let motion = PeriodicMotion {
            samples: PERIOD,
            motion: 0,
        };
        let mut sums = PhaseSums::new(Phases::new(motion, 1).expect("long"), 2);
        for equation in 0..PERIOD {
            let angle = 5.0 * std::f64::consts::TAU * equation as f64 / PERIOD as f64;
            sums.add(equation, [angle.sin(), 3.0 * angle.sin()].iter());
        }
        let split = |_, rows: DMatrix<f64>| {
            let columns = rows.columns(0, 1).clone_owned();
            (columns, DVector::from(rows.column(1)))
        };
        let mean = Mean::new(&[sums], split).expect("every phase");
        let all = vec![1.0; PERIOD / 2 + 1];
        let sizes = DVector::from_element(1, 3.0);
        let without_fault = mean.sum_variances(&DMatrix::identity(1, 1), &all, Some(&sizes))[0];
        assert!(without_fault.variance < 1e-20, "{}", without_fault.variance);
    }
}
