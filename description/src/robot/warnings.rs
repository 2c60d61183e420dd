//! Warnings about readable text that is probably not intended.
//!
//! Examples are numbers without a unit that would fit another unit, a capitalised payload, and
//! incomplete expressions of columns.

use crate::robot::model::Spanned;
use crate::toml_text::reader::{Context, Item};
use overact_exact::{Angle, Number};

/// Length (m) above which numbers without a unit are probably millimetres.
const LONGEST: f64 = 50.0;

/// Warns of a bare angle above a full turn.
pub(crate) fn angle(item: &Item<'_, '_>, angle: Angle) {
    let (_, radians) = angle.parts();
    bare_angle(item, radians.value());
}

/// Warns of a home angle without a unit above a full turn, rad.
pub(crate) fn bare_angle(item: &Item<'_, '_>, bare: f64) {
    if bare.abs() > std::f64::consts::TAU && !item.context.text(&item.span).contains("rad") {
        let what = format!(
            "`{}`: a number without a unit is in rad, and {bare} rad are more than a turn: {bare} deg?",
            item.key.value
        );
        item.context.warn(what, &item.span);
    }
}

/// Warns of a length that is unusual for a robot.
pub(crate) fn length(item: &Item<'_, '_>, length: Number) {
    let metres = length.value();
    if metres.abs() > LONGEST {
        let bare = !item.context.text(&item.span).contains(" m");
        let unit = if bare {
            format!("a number without a unit is in m: {metres} mm?")
        } else {
            String::from("mm?")
        };
        let what = format!("`{}` is {metres} m long, and {unit}", item.key.value);
        item.context.warn(what, &item.span);
    }
}

/// Warns of a fixed joint whose name is `payload` except for capitals.
pub(crate) fn payload(context: &Context<'_>, name: &Spanned<String>) {
    let Spanned { value: name, span } = name;
    if name != "payload" && name.eq_ignore_ascii_case("payload") {
        let what = format!(
            "the fixed joint `{name}` is a permanent body: did you mean `payload`, which only some runs carry?"
        );
        context.warn(what, span);
    }
}

/// Functions of other languages that expressions of columns do not support.
const FOREIGN: [&str; 14] = [
    "deg2rad", "rad2deg", "radians", "degrees", "log", "log10", "ln", "min", "max", "round",
    "diff", "gradient", "mean", "cumsum",
];

/// Warns of an invalid expression of columns; a log's column may have such a name.
pub(crate) fn column(item: &Item<'_, '_>, text: &str) {
    if let Some(why) = broken(text) {
        let what = format!(
            "`{}`: \"{text}\" is not an expression of columns, {why}; it is used as the name of a column",
            item.key.value
        );
        item.context.warn(what, &item.span);
    }
}

/// The reason why a text that looks like an expression is invalid.
fn broken(text: &str) -> Option<String> {
    let text = text.trim();
    if text.ends_with(['+', '-', '*', '/', '^']) {
        return Some(String::from("something is missing at its end"));
    }
    let count = |sign: char| text.matches(sign).count();
    if count('(') != count(')') {
        return Some(String::from("its parentheses do not match"));
    }
    if count('\'') % 2 == 1 {
        return Some(String::from("a quotation mark is missing"));
    }
    let called = |name: &&&str| text.starts_with(&format!("{name}("));
    if let Some(name) = FOREIGN.iter().find(called) {
        let instead = match *name {
            "deg2rad" | "radians" => ": write `* pi/180` behind the column",
            _ => "",
        };
        return Some(format!("there is no function `{name}`{instead}"));
    }
    let of_file = text
        .strip_prefix("file")
        .and_then(|rest| rest.split_once('.'));
    let is_of_file = of_file.is_some_and(|(number, _)| number.parse::<usize>().is_ok());
    let unit = text.rsplit_once(' ').map(|(_, unit)| unit);
    let unit =
        unit.filter(|unit| is_of_file && crate::expressions::dimension::UNITS.contains(unit));
    unit.map(|unit| match unit {
        "deg" => String::from(
            "a unit follows the column: write `* pi/180`, or `position_scale = \"1 deg\"`",
        ),
        _ => {
            format!("the unit `{unit}` follows the column: give `position_scale` or `torque_gain`")
        }
    })
}

#[cfg(test)]
mod tests {
    use super::broken;

    #[test]
    fn malformed_column_expressions_are_distinguished_from_names() {
        for good in [
            "q_1",
            "file1.Joint_3",
            "file1.Joint_3 * pi/180",
            "'motor 1' / 50",
            "q(:,2)",
            "Torque (N m)",
            "motor 1 deg",
            "-$3",
            "sin($1)",
        ] {
            assert_eq!(broken(good), None, "{good}");
        }
        for bad in [
            "file1.Joint_3 *",
            "(a + b",
            "'motor 1",
            "deg2rad(file1.Joint_3)",
            "file1.Joint_3 deg",
        ] {
            assert!(broken(bad).is_some(), "{bad}");
        }
    }
}
