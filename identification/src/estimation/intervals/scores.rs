//! Covariance of an estimate from its scores.
//!
//! The error of the estimate is A^-1 Σ_t s_t, with the score s_t = Σ_j λ_j² w_jt ρ_jt of instant t.
//! Lines are j, weights λ_j, rows w_jt and residuals ρ_jt, and A = Σ_t G_t with G_t = Σ_j λ_j² w_jt
//! w_jtᵀ. The covariance is thus the variance of a sum over time. The size of the residual may
//! vary, and lines and successive instants may be correlated. Equally weighted cosines estimate it
//! (Lazarus, Lewis, Stock and Watson, *HAR inference*, J. Business & Economic Statistics 36, 2018).
//! With φ_b(t) = √2 cos(π b (t + 1/2)/N), each sum T_b = Σ_t φ_b(t) A^-1 s_t has that variance for
//! small b = 1 … B, where B = 0.41 N^(2/3). Then
//!
//! ```text
//! σ_i² = (1/B) Σ_b T_bi²
//! ```
//!
//! has about B degrees of freedom.
//!
//! **Correction for the fit.** The fit removes part of the noise, more so if other columns resemble
//! column i times a slow cosine. Let the noise ε be white in time with any covariance of the lines
//! at each instant. Then ρ = (I - H) ε with H = Λ W A^-1 Wᵀ Λ. The sums T_1 … T_B of parameter i
//! have the covariance
//!
//! ```text
//! C_bb' = Σ_t φ_b φ_b' [A^-1 V_t A^-1]_ii - z_b · y_b' - y_b · z_b' + z_bᵀ R^-T (Σ_t V_t) R^-1 z_b',
//! A = RᵀR,   z_b = R^-T (Σ_t φ_b G_t) A^-1 e_i,   y_b = R^-T (Σ_t φ_b V_t) A^-1 e_i,
//! ```
//!
//! with the covariance V_t of the score of instant t. C is linear in V_t, so s_t s_tᵀ may replace
//! V_t (White, *Econometrica* 48, 1980). This matters if the noise level changes within a few
//! instants, or if lines share noise. In the actuator projection, the torque of an omitted actuator
//! enters the equations of all kept ones, most strongly near a singularity of the partition.
//!
//! The trace of C determines the correction of σ_i². The degrees of freedom of σ_i² are (tr C)²/tr
//! C² (Bell and McCaffrey, *Survey Methodology* 28, 2002). They are few if a few instants dominate.
//!
//! **Other linear estimates.** With instruments Z, rows x = [w z] and the estimate M Σ λ² x y, the
//! scores are M x ρ. Then M V_t Mᵀ replaces A^-1 V_t A^-1, with V_t of the rows x. Further, z_b =
//! R^-T (Σ_t φ_b G_t)_w Mᵀ e_i with the rows of G_t that belong to w, and likewise y_b.

use std::ops::Range;

use nalgebra::DMatrix;
use rayon::prelude::*;

use crate::{
    estimation::{correlation::square, estimate::Estimation, periodic_variance::VarianceRatio},
    regression::system::{Stretch, System},
};

/// B = COSINES N^(2/3), the published rule.
const COSINES: f64 = 0.41;

/// Largest number of cosines; more hardly shorten the intervals.
const MOST_COSINES: usize = 64;

/// Sections of a stretch for each cosine; cosines are constant within a section.
pub(crate) const SECTIONS: usize = 4;

/// Variance of the square of a normal variable divided by its fourth moment.
const SCATTER: f64 = 2.0 / 3.0;

/// Covariance of an estimate, with the degrees of freedom of its variances.
#[derive(Debug, Clone)]
pub(crate) struct Covariance {
    /// Covariance matrix.
    pub(crate) matrix: DMatrix<f64>,
    /// Degrees of freedom of each variance.
    pub(crate) freedoms: Vec<f64>,
}

