//! Reader of MJCF: nested bodies, defaults, equality constraints and actuators.

mod actuators;
mod adjust;
mod bodies;
mod compensation;
mod defaults;
mod equality;
mod include;
mod inertia;
mod keyframe;
mod mesh;
mod names;
mod shell;
mod tendons;
#[cfg(test)]
mod tests;

use crate::{
    bounds,
    files::Files,
    geometry::exact,
    model::{Model, Pose},
    options::Options,
    xml::Element,
};
use adjust::Adjustments;
use defaults::Defaults;
use nalgebra::{Rotation3, Vector3};
use std::collections::BTreeMap;
use tendons::Tendons;

/// Reads a robot; errors are recorded in `files`.
pub(crate) fn read(files: &Files, file: usize, options: &Options) -> Option<Model> {
    let (root, keyframe) = include::whole(files, file, options.include_outside)?;
    bounds::check_elements(files, &root)?;
    let mut model = Model::new(root.get("model").unwrap_or("robot"));
    let mut reader = Reader {
        files,
        compiler: Compiler::new(files, &root),
        defaults: Defaults::new(files, &root)?,
        meshes: mesh::Meshes::new(),
        options,
        has_closures: equality::has_closures(&root),
    };
    reader.meshes = mesh::read(&reader, &root, &files.path(file));
    let mut has_gravity = true;
    for option in root.all("option") {
        if let Some(gravity) = option.numbers(files, "gravity") {
            model.gravity = gravity;
        }
        let flag = option.child("flag");
        let said = flag.and_then(|flag| flag.keyword(files, "gravity", &["enable", "disable"]));
        if let Some(word) = said {
            has_gravity = word == "enable";
        }
    }
    if !has_gravity {
        model.gravity = [0.0; 3];
    }
    let mut sites = BTreeMap::new();
    let (springs, compensation) = bodies::read(&reader, &root, &mut model, &mut sites);
    if !files.is_clean() {
        return None;
    }
    let mut tendons = Tendons::read(&reader, &root, &sites, &model);
    equality::read(&reader, &root, &sites, &mut tendons, &mut model);
    actuators::read(&reader, &root, &mut tendons, &mut model);
    tendons.finish(files, &mut model);
    // Springs given by time constants need all inertias, including rotor inertias.
    adjust::inertias(files, &root, &reader.compiler, &mut model);
    compensation.apply(files, &mut model);
    adjust::springs(files, &mut model, &springs);
    if let Some(keyframe) = keyframe {
        let has_fixed_base = options.fix_base && bodies::has_free_base(&root);
        keyframe::apply(files, &keyframe, has_fixed_base, &mut model);
    }
    files.is_clean().then_some(model)
}

/// Words of a boolean attribute.
const BOOLEAN: &[&str] = &["true", "false"];
/// Words of an attribute that is true, false or chosen by MuJoCo.
const BOOLEAN_OR_AUTO: &[&str] = &["true", "false", "auto"];

/// Context for reading elements.
struct Reader<'r> {
    files: &'r Files,
    compiler: Compiler,
    defaults: Defaults,
    meshes: mesh::Meshes,
    options: &'r Options,
    /// Whether constraints close loops, which may hold free bodies.
    has_closures: bool,
}

/// Body of each site and its pose there.
type Sites = BTreeMap<String, (usize, Pose)>;

/// Settings of `<compiler>`.
struct Compiler {
    is_degrees: bool,
    /// Euler axes, and whether each rotation is about the already rotated axes.
    sequence: [(usize, bool); 3],
    /// Whether inertias come from geoms; `None`: only for bodies without `<inertial>`.
    inertia_from_geometry: Option<bool>,
    /// First and last geom group with inertia.
    inertia_groups: [f64; 2],
    adjustments: Adjustments,
    /// Whether a joint with a range is limited by default.
    limits_ranges: bool,
    /// Folder of mesh files, relative to that of the model.
    mesh_folder: String,
    /// Whether only the last part of the path of a mesh file counts.
    strips_paths: bool,
}

impl Compiler {
    fn new(files: &Files, root: &Element) -> Self {
        let mut own = Self {
            is_degrees: true,
            sequence: [(0, true), (1, true), (2, true)],
            inertia_from_geometry: None,
            inertia_groups: [0.0, 5.0],
            adjustments: Adjustments::default(),
            limits_ranges: true,
            mesh_folder: String::new(),
            strips_paths: false,
        };
        for compiler in root.all("compiler") {
            match compiler.attribute("angle") {
                Some(("radian", _)) => own.is_degrees = false,
                Some(("degree", _)) => own.is_degrees = true,
                Some((other, place)) => {
                    let message = format!("`{other}` is not a unit of angles");
                    files.report(place, message, "write degree or radian");
                }
                None => {}
            }
            if let Some((text, place)) = compiler.attribute("eulerseq") {
                match sequence(text) {
                    Some(sequence) => own.sequence = sequence,
                    None => {
                        let message = format!("`{text}` is not a sequence of three axes");
                        files.report(
                            place,
                            message,
                            "write three of xyzXYZ, for instance \"xyz\"",
                        );
                    }
                }
            }
            if let Some((value, place)) = compiler
                .attribute("coordinate")
                .filter(|(v, _)| *v != "local")
            {
                let message = format!("coordinates of the kind `{value}` are not supported");
                files.report(place, message, "save the model with local coordinates");
            }
            if let Some(word) = compiler.keyword(files, "autolimits", BOOLEAN) {
                own.limits_ranges = word == "true";
            }
            match compiler.keyword(files, "inertiafromgeom", BOOLEAN_OR_AUTO) {
                Some("true") => own.inertia_from_geometry = Some(true),
                Some("false") => own.inertia_from_geometry = Some(false),
                Some("auto") => own.inertia_from_geometry = None,
                _ => {}
            }
            if let Some(groups) = compiler.numbers(files, "inertiagrouprange") {
                own.inertia_groups = groups;
            }
            // `meshdir` overrides `assetdir`.
            let folders = ["assetdir", "meshdir"].map(|key| compiler.get(key));
            if let Some(folder) = folders.into_iter().flatten().next_back() {
                folder.clone_into(&mut own.mesh_folder);
            }
            if let Some(word) = compiler.keyword(files, "strippath", BOOLEAN) {
                own.strips_paths = word == "true";
            }
            own.adjustments.read(files, compiler);
        }
        own
    }

