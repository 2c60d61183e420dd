//! Correlation of the residuals of two actuators.
//!
//! If torque errors e cause the residual, ρ = Jᵀ e with J = J_p^inv (the identity for a joint
//! model). With the rows J_k of J,
//!
//! ```text
//! E ρ ρᵀ = Σ_k σ_kk J_k J_kᵀ + Σ_(k<l) σ_kl (J_k J_lᵀ + J_l J_kᵀ).
//! ```
//!
//! The σ are fitted to ρ ρᵀ of all samples by least squares; σ_kl is zero for independent
//! actuators. With a_k = J_k · ρ and M_kl = J_k · J_l the products are
//!
//! ```text
//! ⟨ρ ρᵀ, kl⟩ = 2 a_k a_l,   ⟨kl, mn⟩ = 2 (M_km M_ln + M_kn M_lm),
//! ```
//!
//! each halved for k = l or m = n.

use nalgebra::{DMatrix, DMatrixView, DVector};

/// Products of actuator pairs: one column for each section of a run, or each cosine.
#[derive(Debug, Clone)]
pub(super) struct Pairs {
    /// Pairs (k, l) with k ≤ l.
    pub(super) pairs: Vec<(usize, usize)>,
    /// Products of the pairs with each other, flattened, and with ρ ρᵀ.
    gram: DMatrix<f64>,
    pub(super) scores: DMatrix<f64>,
}

impl Pairs {
    /// Products without samples.
    pub(super) fn new(actuators: usize, sections: usize) -> Self {
        let of = |k: usize| (k..actuators).map(move |l| (k, l));
        let pairs: Vec<(usize, usize)> = (0..actuators).flat_map(of).collect();
        Self {
            gram: DMatrix::zeros(pairs.len().pow(2), sections),
            scores: DMatrix::zeros(pairs.len(), sections),
            pairs,
        }
    }

    /// Adds a sample to a section: J, n × r, and ρ.
    pub(super) fn add(&mut self, section: usize, jacobian: &DMatrix<f64>, residual: &DVector<f64>) {
        let (torques, products) = (jacobian * residual, jacobian * jacobian.transpose());
        let half = |(k, l): (usize, usize)| if k == l { 0.5 } else { 1.0 };
        let count = self.pairs.len();
        for (i, &(k, l)) in self.pairs.iter().enumerate() {
            let twice = 2.0 * half((k, l));
            self.scores[(i, section)] += twice * torques[k] * torques[l];
            for (j, &(m, n)) in self.pairs.iter().enumerate() {
                let both =
                    products[(k, m)] * products[(l, n)] + products[(k, n)] * products[(l, m)];
                self.gram[(j * count + i, section)] += twice * half((m, n)) * both;
            }
        }
    }

    /// Sums of the sections over cosines.
    pub(super) fn over(&self, waves: &DMatrix<f64>) -> Self {
        Self {
            pairs: self.pairs.clone(),
            gram: &self.gram * waves,
            scores: &self.scores * waves,
        }
    }

    /// Products of the pairs with each other over cosine m.
    pub(super) fn gram(&self, m: usize) -> DMatrixView<'_, f64> {
        let count = self.pairs.len();
        let all = &self.gram.as_slice()[m * count * count..(m + 1) * count * count];
        DMatrixView::from_slice(all, count, count)
    }
}
