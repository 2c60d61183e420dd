//! The prior value of every standard parameter.

use std::collections::BTreeMap;

use overact::StandardParameter;

use super::{
    completion::completed,
    pseudo_inertia::{Inertia, divergence},
};
use crate::{
    error::Problem,
    estimation::base::BaseParameters,
    prior::Prior,
    regression::columns::{Column, ColumnSet},
    result::Estimate,
};

/// Mean square radius of a body of which nothing is known, m².
const SQUARE_RADIUS: f64 = 0.01;

/// Coefficients of friction and rotors of which nothing is known (SI units).
const SMALL: f64 = 0.1;

/// What is wrong with a prior for a model's columns.
pub(crate) fn problems(prior: &Prior, columns: &ColumnSet) -> Vec<Problem> {
    let values = Values::new(prior, columns);
    let mut problems = Vec::new();
    for (suffix, inertia) in &values.given {
        if divergence(inertia, inertia).is_none() {
            let message = format!(
                "no body has the prior parameters of `m{suffix}`: whatever the others are, its pseudo-inertia is not positive definite"
            );
            let help = "give moments about the origin of the body's frame, products of inertia with the sign -∫xy dm, a positive mass";
            problems.push(Problem::new(message).help(help));
        }
    }
    for (name, [low, high]) in &prior.bounds {
        let bounded =
            |symbol: StandardParameter| !symbol.is_inertial() || symbol == StandardParameter::M;
        let known = columns.as_slice().iter().find(|one| one.name == *name);
        if low.partial_cmp(high) != Some(std::cmp::Ordering::Less) {
            let message = format!("the bounds of `{name}` are {low} and {high}");
            problems.push(Problem::new(message).help("give the smaller one first"));
        } else if known.is_some_and(|one| !bounded(one.symbol)) {
            let message = format!("`{name}` can't be bounded");
            let help = "masses, and coefficients of friction and rotors can";
            problems.push(Problem::new(message).help(help));
        } else if *high <= 0.0 && known.is_some_and(|one| one.symbol != StandardParameter::Off) {
            let message = format!("the bounds of `{name}` leave no positive value");
            problems.push(Problem::new(message).help("it can't be negative"));
        }
    }
    problems
}

/// The prior value of every unknown.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Values {
    /// Bodies by the suffix of their names that are given.
    pub(super) given: BTreeMap<String, Inertia>,
    /// Bodies by suffix of a common density.
    uniform: BTreeMap<String, Inertia>,
    pub(super) density: f64,
    /// Coefficients by name.
    scalars: BTreeMap<String, f64>,
}

impl Values {
    /// The values that are given, and uniform bodies of density 1.
    pub(super) fn new(prior: &Prior, columns: &ColumnSet) -> Self {
        let mut values = Self {
            given: BTreeMap::new(),
            uniform: BTreeMap::new(),
            density: 1.0,
            scalars: prior.values.clone(),
        };
        let inertial = columns.as_slice().iter();
        for column in inertial.filter(|column| column.symbol.is_inertial()) {
            let suffix = suffix(column);
            let named = |from: &BTreeMap<String, f64>| {
                StandardParameter::INERTIA
                    .map(|p| from.get(&format!("{}{suffix}", p.name())).copied())
            };
            let uniform = named(&prior.uniform);
            let uniform = match uniform.iter().any(Option::is_some) {
                true => Inertia::from(uniform.map(Option::unwrap_or_default)),
                false => ball(),
            };
            let own = named(&prior.values);
            if own.iter().any(Option::is_some) {
                values
                    .given
                    .insert(suffix.to_owned(), completed(&own, &uniform));
            }
            values.uniform.insert(suffix.to_owned(), uniform);
        }
        values
    }

    /// The coefficients that are not given as the base parameters have them, or a part of them.
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

    /// The magnitude of a coefficient.
    pub(super) fn scalar(&self, column: &Column) -> f64 {
        let own = self.scalars.get(&column.name).copied();
        own.map(f64::abs)
            .filter(|value| *value > 0.0)
            .unwrap_or(SMALL)
    }
}

/// A ball of 1 kg at the origin.
fn ball() -> Inertia {
    let moment = SQUARE_RADIUS;
    Inertia::from([moment, 0.0, 0.0, moment, 0.0, moment, 0.0, 0.0, 0.0, 1.0])
}

/// What follows the symbol in the name of a column's parameter.
pub(super) fn suffix(column: &Column) -> &str {
    let symbol = column.symbol.name();
    column.standard.strip_prefix(symbol).unwrap_or_default()
}
