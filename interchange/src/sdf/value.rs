//! Values of SDFormat, read from the text of elements.

use crate::{
    bounds,
    files::{Files, Place},
    geometry::exact,
    model::Pose,
    xml::{Element, expected, numbers},
};
use nalgebra::{Rotation3, Translation3};

/// Limits from this value on mean "no limit": SDFormat up to 1.8 writes ±1e16.
const NO_LIMIT: f64 = 1e15;

/// Numbers from this value on are rejected, because their squares could soon overflow.
const LARGEST: f64 = 1e15;

/// Text of a child element and its location; `None` if absent or empty.
pub(super) fn text<'e>(of: &'e Element, tag: &str) -> Option<(&'e str, &'e Place)> {
    let (text, place) = &of.child(tag)?.text;
    (!text.is_empty()).then_some((text.as_str(), place))
}

/// Reads `N` numbers from an element; `None` after an error.
pub(super) fn several<const N: usize>(files: &Files, element: &Element) -> Option<[f64; N]> {
    let (text, place) = &element.text;
    match numbers(text).map(<[f64; N]>::try_from) {
        Some(Ok(values)) if values.iter().all(|value| value.abs() < LARGEST) => Some(values),
        Some(Ok(_)) => {
            let message = format!("<{}> has a number beyond {LARGEST:e}", element.name);
            files.report(place, message, "give it in m, rad, kg and kg m^2");
            None
        }
        _ => {
            let message = format!("<{}> must be {}", element.name, expected(N));
            files.report(
                place,
                message,
                "write numbers with a decimal point, without units, and with blanks between them",
            );
            None
        }
    }
}

/// Number in a child element; the default if it is absent or invalid.
pub(super) fn number(files: &Files, of: &Element, tag: &str, default: f64) -> f64 {
    let found = of.child(tag).map(|element| several(files, element));
    found.map_or(default, |values| values.map_or(default, |[value]| value))
}

/// Limit in a child element; `None` if absent or infinite in practice.
pub(super) fn limit(files: &Files, of: &Element, tag: &str) -> Option<f64> {
    let (text, place) = text(of, tag)?;
    match text.parse::<f64>() {
        Ok(value) if !value.is_nan() => (value.abs() < NO_LIMIT).then_some(value),
        _ => {
            let message = format!("<{tag}> is not a limit");
            files.report(place, message, "write a number, or inf for none");
            None
        }
    }
}

/// Whether a child element is true; false if absent or invalid.
pub(super) fn flag(files: &Files, of: &Element, tag: &str) -> bool {
    text(of, tag).is_some_and(|(text, place)| is_true(files, text, place))
}

/// Whether an attribute is true; false if absent or invalid.
pub(super) fn attribute_flag(files: &Files, of: &Element, name: &str) -> bool {
    of.attribute(name)
        .is_some_and(|(text, place)| is_true(files, text, place))
}

/// Whether a boolean is true; capitals do not matter, as in libsdformat.
fn is_true(files: &Files, text: &str, place: &Place) -> bool {
    match text.trim().to_ascii_lowercase().as_str() {
        "false" | "0" => false,
        "true" | "1" => true,
        _ => {
            let message = format!("`{text}` is neither true nor false");
            files.report(place, message, "write true or false");
            false
        }
    }
}

/// Reads `<pose>`, without its reference frame.
pub(super) fn pose(files: &Files, element: Option<&Element>) -> Pose {
    let Some(element) = element.filter(|element| !element.text.0.is_empty()) else {
        return Pose::identity();
    };
    let said = match element.get("rotation_format") {
        Some("quat_xyzw") => several(files, element).map(|[x, y, z, i, j, k, w]| {
            let rotation = exact::quaternion([w, i, j, k]);
            if rotation.is_none() {
                let message = "a quaternion of length zero";
                files.report(&element.text.1, message, "write 0 0 0 1 for no rotation");
            }
            ([x, y, z], rotation.unwrap_or_default())
        }),
        None | Some("euler_rpy") => several(files, element).map(|[x, y, z, r, p, q]| {
            let in_degrees = attribute_flag(files, element, "degrees");
            let angle = |v: f64| if in_degrees { v.to_radians() } else { v };
            let angles = [r, p, q].map(angle);
            bounds::check_angles(files, &element.text.1, &angles);
            ([x, y, z], exact::roll_pitch_yaw(angles))
        }),
        Some(other) => {
            let message = format!("`{other}` is not a format of rotations");
            let help = "write euler_rpy or quat_xyzw";
            files.report(&element.place, message, help);
            None
        }
    };
    let (at, rotation) = said.unwrap_or(([0.0; 3], Rotation3::identity()));
    Pose::from_parts(Translation3::from(at), rotation)
}

/// Reference frame that a pose names: `relative_to`, or `frame` before SDFormat 1.7.
pub(super) fn reference_frame(element: Option<&Element>) -> Option<(&str, &Place)> {
    let pose = element?;
    let named = pose
        .attribute("relative_to")
        .or_else(|| pose.attribute("frame"));
    named.filter(|(name, _)| !name.is_empty())
}
