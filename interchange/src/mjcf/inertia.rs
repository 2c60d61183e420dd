//! Inertias of bodies from `<inertial>` or from geoms, computed as in MuJoCo.

use super::{BOOLEAN, ROTATIONS, Reader, only_one, shell::Shell};
use crate::{
    account::Use,
    files::Files,
    geometry::exact,
    model::{Inertia, Pose},
    xml::Element,
};
use nalgebra::{Matrix3, Point3, Rotation3, Vector3};
use std::f64::consts::PI;

/// Types of geoms.
const SHAPES: &[&str] = &[
    "plane",
    "hfield",
    "sphere",
    "capsule",
    "ellipsoid",
    "cylinder",
    "box",
    "mesh",
    "sdf",
];

/// MuJoCo's default density of geoms, kg/m³.
const DENSITY: f64 = 1000.0;

/// Inertia of a body, and whether it has inertia that the file does not determine.
pub(super) fn read(reader: &Reader<'_>, body: &Element, class: &str) -> (Option<Inertia>, bool) {
    let is_from_geoms = reader.compiler.inertia_from_geometry;
    let inertial = inertial(reader, body, &Pose::identity());
    match (is_from_geoms, inertial) {
        (Some(true), _) | (None, None) => of_geoms(reader, body, class, &Pose::identity()),
        (_, inertial) => (inertial, false),
    }
}

/// `<inertial>` of a body, possibly inside a frame of the body.
fn inertial(reader: &Reader<'_>, element: &Element, offset: &Pose) -> Option<Inertia> {
    let mut all = Vec::new();
    gather_inertials(reader, element, offset, &mut all);
    if let Some((second, _)) = all.get(1) {
        let message = "a body has a second <inertial>";
        reader
            .files
            .report(&second.place, message, "keep one of them");
    }
    let (own, offset) = all.first()?;
    Some(of_inertial(reader, own).transformed(offset))
}

/// `<inertial>` elements of a body and of frames in it, with the poses of these frames.
fn gather_inertials<'e>(
    reader: &Reader<'_>,
    element: &'e Element,
    offset: &Pose,
    all: &mut Vec<(&'e Element, Pose)>,
) {
    all.extend(element.child("inertial").map(|own| (own, *offset)));
    for frame in element.all("frame") {
        let offset = offset * reader.compiler.frame(reader.files, frame);
        gather_inertials(reader, frame, &offset, all);
    }
}

fn of_inertial(reader: &Reader<'_>, inertial: &Element) -> Inertia {
    let files = reader.files;
    let mass = inertial.number(files, "mass", 0.0);
    if mass < 0.0 {
        let place = inertial.attribute("mass").map(|(_, place)| place);
        let place = place.unwrap_or(&inertial.place);
        let help = "give a mass that is zero or more";
        files.report(place, "a mass is negative", help);
    }
    let frame = reader.compiler.frame(files, inertial);
    if inertial.get("fullinertia").is_some() {
        // MuJoCo rejects a rotation, too: `fullinertia` is in the body's axes.
        for other in ROTATIONS.iter().chain(&["diaginertia"]) {
            only_one(files, inertial, &["fullinertia", other]);
        }
    }
    if let Some([xx, yy, zz, xy, xz, yz]) = inertial.numbers(files, "fullinertia") {
        let tensor = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
        let frame = Pose::from_parts(frame.translation, Rotation3::identity());
        return about_centre(mass, tensor).transformed(&frame);
    }
    let diagonal = inertial
        .numbers::<3>(files, "diaginertia")
        .unwrap_or_default();
    let rotation = exact::cleaned(&frame.rotation);
    let frame = Pose::from_parts(frame.translation, rotation);
    about_centre(mass, Matrix3::from_diagonal(&Vector3::from(diagonal))).transformed(&frame)
}

fn about_centre(mass: f64, tensor: Matrix3<f64>) -> Inertia {
    Inertia {
        mass,
        centre: Point3::origin(),
        tensor,
    }
}

