//! Dynamics of the whole robot: columns of identification models, projections of torques, and
//! inverse dynamics with given parameters.

use crate::cas::{Expr, Number};
use crate::derivation::bodies::payload::on_body;
use crate::derivation::context::{DerivationContext, Owner, column};
use crate::derivation::derivation_error::DerivationError;
use crate::derivation::dynamics::actuated_joint_forces::ActuatedJointForces;
use crate::derivation::linear_algebra::elimination::{Rows, inverse};
use crate::derivation::linear_algebra::linear::{add_to, apply, product, transposed};
use crate::derivation::linear_algebra::null_space::null_space;
use crate::derivation::parameter::BodyParameter;
use crate::derivation::regressor::Projection;
use crate::derivation::selection::DynamicsBy;
use overact_core::{ActuatorGroup, Columns, Input};

impl<'a> DerivationContext<'a, '_> {
    /// Parameters of a form's columns.
    pub(crate) fn chosen(&self, columns: Columns) -> Vec<BodyParameter> {
        match columns {
            Columns::Standard => self.selection.standard.clone(),
            Columns::Base => self.selection.base.clone(),
        }
    }

    /// Columns of some parameters in the platform projection, eq. (30).
    pub(crate) fn on_platform(&mut self, of: &[BodyParameter]) -> Rows<'a> {
        let projection = self.robot.project_on_platform();
        self.columns(&projection, of)
    }

    /// Columns of some parameters in the actuator projection, eq. (36).
    pub(crate) fn on_actuators(
        &mut self,
        of: &[BodyParameter],
    ) -> Result<Rows<'a>, DerivationError> {
        let projection = self.kept_projection()?;
        Ok(self.columns(&projection, of))
    }

    /// The projection on the kept actuators, with a guarded determinant.
    fn kept_projection(&mut self) -> Result<Projection<'a>, DerivationError> {
        let projection = self
            .robot
            .project_on_actuators(&self.selection.kept_actuators)?;
        self.guard_platform(&projection.determinants, ActuatorGroup::Kept);
        Ok(projection)
    }

    /// Columns of some parameters: derived, or combined from others among them.
    fn columns(&mut self, projection: &Projection<'a>, of: &[BodyParameter]) -> Rows<'a> {
        let (twist, acceleration) = (self.twist(), self.acceleration());
        let Some(motion) = self.robot.motion(&twist, &acceleration) else {
            return Vec::new();
        };
        self.guards.extend(self.robot.spring_guards());
        self.guards.extend(self.robot.point_spring_guards(&motion));
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

    /// τ* = J (JᵀJ)⁻¹ Jᵀ τ, eq. (50): the torques without internal torques.
    pub(crate) fn project_torques(&mut self, n: usize) -> Vec<Expr<'a>> {
        let torques = self.input("torques", n);
        if n == self.robot.mechanism.dof() {
            return torques;
        }
        let system = self.actuator_system();
        let inner = self.robot.projected_torques(&torques);
        self.robot.with_tensions(system.torques(&inner))
    }

    /// Γ² = τ_a + J_a^-T J_bᵀ τ_b, with the kept actuators a and the others b.
    pub(crate) fn project_actuators(&mut self, n: usize) -> Result<Rows<'a>, DerivationError> {
        let torques = self.input("torques", n);
        let torques = self.robot.with_tensions(torques);
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

    /// Standard or base parameters and those of the payload, with values: an input, or known
    /// constants.
    ///
    /// If base parameters are given all others are zero, since they are regrouped into these.
    pub(super) fn parameter_values(&mut self, of: Columns) -> Vec<(BodyParameter, Expr<'a>)> {
        let mut all = self.chosen(of);
        all.extend(&self.selection.payload);
        if let Some(known) = &self.selection.values {
            let value = |one: &BodyParameter| known.iter().find(|(parameter, _)| parameter == one);
            let number = |one: BodyParameter| {
                let value = value(&one).map_or(0.0, |&(_, value)| value);
                (one, self.robot.arena.number(Number::float(value)))
            };
            let values = all.into_iter().map(number).collect();
            return self.on_bodies(values);
        }
        let input = match of {
            Columns::Standard => Input::Parameters,
            Columns::Base => Input::BaseParameters,
        };
        let values = self.input(input.name(), all.len());
        let values = all.into_iter().zip(values);
        let values = values.filter(|(of, _)| self.owner.has(*of)).collect();
        self.on_bodies(values)
    }

    /// Parameters of payloads with tables of their own as those of the bodies that carry them.
    fn on_bodies(&self, values: Vec<(BodyParameter, Expr<'a>)>) -> Vec<(BodyParameter, Expr<'a>)> {
        let (arena, payloads) = (self.robot.arena, &self.robot.mechanism.payloads);
        let mut all = Vec::with_capacity(values.len());
        for (parameter, value) in values {
            match parameter {
                BodyParameter::Load { payload, symbol } => {
                    let terms = on_body(arena, &payloads[payload], symbol).into_iter();
                    all.extend(terms.map(|(of_body, factor)| (of_body, factor * value)));
                }
                _ => all.push((parameter, value)),
            }
        }
        all
    }

    /// Γ¹ for given parameters.
    pub(crate) fn projected_dynamics(
        &mut self,
        of: Columns,
        twist: &[Expr<'a>],
        acceleration: &[Expr<'a>],
    ) -> Vec<Expr<'a>> {
        self.dynamics_of(of, twist, acceleration, &mut ActuatedJointForces::default())
    }

    /// Γ¹ for given parameters, without the forces that go to `actuators`.
    pub(crate) fn dynamics_of(
        &mut self,
        of: Columns,
        twist: &[Expr<'a>],
        acceleration: &[Expr<'a>],
        actuators: &mut ActuatedJointForces<'a>,
    ) -> Vec<Expr<'a>> {
        let values = self.parameter_values(of);
        self.guards.extend(self.robot.spring_guards());
        let Some(motion) = self.robot.motion(twist, acceleration) else {
            return Vec::new();
        };
        self.guards.extend(self.robot.point_spring_guards(&motion));
        let mut forces = if self.selection.dynamics == DynamicsBy::Bodies {
            let forces = self.robot.summed_forces(&motion, &values, actuators);
            forces.unwrap_or_default()
        } else {
            let projection = self.robot.project_on_platform();
            self.robot
                .generalised_forces(&motion, &projection, &values, actuators)
        };
        if !matches!(self.owner, Owner::Leg(_)) {
            add_to(
                &mut forces,
                self.robot.point_spring_forces(&motion, &values),
            );
            let of_motors = self.robot.motor_forces(&motion, &values, actuators);
            add_to(&mut forces, of_motors);
        }
        forces
    }

    /// τ = J (JᵀJ)⁻¹ Γ¹, the torques of least norm; J⁻ᵀ Γ¹ if J is square.
    pub(crate) fn least_norm_torques(&mut self, of: Columns) -> Vec<Expr<'a>> {
        let (twist, acceleration) = (self.twist(), self.acceleration());
        let mut own = ActuatedJointForces::of(&self.robot);
        let forces = self.dynamics_of(of, &twist, &acceleration, &mut own);
        let torques = self.actuator_system().torques(&forces);
        self.robot.with_tensions(own.with(torques))
    }

    /// Torques p of the kept actuators that produce Γ¹, and a basis N of the internal torques, row
    /// by row: all torques are p + N z.
    ///
    /// # Errors
    /// See [`DerivationContext::null_space`].
    pub(crate) fn tension_system(&mut self, of: Columns) -> Result<Rows<'a>, DerivationError> {
        let (twist, acceleration) = (self.twist(), self.acceleration());
        let forces = self.projected_dynamics(of, &twist, &acceleration);
        let inverse = self.basis()?.1;
        let basis = self.null_space()?;
        let moving = apply(&transposed(&inverse), &forces);
        let mut torques = vec![self.robot.arena.zero(); basis.len()];
        for (&at, &torque) in self.selection.kept_actuators.iter().zip(&moving) {
            torques[at] = torque;
        }
        let mut entries = self.robot.with_tensions(torques);
        entries.extend(basis.into_iter().flatten());
        Ok(column(entries))
    }

    /// τ = J (JᵀJ)⁻¹ Γ¹ + N c, with a basis N of the internal torques.
    ///
    /// Computed from the torques p = J_a^-T Γ¹ of the kept actuators alone as p + N (c - Nᵀ p).
    ///
    /// # Errors
    /// See [`DerivationContext::null_space`].
    pub(crate) fn preloaded_torques(&mut self, n: usize) -> Result<Rows<'a>, DerivationError> {
        let (twist, acceleration) = (self.twist(), self.acceleration());
        let forces = self.projected_dynamics(Columns::Standard, &twist, &acceleration);
        let preload = self.input("preload", n - self.robot.mechanism.dof());
        let (basis, inverse) = self.basis()?;
        let moving = apply(&transposed(&inverse), &forces);
        let kept = &self.selection.kept_actuators;
        let cables = self.redundant_cables();
        let internal = preload.iter().enumerate().map(|(k, &wanted)| {
            let wanted = if cables[k] { -wanted } else { wanted };
            let along = kept.iter().zip(&moving).map(|(&i, &p)| basis[i][k] * p);
            wanted - along.sum::<Expr<'a>>()
        });
        let internal: Vec<Expr<'a>> = internal.collect();
        let mut torques = apply(&basis, &internal);
        for (&i, &p) in kept.iter().zip(&moving) {
            torques[i] = torques[i] + p;
        }
        Ok(column(self.robot.with_tensions(torques)))
    }

    /// A basis of the internal torques, one column for each redundant actuator.
    ///
    /// # Errors
    /// Kept actuators that never determine the platform's motion.
    pub(crate) fn null_space(&mut self) -> Result<Rows<'a>, DerivationError> {
        let columns = transposed(&self.basis()?.0).into_iter();
        let signed = columns.zip(self.redundant_cables()).map(|(own, is_cable)| {
            let own = self.robot.with_tensions(own);
            // The column stays positive on its own actuator.
            let sign = |torque: Expr<'a>| if is_cable { -torque } else { torque };
            own.into_iter().map(sign).collect()
        });
        let columns: Rows<'a> = signed.collect();
        if columns.is_empty() {
            return Ok(vec![Vec::new(); self.robot.mechanism.actuator_count()]);
        }
        Ok(transposed(&columns))
    }

    /// Whether each redundant actuator is a cable, in the order of the columns of N.
    fn redundant_cables(&self) -> Vec<bool> {
        let kept = &self.selection.kept_actuators;
        let all = self.robot.mechanism.pulls().into_iter().enumerate();
        all.filter(|(at, _)| !kept.contains(at))
            .map(|(_, pulls)| pulls)
            .collect()
    }

    /// N, and the inverse of the kept actuators' rows of J_p^inv.
    fn basis(&mut self) -> Result<(Rows<'a>, Rows<'a>), DerivationError> {
        let jacobian = self.robot.inverse_jacobian();
        let kept = &self.selection.kept_actuators;
        let rows: Rows<'a> = kept.iter().map(|&i| jacobian[i].clone()).collect();
        let home = |value: Expr<'a>| self.robot.at_home(value);
        let inverse = inverse(&rows, &home).ok_or(DerivationError::SingularPartition)?;
        self.guard_platform(&inverse.determinants, ActuatorGroup::Kept);
        self.robot.name_partition(&inverse, &[], kept);
        let arena = self.robot.arena;
        let basis = null_space(arena, &jacobian, kept, &inverse);
        Ok((basis, inverse.rows))
    }

    /// M for given parameters, from bodies summed from the tips to the base.
    pub(crate) fn mass_matrix(&mut self, of: Columns) -> Rows<'a> {
        let values = self.parameter_values(of);
        let mut masses = self.robot.masses(&values).unwrap_or_default();
        if !matches!(self.owner, Owner::Leg(_)) {
            self.robot.add_rotors(&mut masses, &values);
        }
        masses
    }
}
