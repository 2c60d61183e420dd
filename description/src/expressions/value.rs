//! Exact values of expressions: a scalar, its dimension and, for joints, a linear combination of
//! joint variables.

use crate::expressions::dimension::Dimension;
use crate::expressions::scalar::Scalar;
use overact_exact::{Number, Ratio};

/// Reason why an operation has no result, and a remedy.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Fault {
    pub(crate) message: String,
    pub(crate) help: Option<String>,
}

impl Fault {
    pub(crate) fn new(message: impl Into<String>) -> Self {
        Self {
            message: message.into(),
            help: None,
        }
    }

    pub(crate) fn help(self, help: impl Into<String>) -> Self {
        Self {
            help: Some(help.into()),
            ..self
        }
    }

    pub(crate) fn maybe_help(self, help: Option<String>) -> Self {
        Self { help, ..self }
    }
}

const TOO_LARGE: &str = "the value is too large";

/// Largest magnitude of a value, SI: products of a few lengths, masses and accelerations stay
/// finite.
const LARGEST: f64 = 1e30;

/// Smallest magnitude of a nonzero value, SI: reciprocals stay finite, too.
const SMALLEST: f64 = 1e-50;

/// The value of an expression.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Value {
    /// The constant part.
    pub(crate) scalar: Scalar,
    /// Dimension of the whole.
    pub(crate) dimension: Dimension,
    /// Joint variables with their nonzero factors, sorted by joint.
    pub(crate) terms: Vec<(usize, Ratio)>,
}

impl Value {
    pub(crate) fn constant(scalar: Scalar, dimension: Dimension) -> Self {
        Self {
            scalar,
            dimension,
            terms: Vec::new(),
        }
    }

    pub(crate) fn plain(number: Number) -> Self {
        Self::constant(Scalar::Number(number), Dimension::NONE)
    }

    /// The variable of a joint.
    pub(crate) fn variable(joint: usize, dimension: Dimension) -> Self {
        let scalar = Scalar::Number(Number::ZERO);
        Self {
            scalar,
            dimension,
            terms: vec![(joint, Ratio::ONE)],
        }
    }

    /// The value, if all of its numbers are in range.
    pub(crate) fn checked(self) -> Result<Self, Fault> {
        // The most negative integer has no negative, so it counts as too large.
        let in_range = |r: Ratio| r.numerator() != i128::MIN;
        let exact = match self.scalar {
            Scalar::Number(number) => number.as_ratio().is_none_or(in_range),
            Scalar::Angle(angle) => in_range(angle.parts().0) && in_range(angle.parts().1),
        };
        let terms = self.terms.iter().all(|(_, factor)| in_range(*factor));
        let finite = self.scalar.value().is_finite();
        if exact && terms && finite {
            Ok(self)
        } else {
            Err(Fault::new(TOO_LARGE))
        }
    }

    /// The value, if its magnitude is possible for a robot.
    pub(crate) fn of_a_robot(self) -> Result<Self, Fault> {
        let size = self.scalar.value().abs();
        let fault = |what: &str| {
            let help = format!("in SI units numbers go from {SMALLEST:e} to {LARGEST:e}");
            Err(Fault::new(what).help(help))
        };
        match size {
            0.0 | SMALLEST..=LARGEST => self.checked(),
            size if size < SMALLEST => fault("the value is too small"),
            _ => fault(TOO_LARGE),
        }
    }

    pub(crate) fn plus(self, other: Self) -> Result<Self, Fault> {
        let dimension = if other.dimension.fits(self.dimension) {
            self.dimension
        } else if self.dimension.fits(other.dimension) {
            other.dimension
        } else {
            let (a, b) = (self.dimension.name(), other.dimension.name());
            return Err(Fault::new(format!("{a} and {b} cannot be added")));
        };
        let mut terms = self.terms;
        for (joint, factor) in other.terms {
            match terms.iter_mut().find(|(j, _)| *j == joint) {
                Some((_, sum)) => *sum = sum.plus(factor).ok_or_else(|| Fault::new(TOO_LARGE))?,
                None => terms.push((joint, factor)),
            }
        }
        terms.retain(|(_, factor)| !factor.is_zero());
        terms.sort_unstable_by_key(|(joint, _)| *joint);
        Self {
            scalar: self.scalar.plus(other.scalar),
            dimension,
            terms,
        }
        .checked()
    }

    pub(crate) fn negative(self) -> Self {
        let terms = self
            .terms
            .into_iter()
            .map(|(j, f)| (j, f.negative()))
            .collect();
        Self {
            scalar: self.scalar.negative(),
            dimension: self.dimension,
            terms,
        }
    }

