//! Forces on the actuated joints, and the systems that lead from them to the platform and back.
//!
//! Where there are as many actuators as independent coordinates, J = J_p^inv is square: what acts on an
//! actuated joint's own rate is that actuator's torque as it is, and only the rest F of the generalised forces
//! goes through the platform, τ = τ_own + J⁻ᵀ F. Small square systems are solved by cofactors, without pivots
//! that could vanish where J is regular. All others are solved by least squares, eqs. (21) and (22).

use super::context::DerivationContext;
use super::elimination::{Inverse, Rows, inverse};
use super::linear::{Factored, apply, dot, transposed};
use super::robot::Robot;
use crate::cas::Expr;
use overact_core::ActuatorGroup;

/// The largest blocks of J that are solved by cofactors: from four rows on least squares take fewer operations.
pub(super) const COFACTORS: usize = 3;

/// What acts on the rates of actuated joints.
#[derive(Debug, Default)]
pub(super) struct OwnForces<'a> {
    /// Leg and quasi-velocity of the actuated joints whose rate is one, with the actuator.
    rates: Vec<(usize, usize, usize)>,
    /// Force on each actuator; empty where none is told apart.
    forces: Vec<Expr<'a>>,
}

impl<'a> OwnForces<'a> {
    /// Of a robot with as many actuators as coordinates; of others nothing is told apart.
    pub(super) fn of(robot: &Robot<'a>) -> Self {
        let mechanism = robot.mechanism;
        let actuated = mechanism.actuated();
        if actuated.len() != mechanism.dof() {
            return Self::default();
        }
        let joints = mechanism.joints();
        let rate = |(actuator, &index): (usize, &usize)| {
            let of = joints[index];
            let own = robot.legs[of.leg].rates.own(&[of.joint]);
            own.first().map(|&rate| (of.leg, rate, actuator))
        };
        Self {
            rates: actuated.iter().enumerate().filter_map(rate).collect(),
            forces: vec![robot.arena.zero(); actuated.len()],
        }
    }

    /// Moves what acts on actuated joints out of the forces on a leg's quasi-velocities.
    pub(super) fn take(&mut self, leg: usize, forces: &mut [Expr<'a>]) {
        for &(_, rate, actuator) in self.rates.iter().filter(|&&(of, ..)| of == leg) {
            let force = forces[rate];
            self.forces[actuator] = self.forces[actuator] + force;
            forces[rate] = force.arena().zero();
        }
    }

    /// The torques with what the rest asks for.
    pub(super) fn with(self, rest: Vec<Expr<'a>>) -> Vec<Expr<'a>> {
        if self.forces.is_empty() {
            return rest;
        }
        let own = self.forces.into_iter().zip(rest);
        own.map(|(own, rest)| own + rest).collect()
    }
}

/// J = J_p^inv, ready to be solved with.
pub(super) enum ActuatorSystem<'a> {
    /// J⁻¹.
    Square(Inverse<'a>),
    /// J and the factors of JᵀJ.
    LeastSquares(Rows<'a>, Factored<'a>),
}

impl<'a> ActuatorSystem<'a> {
    /// The v that fits J v to the actuators' rates best.
    pub(super) fn velocities(&self, rates: &[Expr<'a>]) -> Vec<Expr<'a>> {
        match self {
            Self::Square(inverse) => {
                let rows = inverse.scaled.iter();
                rows.map(|row| row.factor * dot(&row.entries, rates))
                    .collect()
            }
            Self::LeastSquares(jacobian, factored) => {
                factored.solve(&apply(&transposed(jacobian), rates))
            }
        }
    }

    /// The τ of least norm with Jᵀ τ = F.
    pub(super) fn torques(&self, forces: &[Expr<'a>]) -> Vec<Expr<'a>> {
        match self {
            Self::Square(inverse) => {
                let rows = inverse.scaled.iter();
                let scaled: Vec<Expr<'a>> = rows.zip(forces).map(|(r, f)| r.factor * *f).collect();
                let entries: Rows<'a> = inverse.scaled.iter().map(|r| r.entries.clone()).collect();
                apply(&transposed(&entries), &scaled)
            }
            Self::LeastSquares(jacobian, factored) => apply(jacobian, &factored.solve(forces)),
        }
    }

    /// J⁺, r x n.
    pub(super) fn pseudo_inverse(&self) -> Rows<'a> {
        match self {
            Self::Square(inverse) => inverse.rows.clone(),
            Self::LeastSquares(jacobian, factored) => {
                let columns: Rows<'a> = jacobian.iter().map(|row| factored.solve(row)).collect();
                transposed(&columns)
            }
        }
    }
}

impl<'a> DerivationContext<'a, '_> {
    /// J = J_p^inv, ready to be solved with; what is divided by is guarded.
    pub(super) fn actuator_system(&mut self) -> ActuatorSystem<'a> {
        let jacobian = self.robot.inverse_jacobian();
        if let Some(inverse) = self.by_cofactors(&jacobian) {
            self.guard_platform(&inverse.determinants, ActuatorGroup::All);
            return ActuatorSystem::Square(inverse);
        }
        let factored = Factored::normal(&jacobian);
        self.guard_platform(&factored.pivots, ActuatorGroup::All);
        ActuatorSystem::LeastSquares(jacobian, factored)
    }

    /// The x with A x = b for a square A whose blocks are small.
    pub(super) fn solved_by_cofactors(
        &mut self,
        rows: &Rows<'a>,
        right: &[Expr<'a>],
    ) -> Option<Vec<Expr<'a>>> {
        let inverse = self.by_cofactors(rows)?;
        self.guard_platform(&inverse.determinants, ActuatorGroup::All);
        Some(ActuatorSystem::Square(inverse).velocities(right))
    }

    /// The inverse of a square J whose blocks are small.
    pub(super) fn by_cofactors(&self, jacobian: &Rows<'a>) -> Option<Inverse<'a>> {
        if jacobian.len() != self.robot.mechanism.dof() {
            return None;
        }
        let home = |value: Expr<'a>| self.robot.at_home(value);
        let inverse = inverse(jacobian, &home)?;
        (inverse.largest_block <= COFACTORS).then_some(inverse)
    }
}
