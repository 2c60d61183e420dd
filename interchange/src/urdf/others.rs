//! Finds YAML files near a URDF that are ignored because of their names.

use super::Tree;
use crate::{
    account::Use,
    files::{Files, Place, is_standard_input},
};
use std::path::Path;

/// Size limit of the files that are searched, bytes.
const LARGEST: u64 = 1 << 20;

/// Reports YAML files of other names in the folder that close loops of this robot.
pub(super) fn report(files: &Files, file: usize, tree: &Tree) {
    let path = files.path(file);
    if is_standard_input(&path) {
        return;
    }
    let folder = path.parent().unwrap_or(Path::new(""));
    let here = if folder.as_os_str().is_empty() {
        Path::new(".")
    } else {
        folder
    };
    let listed = std::fs::read_dir(here).into_iter().flatten().flatten();
    let mut names: Vec<std::ffi::OsString> = listed.map(|entry| entry.file_name()).collect();
    names.sort();
    for name in names {
        let other = folder.join(&name);
        let ending = other.extension().and_then(|ending| ending.to_str());
        let is_yaml = matches!(ending, Some("yaml" | "yml"));
        // Opening a pipe may block, and a device may have no end.
        let is_small_file =
            std::fs::metadata(&other).is_ok_and(|found| found.is_file() && found.len() <= LARGEST);
        if !is_yaml || other.file_stem() == path.file_stem() || !is_small_file {
            continue;
        }
        let Ok(text) = std::fs::read_to_string(&other) else {
            continue;
        };
        if closes_loops_of(&text, tree) {
            let place = Place { file, span: 0..1 };
            let expected = path.with_extension("yaml");
            let expected = expected.file_name().unwrap_or_default().to_string_lossy();
            let reason = format!(
                "not read: it closes loops between links of this robot; rename it to `{expected}`"
            );
            let name = name.to_string_lossy();
            files.record(Use::Reported, &place, &name, Some("closed_loop"), &reason);
        }
    }
}

/// Whether a YAML text names links of the robot under `closed_loop`.
fn closes_loops_of(text: &str, tree: &Tree) -> bool {
    let mut lines = text
        .lines()
        .skip_while(|line| !line.starts_with("closed_loop"));
    let Some(first) = lines.next() else {
        return false;
    };
    let is_inside = |line: &&str| line.starts_with([' ', '-', '[', ']']) || line.trim().is_empty();
    let inside = std::iter::once(first.split_once(':').map_or("", |(_, value)| value));
    let mut words = inside
        .chain(lines.take_while(is_inside))
        .flat_map(|line| line.split([' ', ',', '[', ']', '-', '\'', '"']));
    words.any(|word| tree.bodies.contains_key(word))
}
