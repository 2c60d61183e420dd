//! Dynamics of the whole robot on a sheet: columns of identification models, projections of torques, and
//! inverse dynamics with given parameters.

use super::elimination::Rows;
use super::linear::{Factored, apply, null_space, product, transposed};
use super::parameter::BodyParameter;
use super::regressor::Projection;
use super::selection::DynamicsBy;
use super::sheet::{Sheet, column};
use super::underivable::Underivable;
use crate::cas::{Expr, Number};
use overact_core::{ActuatorGroup, Columns};

impl<'a> Sheet<'a, '_> {
    /// The parameters of a form's columns.
    pub(super) fn chosen(&self, columns: Columns) -> Vec<BodyParameter> {
        match columns {
            Columns::Standard => self.selection.standard.clone(),
            Columns::Base => self.selection.base.clone(),
        }
    }

    /// Case 1: the columns of some parameters, projected on the platform, eq. (30).
    pub(super) fn on_platform(&mut self, of: &[BodyParameter]) -> Rows<'a> {
        let projection = self.robot.project_on_platform();
        self.columns(&projection, of)
    }

    /// Case 2: the columns of some parameters, projected on the kept actuators, eq. (36).
    pub(super) fn on_actuators(&mut self, of: &[BodyParameter]) -> Result<Rows<'a>, Underivable> {
        let projection = self.kept_projection()?;
        Ok(self.columns(&projection, of))
    }

    /// The projection on the kept actuators, whose determinant is guarded.
    fn kept_projection(&mut self) -> Result<Projection<'a>, Underivable> {
        let projection = self
            .robot
            .project_on_actuators(&self.selection.kept_actuators)?;
        self.guard_platform(&projection.determinants, ActuatorGroup::Kept);
        Ok(projection)
    }

    /// The columns of some parameters: each by itself, or as a combination of others among them.
    fn columns(&mut self, projection: &Projection<'a>, of: &[BodyParameter]) -> Rows<'a> {
        let (twist, acceleration) = (self.twist(), self.acceleration());
        let Some(motion) = self.robot.motion(&twist, &acceleration) else {
            return Vec::new();
        };
        self.guards.extend(self.robot.spring_guards());
        let selection = self.selection;
        let combination = |p: BodyParameter| {
            let found = selection.combined.iter().find(|c| c.parameter == p)?;
            found
                .of
                .iter()
                .all(|(q, _)| of.contains(q))
                .then_some(found)
        };
        let direct = |p: BodyParameter| self.robot.column(&motion, projection, p);
        let own: Vec<Option<Vec<Expr<'a>>>> = of
            .iter()
            .map(|&p| combination(p).is_none().then(|| direct(p)))
            .collect();
        let column_of =
            |p: BodyParameter| of.iter().position(|q| *q == p).and_then(|i| own[i].clone());
        let columns: Rows<'a> = of
            .iter()
            .zip(&own)
            .map(|(&p, own)| match (own, combination(p)) {
                (None, Some(combination)) => self
                    .robot
                    .combined(combination, &column_of)
                    .unwrap_or_else(|| direct(p)),
                (Some(own), _) => own.clone(),
                (None, None) => direct(p),
            })
            .collect();
        if columns.is_empty() {
            return vec![Vec::new(); self.robot.mechanism.dof()];
        }
        transposed(&columns)
    }

    /// τ* = J (JᵀJ)⁻¹ Jᵀ τ, eq. (50): what of the torques moves the robot.
    pub(super) fn project_torques(&mut self, n: usize) -> Vec<Expr<'a>> {
        let torques = self.input("torques", n);
        if n == self.robot.mechanism.dof() {
            return torques;
        }
        let jacobian = self.robot.inverse_jacobian();
        let inner = apply(&transposed(&jacobian), &torques);
        let solved = self.factored(&jacobian).solve(&inner);
        apply(&jacobian, &solved)
    }

    /// Γ² = τ_a + J_a^-T J_bᵀ τ_b, with the kept actuators a and the others b.
    pub(super) fn project_actuators(&mut self, n: usize) -> Result<Rows<'a>, Underivable> {
        let torques = self.input("torques", n);
        let projection = self.kept_projection()?;
        let kept = &self.selection.kept_actuators;
        let jacobian = self.robot.inverse_jacobian();
        let others: Vec<usize> = (0..n).filter(|i| !kept.contains(i)).collect();
        let rows: Rows<'a> = others.iter().map(|&i| jacobian[i].clone()).collect();
        let moved = product(&rows, projection.platform_rows());
        let entry = |k: usize| {
            others
                .iter()
                .zip(&moved)
                .fold(torques[kept[k]], |sum, (&i, row)| sum + row[k] * torques[i])
        };
        Ok(column((0..kept.len()).map(entry).collect()))
    }

    /// The standard parameters with their values: an input, or constants where they are known.
    fn parameter_values(&mut self) -> Vec<(BodyParameter, Expr<'a>)> {
        let all: Vec<BodyParameter> = self
            .selection
            .standard
            .iter()
            .chain(&self.selection.payload)
            .copied()
            .collect();
        if let Some(known) = &self.selection.values {
            let value = |one: &BodyParameter| known.iter().find(|(parameter, _)| parameter == one);
            let number = |one: BodyParameter| {
                let value = value(&one).map_or(0.0, |&(_, value)| value);
                (one, self.robot.arena.number(Number::float(value)))
            };
            return all.into_iter().map(number).collect();
        }
        let values = self.input("parameters", all.len());
        all.into_iter().zip(values).collect()
    }

    /// Γ¹ of given parameters.
    pub(super) fn projected_dynamics(
        &mut self,
        twist: &[Expr<'a>],
        acceleration: &[Expr<'a>],
    ) -> Vec<Expr<'a>> {
        let values = self.parameter_values();
        self.guards.extend(self.robot.spring_guards());
        let Some(motion) = self.robot.motion(twist, acceleration) else {
            return Vec::new();
        };
        if self.selection.dynamics == DynamicsBy::Bodies {
            let forces = self.robot.summed_forces(&motion, &values);
            return forces.unwrap_or_default();
        }
        let projection = self.robot.project_on_platform();
        self.robot.generalised_forces(&motion, &projection, &values)
    }

    /// τ = J (JᵀJ)⁻¹ Γ¹, the torque of least norm.
    pub(super) fn least_norm_torques(&mut self) -> Vec<Expr<'a>> {
        let (twist, acceleration) = (self.twist(), self.acceleration());
        let forces = self.projected_dynamics(&twist, &acceleration);
        let jacobian = self.robot.inverse_jacobian();
        let solved = self.factored(&jacobian).solve(&forces);
        apply(&jacobian, &solved)
    }

    /// τ = J (JᵀJ)⁻¹ Γ¹ + N c, with a basis N of the torques that move nothing.
    pub(super) fn preloaded_torques(&mut self, n: usize) -> Rows<'a> {
        let torques = self.least_norm_torques();
        let preload = self.input("preload", n - self.robot.mechanism.dof());
        let basis = self.null_space();
        let entry = |i: usize| {
            basis[i]
                .iter()
                .zip(&preload)
                .fold(torques[i], |sum, (b, c)| sum + *b * *c)
        };
        column((0..n).map(entry).collect())
    }

    /// A basis of the torques that move nothing, one column for each redundant actuator.
    pub(super) fn null_space(&mut self) -> Rows<'a> {
        let jacobian = self.robot.inverse_jacobian();
        let kept = &self.selection.kept_actuators;
        let seeds: Vec<usize> = (0..jacobian.len()).filter(|i| !kept.contains(i)).collect();
        let pivots = Factored::normal(&jacobian).pivots;
        self.guard_platform(&pivots, ActuatorGroup::All);
        null_space(&jacobian, &seeds)
    }

    /// M of given parameters, from bodies summed from the tips to the base.
    pub(super) fn mass_matrix(&mut self) -> Rows<'a> {
        let values = self.parameter_values();
        self.robot.masses(&values).unwrap_or_default()
    }
}
