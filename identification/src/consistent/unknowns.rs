//! Unknowns of a consistent estimate: bodies, positive coefficients and free ones.

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

/// Constraint on a group of unknowns.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum UnknownKind {
    /// The ten parameters of a body.
    Body {
        /// Nearest body without data.
        prior: Inertia,
    },
    /// A positive coefficient.
    Positive {
        /// Value without data.
        prior: f64,
    },
    /// A coefficient of either sign.
    Free {
        /// Magnitude without data.
        scale: f64,
    },
}

/// Unknowns that are constrained together, with their position among all.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct UnknownGroup {
    /// Number of the first unknown.
    pub(super) first: usize,
    pub(super) kind: UnknownKind,
    /// Bounded unknowns, by number within the group, with their bounds.
    pub(super) bounds: Vec<(usize, [f64; 2])>,
}

impl UnknownGroup {
    /// Number of unknowns.
    pub(super) const fn len(&self) -> usize {
        match self.kind {
            UnknownKind::Body { .. } => 10,
            UnknownKind::Positive { .. } | UnknownKind::Free { .. } => 1,
        }
    }
}

/// All unknowns.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Unknowns {
    pub(super) groups: Vec<UnknownGroup>,
    /// Unknown of each column of the model.
    pub(super) of_column: Vec<usize>,
    /// Names of the unknowns, including those of bodies without a column of their own.
    pub(super) names: Vec<String>,
}

impl Unknowns {
    /// Unknowns of a model's columns.
    pub(super) fn new(columns: &ColumnSet, prior: &Prior, values: &Values) -> Self {
        let mut all = Self {
            of_column: vec![0; columns.len()],
            ..Self::default()
        };
        // Payloads with different names are different bodies.
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
                all.add(scalar_kind(column, values), vec![column.name.clone()]);
            }
        }
        all.bound(prior);
        all
    }

    /// Number of unknowns.
    pub(super) fn len(&self) -> usize {
        self.names.len()
    }

    fn add(&mut self, kind: UnknownKind, names: Vec<String>) {
        self.groups.push(UnknownGroup {
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
        self.add(UnknownKind::Body { prior }, names.to_vec());
    }

    /// Assigns the bounds.
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

/// Kind of a column that belongs to no body.
fn scalar_kind(column: &Column, values: &Values) -> UnknownKind {
    use StandardParameter as P;
    let value = values.scalar(column);
    match column.symbol {
        // Friction split by direction contains the offset, and a spring's coefficient has the sign
        // of its expression; both may have either sign.
        P::Off | P::K | P::FsPos | P::FsNeg => UnknownKind::Free { scale: value },
        P::Fs if column.direction.is_some() => UnknownKind::Free { scale: value },
        _ => UnknownKind::Positive { prior: value },
    }
}
