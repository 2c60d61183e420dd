//! `<include>`: reads the model of another file in the including file's folder or below.

use super::{
    value::{attribute_flag, text},
    version,
};
use crate::{
    account::SDF,
    bounds,
    files::{Files, Place},
    prune::keep_honoured,
    xml::{self, Element},
};
use std::path::{Path, PathBuf};

/// Largest number of files.
const FILES: usize = 500;

/// Origin of a model.
#[derive(Debug, Clone)]
pub(super) struct Source {
    pub(super) version: (u32, u32),
    /// File that the model was included from.
    pub(super) from: Option<PathBuf>,
    /// Whether the model's contents are merged into the surrounding model.
    pub(super) is_merged: bool,
}

/// Result of an `<include>`.
pub(super) enum Included {
    Model(Box<Element>, Source),
    /// URI that is not read, and its location in the file.
    Elsewhere(String, Place),
    Error,
}

/// Reads the model of an `<include>`; the last of the open files contains the element.
pub(super) fn read(files: &Files, element: &Element, open: &[PathBuf]) -> Included {
    let Some((uri, place)) = text(element, "uri") else {
        let message = "<include> names no file";
        files.report(&element.place, message, "write <uri>FILE</uri>");
        return Included::Error;
    };
    let Some(path) = beneath(uri, open) else {
        return Included::Elsewhere(uri.to_owned(), place.clone());
    };
    let include = Include {
        element,
        uri,
        place,
        open,
    };
    include
        .model(files, &path)
        .map_or(Included::Error, |(model, source)| {
            Included::Model(model, source)
        })
}

/// Reports an error for a URI that is not read.
pub(super) fn refuse(files: &Files, uri: &str, place: &Place) {
    let message = format!("`{uri}` is not read: only files in the robot's own folder are");
    let help = "put the model next to this file and write its relative path, or expand it with `gz sdf -p FILE`";
    files.report(place, message, help);
}

/// Path of a relative URI that stays below the folder of the first file.
fn beneath(uri: &str, open: &[PathBuf]) -> Option<PathBuf> {
    let plain = Path::new(uri);
    if uri.contains(':') || plain.is_absolute() || uri.contains('\\') {
        return None;
    }
    let folder = open.last()?.parent()?;
    let path = folder.join(plain);
    let path = if path.is_dir() {
        path.join("model.sdf")
    } else {
        path
    };
    let first = open.first()?.parent()?;
    let real = |path: &Path| {
        if path.as_os_str().is_empty() {
            Path::new(".").canonicalize().ok()
        } else {
            path.canonicalize().ok()
        }
    };
    match (real(first), real(&path)) {
        (Some(first), Some(path)) if !path.starts_with(&first) => None,
        // A missing file is reported when it is opened, but a path with `..` is refused here.
        (_, None) if plain.components().any(|part| part.as_os_str() == "..") => None,
        _ => Some(path),
    }
}

/// An `<include>` element with its URI.
struct Include<'a> {
    element: &'a Element,
    uri: &'a str,
    /// Location of the URI in the file.
    place: &'a Place,
    /// Open files; the last one contains the element.
    open: &'a [PathBuf],
}

impl Include<'_> {
    /// Reads the model from the file at `path`; `None` after an error.
    fn model(&self, files: &Files, path: &Path) -> Option<(Box<Element>, Source)> {
        let real = |path: &Path| path.canonicalize().ok();
        let is_open = |other: &PathBuf| real(other).is_some_and(|other| real(path) == Some(other));
        if self.open.iter().any(is_open) {
            let message = format!("`{}` includes itself", self.uri);
            files.report(self.place, message, "remove one of the includes");
            return None;
        }
        if files.count() > FILES {
            let message = format!("more than {FILES} files are included, counting repetitions");
            files.report(self.place, message, "describe the robot in fewer files");
            return None;
        }
        let file = files.read(path, Some(self.place))?;
        let mut root = xml::parse(files, file)?;
        keep_honoured(files, &SDF, &mut root);
        bounds::check_elements(files, &root)?;
        let version = version(files, &root)?;
        let mut models = root.all("model");
        let (Some(model), None) = (models.next(), models.next()) else {
            let message = "an included file has one <model>";
            files.report(&root.place, message, "put one model into a file");
            return None;
        };
        let source = Source {
            version,
            from: Some(path.to_owned()),
            is_merged: attribute_flag(files, self.element, "merge"),
        };
        Some((Box::new(changed(model.clone(), self.element)), source))
    }
}

/// Applies the name, pose and other overrides of the `<include>` to the model.
fn changed(mut model: Element, include: &Element) -> Element {
    if let Some((name, place)) = text(include, "name") {
        model.attributes.retain(|(key, ..)| key != "name");
        let own = ("name".to_owned(), name.to_owned(), place.clone());
        model.attributes.push(own);
    }
    if let Some((frame, place)) = text(include, "placement_frame") {
        model
            .attributes
            .retain(|(key, ..)| key != "placement_frame");
        let own = (
            "placement_frame".to_owned(),
            frame.to_owned(),
            place.clone(),
        );
        model.attributes.push(own);
    }
    for tag in ["pose", "static"] {
        if let Some(own) = include.child(tag) {
            model.children.retain(|child| child.name != tag);
            model.children.push(own.clone());
        }
    }
    let plugins = include.all("plugin").cloned();
    model.children.extend(plugins);
    model.place = include.place.clone();
    model
}
