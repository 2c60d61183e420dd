//! Export of identified parameters to the file that a description was imported from.
//!
//! The file is imported again to find the location and value of each body and joint. Only text of
//! values that differ is changed.

mod complete;
mod mjcf;
mod patch;
mod share;
mod urdf;

use crate::{
    assembly::network::Network,
    files::{Errors, Files},
    format::Format,
    import::{self, Robot},
    options::Options,
    plan::{Joint, Plan, Spring},
};
use overact_description::{Source, parse_parameters};
use patch::{Patch, element_at};
use std::{
    collections::{BTreeMap, BTreeSet},
    path::{Path, PathBuf},
};

/// Files with changed parameters.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Exported {
    /// Format of the file.
    pub format: Format,
    /// Text of the main file.
    pub text: String,
    /// Changed included files, with their paths and new texts.
    pub included: Vec<(PathBuf, String)>,
    /// Paths of all files read.
    pub inputs: Vec<PathBuf>,
    /// Names of the changed bodies and joints.
    pub changed: Vec<String>,
    /// Parameters that the file cannot express or that are not physically consistent, as sentences.
    pub notes: Vec<String>,
}

/// Writes parameters into a robot file.
///
/// `parameters` is a TOML file as `overact identify --parameters` writes it. The options must be
/// those of the import, because parameter names depend on them. Parameters that are not given keep
/// their values.
///
/// # Errors
/// All errors of one of the files, each with its line.
pub fn export(path: &Path, parameters: &Path, options: &Options) -> Result<Exported, Errors> {
    let files = Files::default();
    let exported = exported(&files, path, parameters, options);
    match exported.filter(|_| files.is_clean()) {
        Some(exported) => Ok(exported),
        None => Err(files.into_errors()),
    }
}

fn exported(files: &Files, path: &Path, parameters: &Path, options: &Options) -> Option<Exported> {
    let (model, format) = import::model(files, path, options)?;
    let other = match format {
        Format::Mjcf | Format::Urdf => None,
        Format::Par => Some(".par files"),
        Format::Sdf => Some("SDFormat"),
    };
    if let Some(other) = other {
        let help = "parameters have the names of the description: edit the file with them";
        files.refuse(format!("parameters are not put back into {other}"), help);
        return None;
    }
    let robot = Robot::new(files, &model, options)?;
    if robot.plan.platform.is_some() {
        let message = "parameters of a platform on legs that block some of its motions are not put back into files";
        let help = "edit the file with them";
        files.refuse(message, help);
        return None;
    }
    // Parameter names do not depend on the virtual experiment.
    let text = robot
        .toml(files, &Err("none is needed".to_owned()), path, options)
        .text;
    let parameters_file = files.count();
    let values = values(files, parameters, &text)?;
    let mut own = Export {
        files,
        network: &robot.network,
        format,
        parameters_file,
        values,
        expressed: BTreeSet::new(),
        wanted: ExportChanges::default(),
        notes: Vec::new(),
    };
    own.gather(&robot.plan);
    own.write_out();
    let changed = own.wanted.names.clone();
    let mut notes = std::mem::take(&mut own.notes);
    notes.extend(own.left_out());
    let mut texts = own.patched()?;
    let mut included = Vec::new();
    let text = texts.remove(&0).unwrap_or_else(|| files.text(0));
    for (file, text) in texts {
        included.push((files.path(file), text));
    }
    let inputs = files.paths();
    Some(Exported {
        format,
        text,
        included,
        inputs,
        changed,
        notes,
    })
}

/// Reads the parameter values by their names in the description.
fn values(files: &Files, parameters: &Path, toml: &str) -> Option<BTreeMap<String, f64>> {
    let file = files.read_given(parameters)?;
    let source = Source::new(files.name(file), files.text(file));
    let Ok(description) = overact_description::parse(&Source::new("imported.toml", toml)) else {
        files.refuse(
            "the description of the file can't be read",
            "`overact import` and `overact check` say why",
        );
        return None;
    };
    match parse_parameters(&source, &description) {
        Ok(values) => Some(
            values
                .into_iter()
                .map(|one| (one.name.value, one.value))
                .collect(),
        ),
        Err(errors) => {
            files.note(file, &errors);
            None
        }
    }
}