impl Covariance {
    /// Covariance of an estimate; `None` without successive equations.
    pub(crate) fn new(system: &System, context: &Context<'_>) -> Option<Self> {
        let p = context.selected.len();
        let stretches = || system.stretches.par_iter();
        let noise = stretches().map(|stretch| context.noise(stretch));
        let noise = noise.reduce(|| DMatrix::zeros(p, p), |a, b| a + b);
        let inverse = &context.estimation.inverse;
        let noise = inverse.transpose() * noise * inverse;
        let contributions: Vec<StretchContribution> = stretches()
            .filter_map(|stretch| context.contribution(stretch, &noise))
            .collect();
        let kept: usize = contributions
            .iter()
            .map(|contribution| contribution.equations)
            .sum();
        let equations = system.lines.iter().map(|line| line.equations()).max()?;
        if kept == 0 {
            return None;
        }
        let mut matrix = DMatrix::zeros(p, p);
        for contribution in &contributions {
            matrix += &contribution.matrix;
        }
        let (mut factors, mut freedoms) = (Vec::new(), Vec::new());
        for i in 0..p {
            let sum = |of: fn(&Moments) -> f64| -> f64 {
                contributions
                    .iter()
                    .map(|contribution| of(&contribution.moments[i]))
                    .sum()
            };
            let (expected, squares) = (sum(|own| own.expected), sum(|own| own.squares));
            // An estimate independent of the data has no variance.
            let varies = expected > 0.0;
            let factor = (sum(|own| own.wanted) / expected).sqrt();
            factors.push(if varies { factor } else { 1.0 });
            let freedom = expected * expected / squares;
            freedoms.push(if varies { freedom } else { f64::INFINITY });
        }
        let scale = equations as f64 / kept as f64;
        for (i, j) in (0..p).flat_map(|i| (0..p).map(move |j| (i, j))) {
            matrix[(i, j)] *= scale * factors[i] * factors[j];
        }
        let sound = matrix.iter().all(|value| value.is_finite())
            && freedoms.iter().all(|freedom| !freedom.is_nan());
        sound.then_some(Self { matrix, freedoms })
    }

    /// Multiplies the variances by ratios; keeps correlations.
    pub(crate) fn enlarge(&mut self, ratios: &[VarianceRatio]) {
        for (i, own) in ratios.iter().enumerate() {
            let factor = own.ratio.sqrt();
            self.matrix.row_mut(i).scale_mut(factor);
            self.matrix.column_mut(i).scale_mut(factor);
            self.freedoms[i] = 1.0 / (1.0 / self.freedoms[i] + 1.0 / own.freedom);
        }
    }
}

/// A linear estimate whose covariance is wanted.
#[derive(Debug)]
pub(crate) struct Context<'a> {
    /// Estimated columns.
    pub(crate) selected: &'a [usize],
    /// Estimation of these columns.
    pub(crate) estimation: &'a Estimation,
    /// A^-1.
    pub(crate) inverse: DMatrix<f64>,
    /// M for an estimate other than least squares: p × 2 p, columns then instruments.
    influence: Option<DMatrix<f64>>,
}

/// Contribution of a stretch to the covariance.
struct StretchContribution {
    equations: usize,
    /// (1/B) Σ_b T_b T_bᵀ.
    matrix: DMatrix<f64>,
    moments: Vec<Moments>,
}

/// Sums over the sections of a stretch, one column each.
struct Sections {
    /// Σ x ρ, q × sections, for rows x of q values.
    scores: DMatrix<f64>,
    /// [M V Mᵀ]_ii, p × sections.
    variances: DMatrix<f64>,
    /// Σ_t (M s_t)_i⁴ of the stretch.
    fourths: Vec<f64>,
    /// Rows of G that belong to columns, without the lower triangle.
    fitted: DMatrix<f64>,
    /// Rows of V that belong to columns, without the lower triangle.
    noisy: DMatrix<f64>,
}

/// Equations of a section.
struct Section {
    /// Scores s_t, one row per instant.
    scores: DMatrix<f64>,
    /// G.
    gram: DMatrix<f64>,
}

