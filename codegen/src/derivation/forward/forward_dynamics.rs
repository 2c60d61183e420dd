//! Forward dynamics: M v̇ = Γ¹(τ) - h, solved for v̇.
//!
//! M is symmetric, and positive definite for physically consistent parameters. It is factored as L
//! D Lᵀ, as in the composite-body methods (M. W. Walker, D. E. Orin, 1982). One function computes
//! the legs' geometry, M and h together; separate functions would repeat the geometry. A pivot that
//! is not positive means that the parameters are not physically consistent.

use crate::cas::Expr;
use crate::derivation::context::DerivationContext;
use crate::derivation::guard::{Guard, GuardKind};
use crate::derivation::linear_algebra::linear::Factored;
use crate::derivation::names::name_matrix;
use overact_core::Columns;

impl<'a> DerivationContext<'a, '_> {
    /// v̇ = M⁻¹ (Γ¹(τ) - h).
    pub(crate) fn forward_dynamics(&mut self, of: Columns, n: usize) -> Vec<Expr<'a>> {
        let twist = self.twist();
        let torques = self.input("torques", n);
        self.solved_acceleration(of, &twist, &torques).0
    }

    /// v̇ = M⁻¹ (Γ¹(τ) - h), and the factors of M.
    pub(crate) fn solved_acceleration(
        &mut self,
        of: Columns,
        twist: &[Expr<'a>],
        torques: &[Expr<'a>],
    ) -> (Vec<Expr<'a>>, Factored<'a>) {
        let still = self.zeros();
        let bias = self.projected_dynamics(of, twist, &still);
        let mass = self.mass_matrix(of);
        name_matrix(&mass, "mass");
        let forces = self.robot.projected_torques(torques);
        let accelerating: Vec<Expr<'a>> = forces
            .iter()
            .zip(&bias)
            .map(|(force, bias)| *force - *bias)
            .collect();
        let factored = Factored::of(mass);
        self.guard_mass(&factored.pivots);
        (factored.solve(&accelerating), factored)
    }

    /// Guards the pivots of the mass matrix, which have to be positive.
    fn guard_mass(&mut self, pivots: &[Expr<'a>]) {
        self.guards.extend(pivots.iter().map(|&value| Guard {
            value,
            kind: GuardKind::Mass,
            leg: String::new(),
        }));
    }
}
