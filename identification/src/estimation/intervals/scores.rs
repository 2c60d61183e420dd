//! The covariance of an estimate from its scores.
//!
//! The estimate is off by A^-1 Σ_t s_t, with s_t = Σ_j λ_j² w_jt ρ_jt the score of the equations of
//! instant t: lines j, weights λ_j, rows w_jt, residuals ρ_jt, and A = Σ_t G_t, G_t = Σ_j λ_j² w_jt w_jtᵀ.
//! So its covariance is the variance of a sum over time, which asks neither that the residual be as
//! large everywhere nor that the lines or successive instants be independent. It is estimated by
//! equally weighted cosines (Lazarus, Lewis, Stock and Watson, *HAR inference*, J. Business & Economic
//! Statistics 36, 2018): with φ_b(t) = √2 cos(π b (t + 1/2)/N), the sums T_b = Σ_t φ_b(t) A^-1 s_t have
//! that variance each for small b = 1 … B, and B = 0.41 N^(2/3), so
//!
//! ```text
//! σ_i² = (1/B) Σ_b T_bi²,
//! ```
//!
//! of about B degrees of freedom.
//!
//! The residual is not the noise: the fit has taken a part away, the more the closer the other columns
//! are to column i times a slow cosine. For white noise ε, ρ = (I - H) ε with H = Λ W A^-1 Wᵀ Λ, so that
//! T_1 … T_B of parameter i have the covariance matrix
//!
//! ```text
//! C_bb' = Σ_t φ_b φ_b' [A^-1 G_t A^-1]_ii - z_b · z_b',   z_b = R^-T (Σ_t φ_b G_t) A^-1 e_i,   A = RᵀR.
//! ```
//!
//! Its trace tells by how much σ_i² is too small, which is made good, and (tr C)²/tr C² are the degrees
//! of freedom of σ_i² (Bell and McCaffrey, *Survey Methodology* 28, 2002), which are few where a few
//! instants outweigh all others.

use nalgebra::DMatrix;
use rayon::prelude::*;

use crate::{
    estimation::estimate::Estimation,
    regression::system::{Stretch, System},
};

/// B = COSINES N^(2/3), the published rule.
const COSINES: f64 = 0.41;

/// Most cosines: more freedom than theirs hardly makes an interval shorter.
const MOST_COSINES: usize = 64;

/// Sections of a stretch for each cosine; within a section the cosines count as constant.
const SECTIONS: usize = 4;

/// The covariance of an estimate, with the degrees of freedom of its variances.
#[derive(Debug, Clone)]
pub(crate) struct Covariance {
    /// The covariance matrix.
    pub(crate) matrix: DMatrix<f64>,
    /// Degrees of freedom of each variance.
    pub(crate) freedoms: Vec<f64>,
}

impl Covariance {
    /// That of an estimate; none without successive equations.
    pub(crate) fn new(system: &System, context: &Context<'_>) -> Option<Self> {
        let p = context.selected.len();
        let shares: Vec<Share> = system
            .stretches
            .par_iter()
            .filter_map(|stretch| context.share(stretch))
            .collect();
        let kept: usize = shares.iter().map(|share| share.equations).sum();
        let equations = system.lines.iter().map(|line| line.equations()).max()?;
        if kept == 0 {
            return None;
        }
        let mut matrix = DMatrix::zeros(p, p);
        for share in &shares {
            matrix += &share.matrix;
        }
        let (mut factors, mut freedoms) = (Vec::new(), Vec::new());
        for i in 0..p {
            let sum = |of: fn(&Moments) -> f64| -> f64 {
                shares.iter().map(|share| of(&share.moments[i])).sum()
            };
            let (expected, squares) = (sum(|own| own.expected), sum(|own| own.squares));
            factors.push((sum(|own| own.wanted) / expected).sqrt());
            freedoms.push(expected * expected / squares);
        }
        let scale = equations as f64 / kept as f64;
        for (i, j) in (0..p).flat_map(|i| (0..p).map(move |j| (i, j))) {
            matrix[(i, j)] *= scale * factors[i] * factors[j];
        }
        let sound = matrix
            .iter()
            .chain(&freedoms)
            .all(|value| value.is_finite());
        sound.then_some(Self { matrix, freedoms })
    }

    /// Multiplies the variances by ratios, each with the degrees of freedom of its own, and leaves the
    /// correlations as they are.
    pub(crate) fn enlarge(&mut self, ratios: &[(f64, f64)]) {
        for (i, (ratio, freedom)) in ratios.iter().enumerate() {
            let factor = ratio.sqrt();
            self.matrix.row_mut(i).scale_mut(factor);
            self.matrix.column_mut(i).scale_mut(factor);
            self.freedoms[i] = 1.0 / (1.0 / self.freedoms[i] + 1.0 / freedom);
        }
    }
}

/// An estimate whose covariance is looked for.
#[derive(Debug)]
pub(crate) struct Context<'a> {
    /// The columns.
    pub(crate) selected: &'a [usize],
    /// Their estimation.
    pub(crate) estimation: &'a Estimation,
    /// A^-1.
    pub(crate) inverse: DMatrix<f64>,
}