impl Section {
    /// Adds products of the columns at some places to G.
    fn add(&mut self, products: &DMatrix<f64>, places: &[usize]) {
        if places.len() == self.gram.ncols() {
            self.gram += products;
            return;
        }
        for (to, from) in places.iter().zip(products.column_iter()) {
            let mut column = self.gram.column_mut(*to);
            for (row, value) in places.iter().zip(from.iter()) {
                column[*row] += value;
            }
        }
    }
}

/// Moments of one parameter's variance estimate for noise white in time.
struct Moments {
    /// True variance.
    wanted: f64,
    /// Mean tr C/B of its estimate.
    expected: f64,
    /// tr C²/B².
    squares: f64,
}

/// B for this number of successive equations.
pub(crate) fn cosines(equations: usize) -> usize {
    let cosines = (COSINES * (equations as f64).powf(2.0 / 3.0)) as usize;
    cosines.clamp(1, MOST_COSINES)
}

impl<'a> Context<'a> {
    /// Context of a least-squares `estimation` of the columns `selected`.
    pub(crate) fn new(selected: &'a [usize], estimation: &'a Estimation) -> Self {
        let triangle = &estimation.inverse;
        Self {
            selected,
            estimation,
            inverse: triangle * triangle.transpose(),
            influence: None,
        }
    }

    /// Context of another linear estimate with the influence M of columns and instruments.
    ///
    /// `estimation` has the values that define the residual, and R^-1 of least squares.
    pub(crate) fn with_influence(self, influence: DMatrix<f64>) -> Self {
        Self {
            influence: Some(influence),
            ..self
        }
    }

    /// M.
    pub(super) fn influence(&self) -> &DMatrix<f64> {
        self.influence.as_ref().unwrap_or(&self.inverse)
    }

    /// Σ_t V_t of a stretch, for columns only.
    fn noise(&self, stretch: &Stretch) -> DMatrix<f64> {
        let p = self.selected.len();
        let nonzero = self.nonzero(stretch);
        let mut sum = DMatrix::zeros(p, p);
        let sections = counts(stretch).map_or(0, |(_, sections)| sections);
        for section in 0..sections {
            let range = range(stretch, section, sections);
            let scores = self.section(stretch, &nonzero, range, false).scores;
            let own = scores.columns(0, p);
            sum.gemm(1.0, &own.transpose(), &own, 1.0);
        }
        sum
    }

    fn contribution(&self, stretch: &Stretch, noise: &DMatrix<f64>) -> Option<StretchContribution> {
        let (cosines, sections) = counts(stretch)?;
        let sums_of_sections = self.sections(stretch, sections);
        let waves = DMatrix::from_fn(sections, cosines, |k, b| {
            std::f64::consts::SQRT_2 * cosine(b + 1, k, sections)
        });
        let sums = self.influence() * &sums_of_sections.scores * &waves;
        let matrix = &sums * sums.transpose() / cosines as f64;
        Some(StretchContribution {
            equations: stretch.lines.first()?.nrows(),
            matrix,
            moments: self.moments(&sums_of_sections, &waves, noise),
        })
    }

    /// Computes the sums of all sections of a stretch.
    fn sections(&self, stretch: &Stretch, sections: usize) -> Sections {
        let turned = self.influence().transpose();
        let nonzero = self.nonzero(stretch);
        let (q, p) = turned.shape();
        let entries = q * p - p * p.saturating_sub(1) / 2;
        let mut sums_of_sections = Sections {
            scores: DMatrix::zeros(q, sections),
            variances: DMatrix::zeros(p, sections),
            fourths: vec![0.0; p],
            fitted: DMatrix::zeros(entries, sections),
            noisy: DMatrix::zeros(entries, sections),
        };
        for section in 0..sections {
            let range = range(stretch, section, sections);
            let Section { scores, gram } = self.section(stretch, &nonzero, range, true);
            sums_of_sections
                .scores
                .set_column(section, &scores.row_sum_tr());
            let noise = square(&scores);
            let own = scores * &turned;
            for (i, column) in own.column_iter().enumerate() {
                sums_of_sections.variances[(i, section)] = column.norm_squared();
                sums_of_sections.fourths[i] +=
                    column.iter().map(|value| value.powi(4)).sum::<f64>();
            }
            for (to, from) in [
                (&mut sums_of_sections.fitted, &gram),
                (&mut sums_of_sections.noisy, &noise),
            ] {
                let mut place = to.column_mut(section);
                let upper = (0..q).flat_map(|j| &from.as_slice()[j * q..j * q + p.min(j + 1)]);
                place
                    .iter_mut()
                    .zip(upper)
                    .for_each(|(to, from)| *to = *from);
            }
        }
        sums_of_sections
    }