    pub(crate) fn times(self, other: Self) -> Result<Self, Fault> {
        let dimension = self.dimension.times(other.dimension);
        let dimension = dimension.ok_or_else(|| Fault::new(TOO_LARGE))?;
        let (linear, factor) = if self.terms.is_empty() {
            (other, self)
        } else {
            (self, other)
        };
        let mut terms = Vec::new();
        if !linear.terms.is_empty() {
            terms = scaled(&linear.terms, &factor)?;
        }
        Self {
            scalar: linear.scalar.times(factor.scalar),
            dimension,
            terms,
        }
        .checked()
    }

    pub(crate) fn reciprocal(self) -> Result<Self, Fault> {
        self.no_variables("a divisor")?;
        if self.scalar.is_zero() {
            return Err(Fault::new("division by zero"));
        }
        let dimension = self
            .dimension
            .power(-1)
            .ok_or_else(|| Fault::new(TOO_LARGE))?;
        let scalar = match self.scalar.as_ratio().and_then(Ratio::reciprocal) {
            Some(ratio) => Scalar::Number(Number::ratio(ratio)),
            None => self.scalar.reciprocal(),
        };
        Self::constant(scalar, dimension).checked()
    }

    /// A power with an integer exponent.
    pub(crate) fn power(self, exponent: &Self) -> Result<Self, Fault> {
        let small = exponent.small_integer()?;
        if small == 0 {
            self.no_variables("a power")?;
            return Ok(Self::plain(Number::ONE));
        }
        let base = if small < 0 { self.reciprocal()? } else { self };
        let mut product = base.clone();
        for _ in 1..small.unsigned_abs() {
            product = product.times(base.clone())?;
        }
        Ok(product)
    }

    /// The value as an exponent.
    pub(crate) fn small_integer(&self) -> Result<i8, Fault> {
        self.no_variables("an exponent")?;
        let integer = self.scalar.as_ratio().filter(|r| r.denominator() == 1);
        let small = integer
            .and_then(|r| i8::try_from(r.numerator()).ok())
            .filter(|e| e.abs() <= 64);
        match small.filter(|_| self.dimension == Dimension::NONE) {
            Some(small) => Ok(small),
            None => {
                let fault = Fault::new("the exponent must be an integer between -64 and 64");
                Err(fault.help("write sqrt(x) for a root"))
            }
        }
    }

    pub(crate) fn square_root(self) -> Result<Self, Fault> {
        self.no_variables("a square root")?;
        let dimension = self.dimension.root().ok_or_else(|| {
            Fault::new(format!("{} has no square root", self.dimension.describe()))
        })?;
        let root = self.scalar.to_number().square_root();
        let root = root.ok_or_else(|| Fault::new("square root of a negative number"))?;
        Self::constant(Scalar::Number(root), dimension).checked()
    }

    /// Returns an error if the value contains joint variables.
    pub(crate) fn no_variables(&self, place: &str) -> Result<(), Fault> {
        if self.terms.is_empty() {
            return Ok(());
        }
        let fault = Fault::new(format!("{place} cannot hold a joint variable"));
        Err(fault
            .help("a joint position is a sum of joint variables times fractions, and a constant"))
    }

    /// "15.52 deg", "0.41 m".
    pub(crate) fn describe(&self) -> String {
        if !self.terms.is_empty() {
            return "a joint variable".to_owned();
        }
        let (value, unit) = match (self.scalar, self.dimension) {
            (Scalar::Angle(angle), Dimension::ANGLE) => {
                (angle.value().to_degrees(), "deg".to_owned())
            }
            (scalar, dimension) => (scalar.value(), dimension.unit()),
        };
        // Twelve digits hide the rounding of the conversion.
        let short = format!("{value:.11e}").parse::<f64>().unwrap_or(value);
        let usual = short == 0.0 || (1e-6..1e9).contains(&short.abs());
        let number = if usual {
            format!("{short}")
        } else {
            format!("{short:e}")
        };
        format!("{number} {unit}").trim_end().to_owned()
    }
}

/// Joint variables times a constant, which has to be a fraction.
fn scaled(terms: &[(usize, Ratio)], factor: &Value) -> Result<Vec<(usize, Ratio)>, Fault> {
    factor.no_variables("the factor of a joint variable")?;
    let Some(ratio) = factor.scalar.as_ratio() else {
        let fault = Fault::new("the factor of a joint variable must be a fraction");
        return Err(fault.help("roots and multiples of pi are not fractions; write the number, for instance `314.1593 rad/m`"));
    };
    let product = |(joint, f): &(usize, Ratio)| Some((*joint, f.times(ratio)?));
    let products: Option<Vec<_>> = terms.iter().map(product).collect();
    let mut products = products.ok_or_else(|| Fault::new(TOO_LARGE))?;
    products.retain(|(_, f)| !f.is_zero());
    Ok(products)
}
