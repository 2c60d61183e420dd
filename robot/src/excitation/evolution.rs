//! Covariance matrix adaptation evolution strategy (CMA-ES), maximising.
//!
//! Hansen, The CMA evolution strategy: a tutorial, arXiv:1604.00772, eqs. (38) to (56). It uses no
//! derivatives, which limits and Coulomb friction do not have everywhere, and depends only on the
//! order of the values.

use nalgebra::{DMatrix, DVector, SymmetricEigen};
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;

/// Number of generations between two eigendecompositions of the covariance.
const LAZY: usize = 5;

/// State of the evolution: candidates and adapted distribution.
pub(super) struct Evolution {
    mean: DVector<f64>,
    step: f64,
    covariance: DMatrix<f64>,
    /// Eigenvectors of the covariance, and square roots of its eigenvalues.
    axes: (DMatrix<f64>, DVector<f64>),
    path: DVector<f64>,
    step_path: DVector<f64>,
    weights: Vec<f64>,
    rates: Rates,
    generation: usize,
    drawn: Vec<DVector<f64>>,
}

/// Learning rates.
#[derive(Clone, Copy)]
struct Rates {
    /// Effective number of parents.
    parents: f64,
    step_path: f64,
    damping: f64,
    path: f64,
    rank_one: f64,
    rank_many: f64,
    /// Expected norm of a standard normal vector.
    length: f64,
}

impl Evolution {
    /// Evolution from a start point, with `size` candidates per generation.
    pub(super) fn new(start: &[f64], step: f64, size: usize) -> Self {
        let n = start.len() as f64;
        let half = size / 2;
        let raw: Vec<f64> = (1..=half)
            .map(|i| (half as f64 + 0.5).ln() - (i as f64).ln())
            .collect();
        let sum: f64 = raw.iter().sum();
        let weights: Vec<f64> = raw.iter().map(|weight| weight / sum).collect();
        let parents = 1.0 / weights.iter().map(|w| w * w).sum::<f64>();
        let step_path = (parents + 2.0) / (n + parents + 5.0);
        let rank_one = 2.0 / ((n + 1.3).powi(2) + parents);
        let rank_many = 2.0 * (parents - 2.0 + 1.0 / parents) / ((n + 2.0).powi(2) + parents);
        let rates = Rates {
            parents,
            step_path,
            damping: 1.0 + 2.0 * (((parents - 1.0) / (n + 1.0)).sqrt() - 1.0).max(0.0) + step_path,
            path: (4.0 + parents / n) / (n + 4.0 + 2.0 * parents / n),
            rank_one,
            rank_many: rank_many.min(1.0 - rank_one),
            length: n.sqrt() * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n)),
        };
        let n = start.len();
        Self {
            mean: DVector::from_column_slice(start),
            step,
            covariance: DMatrix::identity(n, n),
            axes: (DMatrix::identity(n, n), DVector::from_element(n, 1.0)),
            path: DVector::zeros(n),
            step_path: DVector::zeros(n),
            weights,
            rates,
            generation: 0,
            drawn: Vec::new(),
        }
    }

    /// Current step size.
    pub(super) const fn step(&self) -> f64 {
        self.step
    }

    /// Draws the candidates of a generation.
    pub(super) fn draw(&mut self, size: usize, random: &mut Pcg64) -> Vec<Vec<f64>> {
        let n = self.mean.len();
        let (vectors, lengths) = &self.axes;
        self.drawn = (0..size)
            .map(|_| {
                let normal = (0..n).map(|_| StandardNormal.sample(random));
                let normal: DVector<f64> = DVector::from_iterator(n, normal);
                vectors * normal.component_mul(lengths)
            })
            .collect();
        let at = |drawn: &DVector<f64>| (&self.mean + drawn * self.step).iter().copied().collect();
        self.drawn.iter().map(at).collect()
    }

    /// Updates the distribution from the candidates' values, in their order.
    pub(super) fn learn(&mut self, values: &[f64]) {
        let mut order: Vec<usize> = (0..values.len().min(self.drawn.len())).collect();
        order.sort_by(|&a, &b| values[b].total_cmp(&values[a]));
        let n = self.mean.len();
        let best = || {
            order
                .iter()
                .zip(&self.weights)
                .map(|(&at, weight)| (&self.drawn[at], *weight))
        };
        let mut shift = DVector::zeros(n);
        for (drawn, weight) in best() {
            shift += drawn * weight;
        }
        let rates = self.rates;
        let (vectors, lengths) = &self.axes;
        let white = vectors * vectors.tr_mul(&shift).component_div(lengths);
        let gain = (rates.step_path * (2.0 - rates.step_path) * rates.parents).sqrt();
        let step_path = &self.step_path * (1.0 - rates.step_path) + white * gain;
        self.generation += 1;
        let settled = 1.0 - (1.0 - rates.step_path).powi(2 * self.generation.min(10_000) as i32);
        let far = step_path.norm() / settled.sqrt() > (1.4 + 2.0 / (n as f64 + 1.0)) * rates.length;
        let mut path = &self.path * (1.0 - rates.path);
        if !far {
            path += &shift * (rates.path * (2.0 - rates.path) * rates.parents).sqrt();
        }
        let lost = if far {
            rates.path * (2.0 - rates.path)
        } else {
            0.0
        };
        let keep = 1.0 - rates.rank_one - rates.rank_many + rates.rank_one * lost;
        let mut covariance = &self.covariance * keep;
        covariance.ger(rates.rank_one, &path, &path, 1.0);
        for (drawn, weight) in best() {
            covariance.ger(rates.rank_many * weight, drawn, drawn, 1.0);
        }
        let growth = (rates.step_path / rates.damping) * (step_path.norm() / rates.length - 1.0);
        self.mean += shift * self.step;
        self.step *= growth.clamp(-1.0, 1.0).exp();
        (self.path, self.step_path, self.covariance) = (path, step_path, covariance);
        if self.generation.is_multiple_of(LAZY) {
            self.decompose();
        }
    }

    /// Eigendecomposition of the covariance.
    fn decompose(&mut self) {
        let symmetric = (&self.covariance + self.covariance.transpose()) * 0.5;
        let eigen = SymmetricEigen::new(symmetric);
        let least = 1e-14 * eigen.eigenvalues.max();
        let lengths = eigen.eigenvalues.map(|value| value.max(least).sqrt());
        self.axes = (eigen.eigenvectors, lengths);
    }
}

#[cfg(test)]
mod tests {
    use super::Evolution;
    use rand_pcg::Pcg64;

    #[test]
    fn an_ill_conditioned_function_is_optimised() {
        // −Σ 100^i (x_i − 1)² in 6 dimensions: an ill-conditioned test function.
        let value = |x: &Vec<f64>| {
            let terms = x
                .iter()
                .zip(0..)
                .map(|(x, i)| 10.0_f64.powi(i) * (x - 1.0).powi(2));
            -terms.sum::<f64>()
        };
        let mut random = Pcg64::new(7, 0);
        let mut search = Evolution::new(&[0.0; 6], 0.5, 12);
        let mut best = f64::NEG_INFINITY;
        for _ in 0..300 {
            let candidates = search.draw(12, &mut random);
            let values: Vec<f64> = candidates.iter().map(value).collect();
            best = values.iter().copied().fold(best, f64::max);
            search.learn(&values);
        }
        assert!(best > -1e-8, "{best}");
        assert!(search.step() < 1e-2);
    }
}
