//! Physically consistent standard parameters.
//!
//! Base parameters b = B χ do not determine the standard parameters χ individually. Noise can also
//! give them values without a physical meaning: negative masses, or impossible moments of inertia.
//! Controllers and simulators need a χ with a positive definite mass matrix everywhere.
//!
//! The estimate is physically consistent: bodies have positive definite pseudo-inertias, and
//! friction and rotor inertias are positive. Among these χ, it explains the data best, and is
//! nearest to a prior in directions that the data leave open (Sousa, Cortesão 2014; Traversaro et
//! al. 2016; distance: Lee, Wensing, Park 2020).
//!
//! The data enter by the R factors of the observation system, so the cost is independent of the
//! number of samples.

mod bound;
mod completion;
mod cones;
mod density;
mod equations;
mod point;
mod prior;
mod pseudo_inertia;
mod solve;
mod start;
#[cfg(test)]
mod tests;
mod unknowns;
mod values;

use nalgebra::{DMatrix, DVector};
use overact::Info;
use serde::Serialize;

use self::{
    pseudo_inertia::{Inertia, definiteness},
    solve::{Solution, solve},
    unknowns::{UnknownKind, Unknowns},
    values::Values,
};
use crate::{
    estimation::{
        base::BaseParameters,
        estimate::{LineError, line_errors, overall, percent},
    },
    prior::Prior,
    regression::{
        columns::{Column, ColumnSet},
        factor::Factor,
        projection::ModelKind,
        system::System,
    },
    result::Estimate,
};

/// Smallest relative singular value of directions that the data determine.
///
/// Other directions are left to the prior.
const RANK_TOLERANCE: f64 = 1e-10;

/// Smallest relative noise, so that exact data keep a finite weight.
const SMALLEST_NOISE: f64 = 1e-9;

/// A physically consistent set of standard parameters.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Consistent {
    /// Model.
    pub model: ModelKind,
    /// All standard parameters of the model.
    pub parameters: Vec<ConsistentParameter>,
    /// Bodies.
    pub bodies: Vec<ConsistentBody>,
    /// Values of the base parameters in their order (SI units).
    #[serde(skip)]
    pub base_values: Vec<f64>,
    /// ||ρ||, unweighted.
    pub residual_norm: f64,
    /// 100 ||ρ||/||Y||, unweighted.
    pub relative_error_percent: f64,
    /// Relative residual of the base parameters by least squares, without consistency.
    pub base_relative_error_percent: f64,
    /// Each line of Γ.
    pub lines: Vec<LineError>,
}

/// A standard parameter of a consistent estimate.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ConsistentParameter {
    /// Name.
    pub name: String,
    /// SI unit.
    pub unit: String,
    /// Value.
    pub value: f64,
    /// Prior value.
    pub prior: f64,
    /// Fraction of the prior's variance that the data removed.
    ///
    /// 1 for a parameter that they determine, 0 for one that they do not affect.
    pub determined: f64,
}

/// A body of a consistent estimate.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ConsistentBody {
    /// Name of its mass.
    pub mass: String,
    /// Mass, kg.
    pub mass_kg: f64,
    /// Smallest eigenvalue of its pseudo-inertia divided by the trace, with scaled lengths.
    ///
    /// Positive for a body, at most 0.25.
    pub definiteness: f64,
}

impl Consistent {
    /// Adds the held parameters of the prior, which no data affect.
    pub(crate) fn with_held(mut self, info: &Info<'_>, prior: &Prior) -> Self {
        for one in info.parameters {
            if let Some(&value) = prior.held.get(one.name) {
                self.parameters.push(ConsistentParameter {
                    name: one.name.to_owned(),
                    unit: one.unit.to_owned(),
                    value,
                    prior: value,
                    determined: 0.0,
                });
            }
        }
        let place = |one: &ConsistentParameter| {
            let mut all = info.parameters.iter();
            all.position(|own| own.name == one.name)
                .unwrap_or(usize::MAX)
        };
        if !prior.held.is_empty() {
            self.parameters.sort_by_key(place);
        }
        self
    }
}

/// Search for a consistent estimate of a system.
pub(crate) struct ConsistencySearch<'a> {
    /// Columns of the model, and the base parameters among them.
    pub(crate) columns: &'a ColumnSet,
    pub(crate) base: &'a BaseParameters,
    pub(crate) system: &'a System,
    /// Estimate of the base parameters.
    pub(crate) estimate: &'a Estimate,
}