/// Total inertia of a body's geoms, including those in frames.
fn of_geoms(
    reader: &Reader<'_>,
    element: &Element,
    class: &str,
    offset: &Pose,
) -> (Option<Inertia>, bool) {
    let (mut sum, mut is_unknown) = (None, false);
    for child in &element.children {
        let (inertia, unknown) = match child.name.as_str() {
            "geom" => {
                let whole = reader.defaults.apply(reader.files, child, class);
                match geom(reader, &whole) {
                    Shape::Body(own) => (Some(own.transformed(offset)), false),
                    Shape::Empty => (None, false),
                    Shape::Unknown(reason) => {
                        let reason = format!("{reason}: the body's mass is unknown here");
                        let place = &child.place;
                        reader
                            .files
                            .record(Use::Reported, place, "geom", None, &reason);
                        (None, true)
                    }
                }
            }
            "frame" => {
                let class = child.get("childclass").unwrap_or(class);
                let offset = offset * reader.compiler.frame(reader.files, child);
                of_geoms(reader, child, class, &offset)
            }
            _ => continue,
        };
        is_unknown |= unknown;
        sum = match (sum, inertia) {
            (Some(sum), Some(own)) => Some(own.with(&sum)),
            (sum, own) => own.or(sum),
        };
    }
    (sum.filter(|_| !is_unknown), is_unknown)
}

/// Contribution of a geom to its body.
enum Shape {
    Body(Inertia),
    Empty,
    /// With the reason.
    Unknown(String),
}

fn geom(reader: &Reader<'_>, geom: &Element) -> Shape {
    let files = reader.files;
    let [low, high] = reader.compiler.inertia_groups;
    let group = geom.number(files, "group", 0.0);
    let mass = geom
        .attribute("mass")
        .map(|_| geom.number(files, "mass", 0.0));
    let density = geom.number(files, "density", DENSITY);
    let kind = geom.keyword(files, "type", SHAPES).unwrap_or("sphere");
    for key in ["mass", "density"] {
        if let Some((_, place)) = geom
            .attribute(key)
            .filter(|_| geom.number(files, key, 0.0) < 0.0)
        {
            let message = format!("a {key} is negative");
            files.report(place, message, format!("give a {key} that is zero or more"));
        }
    }
    if group < low || group > high || kind == "plane" || mass.unwrap_or(density) == 0.0 {
        return Shape::Empty;
    }
    if kind == "mesh" {
        let name = geom.get("mesh").unwrap_or_default();
        return match reader.meshes.get(name) {
            Some(Ok(mesh)) => {
                let mass = mass.unwrap_or(density * mesh.size);
                let own = Inertia {
                    mass,
                    centre: Point3::from(mesh.centre),
                    tensor: mesh.inertia * (mass / mesh.size),
                };
                Shape::Body(own.transformed(&reader.compiler.frame(files, geom)))
            }
            Some(Err(reason)) => Shape::Unknown(format!("mesh `{name}`: {reason}")),
            None => Shape::Unknown(format!("there is no mesh `{name}`")),
        };
    }
    let is_shell = geom.keyword(files, "shellinertia", BOOLEAN) == Some("true");
    let shape = primitive(reader, geom, kind, is_shell).filter(|_| geom.get("mesh").is_none());
    let Some((size, unit)) = shape else {
        return Shape::Unknown("the inertia of this shape is not computed".to_owned());
    };
    let mass = mass.unwrap_or(density * size);
    let frame = match Segment::of_geom(files, geom) {
        Some(segment) => segment.frame(),
        None => {
            let frame = reader.compiler.frame(files, geom);
            Pose::from_parts(frame.translation, exact::cleaned(&frame.rotation))
        }
    };
    Shape::Body(about_centre(mass, Matrix3::from_diagonal(&(unit * mass))).transformed(&frame))
}

