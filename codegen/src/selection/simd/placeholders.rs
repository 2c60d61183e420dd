//! Placeholders for the numbers and angles by which legs differ.
//!
//! A placeholder is close to the first leg's number, so that the working mode stays, and otherwise
//! unrelated to other numbers. Relations that hold in every leg are kept. Two numbers that are
//! equal or opposite in all legs share a placeholder. So do two angles whose sum or difference is
//! the same in all legs, such as the direction of an axis and the offset that compensates it.

use crate::cas::{Angle, Number, Ratio, Stream};

/// A number that differs between legs.
#[derive(Debug)]
pub(super) struct Constant {
    /// Its placeholder; `None` for a sign.
    pub(super) number: Option<Number>,
    /// Its value in each leg.
    pub(super) values: Vec<f64>,
    /// Its name.
    pub(super) name: String,
}

/// All placeholders.
#[derive(Debug)]
pub(super) struct Placeholders {
    /// All numbers that differ between legs.
    pub(super) constants: Vec<Constant>,
    stream: Stream,
    /// The numbers of the legs, with their placeholder.
    numbers: Vec<(Vec<Number>, Number)>,
    /// The angles of the legs, with their placeholder.
    angles: Vec<(Vec<Angle>, Angle)>,
}

impl Placeholders {
    pub(super) fn new() -> Self {
        Self {
            constants: Vec::new(),
            stream: Stream::new(11),
            numbers: Vec::new(),
            angles: Vec::new(),
        }
    }

    /// The placeholder of the legs' numbers; the number itself if all legs have the same.
    pub(super) fn number(&mut self, all: Vec<Number>, name: &str) -> Number {
        let first = all[0];
        if all.iter().all(|number| *number == first) {
            return first;
        }
        let is = |others: &[Number], sign: fn(Number) -> Number| {
            let mut both = all.iter().zip(others);
            both.all(|(own, other)| *own == sign(*other))
        };
        let known = self.numbers.iter().find_map(|(others, number)| {
            let same = is(others, |other| other).then_some(*number);
            same.or_else(|| is(others, |other| -other).then(|| -*number))
        });
        known.unwrap_or_else(|| {
            let near = 1e-3 * self.stream.number();
            let number = Number::float(first.value() * (1.0 + near) + near);
            let values = all.iter().map(|number| number.value()).collect();
            self.add(number, values, name.to_owned());
            self.numbers.push((all, number));
            number
        })
    }

    /// The placeholder of the legs' angles; the angle itself if all legs have the same.
    pub(super) fn angle(&mut self, all: Vec<Angle>, name: &str) -> Option<Angle> {
        let first = all[0];
        if all.iter().all(|angle| *angle == first) {
            return Some(first);
        }
        let of_others = |(others, angle): &(Vec<Angle>, Angle)| {
            let ahead = constant(&all, others, Angle::negative).and_then(|by| by.plus(*angle));
            let back = || constant(&all, others, |other| other)?.plus(angle.negative());
            ahead.or_else(back)
        };
        let known = self.angles.iter().find_map(of_others);
        let angle = match known {
            Some(angle) => angle,
            None => {
                // Whole nanoradians have exact sums in the field.
                let near = (1e6 * self.stream.number()) as i128;
                first.plus(Angle::radians(Ratio::new(near, 1_000_000_000)?))?
            }
        };
        let (cosine, sine) = angle.cosine_and_sine();
        let of_legs = all.iter().map(|angle| angle.cosine_and_sine());
        let (cosines, sines): (Vec<Number>, Vec<Number>) = of_legs.unzip();
        for (number, of_legs, what) in [(cosine, cosines, "cos"), (sine, sines, "sin")] {
            let values = of_legs.iter().map(|number| number.value()).collect();
            self.add(number, values, format!("{what}({name})"));
        }
        self.angles.push((all, angle));
        Some(angle)
    }

    /// Adds a placeholder, unless it or its negative exists.
    fn add(&mut self, number: Number, values: Vec<f64>, name: String) {
        let mut numbers = self.constants.iter().filter_map(|c| c.number);
        if !numbers
            .any(|other| other.image() == number.image() || (-other).image() == number.image())
        {
            let number = Some(number);
            self.constants.push(Constant {
                number,
                values,
                name,
            });
        }
    }
}

/// The angle by which the legs' angles differ from others, or from their negatives, if it is the same in all legs.
fn constant(all: &[Angle], others: &[Angle], less: fn(Angle) -> Angle) -> Option<Angle> {
    let mut both = all.iter().zip(others);
    let difference = |(own, other): (&Angle, &Angle)| own.plus(less(*other));
    let first = difference(both.next()?)?;
    both.all(|both| difference(both) == Some(first))
        .then_some(first)
}

#[cfg(test)]
mod tests {
    use super::Placeholders;
    use crate::cas::{Angle, Number, Ratio};

    fn degrees(all: [i128; 2]) -> Vec<Angle> {
        let ratio = |degrees: i128| Ratio::new(degrees, 1).expect("a ratio");
        let angle = |degrees: i128| Angle::degrees(ratio(degrees)).expect("degrees");
        all.map(angle).to_vec()
    }

    #[test]
    fn placeholders_keep_equal_and_opposite_values() {
        let mut placeholders = Placeholders::new();
        let numbers = |all: [i64; 2]| all.map(Number::integer).to_vec();
        let mut of = |all| placeholders.number(numbers(all), "d of `1`");
        let first = of([11, -30]);
        assert_ne!(first, Number::integer(11));
        assert_eq!(of([11, -30]), first);
        assert_eq!(of([-11, 30]), -first);
        assert_ne!(of([11, 30]), first);
        assert_eq!(of([2, 2]), Number::integer(2));
        assert_eq!(placeholders.constants.len(), 2);
    }

    #[test]
    fn placeholders_keep_sums_and_differences_of_angles() {
        let mut placeholders = Placeholders::new();
        let mut of = |all| {
            placeholders
                .angle(degrees(all), "gamma of `1`")
                .expect("an angle")
        };
        let first = of([15, 164]);
        let sum = |a: Angle, b: Angle| a.plus(b).expect("a sum");
        assert!(sum(first, of([-15, -164])).is_zero());
        assert_eq!(sum(of([45, 194]), first.negative()), degrees([30, 30])[0]);
        assert_eq!(sum(of([75, -74]), first), degrees([90, 90])[0]);
        assert_eq!(of([7, 7]), degrees([7, 7])[0]);
        assert_eq!(placeholders.constants[1].name, "sin(gamma of `1`)");
        // Cosine and sine of the first angle, and of 30° more; those of its negative and of 90°
        // minus it are known.
        let numbers = placeholders.constants.iter().filter_map(|c| c.number);
        assert_eq!(numbers.count(), 4);
    }
}
