//! The prior values that a description gives, completed, and what is wrong with them.

use std::collections::BTreeMap;

use overact::StandardParameter;

use super::{
    completion::completed,
    pseudo_inertia::{Inertia, divergence},
    values::{Values, ball, suffix},
};
use crate::{error::Problem, prior::Prior, regression::columns::ColumnSet};

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
}
