//! Position-dependent torques of joints: springs, linear in one unknown coefficient, and known
//! torques.
//!
//! The key `spring` of a joint is an expression of its variable `q`: the joint's torque per unit of
//! the coefficient. For a linear spring it is `q` minus its rest position; levers, cables and other
//! springs have their own. The key `known` is the torque itself. Expressions of `q` are stored as
//! formulas with exact constants.

use crate::diagnostic::Code;
use crate::expressions::dimension::Dimension;
use crate::expressions::expression::Quantity;
use crate::expressions::formula::{Formula, Spring};
use crate::expressions::function::{self, is_trigonometric};
use crate::expressions::value::{Fault, Value};
use crate::robot::model::JointKind;
use crate::toml_text::reader::Item;
use crate::toml_text::scope::Scope;
use overact_exact::{Number, Ratio};

/// Reads the key `spring` of a joint; the scope contains `q` as the joint's variable.
pub(crate) fn read(item: &Item<'_, '_>, kind: JointKind, scope: &Scope) -> Option<Spring> {
    let effort = effort(item, kind, "a fixed joint has no spring")?;
    let constant = "a torque that does not depend on the position is not a spring";
    let help = "write it with the joint variable, for instance spring = \"q - 20 deg\"; a constant \
                torque is the parameter `off`";
    with_coefficient(item, scope, effort, constant, help)
}

/// Reads the key `friction_load` of a joint.
pub(crate) fn load(item: &Item<'_, '_>, kind: JointKind, scope: &Scope) -> Option<Spring> {
    let effort = effort(item, kind, "a fixed joint has no friction")?;
    let constant = "friction under a load that does not depend on the position is Coulomb friction";
    let help = "leave `friction_load` out, its parameter is `fs`; or write the load with the joint \
                variable, for instance friction_load = \"40 N m * cos(q)\"";
    with_coefficient(item, scope, effort, constant, help)
}

/// Variable of the rate of a spring's length; others are positions.
pub(crate) const RATE: usize = usize::MAX;

/// Reads the key `force` of a spring between two points; the scope has its length and rate.
///
/// It may be constant, as that of a long gas spring.
pub(crate) fn force(item: &Item<'_, '_>, scope: &Scope) -> Option<Spring> {
    let found = of_length(item, scope)?;
    per_unit(item, found, Dimension::FORCE)
}

/// Reads the key `known` of a spring between two points, N.
pub(crate) fn known_force(item: &Item<'_, '_>, scope: &Scope) -> Option<Formula> {
    let found = of_length(item, scope)?;
    given(item, found, Dimension::FORCE, "l")
}

/// A formula of a length, which no sine contains.
fn of_length(item: &Item<'_, '_>, scope: &Scope) -> Option<Positional> {
    let found: Positional = item.evaluate_as(scope)?;
    if matches!(&found, Positional::Formula(formula, _) if formula.has_angle()) {
        let message = "sines of a length are not supported";
        let help = "write the force with powers, roots and quotients of `l` and `dl`";
        item.context
            .report_once(item.error(Code::SPRING, message).help(help));
        return None;
    }
    Some(found)
}

/// A formula of an effort per unit of a coefficient.
///
/// A constant formula is an error with the message `constant` and `help`.
fn with_coefficient(
    item: &Item<'_, '_>,
    scope: &Scope,
    effort: Dimension,
    constant: &str,
    help: &str,
) -> Option<Spring> {
    let found: Positional = item.evaluate_as(scope)?;
    if matches!(&found, Positional::Exact(value) if value.terms.is_empty()) {
        item.context
            .report_once(item.error(Code::SPRING, constant).help(help));
        return None;
    }
    per_unit(item, found, effort)
}

/// A formula with the unit of its coefficient.
fn per_unit(item: &Item<'_, '_>, found: Positional, effort: Dimension) -> Option<Spring> {
    let inverse = found.dimension().power(-1);
    let Some(dimension) = inverse.and_then(|inverse| effort.times(inverse)) else {
        item.context
            .report_once(item.error(Code::OUT_OF_RANGE, TOO_LARGE));
        return None;
    };
    Some(Spring {
        unit: match dimension.unit() {
            none if none.is_empty() => "1".to_owned(),
            unit => unit,
        },
        formula: found.formula(),
        dimension,
    })
}

/// Reads the key `known` of a joint, a torque or force that may depend on `q`.
pub(crate) fn known(item: &Item<'_, '_>, kind: JointKind, scope: &Scope) -> Option<Formula> {
    let effort = effort(item, kind, "no torque acts on a fixed joint")?;
    let found: Positional = item.evaluate_as(scope)?;
    given(item, found, effort, "cos(q)")
}

