//! Standard parameters that a robot can have: the physically consistent estimate.
//!
//! Base parameters b = B χ say nothing of the standard parameters χ one by one, and noise can give them
//! values that no robot has: negative masses, moments that no distribution of mass yields. Controllers and
//! simulators need a χ whose mass matrix is positive definite everywhere. Of all χ whose bodies have
//! positive definite pseudo-inertias, and whose friction and rotor inertias are positive, the one is taken
//! that explains the data best; where they leave it open, the one nearest to a prior (Sousa, Cortesão
//! 2014; Traversaro et al. 2016; distance: Lee, Wensing, Park 2020).
//!
//! The data enter by the R factors of the observation system, so a million samples cost as much as a
//! thousand.

mod completion;
mod cones;
mod density;
mod equations;
mod point;
mod prior;
mod pseudo_inertia;
mod side;
mod solve;
mod start;
#[cfg(test)]
mod tests;
mod unknowns;
mod values;

use nalgebra::{DMatrix, DVector};
use serde::Serialize;

use self::{
    pseudo_inertia::{Inertia, definiteness},
    solve::{Solution, solve},
    unknowns::{Kind, Unknowns},
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

/// Directions of the base parameters that the data show less than this part as well as the best one are
/// left to the prior.
const RANK_TOLERANCE: f64 = 1e-10;

/// Noise is at least this part of what is measured, so that exact data keep a weight.
const SMALLEST_NOISE: f64 = 1e-9;

/// A set of standard parameters that a robot can have.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Consistent {
    /// Which inputs it explains.
    pub model: ModelKind,
    /// All standard parameters of the model.
    pub parameters: Vec<ConsistentParameter>,
    /// The bodies.
    pub bodies: Vec<ConsistentBody>,
    /// Values of the base parameters that follow (SI units), in their order.
    #[serde(skip)]
    pub base_values: Vec<f64>,
    /// ||ρ||, unweighted.
    pub residual_norm: f64,
    /// 100 ||ρ||/||Y||, unweighted.
    pub relative_error_percent: f64,
    /// The relative error of the base parameters by least squares, of which no consistency is asked.
    pub base_relative_error_percent: f64,
    /// Each line of Γ.
    pub lines: Vec<LineError>,
}

/// A standard parameter of a consistent estimate.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ConsistentParameter {
    /// Its name.
    pub name: String,
    /// SI unit.
    pub unit: String,
    /// Value.
    pub value: f64,
    /// What was believed before the data spoke.
    pub prior: f64,
    /// The part of the prior's variance that the data took away: 1 for a parameter that they determine, 0
    /// for one of which they say nothing.
    pub determined: f64,
}

/// A body of a consistent estimate.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ConsistentBody {
    /// Name of its mass.
    pub mass: String,
    /// Mass, kg.
    pub mass_kg: f64,
    /// Smallest eigenvalue of its pseudo-inertia by the trace, lengths being scaled to the body: positive
    /// for a body, 0.25 at most.
    pub definiteness: f64,
}

/// The consistent estimate of a system, none where no step leads there.
#[must_use]
pub(crate) fn consistent(
    (columns, base): (&ColumnSet, &BaseParameters),
    system: &System,
    estimate: &Estimate,
    prior: &Prior,
) -> Option<Consistent> {
    let (reduced, b) = observed(system, estimate, base.columns.len());
    let values = Values::new(prior, &columns.named()).with_estimate(columns, base, estimate);
    let unknowns = Unknowns::new(columns, prior, &values);
    let a = &reduced * regroupings(base, &unknowns);
    let values = values.with_density(&unknowns, &a, &b);
    let unknowns = Unknowns::new(columns, prior, &values);
    let solution = solve(&unknowns, &a, &b)?;
    Some(told(
        (columns, base),
        system,
        estimate,
        (&unknowns, &solution),
    ))
}

/// What the data say of the base parameters, in units of its noise: one row for each direction.
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
    // Rows that say nothing are those behind the rank of a triangle of falling diagonal.
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

/// B: base parameters of unknowns.
fn regroupings(base: &BaseParameters, unknowns: &Unknowns) -> DMatrix<f64> {
    let mut matrix = DMatrix::zeros(base.columns.len(), unknowns.len());
    for (row, (&kept, regrouped)) in base.columns.iter().zip(&base.regroupings).enumerate() {
        for &(column, coefficient) in regrouped.iter().chain([&(kept, 1.0)]) {
            matrix[(row, unknowns.of_column[column])] += coefficient;
        }
    }
    matrix
}

fn told(
    (columns, base): (&ColumnSet, &BaseParameters),
    system: &System,
    estimate: &Estimate,
    (unknowns, solution): (&Unknowns, &Solution),
) -> Consistent {
    let values = regroupings(base, unknowns) * &solution.values;
    let values: Vec<f64> = values.iter().copied().collect();
    let all: Vec<usize> = (0..values.len()).collect();
    let lines = line_errors(system, &all, &values);
    let (residual_norm, measured_norm) = overall(&lines);
    let priors = priors(unknowns);
    let parameter = |(column, &unknown): (&Column, &usize)| ConsistentParameter {
        name: column.name.clone(),
        unit: column.unit.to_owned(),
        value: solution.values[unknown],
        prior: priors[unknown],
        determined: solution.determined[unknown],
    };
    let pairs = columns.as_slice().iter().zip(&unknowns.of_column);
    Consistent {
        model: estimate.model,
        parameters: pairs.map(parameter).collect(),
        bodies: bodies(unknowns, solution),
        base_values: values,
        residual_norm,
        relative_error_percent: percent(residual_norm, measured_norm),
        base_relative_error_percent: estimate.relative_error_percent,
        lines,
    }
}

fn priors(unknowns: &Unknowns) -> Vec<f64> {
    let own = |kind: &Kind| match kind {
        Kind::Body { prior } => prior.iter().copied().collect(),
        Kind::Positive { prior } => vec![*prior],
        Kind::Free { .. } => vec![0.0],
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
        .filter(|group| matches!(group.kind, Kind::Body { .. }));
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
