//! Expands the includes of a file.

use super::keyframe::{self, Keyframe};
use crate::{
    account::MJCF,
    files::Files,
    prune::keep_honoured,
    xml::{self, Element},
};
use std::path::{Component, Path, PathBuf};

/// Largest depth of nested includes.
const DEPTH: usize = 30;
/// Largest number of files; a file counts as often as it is included.
const FILES: usize = 500;

/// File with its includes, as one element, and its keyframe; `None` after an error.
///
/// Unless `may_leave`, included files must be in the file's folder or below.
pub(super) fn whole(
    files: &Files,
    file: usize,
    may_leave: bool,
) -> Option<(Element, Option<Keyframe>)> {
    let mut root = xml::parse(files, file)?;
    let folder = Folder {
        path: files.folder(file),
        may_leave,
    };
    let mut open = vec![files.path(file)];
    expand(files, &mut root, &folder, &mut open, 0)?;
    let keyframe = keyframe::positions(&root);
    keep_honoured(files, &MJCF, &mut root);
    files.is_clean().then_some((root, keyframe))
}

/// Folder of the first file.
struct Folder {
    path: PathBuf,
    /// Whether files outside it may be included.
    may_leave: bool,
}

impl Folder {
    /// Path of an included file.
    ///
    /// As in MuJoCo it is relative to the first file, otherwise to the file that includes it.
    fn find(&self, name: &str, open: &[PathBuf]) -> PathBuf {
        let path = self.path.join(name);
        let around = open.last().and_then(|file| file.parent());
        let near = around.map(|folder| folder.join(name));
        match near {
            Some(near) if !path.exists() && near.exists() => near,
            _ => path,
        }
    }

    /// Whether a name means a file in the folder or below, also after symbolic links.
    fn contains(&self, name: &str, path: &Path) -> bool {
        let mut components = Path::new(name).components();
        let is_plain =
            components.all(|part| matches!(part, Component::Normal(_) | Component::CurDir));
        let own = if self.path.as_os_str().is_empty() {
            Path::new(".").canonicalize()
        } else {
            self.path.canonicalize()
        };
        match (own, path.canonicalize()) {
            (Ok(own), Ok(path)) => path.starts_with(own),
            // A missing file is reported when it is opened.
            _ => is_plain,
        }
    }
}

/// Replaces includes by the elements of the included files; `depth` is the element's depth.
fn expand(
    files: &Files,
    of: &mut Element,
    folder: &Folder,
    open: &mut Vec<PathBuf>,
    depth: usize,
) -> Option<()> {
    if depth > xml::DEPTH {
        xml::too_deep(files, &of.place);
        return None;
    }
    let mut children = Vec::with_capacity(of.children.len());
    for mut child in std::mem::take(&mut of.children) {
        if child.name != "include" {
            expand(files, &mut child, folder, open, depth + 1)?;
            children.push(child);
            continue;
        }
        let Some((name, place)) = child.attribute("file") else {
            files.report(&child.place, "<include> names no file", "write file=\"…\"");
            continue;
        };
        let path = folder.find(name, open);
        let same = |other: &PathBuf| match (path.canonicalize(), other.canonicalize()) {
            (Ok(a), Ok(b)) => a == b,
            _ => *other == path,
        };
        let problem = if !folder.may_leave && !folder.contains(name, &path) {
            let message = format!("`{name}` is outside the folder of the file and is not read");
            let help = "copy it into the folder, or give `--include-outside` if you trust the file";
            Some((message, help))
        } else if open.iter().any(same) {
            Some((
                format!("`{name}` includes itself"),
                "remove one of the includes",
            ))
        } else if open.len() > DEPTH {
            let message = format!("includes are nested more than {DEPTH} deep");
            Some((message, "describe the robot in fewer files"))
        } else if files.count() > FILES {
            let message = format!("more than {FILES} files are included, counting repetitions");
            Some((message, "include each file once, or use fewer files"))
        } else {
            None
        };
        if let Some((message, help)) = problem {
            files.report(place, message, help);
            return None;
        }
        let Some(file) = files.read(&path, Some(place)) else {
            continue;
        };
        let Some(mut included) = xml::parse(files, file) else {
            if files.elements_left() == 0 {
                return None;
            }
            continue;
        };
        open.push(path);
        expand(files, &mut included, folder, open, depth)?;
        open.pop();
        children.append(&mut included.children);
    }
    of.children = children;
    Some(())
}
