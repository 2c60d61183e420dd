//! First moment of the whole robot, and its momentum for unit velocities.
//!
//! Masses and first moments are summed from the tips to the base. The linear momentum for a unit
//! quasi-velocity is the force that accelerates all bodies by it from rest, which the composite
//! bodies give. Bodies on the platform have the momentum m v + ω × s.

use super::composite::Chain;
use super::tree_masses::{on_carrier, wrench_on_carrier};
use crate::cas::{Expr, Vector3};
use crate::derivation::bodies::inertia::Inertia;
use crate::derivation::kinematics::orientation::constant_rotation;
use crate::derivation::kinematics::platform::on_twist;
use crate::derivation::kinematics::spatial::Wrench;
use crate::derivation::linear_algebra::elimination::Rows;
use crate::derivation::linear_algebra::linear::add_to;
use crate::derivation::parameter::BodyParameter;
use crate::derivation::robot::Robot;
use crate::mechanism::{StandardParameter, TwistCoordinate};

/// Mass of all bodies, and their first moment about the base's origin.
pub(crate) struct FirstMoment<'a> {
    /// Mass.
    pub(crate) mass: Expr<'a>,
    /// First moment, in the base's axes.
    pub(crate) moment: Vector3<'a>,
}

impl<'a> Robot<'a> {
    /// Sum of all masses.
    pub(crate) fn total_mass(&self, values: &[(BodyParameter, Expr<'a>)]) -> Expr<'a> {
        let masses = values
            .iter()
            .filter(|(parameter, _)| parameter.symbol() == StandardParameter::M);
        masses.fold(self.arena.zero(), |sum, (_, value)| sum + *value)
    }

    /// First moment of all bodies. `None` if the configuration does not determine a sine or cosine.
    pub(crate) fn first_moment(
        &self,
        values: &[(BodyParameter, Expr<'a>)],
    ) -> Option<FirstMoment<'a>> {
        let chains = self.composites(values)?;
        let mut sum = Inertia::zero(self.arena);
        let legs = self.mechanism.legs.iter().zip(&chains);
        for (leg, chain) in legs.filter(|(leg, _)| leg.base_body.is_none()) {
            let still = Vector3::zero(self.arena);
            sum = on_carrier(self.arena, leg, &chain.at_base()).moved_onto(&sum, still);
        }
        if let Some(pose) = &self.platform {
            let platform = self.platform_inertia(values).rotated(pose.rotation);
            sum = platform.moved_onto(&sum, pose.origin);
        }
        Some(FirstMoment {
            mass: self.total_mass(values),
            moment: sum.first,
        })
    }

    /// The composite bodies of all legs; a leg on a body of another leg is part of that body.
    fn composites(&self, values: &[(BodyParameter, Expr<'a>)]) -> Option<Vec<Chain<'_, 'a>>> {
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
        arena.enter("");
        Some(chains)
    }

    /// Linear momentum of all bodies per independent velocity, 3 × r.
    pub(crate) fn momentum_rows(&self, values: &[(BodyParameter, Expr<'a>)]) -> Option<Rows<'a>> {
        let chains = self.composites(values)?;
        let zero = self.arena.zero();
        let mut total = vec![vec![zero; self.mechanism.dof()]; 3];
        // Per component of the velocity of a platform with parasitic motion.
        let mut free = vec![vec![zero; self.free.len()]; 3];
        for (index, chain) in chains.iter().enumerate() {
            let leg = &self.mechanism.legs[index];
            self.arena.enter(&leg.name);
            let count = leg.independent().count();
            let momenta: Vec<Vector3<'a>> = (0..count)
                .map(|u| match chain.base_wrench(u) {
                    Some(wrench) => self.in_base(&chains, index, wrench),
                    None => Vector3::zero(self.arena),
                })
                .collect();
            self.add_leg(index, &momenta, &mut total, &mut free);
        }
        self.arena.enter("platform");
        if let Some(pose) = &self.platform {
            let platform = self.platform_inertia(values).rotated(pose.rotation);
            for (at, coordinate) in self.free.iter().enumerate() {
                let own = match coordinate {
                    TwistCoordinate::Linear(axis) => {
                        Vector3::unit(self.arena, *axis).scaled(platform.mass)
                    }
                    TwistCoordinate::Angular(axis) => {
                        Vector3::unit(self.arena, *axis).cross(platform.first)
                    }
                };
                for (row, entry) in free.iter_mut().zip(own.0) {
                    row[at] = row[at] + entry;
                }
            }
        }
        self.arena.enter("");
        for (row, free) in total.iter_mut().zip(free) {
            if self.platform.is_some() {
                add_to(row, self.on_independent(free));
            }
        }
        Some(total)
    }

    /// Adds the momentum of a leg, given per quasi-velocity.
    ///
    /// For a leg on a platform, row i of the sum Σ p_u f_uᵀ over its wrenches f_u is a force at the
    /// leg's end, with components on the platform's velocity.
    fn add_leg(
        &self,
        index: usize,
        momenta: &[Vector3<'a>],
        total: &mut Rows<'a>,
        free: &mut Rows<'a>,
    ) {
        let state = &self.legs[index];
        let closure = state.closure.as_ref().filter(|_| self.platform.is_some());
        for (axis, (total, free)) in total.iter_mut().zip(free).enumerate() {
            let along: Vec<Expr<'a>> = momenta.iter().map(|momentum| momentum.0[axis]).collect();
            let Some(closure) = closure else {
                let rows = state.rows[..along.len()].to_vec();
                add_to(total, self.combine(&rows, &along));
                continue;
            };
            let zero = Vector3::zero(self.arena);
            let sum = |vectors: &[Vector3<'a>]| {
                let parts = vectors.iter().zip(&along);
                parts.fold(zero, |sum, (vector, p)| sum + vector.scaled(*p))
            };
            let wrench = Wrench {
                force: sum(&closure.forces),
                moment: sum(&closure.moments),
            };
            add_to(free, on_twist(&self.free, closure.arm, wrench));
        }
    }

    /// The force of a wrench at a leg's base, in the base's axes.
    fn in_base(
        &self,
        chains: &[Chain<'_, 'a>],
        index: usize,
        mut wrench: Wrench<'a>,
    ) -> Vector3<'a> {
        let mut leg = &self.mechanism.legs[index];
        while let Some(carrier) = leg.base_body {
            let on_body = wrench_on_carrier(self.arena, leg, &wrench);
            let chain = &chains[carrier.leg];
            wrench = chain.project_to_base(carrier.joint, on_body).at_base;
            leg = &self.mechanism.legs[carrier.leg];
        }
        constant_rotation(self.arena, leg.base.rotation) * wrench.force
    }
}