    /// Places of the columns of each line of a stretch that are not zero.
    fn nonzero(&self, stretch: &Stretch) -> Vec<Vec<usize>> {
        let is_nonzero = |column: &[f64]| column.iter().any(|value| *value != 0.0);
        let of_line = |line| {
            let columns = self.columns(stretch, line).enumerate();
            let nonzero = columns.filter(|(_, column)| is_nonzero(column));
            nonzero.map(|(place, _)| place).collect()
        };
        (0..stretch.lines.len()).map(of_line).collect()
    }

    /// Equations of a section of a stretch; with G if `wanted`.
    ///
    /// `nonzero` are the places of each line's columns that are not zero.
    fn section(
        &self,
        stretch: &Stretch,
        nonzero: &[Vec<usize>],
        range: Range<usize>,
        wanted: bool,
    ) -> Section {
        let (q, count) = (self.influence().ncols(), range.len());
        let mut section = Section {
            scores: DMatrix::zeros(count, q),
            gram: DMatrix::zeros(if wanted { q } else { 0 }, if wanted { q } else { 0 }),
        };
        let mut residual = vec![0.0; count];
        // Weighted rows of lines with the same columns, stacked line by line.
        let mut stacked: Vec<f64> = Vec::new();
        let lines = stretch.lines.iter().zip(&self.estimation.weights);
        let lines: Vec<_> = lines.zip(nonzero).enumerate().collect();
        for group in lines.chunk_by(|(_, (_, own)), (_, (_, next))| own == next) {
            let places = group.first().map_or(&[][..], |(_, (_, own))| own);
            let height = count * group.len();
            stacked.clear();
            stacked.resize(height * places.len(), 0.0);
            for (inside, (number, ((line, weight), _))) in group.iter().enumerate() {
                let own = inside * count..(inside + 1) * count;
                let measured = &column(line, line.ncols() - 1)[range.clone()];
                scale(&mut residual, measured, **weight);
                let mut columns = self.columns(stretch, *number).enumerate();
                for (to, place) in stacked.chunks_exact_mut(height).zip(places) {
                    let from = columns.find(|(own, _)| own == place);
                    let Some((_, from)) = from else { continue };
                    let to = &mut to[own.clone()];
                    scale(to, &from[range.clone()], **weight);
                    // The columns come before the instruments.
                    if let Some(value) = self.estimation.values.get(*place) {
                        let left = residual.iter_mut().zip(to);
                        left.for_each(|(left, x)| *left -= value * *x);
                    }
                }
                for (from, place) in stacked.chunks_exact(height).zip(places) {
                    let sums = &mut section.scores.as_mut_slice()[place * count..][..count];
                    for ((sum, x), left) in sums.iter_mut().zip(&from[own.clone()]).zip(&residual) {
                        *sum += x * left;
                    }
                }
            }
            if wanted {
                let rows = DMatrix::from_vec(height, places.len(), std::mem::take(&mut stacked));
                section.add(&square(&rows), places);
                stacked = rows.data.into();
            }
        }
        section
    }

    /// Columns of the rows x of a line of a stretch.
    fn columns<'s>(&'s self, stretch: &'s Stretch, line: usize) -> impl Iterator<Item = &'s [f64]> {
        let instruments = self.influence.as_ref();
        let instruments = instruments.and_then(|_| stretch.instruments.get(line));
        let all = std::iter::once(&stretch.lines[line]).chain(instruments);
        all.flat_map(|rows| self.selected.iter().map(|place| column(rows, *place)))
    }