/// What a stretch adds to the covariance.
struct Share {
    equations: usize,
    /// (1/B) Σ_b T_b T_bᵀ.
    matrix: DMatrix<f64>,
    moments: Vec<Moments>,
}

/// For one parameter, what white noise of unit variance gives.
struct Moments {
    /// The variance that is looked for.
    wanted: f64,
    /// The mean tr C/B of its estimate.
    expected: f64,
    /// tr C²/B².
    squares: f64,
}

/// B for so many successive equations.
pub(crate) fn cosines(equations: usize) -> usize {
    let cosines = (COSINES * (equations as f64).powf(2.0 / 3.0)) as usize;
    cosines.clamp(1, MOST_COSINES)
}

impl<'a> Context<'a> {
    /// That of an `estimation` of the columns `selected`.
    pub(crate) fn new(selected: &'a [usize], estimation: &'a Estimation) -> Self {
        let triangle = &estimation.inverse;
        Self {
            selected,
            estimation,
            inverse: triangle * triangle.transpose(),
        }
    }

    fn share(&self, stretch: &Stretch) -> Option<Share> {
        let equations = stretch.lines.first()?.nrows();
        let cosines = cosines(equations);
        let sections = (SECTIONS * cosines).min(equations);
        if sections <= cosines {
            return None;
        }
        let (scores, grams) = self.sections(stretch, equations, sections);
        let waves = DMatrix::from_fn(sections, cosines, |k, b| {
            std::f64::consts::SQRT_2 * cosine(b + 1, k, sections)
        });
        let sums = &self.inverse * scores * &waves;
        let matrix = &sums * sums.transpose() / cosines as f64;
        Some(Share {
            equations,
            matrix,
            moments: self.moments(&grams, &waves),
        })
    }

    /// For each section of a stretch its score, p x sections, and its G, p² x sections.
    fn sections(
        &self,
        stretch: &Stretch,
        equations: usize,
        sections: usize,
    ) -> (DMatrix<f64>, DMatrix<f64>) {
        let p = self.selected.len();
        let mut scores = DMatrix::zeros(p, sections);
        let mut grams = DMatrix::zeros(p * p, sections);
        for section in 0..sections {
            let first = equations * section / sections;
            let count = equations * (section + 1) / sections - first;
            let mut gram = DMatrix::zeros(p, p);
            for (line, weight) in stretch.lines.iter().zip(&self.estimation.weights) {
                let rows = line.rows(first, count);
                let own = rows.select_columns(self.selected) * *weight;
                let mut residual = rows.column(rows.ncols() - 1) * *weight;
                for (column, value) in own.column_iter().zip(&self.estimation.values) {
                    residual.axpy(-value, &column, 1.0);
                }
                scores
                    .column_mut(section)
                    .gemv_tr(1.0, &own, &residual, 1.0);
                gram.gemm_tr(1.0, &own, &own, 1.0);
            }
            grams.column_mut(section).copy_from_slice(gram.as_slice());
        }
        (scores, grams)
    }

    fn moments(&self, grams: &DMatrix<f64>, waves: &DMatrix<f64>) -> Vec<Moments> {
        let p = self.selected.len();
        let (sections, cosines) = waves.shape();
        // [A^-1 G_k A^-1]_ii of all sections k.
        let diagonals: Vec<Vec<f64>> = grams
            .column_iter()
            .map(|gram| {
                let gram = nalgebra::DMatrixView::from_slice(gram.as_slice(), p, p);
                let product = gram * &self.inverse;
                let own = |i: usize| self.inverse.column(i).dot(&product.column(i));
                (0..p).map(own).collect()
            })
            .collect();
        let sums = grams * waves;
        let fitted: Vec<DMatrix<f64>> = sums
            .column_iter()
            .map(|sum| {
                let sum = nalgebra::DMatrixView::from_slice(sum.as_slice(), p, p);
                self.estimation.inverse.tr_mul(&(sum * &self.inverse))
            })
            .collect();
        (0..p)
            .map(|i| {
                let own: Vec<f64> = diagonals.iter().map(|diagonal| diagonal[i]).collect();
                // φ_b φ_b' are cosines of the difference and of the sum.
                let spectrum: Vec<f64> = (0..=2 * cosines)
                    .map(|m| {
                        let terms = own.iter().enumerate();
                        terms.map(|(k, a)| a * cosine(m, k, sections)).sum()
                    })
                    .collect();
                let z = DMatrix::from_fn(p, cosines, |row, b| fitted[b][(row, i)]);
                let taken = z.tr_mul(&z);
                let c = DMatrix::from_fn(cosines, cosines, |a, b| {
                    spectrum[a.abs_diff(b)] + spectrum[a + b + 2] - taken[(a, b)]
                });
                let count = cosines as f64;
                Moments {
                    wanted: own.iter().sum(),
                    expected: c.trace() / count,
                    squares: c.norm_squared() / (count * count),
                }
            })
            .collect()
    }
}

/// cos(π b (k + 1/2)/K).
fn cosine(b: usize, k: usize, sections: usize) -> f64 {
    let angle = b as f64 * (k as f64 + 0.5) / sections as f64;
    (std::f64::consts::PI * angle).cos()
}
