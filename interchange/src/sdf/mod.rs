//! Reader of SDFormat 1.4 to 1.12, the format of Gazebo.
//!
//! Joints may connect any two links, so that a robot may have loops. Poses follow "Pose frame
//! semantics" and its proposal on sdformat.org, and the element descriptions in gazebosim/sdformat.
//! The default reference frame of a pose depends on the element:
//!
//! | element | default reference frame |
//! |---|---|
//! | link | model |
//! | joint | child link |
//! | `<frame>` | frame that it is attached to |
//! | model | enclosing model or world |
//!
//! Axes are expressed in the frame of their joint. All joints are at zero in the file's poses, so
//! its loops are closed there.

mod contents;
mod couplings;
mod frames;
mod include;
mod joints;
mod links;
mod tree;
mod value;

use crate::{
    account::{SDF, Use},
    bounds,
    files::Files,
    model::Model,
    options::Options,
    prune::keep_honoured,
    xml::{self, Element},
};
use contents::{Owner, SdfContents};
use include::{Included, Source};
use value::{flag, several};

/// Default gravity of a world, m/s².
const GRAVITY: [f64; 3] = [0.0, 0.0, -9.8];

/// Reads a robot; errors are recorded in `files`.
pub(crate) fn read(files: &Files, file: usize, options: &Options) -> Option<Model> {
    let mut root = xml::parse(files, file)?;
    keep_honoured(files, &SDF, &mut root);
    bounds::check_elements(files, &root)?;
    let version = version(files, &root)?;
    let mut worlds = root.all("world");
    let world = worlds.next();
    if let Some(second) = worlds.next() {
        let message = "the file has more than one world";
        files.report(
            &second.place,
            message,
            "put each world into a file of its own",
        );
        return None;
    }
    let around = world.unwrap_or(&root);
    let mut model = Model::new("robot");
    if let Some(world) = world {
        model.gravity = gravity(files, world, version)?;
    }
    let path = files.path(file);
    let models = models(files, around, version, &path)?;
    let robot = chosen(files, around, &models, options)?;
    let name = models[robot].element.get("name").unwrap_or("robot");
    model.name = name.to_owned();
    let shown_without = format!("{name}::");
    let mut contents = SdfContents::new(files, around.place.clone(), version, path, shown_without);
    for (at, found) in models.into_iter().enumerate() {
        let owner = match (at == robot, found.is_static) {
            (true, _) => Owner::Robot,
            (false, true) => Owner::Ground,
            (false, false) => Owner::Stranger,
        };
        if owner == Owner::Stranger {
            let place = &found.element.place;
            files.record(
                Use::Ignored,
                place,
                "model",
                None,
                "another model of the world",
            );
        }
        contents.model(&found.element, found.source, 0, owner)?;
    }
    contents.parts(around, 0, Owner::Robot)?;
    contents.frames.resolve(files)?;
    if !files.is_clean() {
        return None;
    }
    let (edges, axes) = tree::build(&contents, options, &mut model)?;
    couplings::read(&contents, &edges, &axes, &mut model);
    files.is_clean().then_some(model)
}

/// Gravity of a world; `None` after an error.
///
/// Up to SDFormat 1.5 it is an element of `<physics>`.
fn gravity(files: &Files, world: &Element, version: (u32, u32)) -> Option<[f64; 3]> {
    let own = world.child("gravity");
    let physics = world.all("physics");
    let in_physics: Vec<&Element> = physics.filter_map(|own| own.child("gravity")).collect();
    let used = match own {
        None if version <= (1, 5) => in_physics.first().copied(),
        own => own,
    };
    for unused in in_physics {
        let is_used = used.is_some_and(|used| used.place == unused.place);
        if !is_used {
            let reason = "not used: gravity is that of the world, or of its first <physics> up to SDFormat 1.5";
            files.demote(&unused.place, "gravity", None, reason);
        }
    }
    used.map_or(Some(GRAVITY), |used| several(files, used))
}

/// SDFormat version of a file; `None` after an error.
fn version(files: &Files, root: &Element) -> Option<(u32, u32)> {
    let Some((text, place)) = root.attribute("version") else {
        let help = "write for instance <sdf version=\"1.9\">";
        files.report(&root.place, "the file has no version of SDFormat", help);
        return None;
    };
    let parts = text.trim().split_once('.');
    let number = |part: &str| part.parse::<u32>().ok();
    let found = parts.and_then(|(major, minor)| Some((number(major)?, number(minor)?)));
    let known = found.filter(|version| ((1, 4)..=(1, 12)).contains(version));
    if known.is_none() {
        let message = format!("SDFormat of version `{text}` is not read");
        let help =
            "supported are 1.4 to 1.12: `gz sdf -p FILE` converts a file to its newest version";
        files.report(place, message, help);
    }
    known
}

/// A model of the world or of the file.
struct FoundModel {
    element: Element,
    source: Source,
    is_static: bool,
}

/// Models of a world or of a file.
///
/// An `<include>` of a world that cannot be read is omitted and reported.
fn models(
    files: &Files,
    around: &Element,
    version: (u32, u32),
    path: &std::path::Path,
) -> Option<Vec<FoundModel>> {
    let mut all = Vec::new();
    let mut elsewhere = Vec::new();
    for child in &around.children {
        let (element, source) = match child.name.as_str() {
            "model" => {
                let source = Source {
                    version,
                    from: None,
                    is_merged: false,
                };
                (child.clone(), source)
            }
            "include" => match include::read(files, child, &[path.to_owned()]) {
                Included::Model(model, source) => (*model, source),
                Included::Elsewhere(uri, place) => {
                    elsewhere.push((uri, place));
                    continue;
                }
                Included::Error => return None,
            },
            _ => continue,
        };
        all.push(FoundModel {
            is_static: flag(files, &element, "static"),
            element,
            source,
        });
    }
    if all.iter().all(|found| found.is_static)
        && let Some((uri, place)) = elsewhere.first()
    {
        include::refuse(files, uri, place);
        return None;
    }
    for (uri, place) in &elsewhere {
        let reason = format!("`{uri}` is not read");
        files.record(Use::Reported, place, "include", Some("uri"), &reason);
    }
    Some(all)
}

/// Chooses the robot: the model given in the options, else the only one that moves.
fn chosen(
    files: &Files,
    around: &Element,
    models: &[FoundModel],
    options: &Options,
) -> Option<usize> {
    let name = |at: usize| models[at].element.get("name").unwrap_or_default();
    if let Some(wanted) = &options.model {
        let found = (0..models.len()).find(|&at| name(at) == wanted);
        if found.is_none() {
            let near = files.did_you_mean(wanted, (0..models.len()).map(name));
            let help = near.unwrap_or_else(|| "name a <model> of the file".to_owned());
            files.report(&around.place, format!("there is no model `{wanted}`"), help);
        }
        return found;
    }
    let moving: Vec<usize> = (0..models.len())
        .filter(|&at| !models[at].is_static)
        .collect();
    match (&moving[..], models.len()) {
        ([only], _) => Some(*only),
        // `SdfContents::model` reports the error for a static robot.
        ([], 1) => Some(0),
        ([], _) => {
            let message = "there is no <model> that moves";
            let help = "the robot is a <model> that is not static";
            files.report(&around.place, message, help);
            None
        }
        _ => {
            let list: Vec<String> = moving.iter().map(|&at| format!("`{}`", name(at))).collect();
            let message = format!("there are {} models: {}", moving.len(), list.join(", "));
            let help = format!("choose the robot: `--model {}`", name(moving[0]));
            files.report(&around.place, message, help);
            None
        }
    }
}
