//! Common density of bodies of which only the shape is known beforehand.

use nalgebra::{DMatrix, DVector};

use super::{
    unknowns::{UnknownKind, Unknowns},
    values::Values,
};

impl Values {
    /// Sets the density with which uniform bodies fit the data best.
    pub(super) fn with_density(
        mut self,
        unknowns: &Unknowns,
        a: &DMatrix<f64>,
        b: &DVector<f64>,
    ) -> Self {
        let (mut known, mut uniform) = (DVector::zeros(a.ncols()), DVector::zeros(a.ncols()));
        for group in &unknowns.groups {
            match &group.kind {
                UnknownKind::Body { prior } => {
                    let suffix = unknowns.names[group.first].trim_start_matches("xx");
                    let to = if self.given.contains_key(suffix) {
                        &mut known
                    } else {
                        &mut uniform
                    };
                    to.rows_mut(group.first, 10).copy_from(prior);
                }
                UnknownKind::Positive { prior } => known[group.first] = *prior,
                UnknownKind::Free { .. } => {}
            }
        }
        let (rest, column) = (b - a * known, a * uniform);
        let density = column.dot(&rest) / column.norm_squared();
        if density.is_finite() && density > 0.0 {
            self.density = density;
        }
        self
    }
}
