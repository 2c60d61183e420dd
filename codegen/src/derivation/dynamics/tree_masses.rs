//! Mass matrix of a robot with legs on bodies of other legs: M = Gᵀ M_u G.
//!
//! M_u is the mass matrix of the tree of all joints with its loops opened, and G = ∂u/∂v is the
//! reduced Jacobian of all quasi-velocities. A mounted leg acts as an additional body for its base
//! body. Each of its quasi-accelerations produces a wrench on that body, whose components on the
//! earlier joints couple the two.

use super::composite::Chain;
use crate::cas::{Arena, Expr, Vector3};
use crate::derivation::bodies::inertia::Inertia;
use crate::derivation::kinematics::orientation::constant_rotation;
use crate::derivation::kinematics::spatial::Wrench;
use crate::derivation::linear_algebra::elimination::Rows;
use crate::derivation::linear_algebra::linear::{dot, transposed};
use crate::derivation::names::name_matrix;
use crate::derivation::parameter::BodyParameter;
use crate::derivation::robot::Robot;
use crate::mechanism::{BodyIndex, Leg};

impl<'a> Robot<'a> {
    /// M for given parameters. `None` if the configuration does not determine a sine or cosine.
    pub(crate) fn tree_masses(&self, values: &[(BodyParameter, Expr<'a>)]) -> Option<Rows<'a>> {
        let of_tree = self.masses_of_joints(values)?;
        let legs = self.mechanism.legs.iter().zip(&self.legs);
        let rows: Rows<'a> = legs
            .flat_map(|(leg, state)| state.rows[..leg.independent().count()].to_vec())
            .collect();
        self.arena.enter("");
        let columns = transposed(&rows);
        let moved: Rows<'a> = columns
            .iter()
            .map(|column| of_tree.iter().map(|row| dot(row, column)).collect())
            .collect();
        let dof = self.mechanism.dof();
        let entry = |a: usize, b: usize| dot(&columns[a.min(b)], &moved[a.max(b)]);
        Some(
            (0..dof)
                .map(|a| (0..dof).map(|b| entry(a, b)).collect())
                .collect(),
        )
    }

    /// M_u, in the quasi-velocities of all legs.
    fn masses_of_joints(&self, values: &[(BodyParameter, Expr<'a>)]) -> Option<Rows<'a>> {
        let (arena, mechanism) = (self.arena, self.mechanism);
        let chains = (0..mechanism.legs.len()).map(|index| self.chain(index, values));
        let mut chains = chains.collect::<Option<Vec<_>>>()?;
        for (index, leg) in mechanism.legs.iter().enumerate().rev() {
            arena.enter(&leg.name);
            chains[index].add_up();
            if let Some(carrier) = leg.base_body {
                let whole = on_carrier(arena, leg, &chains[index].at_base());
                chains[carrier.leg].carry(carrier.joint, &whole);
            }
        }
        let count = mechanism.joints().len();
        let mut all = vec![vec![arena.zero(); count]; count];
        let mut set = |i: usize, k: usize, value: Expr<'a>| {
            all[i][k] = value;
            all[k][i] = value;
        };
        for (index, leg) in mechanism.legs.iter().enumerate() {
            arena.enter(&leg.name);
            let own = mechanism.leg_range(index);
            for k in 0..own.len() {
                for (i, value) in chains[index].column(k).into_iter().enumerate() {
                    set(own.start + i, own.start + k, value);
                }
                let Some(wrench) = chains[index].base_wrench(k) else {
                    continue;
                };
                for (body, forces) in self.forces_on_base_legs(&chains, index, wrench) {
                    let first = mechanism.leg_range(body.leg).start;
                    for (i, force) in forces.into_iter().enumerate() {
                        set(first + i, own.start + k, force);
                    }
                }
            }
        }
        arena.enter("");
        name_matrix(&all, "masses_of_joints");
        Some(all)
    }

    /// Forces of a wrench at a leg's base on the quasi-velocities of the legs that carry it.
    fn forces_on_base_legs(
        &self,
        chains: &[Chain<'_, 'a>],
        index: usize,
        mut wrench: Wrench<'a>,
    ) -> Vec<(BodyIndex, Vec<Expr<'a>>)> {
        let mut leg = &self.mechanism.legs[index];
        let mut all = Vec::new();
        while let Some(carrier) = leg.base_body {
            let chain = &chains[carrier.leg];
            let on_body = wrench_on_carrier(self.arena, leg, &wrench);
            let transferred = chain.project_to_base(carrier.joint, on_body);
            all.push((carrier, transferred.forces));
            wrench = transferred.at_base;
            leg = &self.mechanism.legs[carrier.leg];
        }
        all
    }
}

/// An inertia in a leg's base frame, in the frame of the leg's base body.
pub(crate) fn on_carrier<'a>(arena: &'a Arena, leg: &Leg, at_base: &Inertia<'a>) -> Inertia<'a> {
    let turned = at_base.rotated(constant_rotation(arena, leg.base.rotation));
    turned.moved_onto(&Inertia::zero(arena), Vector3::constant(arena, leg.base.at))
}

/// A wrench at a leg's base, in its axes, as one at the frame of the leg's base body.
pub(crate) fn wrench_on_carrier<'a>(
    arena: &'a Arena,
    leg: &Leg,
    wrench: &Wrench<'a>,
) -> Wrench<'a> {
    let Wrench { force, moment } = wrench.rotated(constant_rotation(arena, leg.base.rotation));
    let lever = Vector3::constant(arena, leg.base.at).cross(force);
    Wrench {
        force,
        moment: moment + lever,
    }
}