/// A formula of a known effort; `example` is an expression of the variable.
fn given(
    item: &Item<'_, '_>,
    found: Positional,
    effort: Dimension,
    example: &str,
) -> Option<Formula> {
    if !found.dimension().fits(effort) {
        let (name, unit) = (effort.name(), effort.unit());
        let message = format!(
            "expected {name} ({unit}), found {}",
            found.dimension().name()
        );
        let unit = match example {
            "l" => "N/m",
            _ => unit.as_str(),
        };
        let help = format!("give its factors their units, for instance \"2 {unit} * {example}\"");
        item.context
            .report_once(item.error(Code::UNIT, message).help(help));
        return None;
    }
    Some(found.formula())
}

/// Dimension of forces on a joint; `None` for a fixed one, which is reported.
fn effort(item: &Item<'_, '_>, kind: JointKind, fixed: &str) -> Option<Dimension> {
    match kind {
        JointKind::Revolute => Some(Dimension::TORQUE),
        JointKind::Prismatic => Some(Dimension::FORCE),
        JointKind::Fixed => {
            let error = item.error(Code::SPRING, fixed);
            item.context
                .report_once(error.help("give it to a joint that moves"));
            None
        }
    }
}

/// A value with any dependence on a joint's position.
#[derive(Debug, Clone)]
pub(crate) enum Positional {
    /// Linear in the position.
    Exact(Value),
    /// Not linear.
    Formula(Formula, Dimension),
}

const TOO_LARGE: &str = "the value is too large";

/// Largest number of operations of a formula.
const LONGEST: usize = 1000;

impl Positional {
    fn dimension(&self) -> Dimension {
        match self {
            Self::Exact(value) => value.dimension,
            Self::Formula(_, dimension) => *dimension,
        }
    }

    fn is_constant(&self) -> bool {
        matches!(self, Self::Exact(value) if value.terms.is_empty())
    }

    fn formula(self) -> Formula {
        match self {
            Self::Exact(value) => linear(&value),
            Self::Formula(formula, _) => formula,
        }
    }

    fn quotient(self, divisor: Self) -> Result<Self, Fault> {
        let inverse = divisor.dimension().power(-1);
        let dimension = inverse.and_then(|inverse| self.dimension().times(inverse));
        let dimension = dimension.ok_or_else(|| Fault::new(TOO_LARGE))?;
        let [above, below] = parts(self, divisor)?;
        Ok(Self::Formula(Formula::Quotient(above, below), dimension))
    }
}

/// The formula of a value that is linear in a position and a rate.
fn linear(value: &Value) -> Formula {
    let of = |is_rate: bool| {
        let mut terms = value.terms.iter();
        terms.find(|(variable, _)| (*variable == RATE) == is_rate)
    };
    let position = Formula::Linear {
        offset: value.scalar.to_number(),
        factor: of(false).map_or(Ratio::ZERO, |(_, factor)| *factor),
    };
    match of(true) {
        Some((_, factor)) => {
            let rate = Formula::Rate { factor: *factor };
            Formula::Sum(Box::new(position), Box::new(rate))
        }
        None => position,
    }
}

/// Two operands of a formula, unless they are too long together.
fn parts(one: Positional, two: Positional) -> Result<[Box<Formula>; 2], Fault> {
    let parts = [one, two].map(Positional::formula);
    if parts.iter().map(Formula::size).sum::<usize>() < LONGEST {
        return Ok(parts.map(Box::new));
    }
    let fault = Fault::new(format!("the formula has more than {LONGEST} operations"));
    Err(fault.help("write powers and sums in a shorter form"))
}

impl Quantity for Positional {
    fn constant_part(&self) -> Option<f64> {
        match self {
            Self::Exact(value) => value.constant_part(),
            Self::Formula(..) => None,
        }
    }

    fn from_value(value: Value) -> Self {
        Self::Exact(value)
    }

    fn plus(self, other: Self) -> Result<Self, Fault> {
        let (one, two) = match (self, other) {
            (Self::Exact(a), Self::Exact(b)) => return Ok(Self::Exact(a.plus(b)?)),
            both => both,
        };
        let [a, b] = [one.dimension(), two.dimension()];
        let dimension = if b.fits(a) {
            a
        } else if a.fits(b) {
            b
        } else {
            let message = format!("{} and {} cannot be added", a.name(), b.name());
            return Err(Fault::new(message));
        };
        let [one, two] = parts(one, two)?;
        Ok(Self::Formula(Formula::Sum(one, two), dimension))
    }

