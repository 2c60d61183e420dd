//! A leg that stands for all legs of its kind: the numbers in which they differ are elements of an array.

use super::fields::{angles, numbers};
use crate::cas::{Angle, Arena, Number, Ratio, Stream};
use crate::mechanism::{Leg, Mechanism};

/// The name of the array.
pub(super) const ARRAY: &str = "of_leg";

/// A robot whose first leg stands for all.
#[derive(Debug)]
pub(super) struct Template {
    /// The robot; where the legs differ, the first one has numbers of no meaning.
    pub(super) mechanism: Mechanism,
    /// The numbers in which they differ.
    constants: Vec<Constant>,
}

/// A number in which legs differ.
#[derive(Debug)]
struct Constant {
    /// What stands for it.
    number: Number,
    /// What it is in each leg.
    values: Vec<f64>,
}

impl Template {
    /// The template of a robot whose legs are all alike but for numbers.
    pub(super) fn of(mechanism: &Mechanism) -> Option<Self> {
        let [first, others @ ..] = &mechanism.legs[..] else {
            return None;
        };
        if others.is_empty() || !others.iter().all(|leg| shape(leg) == shape(first)) {
            return None;
        }
        let mut constants = Vec::new();
        let mut stream = Stream::new(11);
        let mut legs = mechanism.legs.clone();
        let mut of_legs: Vec<_> = legs.iter_mut().map(numbers).collect();
        for at in 0..of_legs[0].len() {
            let all: Vec<Number> = of_legs.iter().map(|of_leg| *of_leg[at]).collect();
            if let Some(number) = standing_number(&all, &mut stream) {
                let values = all.iter().map(|number| number.value()).collect();
                constants.push(Constant { number, values });
                *of_legs[0][at] = number;
            }
        }
        let mut of_legs: Vec<_> = legs.iter_mut().map(angles).collect();
        for at in 0..of_legs[0].len() {
            let all: Vec<Angle> = of_legs.iter().map(|of_leg| *of_leg[at]).collect();
            if let Some(angle) = standing_angle(&all, &mut stream) {
                let all: Vec<_> = all.iter().map(|angle| angle.cosine_and_sine()).collect();
                let (cosine, sine) = angle.cosine_and_sine();
                constants.push(Constant {
                    number: cosine,
                    values: all.iter().map(|(cosine, _)| cosine.value()).collect(),
                });
                constants.push(Constant {
                    number: sine,
                    values: all.iter().map(|(_, sine)| sine.value()).collect(),
                });
                *of_legs[0][at] = angle;
            }
        }
        legs[0].name = name(&mechanism.legs);
        let mechanism = Mechanism {
            legs,
            ..mechanism.clone()
        };
        Some(Self {
            mechanism,
            constants,
        })
    }

    /// How many numbers differ.
    pub(super) fn len(&self) -> usize {
        self.constants.len()
    }

    /// Lets elements of the array stand for the numbers wherever they come up in a graph.
    pub(super) fn stand_in(&self, arena: &Arena) {
        for (index, constant) in self.constants.iter().enumerate() {
            arena.stand_for(constant.number, ARRAY, index);
        }
    }

    /// The numbers of a leg.
    pub(super) fn values(&self, leg: usize) -> Vec<f64> {
        self.constants.iter().map(|c| c.values[leg]).collect()
    }
}

/// What the leg that stands for all is called: as no leg is.
fn name(legs: &[Leg]) -> String {
    let mut name = "leg".to_owned();
    while legs.iter().any(|leg| leg.name == name) {
        name.push_str("_i");
    }
    name
}

/// What a leg is but for its name and these numbers.
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

/// What stands for numbers that differ: one close to the first leg's, so that its working mode stays, and with no
/// relation to any other.
fn standing_number(all: &[Number], stream: &mut Stream) -> Option<Number> {
    let first = all[0];
    if all.iter().all(|number| *number == first) {
        return None;
    }
    let near = 1e-3 * stream.number();
    Some(Number::float(first.value() * (1.0 + near) + near))
}

/// What stands for angles that differ.
fn standing_angle(all: &[Angle], stream: &mut Stream) -> Option<Angle> {
    let first = all[0];
    if all.iter().all(|angle| *angle == first) {
        return None;
    }
    let near = (1e9 * stream.number()) as i128;
    first.plus(Angle::radians(Ratio::new(near, 1_000_000_000_000)?))
}
