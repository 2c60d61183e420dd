//! Recovers expressions of description constants from numbers: `L_AB`, `R_P_SQUARED_PER_L_BC`.
//!
//! Constant folding turns the numbers of a description into others. A number that is a simple
//! expression of named constants, a power, product or quotient of two, gets a name and the
//! expression. If several equally simple expressions have the same value, none is used, since the
//! intended one is unknown. A number also stays without a name if an unnamed number of the text
//! explains it as simply: 50 may be 1/(20 mm) of a named pitch, or the `50 rad/m` of a gear. Numbers
//! of one or two digits may equal a long expression by chance.

use crate::model::RobotModel;

/// A number with a name.
#[derive(Debug, Clone, PartialEq)]
pub struct Dimension {
    /// The name of the Rust constant.
    pub name: String,
    /// Its expression in the description's names.
    pub expression: String,
    value: f64,
    /// Complexity of the expression: the simplest one of a value is used.
    size: usize,
    /// Whether the expression is one of named constants.
    has_name: bool,
}

/// All numbers that have names.
#[derive(Debug, Clone, Default)]
pub struct Dimensions(Vec<Dimension>);

/// Complexity from which expressions match numbers of few digits by chance.
const LONG: usize = 4;

/// Relative difference, of some roundings, below which two numbers are equal.
const ROUNDING: f64 = 1e-15;

impl Dimensions {
    /// The named numbers of a robot's description.
    #[must_use]
    pub fn of(model: &RobotModel) -> Self {
        let constants = &model.mechanism.constants;
        let values: Vec<(&str, f64)> = constants
            .iter()
            .map(|(name, value)| (name.as_str(), value.abs()))
            .collect();
        Self::expressions_of(&values, &model.mechanism.magnitudes)
    }

    /// All expressions of named values, and the powers of numbers without a name.
    fn expressions_of(values: &[(&str, f64)], magnitudes: &[f64]) -> Self {
        let mut bases: Vec<Base> = Vec::new();
        for &(name, value) in values {
            if !value.is_normal() || is_plain_number(value) {
                continue;
            }
            match bases.iter_mut().find(|base| is_same(base.value, value)) {
                Some(base) => base.others.push(name.to_owned()),
                None => bases.push(Base {
                    name: name.to_owned(),
                    others: Vec::new(),
                    value,
                }),
            }
        }
        let mut all = Vec::new();
        for (at, base) in bases.iter().enumerate() {
            all.extend(base.powers());
            for (other_at, other) in bases.iter().enumerate() {
                all.extend(base.quotients(other).into_iter().filter(|_| at != other_at));
                all.extend((at < other_at).then(|| base.times(other)));
            }
        }
        let unnamed = magnitudes.iter().filter(|value| value.is_normal());
        let unnamed = unnamed.filter(|&&value| !is_plain_number(value));
        all.extend(unnamed.flat_map(|&value| powers_without_name(value)));
        all.retain(|dimension| !is_plain_number(dimension.value) && !is_by_chance(dimension));
        all.sort_by_key(|dimension| dimension.size);
        Self(all)
    }

    /// The name of a positive number, if one expression is simpler than all others and is one of
    /// named constants.
    #[must_use]
    pub fn find(&self, value: f64) -> Option<&Dimension> {
        let mut fitting = self.0.iter().filter(|d| is_same(d.value, value));
        let first = fitting.next()?;
        let is_only = fitting.next().is_none_or(|second| second.size > first.size);
        (is_only && first.has_name).then_some(first)
    }
}

/// Whether a number needs no name: a factor of two is no ratio of lengths, even if one has this
/// value.
fn is_plain_number(value: f64) -> bool {
    [0.5, 1.0, 2.0].into_iter().any(|own| is_same(own, value))
}

/// Whether a long expression has a value of one or two digits, such as 2.5, that others share.
fn is_by_chance(dimension: &Dimension) -> bool {
    let value = dimension.value;
    let tens = 10.0_f64.powf(1.0 - value.log10().floor());
    dimension.size >= LONG && is_same(value * tens, (value * tens).round())
}

fn is_same(a: f64, b: f64) -> bool {
    (a - b).abs() <= ROUNDING * a.abs()
}

/// The powers of a number without a name.
fn powers_without_name(value: f64) -> impl Iterator<Item = Dimension> {
    let base = Base {
        name: String::new(),
        others: Vec::new(),
        value,
    };
    let unnamed = |dimension| Dimension {
        has_name: false,
        ..dimension
    };
    base.powers().into_iter().map(unnamed)
}

/// A named constant, and others of the same value.
struct Base {
    name: String,
    others: Vec<String>,
    value: f64,
}

impl Base {
    fn dimension(&self, name: &str, expression: &str, value: f64, size: usize) -> Dimension {
        Dimension {
            name: name.to_uppercase(),
            expression: expression.to_owned(),
            value,
            size,
            has_name: true,
        }
    }

