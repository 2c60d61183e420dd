//! Effect of the uncertainty of previous identifications on estimates.
//!
//! Let v_j be the change of the torques with quantity j, and P_j the estimate from v_j alone, with
//! the same columns and weights. The error of the estimate is P δ. With the covariance C of δ, its
//! covariance increases by P C Pᵀ.

use nalgebra::DMatrix;

use super::factor::Factor;

/// Contribution of each quantity to the equations of each projection.
#[derive(Debug, Clone)]
pub(crate) struct PropagatedUncertainty {
    /// For each projection the factors of its lines; empty without equations.
    ///
    /// Columns are those of the base parameters, then one for each quantity; the last one replaces
    /// Y.
    projections: Vec<Vec<Factor>>,
    /// Number of base parameters.
    parameters: usize,
    /// C.
    covariance: DMatrix<f64>,
}

impl PropagatedUncertainty {
    pub(crate) const fn new(
        projections: Vec<Vec<Factor>>,
        parameters: usize,
        covariance: DMatrix<f64>,
    ) -> Self {
        Self {
            projections,
            parameters,
            covariance,
        }
    }

    /// P C Pᵀ of an estimate of the columns `selected` with the weights of the lines.
    ///
    /// `None` if the columns are dependent.
    pub(crate) fn covariance(
        &self,
        projection: usize,
        selected: &[usize],
        weights: &[f64],
    ) -> Option<DMatrix<f64>> {
        let lines = self.projections.get(projection)?;
        let (p, count) = (selected.len(), self.covariance.nrows());
        if lines.is_empty() || count == 0 {
            return None;
        }
        let columns: Vec<usize> = (0..count - 1).map(|j| self.parameters + j).collect();
        let reduced = Factor::reduced_together(lines, weights, &[selected, &columns].concat());
        let mut right = DMatrix::zeros(p, count);
        let own = reduced.triangle.view((0, p), (p, count - 1));
        right.columns_mut(0, count - 1).copy_from(&own);
        right.set_column(count - 1, &reduced.rhs.rows(0, p));
        let triangle = reduced.triangle.view((0, 0), (p, p));
        let sensitivities = triangle.solve_upper_triangular(&right)?;
        Some(&sensitivities * &self.covariance * sensitivities.transpose())
    }
}
