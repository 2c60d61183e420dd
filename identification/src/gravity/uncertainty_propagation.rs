//! Effect of the uncertain direction of gravity on parameters.

use std::fmt;

use nalgebra::{DMatrix, DVector};

use super::{columns::Extended, solve::GravitySolution};
use crate::regression::{
    factor::Factor, system::System, uncertainty_propagation::PropagatedUncertainty,
};
use overact_logs::Error;

/// Columns and angle derivatives in the estimated direction, and equations of each projection.
#[derive(Clone, PartialEq)]
pub(super) struct Turned {
    names: Vec<String>,
    /// Columns as combinations of the independent ones.
    columns: DMatrix<f64>,
    /// Derivatives with respect to the angles, as such combinations.
    slopes: DMatrix<f64>,
    /// R factors of the lines of each projection; empty without equations.
    projections: Vec<Vec<Factor>>,
}

impl fmt::Debug for Turned {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Turned").finish_non_exhaustive()
    }
}

impl Turned {
    pub(super) fn new(
        extended: &Extended,
        systems: &[Result<System, Error>],
        solution: &GravitySolution,
    ) -> Self {
        let lines = |system: &Result<System, Error>| {
            let own = system.as_ref().map(|own| own.lines.clone());
            own.unwrap_or_default()
        };
        Self {
            names: extended.names.clone(),
            columns: extended.at(&solution.frame.gravity()),
            slopes: solution.slopes.clone(),
            projections: systems.iter().map(lines).collect(),
        }
    }

    /// Effect of angles with this covariance on estimates of the parameters `names`.
    pub(super) fn propagated_uncertainty(
        &self,
        names: &[&str],
        covariance: &DMatrix<f64>,
    ) -> PropagatedUncertainty {
        let rows = self.columns.nrows();
        let column = |name: &&str| {
            let at = self.names.iter().position(|own| own == name);
            at.map_or_else(|| DVector::zeros(rows), |at| self.columns.column(at).into())
        };
        let own = names.iter().map(column);
        let slopes = self.slopes.column_iter().map(Into::into);
        // The last column replaces Y.
        let mut all: Vec<DVector<f64>> = own.chain(slopes).collect();
        let last = all.pop().unwrap_or_else(|| DVector::zeros(rows));
        let coefficients = if all.is_empty() {
            DMatrix::zeros(rows, 0)
        } else {
            DMatrix::from_columns(&all)
        };
        let of_line = |line: &Factor| line.combined_with(&coefficients, &last);
        let of = |lines: &Vec<Factor>| lines.iter().map(of_line).collect();
        let projections = self.projections.iter().map(of).collect();
        PropagatedUncertainty::new(projections, names.len(), covariance.clone())
    }
}
