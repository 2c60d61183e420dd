//! The functions of expressions.

use crate::expressions::dimension::Dimension;
use crate::expressions::scalar::Scalar;
use crate::expressions::value::{Fault, Value};
use overact_exact::{Angle, Number, Ratio};

/// Names of the functions.
pub(crate) const FUNCTIONS: [&str; 5] = ["sqrt", "sin", "cos", "tan", "atan2"];

/// Number of arguments of a function.
pub(crate) fn arity(name: &str) -> Option<usize> {
    let arguments = if name == "atan2" { 2 } else { 1 };
    FUNCTIONS.contains(&name).then_some(arguments)
}

/// Whether a function takes an angle.
pub(crate) fn is_trigonometric(name: &str) -> bool {
    ["sin", "cos", "tan"].contains(&name)
}

/// Value of a function; the number of arguments is already checked.
pub(crate) fn apply(name: &str, arguments: Vec<Value>) -> Result<Value, Fault> {
    let mut arguments = arguments.into_iter();
    let (Some(first), second) = (arguments.next(), arguments.next()) else {
        return Err(Fault::new("an argument is missing"));
    };
    first.no_variables("the argument of a function")?;
    match (name, second) {
        ("sqrt", _) => first.square_root(),
        ("atan2", Some(x)) => arc_tangent(&first, &x),
        _ => trigonometric(name, &first),
    }
}

fn trigonometric(name: &str, argument: &Value) -> Result<Value, Fault> {
    if !argument.dimension.fits(Dimension::ANGLE) {
        let (found, value) = (argument.dimension.name(), argument.describe());
        return Err(Fault::new(format!(
            "`{name}` takes an angle (rad), found {found} ({value})"
        )));
    }
    let angle = argument
        .scalar
        .to_angle()
        .ok_or_else(|| Fault::new("the angle is too large"))?;
    let (cosine, sine) = angle.cosine_and_sine();
    let number = match name {
        "sin" => sine,
        "cos" => cosine,
        _ if cosine.is_zero() => {
            return Err(Fault::new("the tangent of a right angle is infinite"));
        }
        _ => sine / cosine,
    };
    Value::plain(number).checked()
}

/// The angle of the point (x, y).
fn arc_tangent(y: &Value, x: &Value) -> Result<Value, Fault> {
    x.no_variables("the argument of a function")?;
    if !x.dimension.fits(y.dimension) && !y.dimension.fits(x.dimension) {
        let (y, x) = (y.dimension.name(), x.dimension.name());
        return Err(Fault::new(format!(
            "`atan2` takes two quantities of the same unit, found {y} and {x}"
        )));
    }
    let (y, x) = (y.scalar.to_number(), x.scalar.to_number());
    if x.is_zero() && y.is_zero() {
        return Err(Fault::new("`atan2` of two zeros has no value"));
    }
    let radians = y.value().atan2(x.value());
    // A decimal angle in degrees is recognised exactly: the point has to lie on its ray.
    let degrees = format!("{:.6}", radians.to_degrees());
    let candidate = Ratio::decimal(&degrees)
        .and_then(Angle::degrees)
        .filter(|angle| {
            let (cosine, sine) = angle.cosine_and_sine();
            (angle.value() - radians).abs() < 1e-12 && (y * cosine - x * sine).is_zero()
        });
    let scalar = candidate.map_or_else(|| Scalar::Number(Number::float(radians)), Scalar::angle);
    Ok(Value::constant(scalar, Dimension::ANGLE))
}