    /// R^-T (Σ φ_b X) Mᵀ of all cosines side by side.
    ///
    /// `sections` holds the rows X of each section without their lower triangle.
    fn turned(&self, sections: &DMatrix<f64>, waves: &DMatrix<f64>) -> DMatrix<f64> {
        let (p, q) = self.influence().shape();
        let sums = sections * waves;
        // Few products of large matrices take less time than many of small ones.
        let mut below = DMatrix::zeros(p * waves.ncols(), q);
        for (b, sum) in sums.column_iter().enumerate() {
            let mut values = sum.iter();
            for j in 0..q {
                for i in 0..p.min(j + 1) {
                    let value = values.next().copied().unwrap_or_default();
                    below[(b * p + i, j)] = value;
                    if j < p {
                        below[(b * p + j, i)] = value;
                    }
                }
            }
        }
        let below = below * self.influence().transpose();
        let mut beside = DMatrix::zeros(p, p * waves.ncols());
        for b in 0..waves.ncols() {
            let own = below.rows(b * p, p);
            beside.columns_mut(b * p, p).copy_from(&own);
        }
        self.estimation.inverse.transpose() * beside
    }

    fn moments(
        &self,
        sums_of_sections: &Sections,
        waves: &DMatrix<f64>,
        noise: &DMatrix<f64>,
    ) -> Vec<Moments> {
        let p = self.selected.len();
        let (sections, cosines) = waves.shape();
        let fitted = self.turned(&sums_of_sections.fitted, waves);
        let noisy = self.turned(&sums_of_sections.noisy, waves);
        // Half of the symmetric correction: the quadratic term minus the mixed ones.
        let correction = noise * &fitted * 0.5 - noisy;
        // φ_b φ_b' are cosines of the difference and of the sum.
        let both = DMatrix::from_fn(sections, 2 * cosines + 1, |k, m| cosine(m, k, sections));
        let spectra = &sums_of_sections.variances * both;
        (0..p)
            .map(|i| {
                let own = sums_of_sections.variances.row(i);
                let spectrum = spectra.row(i);
                let of = |all: &DMatrix<f64>| {
                    DMatrix::from_fn(p, cosines, |row, b| all[(row, b * p + i)])
                };
                let half = of(&fitted).transpose() * of(&correction);
                let c = DMatrix::from_fn(cosines, cosines, |a, b| {
                    spectrum[a.abs_diff(b)] + spectrum[a + b + 2] + (half[(a, b)] + half[(b, a)])
                });
                let count = cosines as f64;
                let expected = c.trace() / count;
                // Scatter of single squares, which enters every C_bb'².
                let by_chance = SCATTER * sums_of_sections.fourths[i];
                let squares = c.norm_squared() / (count * count) - by_chance;
                Moments {
                    wanted: own.iter().sum(),
                    expected,
                    squares: squares.max(expected * expected / count),
                }
            })
            .collect()
    }
}

/// A column of a matrix.
fn column(matrix: &DMatrix<f64>, place: usize) -> &[f64] {
    let rows = matrix.nrows();
    &matrix.as_slice()[place * rows..(place + 1) * rows]
}

/// Writes `from` times `factor` to `to`.
fn scale(to: &mut [f64], from: &[f64], factor: f64) {
    to.iter_mut()
        .zip(from)
        .for_each(|(to, from)| *to = factor * from);
}

/// Numbers of cosines and sections of a stretch; `None` if it is too short.
fn counts(stretch: &Stretch) -> Option<(usize, usize)> {
    let equations = stretch.lines.first()?.nrows();
    let cosines = cosines(equations);
    let sections = (SECTIONS * cosines).min(equations);
    (sections > cosines).then_some((cosines, sections))
}

/// Equations of a section.
fn range(stretch: &Stretch, section: usize, sections: usize) -> Range<usize> {
    let equations = stretch.lines.first().map_or(0, DMatrix::nrows);
    equations * section / sections..equations * (section + 1) / sections
}

/// cos(π b (k + 1/2)/K).
fn cosine(b: usize, k: usize, sections: usize) -> f64 {
    let angle = b as f64 * (k as f64 + 0.5) / sections as f64;
    (std::f64::consts::PI * angle).cos()
}
