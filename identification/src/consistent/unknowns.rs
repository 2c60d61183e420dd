//! The unknowns of a consistent estimate: bodies, coefficients that can't be negative, and free ones.

use std::collections::BTreeMap;

use overact::{Body, StandardParameter};

use super::{
    pseudo_inertia::Inertia,
    values::{Values, suffix},
};
use crate::{
    prior::Prior,
    regression::columns::{Column, ColumnSet},
};

/// Unknowns that are constrained together.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Kind {
    /// The ten parameters of a body.
    Body {
        /// The nearest body where the data say nothing.
        prior: Inertia,
    },
    /// A coefficient above zero.
    Positive {
        /// The nearest value where the data say nothing.
        prior: f64,
    },
    /// A coefficient of either sign.
    Free {
        /// Its magnitude where the data say nothing.
        scale: f64,
    },
}

/// Unknowns that are constrained together, with their place among all unknowns.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Group {
    /// Number of the first unknown.
    pub(super) first: usize,
    pub(super) kind: Kind,
    /// Numbers within the group of unknowns with bounds, and the bounds.
    pub(super) bounds: Vec<(usize, [f64; 2])>,
}

impl Group {
    /// Number of unknowns.
    pub(super) const fn len(&self) -> usize {
        match self.kind {
            Kind::Body { .. } => 10,
            Kind::Positive { .. } | Kind::Free { .. } => 1,
        }
    }
}

/// All unknowns.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Unknowns {
    pub(super) groups: Vec<Group>,
    /// Number of the unknown of each column of the model.
    pub(super) of_column: Vec<usize>,
    /// Names by unknown: those of bodies without a column of their own, too.
    pub(super) names: Vec<String>,
}

impl Unknowns {
    /// The unknowns of a model's columns.
    pub(super) fn new(columns: &ColumnSet, prior: &Prior, values: &Values) -> Self {
        let mut all = Self {
            of_column: vec![0; columns.len()],
            ..Self::default()
        };
        // Payloads of different names are different bodies.
        let mut bodies: BTreeMap<(Body, Option<&str>), Vec<usize>> = BTreeMap::new();
        for (index, column) in columns.as_slice().iter().enumerate() {
            if column.symbol.is_inertial() {
                let body = (column.body, column.load.as_deref());
                bodies.entry(body).or_default().push(index);
            }
        }
        for own in bodies.values() {
            all.add_body(columns.as_slice(), own, values);
        }
        for (index, column) in columns.as_slice().iter().enumerate() {
            if !column.symbol.is_inertial() {
                all.of_column[index] = all.names.len();
                all.add(scalar(column, values), vec![column.name.clone()]);
            }
        }
        all.bound(prior);
        all
    }

    /// Number of unknowns.
    pub(super) fn len(&self) -> usize {
        self.names.len()
    }

    fn add(&mut self, kind: Kind, names: Vec<String>) {
        self.groups.push(Group {
            first: self.names.len(),
            kind,
            bounds: Vec::new(),
        });
        self.names.extend(names);
    }

    fn add_body(&mut self, columns: &[Column], own: &[usize], values: &Values) {
        let body = own.first().map(|&index| &columns[index]);
        let suffix = body.map_or("", |one| suffix(&one.standard, one.symbol));
        let names = StandardParameter::INERTIA.map(|symbol| format!("{}{suffix}", symbol.name()));
        let first = self.names.len();
        for &index in own {
            let symbol = columns[index].symbol;
            let place = StandardParameter::INERTIA
                .iter()
                .position(|one| *one == symbol);
            self.of_column[index] = first + place.unwrap_or_default();
        }
        let prior = values.body(suffix);
        self.add(Kind::Body { prior }, names.to_vec());
    }

    /// Gives each unknown its bounds.
    fn bound(&mut self, prior: &Prior) {
        for group in &mut self.groups {
            let own = (0..group.len()).filter_map(|k| {
                let name = self.names.get(group.first + k)?;
                Some((k, *prior.bounds.get(name)?))
            });
            group.bounds = own.collect();
        }
    }
}

/// What a column that is no body's is.
fn scalar(column: &Column, values: &Values) -> Kind {
    use StandardParameter as P;
    let value = values.scalar(column);
    match column.symbol {
        // Friction split by direction contains the offset, which has either sign.
        // So may the coefficient of a spring have, as its expression is written.
        P::Off | P::K | P::FsPos | P::FsNeg => Kind::Free { scale: value },
        P::Fs if column.direction.is_some() => Kind::Free { scale: value },
        _ => Kind::Positive { prior: value },
    }
}