/// Volume or area, and principal moments for unit mass, of a primitive; `None` for other shapes.
fn primitive(
    reader: &Reader<'_>,
    geom: &Element,
    kind: &str,
    is_shell: bool,
) -> Option<(f64, Vector3<f64>)> {
    let files: &Files = reader.files;
    let size = geom.list(files, "size").unwrap_or_default();
    let length = Segment::of_geom(files, geom).map(|segment| segment.length());
    check_sizes(files, geom, kind, &size, length);
    let at = |index: usize| size.get(index).copied();
    let radius = at(0)?;
    // With `fromto`, x and y use the first size.
    let half_length = |index: usize| length.map_or_else(|| at(index), |length| Some(0.5 * length));
    let second = if length.is_some() {
        Some(radius)
    } else {
        at(1)
    };
    let of_shell = |shell: Shell| (shell.area, shell.moments);
    Some(match kind {
        "sphere" if is_shell => of_shell(Shell::sphere(radius)),
        "sphere" => {
            let volume = 4.0 / 3.0 * PI * radius.powi(3);
            (volume, uniform(0.4 * radius * radius))
        }
        "ellipsoid" => {
            let (y, z) = (second?, half_length(2)?);
            if is_shell {
                return Some(of_shell(Shell::ellipsoid(radius, y, z)));
            }
            let moments = moments(radius, y, z) / 5.0;
            (4.0 / 3.0 * PI * radius * y * z, moments)
        }
        "box" => {
            let (y, z) = (second?, half_length(2)?);
            if is_shell {
                return Some(of_shell(Shell::cuboid(radius, y, z)));
            }
            (8.0 * radius * y * z, moments(radius, y, z) / 3.0)
        }
        "cylinder" if is_shell => of_shell(Shell::cylinder(radius, 2.0 * half_length(1)?)),
        "cylinder" => {
            let height = 2.0 * half_length(1)?;
            let across = (3.0 * radius * radius + height * height) / 12.0;
            let along = 0.5 * radius * radius;
            let volume = PI * radius * radius * height;
            (volume, Vector3::new(across, across, along))
        }
        "capsule" if is_shell => of_shell(Shell::capsule(radius, 2.0 * half_length(1)?)),
        "capsule" => capsule(radius, 2.0 * half_length(1)?),
        _ => return None,
    })
}

/// Reports sizes of a primitive that are not positive.
fn check_sizes(files: &Files, geom: &Element, kind: &str, size: &[f64], length: Option<f64>) {
    let used = match kind {
        "sphere" => 1,
        _ if length.is_some() => 1,
        "capsule" | "cylinder" => 2,
        _ => 3,
    };
    let given = geom.attribute("size").map(|(_, place)| place);
    if let Some(place) = given.filter(|_| size.iter().take(used).any(|own| *own <= 0.0)) {
        let message = "a size of the geom is not positive";
        files.report(place, message, "give radii and half lengths in m");
    }
    let ends = geom.attribute("fromto").map(|(_, place)| place);
    if let Some(place) = ends.filter(|_| length == Some(0.0)) {
        let message = "`fromto` of the geom has no length";
        files.report(place, message, "give two different points");
    }
}

fn uniform(value: f64) -> Vector3<f64> {
    Vector3::repeat(value)
}

/// Sums of two squares: yy + zz, xx + zz, xx + yy.
fn moments(x: f64, y: f64, z: f64) -> Vector3<f64> {
    Vector3::new(y * y + z * z, x * x + z * z, x * x + y * y)
}

/// Volume and moments of a capsule: a cylinder with two half spheres.
fn capsule(radius: f64, height: f64) -> (f64, Vector3<f64>) {
    let ball = 4.0 / 3.0 * PI * radius.powi(3);
    let cylinder = PI * radius * radius * height;
    let volume = ball + cylinder;
    let (ball, cylinder) = (ball / volume, cylinder / volume);
    let square = radius * radius;
    let along = cylinder * 0.5 * square + ball * 0.4 * square;
    // The centre of each half sphere is 3/8 of the radius from the cylinder's end.
    let across = cylinder * (3.0 * square + height * height) / 12.0
        + ball * (0.4 * square + 0.25 * height * height + 0.375 * radius * height);
    (volume, Vector3::new(across, across, along))
}

/// Line segment that a geom's `fromto` gives.
struct Segment {
    from: Vector3<f64>,
    to: Vector3<f64>,
}

impl Segment {
    /// Segment of a geom; `None` without `fromto`.
    fn of_geom(files: &Files, geom: &Element) -> Option<Self> {
        let [ax, ay, az, bx, by, bz] = geom.numbers(files, "fromto")?;
        Some(Self {
            from: Vector3::new(ax, ay, az),
            to: Vector3::new(bx, by, bz),
        })
    }

    /// Frame at the midpoint with z along the segment.
    fn frame(&self) -> Pose {
        let along = self.to - self.from;
        let turned = Rotation3::rotation_between(&Vector3::z(), &along);
        let turned = turned.unwrap_or_else(|| Rotation3::from_axis_angle(&Vector3::x_axis(), PI));
        let middle = 0.5 * (self.from + self.to);
        Pose::from_parts(middle.into(), exact::cleaned(&turned))
    }

    /// Distance between the ends.
    fn length(&self) -> f64 {
        (self.to - self.from).norm()
    }
}
