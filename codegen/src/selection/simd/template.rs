//! One leg as a template of equal legs: the numbers by which they differ are elements of an array.

use super::fields::{angles, names_of_angles, names_of_numbers, numbers};
use super::placeholders::{Constant, Placeholders};
use crate::cas::{Angle, Arena, InputElement, Number};
use crate::derivation::working_modes;
use crate::mechanism::{Joint, Leg, Mechanism};

/// Name of the array.
pub(super) const ARRAY: &str = "of_leg";

/// A robot whose first leg is the template of all legs.
#[derive(Debug)]
pub(super) struct Template {
    /// The robot; the first leg has placeholders for numbers that differ.
    pub(super) mechanism: Mechanism,
    /// The numbers that differ.
    constants: Vec<Constant>,
}

impl Template {
    /// The template of a robot whose legs differ by numbers only.
    pub(super) fn of(mechanism: &Mechanism) -> Option<Self> {
        let [first, others @ ..] = &mechanism.legs[..] else {
            return None;
        };
        // The home angles of passive joints, near which formulas take them, differ between legs, and
        // known torques belong to no parameter of a leg.
        let is_one =
            |joint: &Joint| joint.spring.is_some() || joint.known.is_some() || joint.load.is_some();
        let has_formula = |leg: &Leg| leg.joints.iter().any(is_one);
        // Cables have short programs, and those of pulleys may differ in their signs at home.
        if mechanism.has_cables()
            || !mechanism.springs.is_empty()
            || mechanism.legs.iter().any(has_formula)
        {
            return None;
        }
        if others.is_empty() || !others.iter().all(|leg| shape(leg) == shape(first)) {
            return None;
        }
        let mut placeholders = Placeholders::new();
        let mut legs = mechanism.legs.clone();
        let names = names_of_numbers(first);
        let mut of_legs: Vec<_> = legs.iter_mut().map(numbers).collect();
        for at in 0..of_legs[0].len() {
            let all = of_legs.iter().map(|of_leg| *of_leg[at]).collect();
            *of_legs[0][at] = placeholders.number(all, &names[at]);
        }
        let names = names_of_angles(first);
        let mut of_legs: Vec<_> = legs.iter_mut().map(angles).collect();
        for at in 0..of_legs[0].len() {
            let all = of_legs.iter().map(|of_leg| *of_leg[at]).collect();
            *of_legs[0][at] = placeholders.angle(all, &names[at])?;
        }
        let mut constants = placeholders.constants;
        legs[0].name = name(&mechanism.legs);
        let mut home = mechanism.home.clone();
        home.signs = signs(mechanism, &mut constants);
        let mechanism = Mechanism {
            legs,
            home,
            ..mechanism.clone()
        };
        Some(Self {
            mechanism,
            constants,
        })
    }

    /// Count of the numbers that differ.
    pub(super) fn len(&self) -> usize {
        self.constants.len()
    }

    /// Replaces the placeholders in a graph by elements of the array.
    pub(super) fn substitute_placeholders(&self, arena: &Arena) {
        for (index, constant) in self.constants.iter().enumerate() {
            match constant.number {
                Some(number) => arena.stand_for(number, ARRAY, index),
                None => arena.let_be_sign(ARRAY, index),
            }
        }
    }

    /// Name of an element of the array.
    pub(super) fn name(&self, index: usize) -> &str {
        &self.constants[index].name
    }

    /// Numbers of a leg.
    pub(super) fn values(&self, leg: usize) -> Vec<f64> {
        self.constants.iter().map(|c| c.values[leg]).collect()
    }
}

/// The array elements with the signs of the roots in the first leg's closed form.
///
/// They exist if some leg has another working mode than the first.
fn signs(mechanism: &Mechanism, constants: &mut Vec<Constant>) -> Vec<Option<InputElement>> {
    let Some(modes) = working_modes(mechanism) else {
        return Vec::new();
    };
    let first = &modes[0];
    if modes.iter().any(|mode| mode.len() != first.len()) {
        return Vec::new();
    }
    let leg = &mechanism.legs[0].name;
    let sign = |root: usize| {
        let values = modes
            .iter()
            .map(|mode| if mode[root] == first[root] { 1.0 } else { -1.0 });
        let values: Vec<f64> = values.collect();
        let index = constants.len();
        values.contains(&-1.0).then(|| {
            constants.push(Constant {
                number: None,
                values,
                name: format!("sign of a root in the closed form, relative to that of `{leg}`"),
            });
            InputElement {
                array: ARRAY,
                index,
            }
        })
    };
    (0..first.len()).map(sign).collect()
}

/// Name of the template, different from those of all legs.
fn name(legs: &[Leg]) -> String {
    let mut name = "leg".to_owned();
    while legs.iter().any(|leg| leg.name == name) {
        name.push_str("_i");
    }
    name
}

/// A leg's description without its name and these numbers.
fn shape(leg: &Leg) -> String {
    let mut leg = leg.clone();
    leg.name.clear();
    for number in numbers(&mut leg) {
        *number = Number::ZERO;
    }
    for angle in angles(&mut leg) {
        *angle = Angle::ZERO;
    }
    format!("{leg:?}")
}
