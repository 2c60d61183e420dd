//! Prior values of all standard parameters.

use std::collections::BTreeMap;

use overact::StandardParameter;

use super::pseudo_inertia::Inertia;
use crate::{
    estimation::base::BaseParameters,
    regression::columns::{Column, ColumnSet},
    result::Estimate,
};

/// Mean square radius of an unknown body, m².
const SQUARE_RADIUS: f64 = 0.01;

/// Unknown coefficients of friction and rotors (SI units).
const SMALL: f64 = 0.1;

/// Prior values of all unknowns.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Values {
    /// Given bodies, by the suffix of their names.
    pub(super) given: BTreeMap<String, Inertia>,
    /// Uniform bodies of unit density, by suffix, and their common density.
    pub(super) uniform: BTreeMap<String, Inertia>,
    pub(super) density: f64,
    /// Coefficients by name.
    pub(super) scalars: BTreeMap<String, f64>,
}

impl Values {
    /// Sets coefficients that are not given from the positive base parameters.
    pub(super) fn with_estimate(
        mut self,
        columns: &ColumnSet,
        base: &BaseParameters,
        estimate: &Estimate,
    ) -> Self {
        let name = |index: usize| columns.as_slice().get(index).map(|one| one.name.clone());
        for parameter in estimate.parameters.iter().filter(|one| one.value > 0.0) {
            let Some(&kept) = base.columns.get(parameter.column) else {
                continue;
            };
            let regrouped = &base.regroupings[parameter.column];
            let members = regrouped.iter().map(|(index, _)| *index).chain([kept]);
            let part = parameter.value / (regrouped.len() + 1) as f64;
            for name in members.filter_map(name) {
                self.scalars.entry(name).or_insert(part);
            }
        }
        self
    }

    /// The ten parameters of a body.
    pub(super) fn body(&self, suffix: &str) -> Inertia {
        let uniform = || {
            self.uniform
                .get(suffix)
                .map_or_else(ball, |own| own * self.density)
        };
        self.given.get(suffix).copied().unwrap_or_else(uniform)
    }

    /// Magnitude of a coefficient.
    pub(super) fn scalar(&self, column: &Column) -> f64 {
        let own = self.scalars.get(&column.name).copied();
        own.map(f64::abs)
            .filter(|value| *value > 0.0)
            .unwrap_or(SMALL)
    }
}

/// A ball of 1 kg at the origin.
pub(super) fn ball() -> Inertia {
    let moment = SQUARE_RADIUS;
    Inertia::from([moment, 0.0, 0.0, moment, 0.0, moment, 0.0, 0.0, 0.0, 1.0])
}

/// The part of a parameter's name after its symbol.
pub(super) fn suffix(name: &str, symbol: StandardParameter) -> &str {
    name.strip_prefix(symbol.name()).unwrap_or_default()
}
