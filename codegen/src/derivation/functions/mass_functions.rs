//! Centre of mass, total mass and energies for given standard parameters.

use super::Derived;
use crate::cas::{Arena, Expr, Number};
use crate::derivation::context::DerivationContext;
use crate::derivation::dynamics::centre_of_mass::FirstMoment;
use crate::derivation::guard::{Guard, GuardKind};
use crate::derivation::linear_algebra::elimination::Rows;
use crate::derivation::parameter::BodyParameter;
use crate::derivation::selection::Selection;
use crate::mechanism::StandardParameter;
use overact_core::{Columns, Input};

/// The sum of all masses, from the parameters alone.
pub(super) fn total_mass<'a>(arena: &'a Arena, selection: &Selection) -> Derived<'a> {
    let all = || selection.standard.iter().chain(&selection.payload);
    let is_mass =
        |(_, parameter): &(usize, &BodyParameter)| parameter.symbol() == StandardParameter::M;
    let mass = |(index, parameter)| match &selection.values {
        None => arena.input(Input::Parameters.name(), index),
        Some(known) => {
            let value = known.iter().find(|(own, _)| own == parameter);
            arena.number(Number::float(value.map_or(0.0, |(_, value)| *value)))
        }
    };
    let masses = all().enumerate().filter(is_mass).map(mass);
    let total = masses.fold(arena.zero(), |sum, mass| sum + mass);
    let inputs = match selection.values {
        None => vec![(Input::Parameters.name(), all().count())],
        Some(_) => Vec::new(),
    };
    Derived {
        inputs,
        shape: (1, 1),
        entries: vec![total],
        guards: Vec::new(),
        divisors: Vec::new(),
    }
}

impl<'a> DerivationContext<'a, '_> {
    /// The centre of mass in the description's base frame.
    pub(super) fn centre_of_mass(&mut self) -> Vec<Expr<'a>> {
        let Some(FirstMoment { mass, moment }) = self.first_moment() else {
            return Vec::new();
        };
        let per_mass = self.per_mass(mass);
        let origin = self
            .robot
            .mechanism
            .origin
            .map(|at| self.robot.arena.number(at));
        let entries = moment.0.into_iter().zip(origin);
        entries.map(|(moment, at)| moment * per_mass + at).collect()
    }

    /// Velocity of the centre of mass per independent velocity.
    pub(super) fn centre_of_mass_jacobian(&mut self) -> Rows<'a> {
        let values = self.parameter_values(Columns::Standard);
        let Some(momentum) = self.robot.momentum_rows(&values) else {
            return Vec::new();
        };
        let mass = self.robot.total_mass(&values);
        let per_mass = self.per_mass(mass);
        let scaled = |row: Vec<Expr<'a>>| row.into_iter().map(|entry| entry * per_mass).collect();
        momentum.into_iter().map(scaled).collect()
    }

    /// Kinetic energy of all bodies and rotors.
    pub(super) fn kinetic_energy(&mut self) -> Expr<'a> {
        let twist = self.twist();
        let values = self.parameter_values(Columns::Standard);
        let still = self.zeros();
        let motion = self.robot.motion(&twist, &still);
        let energy = motion.and_then(|motion| self.robot.kinetic_energy(&twist, &motion, &values));
        energy.unwrap_or_else(|| self.robot.arena.zero())
    }

    /// Potential energy of all bodies in gravity.
    pub(super) fn potential_energy(&mut self) -> Expr<'a> {
        let arena = self.robot.arena;
        let Some(FirstMoment { mass, moment }) = self.first_moment() else {
            return arena.zero();
        };
        let mechanism = self.robot.mechanism;
        let axes = mechanism.gravity.into_iter().zip(mechanism.origin);
        let along = axes.zip(moment.0).map(|((gravity, origin), moment)| {
            -((moment + mass * arena.number(origin)) * arena.number(gravity))
        });
        along.fold(arena.zero(), |sum, part| sum + part)
    }

    fn first_moment(&mut self) -> Option<FirstMoment<'a>> {
        let values = self.parameter_values(Columns::Standard);
        self.robot.first_moment(&values)
    }

    /// 1/m; the mass has to be positive.
    fn per_mass(&mut self, mass: Expr<'a>) -> Expr<'a> {
        self.guards.push(Guard {
            value: mass,
            kind: GuardKind::Mass,
            leg: String::new(),
        });
        mass.reciprocal()
    }
}
