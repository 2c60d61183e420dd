//! Derivatives of inverse and forward dynamics along displacements and with respect to the twist.
//!
//! With the residual F = Γ¹(x, v, v̇) - Jᵀ τ, J = J_p^inv, and τ held, the derivatives of v̇ are
//! -M⁻¹ ∂F (Carpentier and Mansard, *Analytical derivatives of rigid body dynamics algorithms*,
//! 2018). Those of τ follow from Jᵀ τ = Γ¹: with as many actuators as coordinates they are J⁻ᵀ ∂F.
//! Otherwise τ = J λ with JᵀJ λ = Γ¹, so ∂τ = ∂J λ + J (JᵀJ)⁻¹ (∂F - Jᵀ ∂J λ). Only F and J λ are
//! differentiated, with τ and λ as constants.

use super::actuators::ActuatorSystem;
use crate::cas::jacobian::LinearisedGraph;
use crate::cas::{Expr, Substitution};
use crate::derivation::context::DerivationContext;
use crate::derivation::dynamics::actuated_joint_forces::ActuatedJointForces;
use crate::derivation::linear_algebra::elimination::Rows;
use crate::derivation::linear_algebra::linear::{apply, transposed};
use overact_core::Columns;

/// The variable of a derivative.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Variable {
    /// A displacement of the pose.
    Displacement,
    /// The twist.
    Twist,
}

impl<'a> DerivationContext<'a, '_> {
    /// Derivatives of the actuator torques, n × r.
    pub(super) fn inverse_dynamics_by(&mut self, of: Columns, variable: Variable) -> Rows<'a> {
        let (twist, acceleration) = (self.twist(), self.acceleration());
        let mut own = ActuatedJointForces::of(&self.robot);
        let forces = self.dynamics_of(of, &twist, &acceleration, &mut own);
        let system = self.actuator_system();
        let torques = system.torques(&forces);
        let jacobian = self.robot.inverse_jacobian();
        let one = self.robot.arena.one();
        let mut graph = self.graph(variable, &twist);
        residual(&mut graph, &forces, &jacobian, &torques);
        // J λ with λ held.
        let multipliers = match &system {
            ActuatorSystem::LeastSquares(_, factored) if jacobian.len() != forces.len() => {
                Some(factored.solve(&forces))
            }
            _ => None,
        };
        let moved = multipliers.iter().flat_map(|multipliers| {
            jacobian.iter().map(|row| -> Vec<(Expr<'a>, Expr<'a>)> {
                row.iter()
                    .copied()
                    .zip(multipliers.iter().copied())
                    .collect()
            })
        });
        moved.for_each(|terms| graph.output(&terms));
        for &force in own.forces() {
            graph.output(&[(force, one)]);
        }
        let rows = graph.derivatives(self.selection.formulation.elimination);
        let (residual, direct) = rows.split_at(forces.len());
        let columns = (0..twist.len()).map(|k| {
            let mut right: Vec<Expr<'a>> = residual.iter().map(|row| row[k]).collect();
            let direct: Vec<Expr<'a>> = direct.iter().map(|row| row[k]).collect();
            if multipliers.is_some() {
                let inner = apply(&transposed(&jacobian), &direct);
                right = right.iter().zip(inner).map(|(r, i)| *r - i).collect();
            }
            let torques = system.torques(&right);
            if direct.is_empty() {
                return torques;
            }
            torques.iter().zip(direct).map(|(t, d)| *t + d).collect()
        });
        transposed(&columns.collect())
    }

    /// Derivatives of the acceleration under given torques, r × r.
    pub(super) fn forward_dynamics_by(
        &mut self,
        of: Columns,
        variable: Variable,
        n: usize,
    ) -> Rows<'a> {
        let arena = self.robot.arena;
        let (twist, torques) = (self.twist(), self.input("torques", n));
        let (acceleration, factored) = self.solved_acceleration(of, &twist, &torques);
        // The acceleration is a symbol while forces are differentiated.
        let names: Vec<String> = { 0..acceleration.len() }
            .map(|k| format!("acceleration {k} under the torques"))
            .collect();
        let held: Vec<Expr<'a>> = names.iter().map(|name| arena.placeholder(name)).collect();
        let guards = self.guards.len();
        let forces = self.projected_dynamics(of, &twist, &held);
        self.guards.truncate(guards);
        let jacobian = self.robot.inverse_jacobian();
        let mut graph = self.graph(variable, &twist);
        residual(&mut graph, &forces, &jacobian, &torques);
        let rows = graph.derivatives(self.selection.formulation.elimination);
        let replaced = names
            .iter()
            .zip(acceleration)
            .fold(Substitution::new(arena), |replaced, (name, value)| {
                replaced.value(arena.symbol(name), value)
            });
        let rows: Rows<'a> = { rows.iter() }
            .map(|row| {
                replaced
                    .apply_all(row)
                    .into_iter()
                    .map(|entry| -entry)
                    .collect()
            })
            .collect();
        let columns = transposed(&rows);
        transposed(
            &columns
                .iter()
                .map(|column| factored.solve(column))
                .collect(),
        )
    }

    /// The linearised graph along the directions of a variable.
    fn graph(&self, variable: Variable, twist: &[Expr<'a>]) -> LinearisedGraph<'a> {
        match variable {
            Variable::Displacement => self.robot.along_displacements(),
            Variable::Twist => self.robot.along_twist(twist),
        }
    }
}

/// Adds the outputs Γ¹ - Jᵀ τ with τ held.
fn residual<'a>(
    graph: &mut LinearisedGraph<'a>,
    forces: &[Expr<'a>],
    jacobian: &Rows<'a>,
    torques: &[Expr<'a>],
) {
    for (k, &force) in forces.iter().enumerate() {
        let one = force.arena().one();
        let mut terms = vec![(force, one)];
        let loads = jacobian.iter().zip(torques);
        terms.extend(loads.map(|(row, &torque)| (row[k], -torque)));
        graph.output(&terms);
    }
}
