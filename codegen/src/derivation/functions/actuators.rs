//! Forces on the actuated joints, and the linear systems between them and the platform.
//!
//! With as many actuators as independent coordinates, J = J_p^inv is square. A force on an actuated
//! joint's own rate is then the torque of its actuator, and only the remaining generalised forces F
//! are transformed: τ = τ_own + J⁻ᵀ F. Small square systems are solved by cofactors, because pivots
//! could vanish although J is regular. All others are solved by least squares, eqs. (21) and (22).

use crate::cas::Expr;
use crate::derivation::context::DerivationContext;
use crate::derivation::linear_algebra::elimination::{Inverse, Rows, inverse};
use crate::derivation::linear_algebra::linear::{Factored, apply, dot, transposed};
use overact_core::ActuatorGroup;

/// Size of the largest blocks of J that are solved by cofactors; from four rows on least squares
/// are cheaper.
pub(crate) const COFACTORS: usize = 3;

/// J = J_p^inv, prepared for solving.
pub(crate) enum ActuatorSystem<'a> {
    /// J⁻¹.
    Square(Inverse<'a>),
    /// J and the factors of JᵀJ.
    LeastSquares(Rows<'a>, Factored<'a>),
}

impl<'a> ActuatorSystem<'a> {
    /// The v for which J v fits the actuators' rates best.
    pub(crate) fn velocities(&self, rates: &[Expr<'a>]) -> Vec<Expr<'a>> {
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
    pub(crate) fn torques(&self, forces: &[Expr<'a>]) -> Vec<Expr<'a>> {
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

    /// J⁺, r × n.
    pub(crate) fn pseudo_inverse(&self) -> Rows<'a> {
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
    /// J = J_p^inv, prepared for solving; its divisors are guarded.
    pub(crate) fn actuator_system(&mut self) -> ActuatorSystem<'a> {
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
    pub(crate) fn solved_by_cofactors(
        &mut self,
        rows: &Rows<'a>,
        right: &[Expr<'a>],
    ) -> Option<Vec<Expr<'a>>> {
        let inverse = self.by_cofactors(rows)?;
        self.guard_platform(&inverse.determinants, ActuatorGroup::All);
        Some(ActuatorSystem::Square(inverse).velocities(right))
    }

    /// The inverse of a square J whose blocks are small.
    pub(crate) fn by_cofactors(&self, jacobian: &Rows<'a>) -> Option<Inverse<'a>> {
        if jacobian.len() != self.robot.mechanism.dof() {
            return None;
        }
        let home = |value: Expr<'a>| self.robot.at_home(value);
        let inverse = inverse(jacobian, &home)?;
        (inverse.largest_block <= COFACTORS).then_some(inverse)
    }
}
