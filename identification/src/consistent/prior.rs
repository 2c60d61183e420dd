//! Completion and validation of the prior values of a description.

use overact::Code;
use std::collections::BTreeMap;

use overact::StandardParameter;

use super::{
    completion::completed,
    pseudo_inertia::{Inertia, divergence},
    values::{Values, ball, suffix},
};
use crate::prior::Prior;
use overact_logs::Problem;

/// Name and symbol of a standard parameter.
pub(super) type NamedParameter<'a> = (&'a str, StandardParameter);

impl Prior {
    /// Problems of the prior for a robot with these standard parameters.
    ///
    /// They are impossible bodies and empty bounds. The problem's column is a parameter of the
    /// body.
    #[must_use]
    pub fn problems(&self, parameters: &[NamedParameter<'_>]) -> Vec<Problem> {
        let values = Values::new(self, parameters);
        let impossible = values
            .given
            .iter()
            .filter(|(_, inertia)| divergence(inertia, inertia).is_none());
        let bodies = impossible.map(|(suffix, _)| self.impossible_body(suffix));
        let bounds = self.bounds.iter().filter_map(|(name, &[low, high])| {
            let known = parameters.iter().find(|(own, _)| own == name);
            impossible_bounds(name, low, high, known.map(|(_, symbol)| *symbol))
        });
        bodies.chain(bounds).collect()
    }

    /// The problem of a body with impossible parameters.
    fn impossible_body(&self, suffix: &str) -> Problem {
        let message = format!(
            "no body has the prior parameters of `m{suffix}`: whatever the others are, its pseudo-inertia is not positive definite"
        );
        let help = "give moments about the origin of the body's frame, products of inertia with the sign -∫xy dm, a positive mass";
        let problem = Problem::new(Code::PRIOR, message).help(help);
        let names = StandardParameter::INERTIA.map(|symbol| format!("{}{suffix}", symbol.name()));
        let given = names
            .into_iter()
            .find(|name| self.values.contains_key(name));
        match given {
            Some(name) => problem.column(name),
            None => problem,
        }
    }
}

/// The problem of a parameter's bounds, if there is one.
fn impossible_bounds(
    name: &str,
    low: f64,
    high: f64,
    known: Option<StandardParameter>,
) -> Option<Problem> {
    let bounded =
        |symbol: StandardParameter| !symbol.is_inertial() || symbol == StandardParameter::M;
    let (message, help) = if low.partial_cmp(&high) != Some(std::cmp::Ordering::Less) {
        let message = format!("the bounds of `{name}` are {low} and {high}");
        (message, "give the smaller one first")
    } else if known.is_some_and(|symbol| !bounded(symbol)) {
        let help = "masses, and coefficients of friction and rotors can";
        (format!("`{name}` can't be bounded"), help)
    } else if high <= 0.0 && known.is_some_and(StandardParameter::is_nonnegative) {
        let message = format!("the bounds of `{name}` leave no positive value");
        (message, "it can't be negative")
    } else {
        return None;
    };
    Some(Problem::new(Code::PRIOR, message).help(help))
}

impl Values {
    /// The given values, and uniform bodies of density 1.
    pub(super) fn new(prior: &Prior, parameters: &[NamedParameter<'_>]) -> Self {
        let mut values = Self {
            given: BTreeMap::new(),
            uniform: BTreeMap::new(),
            density: 1.0,
            scalars: prior.values.clone(),
        };
        for &(name, symbol) in parameters.iter().filter(|(_, s)| s.is_inertial()) {
            let suffix = suffix(name, symbol);
            let named = |from: &BTreeMap<String, f64>| {
                StandardParameter::INERTIA
                    .map(|p| from.get(&format!("{}{suffix}", p.name())).copied())
            };
            let uniform = named(&prior.uniform);
            let uniform = if uniform.iter().any(Option::is_some) {
                Inertia::from(uniform.map(Option::unwrap_or_default))
            } else {
                ball()
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