    /// v, v², 1/v and similar powers.
    fn powers(&self) -> Vec<Dimension> {
        let (n, v) = (&self.name, self.value);
        let own = if self.others.is_empty() {
            n.clone()
        } else {
            format!("{n} = {}", self.others.join(" = "))
        };
        vec![
            self.dimension(n, &own, v, 1),
            self.dimension(&format!("{n}_squared"), &format!("{n}²"), v * v, 2),
            self.dimension(&format!("inv_{n}"), &format!("1 / {n}"), 1.0 / v, 2),
            self.dimension(&format!("half_{n}"), &format!("{n} / 2"), v / 2.0, 2),
            self.dimension(&format!("twice_{n}"), &format!("2 {n}"), 2.0 * v, 2),
            self.dimension(
                &format!("inv_twice_{n}"),
                &format!("1 / (2 {n})"),
                0.5 / v,
                3,
            ),
            self.dimension(
                &format!("twice_{n}_squared"),
                &format!("2 {n}²"),
                2.0 * v * v,
                3,
            ),
            self.dimension(
                &format!("inv_{n}_squared"),
                &format!("1 / {n}²"),
                1.0 / (v * v),
                3,
            ),
        ]
    }

    /// v/w and similar quotients.
    fn quotients(&self, other: &Self) -> Vec<Dimension> {
        let (n, v, m, w) = (&self.name, self.value, &other.name, other.value);
        vec![
            self.dimension(&format!("{n}_per_{m}"), &format!("{n} / {m}"), v / w, 3),
            self.dimension(
                &format!("{n}_squared_per_{m}"),
                &format!("{n}² / {m}"),
                v * v / w,
                4,
            ),
            self.dimension(
                &format!("{n}_per_{m}_squared"),
                &format!("{n} / {m}²"),
                v / (w * w),
                4,
            ),
        ]
    }

    /// The product v w.
    fn times(&self, other: &Self) -> Dimension {
        let (n, m) = (&self.name, &other.name);
        self.dimension(
            &format!("{n}_{m}"),
            &format!("{n} {m}"),
            self.value * other.value,
            3,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::Dimensions;

    fn name(values: &[(&str, f64)], value: f64) -> Option<String> {
        let dimensions = Dimensions::expressions_of(values, &[]);
        dimensions
            .find(value)
            .map(|d| format!("{}: {}", d.name, d.expression))
    }

    #[test]
    fn dualv_lengths_and_their_products_are_named() {
        let values = [("l_ab", 0.28), ("l_bc", 0.28), ("r_p", 0.11)];
        let found = |value: f64| name(&values, value);
        assert_eq!(found(0.11).as_deref(), Some("R_P: r_p"));
        assert_eq!(found(0.28).as_deref(), Some("L_AB: l_ab = l_bc"));
        assert_eq!(found(0.0784).as_deref(), Some("L_AB_SQUARED: l_ab²"));
        assert_eq!(found(1.0 / 0.28).as_deref(), Some("INV_L_AB: 1 / l_ab"));
        assert_eq!(
            found(0.11 * 0.11 / 0.28).as_deref(),
            Some("R_P_SQUARED_PER_L_AB: r_p² / l_ab")
        );
        assert_eq!(found(0.123), None);
    }

    #[test]
    fn ambiguous_values_have_no_name() {
        let values = [("a", 0.3), ("b", 0.6)];
        assert_eq!(name(&values, 0.3).as_deref(), Some("A: a"));
        // 1.2 is twice b; 0.18 is a b and 2 a².
        assert_eq!(name(&values, 1.2).as_deref(), Some("TWICE_B: 2 b"));
        assert_eq!(name(&values, 0.18), None);
        // 2.5 is r / l², but more likely 1 / (2 l) or a number.
        let values = [("l", 0.2), ("r", 0.1)];
        assert_eq!(
            name(&values, 2.5).as_deref(),
            Some("INV_TWICE_L: 1 / (2 l)")
        );
        assert_eq!(
            name(&[("l", 0.4), ("r", 0.6)], 3.75),
            Some("R_PER_L_SQUARED: r / l²".to_owned())
        );
        assert_eq!(name(&[("l", 0.5), ("r", 0.6)], 2.4), None);
    }

    #[test]
    fn unnamed_numbers_of_the_description_stay_unnamed() {
        let named = |value: f64| {
            let dimensions = Dimensions::expressions_of(&[("pitch", 0.02)], &[50.0, 0.3]);
            dimensions.find(value).map(|d| d.name.clone())
        };
        // 50 rad/m of the text, not the reciprocal of the pitch.
        assert_eq!(named(50.0), None);
        assert_eq!(named(0.3), None);
        assert_eq!(named(100.0), None);
        // 0.02 may be 1/50, but the pitch itself is the simpler expression.
        assert_eq!(named(0.02).as_deref(), Some("PITCH"));
    }

    #[test]
    fn trivial_factors_stay_unnamed() {
        assert_eq!(name(&[("zero", 0.0), ("one", 1.0)], 1.0), None);
        assert_eq!(name(&[("r_b", 0.2), ("r_p", 0.1)], 2.0), None);
    }
}
