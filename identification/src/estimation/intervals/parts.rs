//! Covariance of an estimate from score sums over parts of the runs.
//!
//! It only needs the R factor of each part, not successive equations. The score of part g is s_g =
//! Σ_j λ_j² W_gjᵀ ρ_gj. It follows from the factors for any χ, since W_gjᵀ ρ_gj = R_Wᵀ (R_Y - R_W
//! χ). For independent parts the covariance is A^-1 (Σ_g s_g s_gᵀ) A^-1, for any residual within
//! them (Liang and Zeger, *Biometrika* 73, 1986). The fit reduces the scores. For white noise of
//! the weighted equations, T_g = e_iᵀ A^-1 s_g has the covariance
//!
//! ```text
//! C_gg' = δ_gg' a_g - z_gᵀ z_g',   a_g = e_iᵀ A^-1 G_g A^-1 e_i,
//! z_g = R^-T G_g A^-1 e_i,   G_g = Σ_j λ_j² W_gjᵀ W_gj.
//! ```
//!
//! The variance is divided by tr C/Σ a_g and has (tr C)²/tr C² degrees of freedom (Bell and
//! McCaffrey, *Survey Methodology* 28, 2002), few for few parts. Two effects are neglected:
//! neighbouring parts are not quite independent, and residuals may repeat with the motion.

use nalgebra::{DMatrix, DVector};

use super::scores::{Context, Covariance};
use crate::regression::system::{RunPart, System};

/// Smallest fraction of the white-noise variance that the parts must represent.
const LEAST_VARIANCE_RATIO: f64 = 1e-6;

/// Covariance from the parts of a system; `None` if they represent too little of a parameter.
pub(super) fn covariance(system: &System, context: &Context<'_>) -> Option<Covariance> {
    let p = context.selected.len();
    let inverse = &context.inverse;
    let turned = context.estimation.inverse.transpose();
    let grams: Vec<DMatrix<f64>> = system
        .parts
        .iter()
        .map(|part| gram(part, context))
        .collect();
    let scores: Vec<DVector<f64>> = system
        .parts
        .iter()
        .map(|part| score(part, context))
        .collect();
    let shares: Vec<DMatrix<f64>> = grams.iter().map(|gram| gram * inverse).collect();
    let mut matrix = DMatrix::zeros(p, p);
    for score in &scores {
        let own = inverse * score;
        matrix.ger(1.0, &own, &own, 1.0);
    }
    let (mut factors, mut freedoms) = (Vec::new(), Vec::new());
    for i in 0..p {
        let own = shares.iter().map(|share| share.column(i));
        let own: Vec<DVector<f64>> = own.map(|own| own.clone_owned()).collect();
        let a = own.iter().map(|own| inverse.column(i).dot(own));
        let a: Vec<f64> = a.collect();
        let z: Vec<DVector<f64>> = own.iter().map(|own| &turned * own).collect();
        let c = DMatrix::from_fn(z.len(), z.len(), |g, h| {
            let same = if g == h { a[g] } else { 0.0 };
            same - z[g].dot(&z[h])
        });
        let wanted: f64 = a.iter().sum();
        let variance_ratio = c.trace() / wanted;
        if variance_ratio.is_nan() || variance_ratio < LEAST_VARIANCE_RATIO {
            return None;
        }
        factors.push(variance_ratio.sqrt().recip());
        freedoms.push(c.trace().powi(2) / c.norm_squared());
    }
    for (i, j) in (0..p).flat_map(|i| (0..p).map(move |j| (i, j))) {
        matrix[(i, j)] *= factors[i] * factors[j];
    }
    let sound = matrix
        .iter()
        .chain(&freedoms)
        .all(|value| value.is_finite());
    sound.then_some(Covariance { matrix, freedoms })
}

/// G of a part.
pub(super) fn gram(part: &RunPart, context: &Context<'_>) -> DMatrix<f64> {
    let p = context.selected.len();
    let mut sum = DMatrix::zeros(p, p);
    for (line, weight) in part.lines.iter().zip(&context.estimation.weights) {
        let own = line.matrix().select_columns(context.selected) * *weight;
        sum.gemm_tr(1.0, &own, &own, 1.0);
    }
    sum
}

/// s of a part.
pub(super) fn score(part: &RunPart, context: &Context<'_>) -> DVector<f64> {
    let values = DVector::from_column_slice(&context.estimation.values);
    let mut sum = DVector::zeros(context.selected.len());
    for (line, weight) in part.lines.iter().zip(&context.estimation.weights) {
        let own = line.matrix().select_columns(context.selected);
        let residual = line.matrix().column(line.parameters()) - &own * &values;
        sum.gemv_tr(weight * weight, &own, &residual, 1.0);
    }
    sum
}
