//! Serial robots as MJCF and URDF, written from nothing.
//!
//! Each body has one joint, about or along the z axis of the body's frame.

mod mjcf;
mod urdf;

use crate::format::Format;
use nalgebra::{Isometry3, Matrix3, Vector3};

/// A tree of bodies that a file describes.
#[derive(Debug, Clone, PartialEq)]
pub struct SerialTree {
    /// Name of the robot.
    pub name: String,
    /// Lines of the comment at the head of the file.
    pub comment: Vec<String>,
    /// Acceleration of gravity in the base frame, m/s².
    pub gravity: Vector3<f64>,
    /// The bodies; a body's parent comes first.
    pub bodies: Vec<SerialBody>,
}

/// A body with its joint.
#[derive(Debug, Clone, PartialEq)]
pub struct SerialBody {
    /// Name of the body and of its joint.
    pub name: String,
    /// The body that carries it; `None` for the base.
    pub parent: Option<usize>,
    /// Its frame in the parent's frame at joint position zero.
    pub placement: Isometry3<f64>,
    /// Whether the joint turns about z; otherwise it slides along z.
    pub is_revolute: bool,
    /// Body whose joint this one follows, with the factor; `None` for an independent joint.
    pub follows: Option<(usize, f64)>,
    /// Range of the joint's position, rad or m.
    pub range: [f64; 2],
    /// Rotor inertia on the joint, kg m² or kg; zero in URDF.
    pub armature: f64,
    /// Inertial parameters xx, xy, xz, yy, yz, zz, mx, my, mz, m about the body's frame.
    pub inertia: [f64; 10],
}

/// The tree as a file.
///
/// ```
/// use nalgebra::{Isometry3, Vector3};
/// use overact_interchange::{Format, SerialBody, SerialTree, write_serial};
///
/// let body = SerialBody {
///     name: "arm".to_owned(),
///     parent: None,
///     placement: Isometry3::identity(),
///     is_revolute: true,
///     follows: None,
///     range: [-1.0, 1.0],
///     armature: 0.01,
///     inertia: [0.1, 0.0, 0.0, 0.1, 0.0, 0.1, 0.2, 0.0, 0.0, 1.0],
/// };
/// let tree = SerialTree {
///     name: "Arm".to_owned(),
///     comment: Vec::new(),
///     gravity: Vector3::new(0.0, 0.0, -9.81),
///     bodies: vec![body],
/// };
/// assert!(write_serial(&tree, Format::Mjcf).contains("armature=\"0.01\""));
/// ```
#[must_use]
pub fn write_serial(tree: &SerialTree, format: Format) -> String {
    match format {
        Format::Urdf => urdf::text(tree),
        _ => mjcf::text(tree),
    }
}

/// Mass, centre and inertia matrix about the centre of ten parameters with a positive mass.
fn centred(inertia: &[f64; 10]) -> (f64, Vector3<f64>, Matrix3<f64>) {
    let [xx, xy, xz, yy, yz, zz, mx, my, mz, mass] = *inertia;
    let centre = Vector3::new(mx, my, mz) / mass;
    let about = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
    let point = (Matrix3::identity() * centre.norm_squared() - centre * centre.transpose()) * mass;
    (mass, centre, about - point)
}

/// Numbers with blanks between them, exact.
fn numbers(values: &[f64]) -> String {
    let shown: Vec<String> = values.iter().map(|value| number(*value)).collect();
    shown.join(" ")
}

/// A number with the fewest digits that give it again.
fn number(value: f64) -> String {
    // Without the sign of a zero, and with an exponent if the digits are many.
    let text = format!("{:?}", value + 0.0);
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}

/// A text in an attribute or comment of XML.
fn escaped(text: &str) -> String {
    let text = text.replace('&', "&amp;").replace('<', "&lt;");
    text.replace('"', "&quot;").replace("--", "- -")
}

/// The comment at the head of the file.
fn comment(tree: &SerialTree) -> String {
    let lines: Vec<String> = tree.comment.iter().map(|line| escaped(line)).collect();
    format!("<!-- {} -->\n", lines.join("\n     "))
}

#[cfg(test)]
mod tests {
    use super::{centred, number};

    #[test]
    fn numbers_are_exact_and_short() {
        assert_eq!(number(0.1), "0.1");
        assert_eq!(number(-0.0), "0");
        assert_eq!(number(2.0), "2");
        assert_eq!(number(1.0 / 3.0).parse(), Ok(1.0 / 3.0));
        assert_eq!(number(1e-17).parse(), Ok(1e-17));
    }

    #[test]
    fn a_point_mass_has_no_inertia_about_itself() {
        let (mass, centre, inertia) = centred(&[2.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 0.0, 2.0, 2.0]);
        assert_eq!((mass, centre.z), (2.0, 1.0));
        assert!(inertia.norm() < 1e-15);
    }
}