impl ConsistencySearch<'_> {
    /// The consistent estimate; `None` if the search fails.
    pub(crate) fn run(&self, prior: &Prior) -> Option<Consistent> {
        let &Self {
            columns,
            base,
            system,
            estimate,
        } = self;
        let (reduced, b) = observed(system, estimate, base.columns.len());
        let values = Values::new(prior, &columns.named()).with_estimate(columns, base, estimate);
        let unknowns = Unknowns::new(columns, prior, &values);
        let a = &reduced * regroupings(base, &unknowns);
        let values = values.with_density(&unknowns, &a, &b);
        let unknowns = Unknowns::new(columns, prior, &values);
        let solution = solve(&unknowns, &a, &b)?;
        Some(self.consistent(&unknowns, &solution))
    }

    /// The estimate of a solution, with its residuals.
    fn consistent(&self, unknowns: &Unknowns, solution: &Solution) -> Consistent {
        let values = regroupings(self.base, unknowns) * &solution.values;
        let values: Vec<f64> = values.iter().copied().collect();
        let all: Vec<usize> = (0..values.len()).collect();
        let lines = line_errors(self.system, &all, &values);
        let (residual_norm, measured_norm) = overall(&lines);
        let priors = priors(unknowns);
        let parameter = |(column, &unknown): (&Column, &usize)| ConsistentParameter {
            name: column.name.clone(),
            unit: column.unit.to_owned(),
            value: solution.values[unknown],
            prior: priors[unknown],
            determined: solution.determined[unknown],
        };
        let pairs = self.columns.as_slice().iter().zip(&unknowns.of_column);
        Consistent {
            model: self.estimate.model,
            parameters: pairs.map(parameter).collect(),
            bodies: bodies(unknowns, solution),
            base_values: values,
            residual_norm,
            relative_error_percent: percent(residual_norm, measured_norm),
            base_relative_error_percent: self.estimate.relative_error_percent,
            lines,
        }
    }
}

/// Measured directions of the base parameters in units of the noise: rows and right-hand side.
fn observed(system: &System, estimate: &Estimate, count: usize) -> (DMatrix<f64>, DVector<f64>) {
    let all: Vec<usize> = (0..count).collect();
    let reduced = Factor::reduced_together(&system.lines, &estimate.weights, &all);
    let lines = system.lines.iter().zip(&estimate.weights);
    let measured: f64 = lines
        .map(|(line, weight)| (weight * line.measured_norm()).powi(2))
        .sum();
    let equations = estimate.equations.max(1) as f64;
    let smallest = SMALLEST_NOISE * (measured / equations).sqrt();
    let noise = estimate
        .residual_deviation
        .max(smallest)
        .max(f64::MIN_POSITIVE);
    // Rows beyond the rank of the pivoted triangle contain no information.
    let mut b = reduced.rhs / noise;
    let sorted = (reduced.triangle / noise).col_piv_qr();
    let mut rows = sorted.r();
    sorted.q_tr_mul(&mut b);
    sorted.p().inv_permute_columns(&mut rows);
    let diagonal = sorted.r().diagonal().map(f64::abs);
    let seen = diagonal
        .iter()
        .take_while(|value| **value > RANK_TOLERANCE * diagonal[0])
        .count();
    (
        rows.rows(0, seen).into_owned(),
        b.rows(0, seen).into_owned(),
    )
}

/// B: base parameters from unknowns.
fn regroupings(base: &BaseParameters, unknowns: &Unknowns) -> DMatrix<f64> {
    let mut matrix = DMatrix::zeros(base.columns.len(), unknowns.len());
    for (row, (&kept, regrouped)) in base.columns.iter().zip(&base.regroupings).enumerate() {
        for &(column, coefficient) in regrouped.iter().chain([&(kept, 1.0)]) {
            matrix[(row, unknowns.of_column[column])] += coefficient;
        }
    }
    matrix
}

fn priors(unknowns: &Unknowns) -> Vec<f64> {
    let own = |kind: &UnknownKind| match kind {
        UnknownKind::Body { prior } => prior.iter().copied().collect(),
        UnknownKind::Positive { prior } => vec![*prior],
        UnknownKind::Free { .. } => vec![0.0],
    };
    unknowns
        .groups
        .iter()
        .flat_map(|group| own(&group.kind))
        .collect()
}

fn bodies(unknowns: &Unknowns, solution: &Solution) -> Vec<ConsistentBody> {
    let own = unknowns
        .groups
        .iter()
        .filter(|group| matches!(group.kind, UnknownKind::Body { .. }));
    own.map(|group| {
        let inertia = solution.values.rows(group.first, group.len());
        let inertia = Inertia::from_iterator(inertia.iter().copied());
        ConsistentBody {
            mass: unknowns.names[group.first + 9].clone(),
            mass_kg: inertia[9],
            definiteness: definiteness(&inertia),
        }
    })
    .collect()
}