    fn angle(&self, value: f64) -> f64 {
        exact::angle(if self.is_degrees {
            value.to_radians()
        } else {
            value
        })
    }

    /// Rotation given by `quat`, `axisangle`, `xyaxes`, `zaxis` or `euler`.
    fn rotation(&self, files: &Files, of: &Element) -> Rotation3<f64> {
        only_one(files, of, ROTATIONS);
        if let Some(quaternion) = of.numbers(files, "quat") {
            return exact::quaternion(quaternion).unwrap_or_else(|| {
                files.report(
                    &of.place,
                    "a quaternion of length zero",
                    "write 1 0 0 0 for no rotation",
                );
                Rotation3::identity()
            });
        }
        if let Some([x, y, z, angle]) = of.numbers(files, "axisangle") {
            let axis = exact::unit(&Vector3::new(x, y, z), 1e-12);
            bounds::check_angles(files, &of.place, &[self.angle(angle)]);
            return axis.map_or_else(Rotation3::identity, |axis| {
                exact::turn(&axis, self.angle(angle))
            });
        }
        if let Some([a, b, c, d, e, f]) = of.numbers(files, "xyaxes")
            && let Some(rotation) = of_axes(&Vector3::new(a, b, c), &Vector3::new(d, e, f))
        {
            return rotation;
        }
        if let Some([x, y, z]) = of.numbers(files, "zaxis") {
            let axis = exact::unit(&Vector3::new(x, y, z), 0.0).unwrap_or_else(Vector3::z);
            let to = Rotation3::rotation_between(&Vector3::z(), &axis);
            let turned = || Rotation3::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI);
            return exact::cleaned(&to.unwrap_or_else(turned));
        }
        if let Some(angles) = of.numbers::<3>(files, "euler") {
            let turned = angles.map(|angle| self.angle(angle));
            bounds::check_angles(files, &of.place, &turned);
            let mut whole = Rotation3::identity();
            for (angle, (axis, turns_along)) in angles.into_iter().zip(self.sequence) {
                let turn = exact::about(axis, self.angle(angle));
                whole = if turns_along {
                    whole * turn
                } else {
                    turn * whole
                };
            }
            return whole;
        }
        Rotation3::identity()
    }

    /// Pose given by `pos` and a rotation.
    fn frame(&self, files: &Files, of: &Element) -> Pose {
        let [x, y, z] = of.numbers(files, "pos").unwrap_or_default();
        Pose::from_parts(Vector3::new(x, y, z).into(), self.rotation(files, of))
    }
}

/// Attributes that give a rotation.
const ROTATIONS: &[&str] = &["quat", "axisangle", "xyaxes", "zaxis", "euler"];

/// Reports a second attribute of those that exclude each other.
fn only_one(files: &Files, of: &Element, names: &[&str]) {
    let given = of.attributes.iter();
    let mut given = given.filter(|(name, ..)| names.contains(&name.as_str()));
    if let (Some((first, ..)), Some((second, _, place))) = (given.next(), given.next()) {
        let message = format!(
            "`{}` has both `{first}` and `{second}`, which exclude each other",
            of.name
        );
        files.report(place, message, "keep one of them");
    }
}

/// Rotation with first axis along `x` and second axis in the plane of both; `None` if they are
/// parallel.
fn of_axes(x: &Vector3<f64>, y: &Vector3<f64>) -> Option<Rotation3<f64>> {
    let x = exact::unit(x, 0.0)?;
    let y = if y.amax() > 1e100 { y / y.amax() } else { *y };
    let y = exact::unit(&(y - x * x.dot(&y)), 0.0)?;
    let matrix = nalgebra::Matrix3::from_columns(&[x, y, x.cross(&y)]);
    Some(exact::cleaned(&Rotation3::from_matrix_unchecked(matrix)))
}

fn sequence(text: &str) -> Option<[(usize, bool); 3]> {
    let axis = |c: char| Some(("xyz".find(c.to_ascii_lowercase())?, c.is_ascii_lowercase()));
    let found: Option<Vec<_>> = text.chars().map(axis).collect();
    found?.try_into().ok()
}