    fn negative(self) -> Self {
        match self {
            Self::Exact(value) => Self::Exact(value.negative()),
            Self::Formula(formula, dimension) => {
                let minus = Formula::constant(-Number::ONE);
                let product = Formula::Product(Box::new(minus), Box::new(formula));
                Self::Formula(product, dimension)
            }
        }
    }

    fn times(self, other: Self) -> Result<Self, Fault> {
        if let (Self::Exact(a), Self::Exact(b)) = (&self, &other)
            && (a.terms.is_empty() || b.terms.is_empty())
        {
            // An irrational factor, such as a root, makes a position a formula.
            if let Ok(product) = a.clone().times(b.clone()) {
                return Ok(Self::Exact(product));
            }
        }
        let dimension = self.dimension().times(other.dimension());
        let dimension = dimension.ok_or_else(|| Fault::new(TOO_LARGE))?;
        let [one, two] = parts(self, other)?;
        Ok(Self::Formula(Formula::Product(one, two), dimension))
    }

    fn reciprocal(self) -> Result<Self, Fault> {
        match self {
            Self::Exact(value) if value.terms.is_empty() => Ok(Self::Exact(value.reciprocal()?)),
            other => Self::Exact(Value::plain(Number::ONE)).quotient(other),
        }
    }

    fn power(self, exponent: &Self) -> Result<Self, Fault> {
        let exponent = match exponent {
            Self::Exact(value) if value.terms.is_empty() => value,
            _ => {
                let fault = Fault::new("an exponent cannot hold a joint variable");
                return Err(fault.help("powers have integer exponents, for instance q^2"));
            }
        };
        if let (Self::Exact(value), true) = (&self, self.is_constant()) {
            return Ok(Self::Exact(value.clone().power(exponent)?));
        }
        let count = exponent.small_integer()?;
        let base = if count < 0 { self.reciprocal()? } else { self };
        let one = Self::Exact(Value::plain(Number::ONE));
        let mut product = if count == 0 { one } else { base.clone() };
        for _ in 1..count.unsigned_abs() {
            product = product.times(base.clone())?;
        }
        Ok(product)
    }

    fn apply(name: &str, mut arguments: Vec<Self>) -> Result<Self, Fault> {
        if arguments.iter().all(Self::is_constant) {
            let exact = |argument| match argument {
                Self::Exact(value) => Some(value),
                Self::Formula(..) => None,
            };
            let values = arguments.into_iter().filter_map(exact).collect();
            return Ok(Self::Exact(function::apply(name, values)?));
        }
        let argument = arguments.swap_remove(0);
        match (name, argument) {
            ("sqrt", argument) => {
                let dimension = argument.dimension();
                let root = dimension.root().ok_or_else(|| {
                    Fault::new(format!("{} has no square root", dimension.describe()))
                })?;
                let formula = Formula::SquareRoot(Box::new(argument.formula()));
                Ok(Self::Formula(formula, root))
            }
            (name, Self::Exact(angle)) if is_trigonometric(name) => turned(name, &angle),
            (name, _) if is_trigonometric(name) => {
                let message =
                    format!("`{name}` takes an angle that is linear in the joint variable");
                let help = "for instance cos(q - 20 deg)";
                Err(Fault::new(message).help(help))
            }
            (name, _) => Err(Fault::new(format!(
                "the argument of `{name}` cannot hold a joint variable"
            ))),
        }
    }
}

/// Sine, cosine or tangent of an angle that is linear in the joint's position.
fn turned(name: &str, angle: &Value) -> Result<Positional, Fault> {
    if !angle.dimension.fits(Dimension::ANGLE) {
        let found = angle.dimension.name();
        return Err(Fault::new(format!(
            "`{name}` takes an angle (rad), found {found}"
        )));
    }
    let offset = angle.scalar.to_angle();
    let offset = offset.ok_or_else(|| Fault::new("the angle is too large"))?;
    let factor = angle
        .terms
        .first()
        .map_or(Ratio::ZERO, |(_, factor)| *factor);
    let (sine, cosine) = (
        Formula::Sine { offset, factor },
        Formula::Cosine { offset, factor },
    );
    let formula = match name {
        "sin" => sine,
        "cos" => cosine,
        _ => Formula::Quotient(Box::new(sine), Box::new(cosine)),
    };
    Ok(Positional::Formula(formula, Dimension::NONE))
}
