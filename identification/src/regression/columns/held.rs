//! Held parameters: known values of standard parameters that have no column.
//!
//! Their torque is subtracted from the measured one with the motion. The base parameters are those
//! of the other columns.

use overact::{Columns, Function, Model, SampleError, Sizes};

use super::{Column, ColumnSet};
use crate::{prior::Prior, regression::states::SampledStates};

impl ColumnSet {
    /// Leaves out the columns of parameters that a prior holds.
    #[must_use]
    pub fn holding(self, prior: &Prior) -> Self {
        let value = |column: &Column| {
            let value = prior.held.get(&column.standard)?;
            Some((column.index()?, *value))
        };
        let mut held = self.held;
        held.extend(self.columns.iter().filter_map(value));
        let own = self.columns.into_iter();
        Self {
            columns: own.filter(|column| value(column).is_none()).collect(),
            held,
        }
    }

    /// Values of the held parameters among the model's standard parameters; empty without any.
    pub(crate) fn held(&self, sizes: &Sizes) -> Vec<f64> {
        if self.held.is_empty() {
            return Vec::new();
        }
        let mut all = vec![0.0; sizes.parameters];
        self.held.iter().for_each(|&(k, value)| all[k] = value);
        all
    }

    /// Γ¹ of the held parameters, samples × r; empty without any.
    ///
    /// # Errors
    /// The first sample at which the model has no value.
    pub(crate) fn held_inputs(
        &self,
        model: &dyn Model,
        states: &SampledStates<'_>,
    ) -> Result<Vec<f64>, SampleError> {
        let sizes = model.info().sizes;
        let values = self.held(&sizes);
        if values.is_empty() {
            return Ok(Vec::new());
        }
        let mut numbers = vec![0.0; states.samples * sizes.dof * sizes.parameters];
        let inputs = [states.pose, states.twist, states.acceleration];
        let function = Function::IdmRedPlatform(Columns::Standard);
        model.evaluate(function, &inputs, &mut numbers)?;
        let rows = numbers.chunks_exact(sizes.parameters);
        let product = |row: &[f64]| row.iter().zip(&values).map(|(w, x)| w * x).sum();
        Ok(rows.map(product).collect())
    }
}