/// Changes to make, by the location of the element.
#[derive(Debug, Default)]
struct ExportChanges {
    inertias: BTreeMap<(usize, usize), crate::model::Inertia>,
    joints: BTreeMap<(usize, usize), Vec<(&'static str, f64)>>,
    /// Springs and dampers between two points.
    springs: BTreeMap<(usize, usize), Vec<(&'static str, f64)>>,
    names: Vec<String>,
}

struct Export<'e, 'm> {
    files: &'e Files,
    network: &'e Network<'m>,
    format: Format,
    /// Number of the file with the parameters.
    parameters_file: usize,
    values: BTreeMap<String, f64>,
    /// Names of parameters that are exported or unchanged.
    expressed: BTreeSet<String>,
    wanted: ExportChanges,
    notes: Vec<String>,
}

/// Inertial parameters of a body in the order of their columns.
const INERTIAL: [&str; 10] = ["xx", "xy", "xz", "yy", "yz", "zz", "mx", "my", "mz", "m"];
/// Relative difference that counts as rounding.
const SAME: f64 = 1e-13;

impl Export<'_, '_> {
    fn gather(&mut self, plan: &Plan) {
        let is_single = plan.legs.len() == 1;
        for leg in &plan.legs {
            for joint in &leg.joints {
                let of = if is_single {
                    joint.name.clone()
                } else {
                    format!("{}_{}", joint.name, leg.name)
                };
                self.body(joint, &of);
                self.torques(joint, &of);
            }
        }
        for spring in &plan.springs {
            self.point_spring(spring);
        }
    }

    /// Compares stiffness and damping between two points with the file's and records changes.
    fn point_spring(&mut self, spring: &Spring) {
        let file_spring = &self.network.model.springs[spring.of];
        let stiffness = spring
            .stiffness
            .map(|value| ("stiffness", &spring.name, value));
        let damper = spring.damper.as_ref();
        let damping = damper.map(|(name, value)| ("damping", name, *value));
        let mut changes = Vec::new();
        for (attribute, name, before) in stiffness.into_iter().chain(damping) {
            let name = format!("k_{name}");
            let Some(&value) = self.values.get(&name) else {
                continue;
            };
            if (value - before).abs() > SAME * before.abs() {
                changes.push((attribute, value));
            }
            self.expressed.insert(name);
        }
        if !changes.is_empty() {
            let place = &file_spring.place;
            let key = (place.file, place.span.start);
            self.wanted.springs.insert(key, changes);
            self.wanted.names.push(file_spring.name.clone());
        }
    }

    /// Compares the inertia of a joint's body with the file's and records changes.
    fn body(&mut self, joint: &Joint, of: &str) {
        let Some((group, frame)) = joint.carries else {
            return;
        };
        let own = |symbol: &str| {
            joint
                .values
                .iter()
                .find(|(s, _)| *s == symbol)
                .map_or(0.0, |(_, v)| *v)
        };
        let before = INERTIAL.map(own);
        let mut after = before;
        let mut is_given = [false; 10];
        for (at, symbol) in INERTIAL.iter().enumerate() {
            let name = format!("{symbol}_{of}");
            if let Some(value) = self.values.get(&name) {
                (after[at], is_given[at]) = (*value, true);
                self.expressed.insert(name);
            }
        }
        if is_same(&before, &after) {
            return;
        }
        let name = self.network.group_name(group).to_owned();
        let cannot_be =
            |values| !share::inertia(values, &frame).is_some_and(|own| share::is_body(&own));
        if is_given.contains(&false)
            && cannot_be(after)
            && let Some(whole) = complete::completed(&after, is_given)
        {
            after = whole;
            self.notes.push(format!(
                "Parameters of `{name}` without effect on the motion were chosen to be physically consistent with the others."
            ));
        }
        let Some(whole) = share::inertia(after, &frame) else {
            self.notes.push(format!(
                "`{name}` has first moments without a mass, which the file does not support: it is unchanged."
            ));
            return;
        };
        if !share::is_body(&whole) {
            self.notes.push(format!(
                "`{name}` is not physically consistent: its mass or a principal moment is not positive, or one is larger than the sum of the other two; the engine may reject it."
            ));
        }
        let (shares, is_gathered) = share::among(self.network, group, &whole);
        if is_gathered {
            self.notes.push(format!(
                "The inertia of `{name}` and of bodies fixed to it is in one of them."
            ));
        }
        for share in shares {
            let body = &self.network.model.bodies[share.body];
            if let Some(place) = &body.place {
                self.wanted
                    .inertias
                    .insert((place.file, place.span.start), share.inertia);
                self.wanted.names.push(body.name.clone());
            }
        }
    }

    /// Compares friction, rotor inertia and spring with the file's and records changes.
    fn torques(&mut self, joint: &Joint, of: &str) {
        let Some(own) = joint.of else { return };
        let file_joint = &self.network.model.joints[own];
        let mut changes = Vec::new();
        for symbol in ["ia", "fv", "fs", "k"] {
            let name = format!("{symbol}_{of}");
            let attribute = match self.format {
                Format::Mjcf => mjcf::attribute(symbol),
                Format::Urdf => urdf::attribute(symbol),
                Format::Par | Format::Sdf => None,
            };
            let (Some(value), Some(attribute)) = (self.values.get(&name), attribute) else {
                continue;
            };
            let before = joint
                .values
                .iter()
                .find(|(s, _)| *s == symbol)
                .map_or(0.0, |(_, v)| *v);
            if (value - before).abs() > SAME * before.abs() {
                let others = file_joint.of_others(symbol);
                let is_less = others > 0.0 && *value < others;
                if is_less {
                    self.notes.push(format!(
                        "{name} = {value} is less than the {others} of its actuators and tendons: `{attribute}` is zero."
                    ));
                }
                let rest = if is_less { 0.0 } else { value - others };
                changes.push((attribute, rest));
            }
            self.expressed.insert(name);
        }
        if !changes.is_empty() {
            let place = &file_joint.place;
            self.wanted
                .joints
                .insert((place.file, place.span.start), changes);
            self.wanted.names.push(file_joint.name.clone());
        }
    }

    /// Writes out what settings of the file would compute again from changed values.
    fn write_out(&mut self) {
        let model = self.network.model;
        if self.format != Format::Mjcf || self.wanted.names.is_empty() {
            return;
        }
        if model.adjusts_inertias && !self.wanted.inertias.is_empty() {
            for (at, inertia) in mjcf::adjusted_inertias(model) {
                if let Some(place) = &model.bodies[at].place {
                    let key = (place.file, place.span.start);
                    self.wanted.inertias.entry(key).or_insert(inertia);
                }
            }
            self.notes.push("Settings of <compiler> that change inertias are removed: all inertias are written out.".to_owned());
        }
        for joint in &model.joints {
            let Some([stiffness, damping]) = joint.timed_spring else {
                continue;
            };
            let key = (joint.place.file, joint.place.span.start);
            let changes = self.wanted.joints.entry(key).or_default();
            for (name, value) in [("stiffness", stiffness), ("damping", damping)] {
                if changes.iter().all(|(own, _)| *own != name) {
                    changes.push((name, value));
                }
            }
            self.notes.push(format!(
                "`springdamper` of `{}` is replaced by its stiffness and damping.",
                joint.name
            ));
        }
    }

    /// Note on parameters that the file cannot express.
    fn left_out(&self) -> Option<String> {
        let left = self
            .values
            .iter()
            .filter(|(name, value)| **value != 0.0 && !self.expressed.contains(*name));
        let left: Vec<String> = left
            .map(|(name, value)| format!("{name} = {value}"))
            .collect();
        let format = match self.format {
            Format::Mjcf => "MJCF",
            Format::Urdf => "URDF",
            Format::Par => ".par",
            Format::Sdf => "SDFormat",
        };
        (!left.is_empty())
            .then(|| format!("{format} has no place for {}: left out.", left.join(", ")))
    }

    /// Texts of the changed files; `None` after an error.
    fn patched(&self) -> Option<BTreeMap<usize, String>> {
        let keys = self.wanted.inertias.keys().chain(self.wanted.joints.keys());
        let keys = keys.chain(self.wanted.springs.keys());
        let mut files: BTreeSet<usize> = keys.map(|(file, _)| *file).collect();
        let is_written_out = self.format == Format::Mjcf
            && self.network.model.adjusts_inertias
            && !self.wanted.inertias.is_empty();
        if is_written_out {
            files.extend(0..self.files.count());
            files.remove(&self.parameters_file);
        }
        let mut texts = BTreeMap::new();
        for file in files {
            let text = self.files.text(file);
            let document = roxmltree::Document::parse(&text).ok()?;
            let mut patch = Patch::default();
            if is_written_out {
                mjcf::without_adjustments(&mut patch, &text, &document);
            }
            for ((_, start), inertia) in self
                .wanted
                .inertias
                .iter()
                .filter(|((of, _), _)| *of == file)
            {
                let node = element_at(&document, *start)?;
                match self.format {
                    Format::Mjcf => mjcf::inertia(&mut patch, &text, node, inertia),
                    Format::Urdf => {
                        urdf::inertia(&mut patch, self.files, &text, node, inertia, file)
                    }
                    Format::Par | Format::Sdf => {}
                }
            }
            for ((_, start), values) in self.wanted.joints.iter().filter(|((of, _), _)| *of == file)
            {
                let node = element_at(&document, *start)?;
                match self.format {
                    Format::Mjcf => mjcf::joint(&mut patch, node, values),
                    Format::Urdf => urdf::joint(&mut patch, &text, node, values),
                    Format::Par | Format::Sdf => {}
                }
            }
            let springs = self.wanted.springs.iter();
            for ((_, start), values) in springs.filter(|((of, _), _)| *of == file) {
                let node = element_at(&document, *start)?;
                mjcf::tendon(&mut patch, node, values);
            }
            if !patch.is_empty() {
                texts.insert(file, patch.applied(&text));
            }
        }
        Some(texts)
    }
}

/// Whether two parameter sets are equal up to rounding.
fn is_same(before: &[f64; 10], after: &[f64; 10]) -> bool {
    [0..6, 6..9, 9..10].into_iter().all(|kind| {
        let scale = before[kind.clone()]
            .iter()
            .copied()
            .map(f64::abs)
            .fold(0.0, f64::max);
        kind.into_iter()
            .all(|at| (after[at] - before[at]).abs() <= SAME * scale)
    })
}
