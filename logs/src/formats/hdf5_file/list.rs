//! Lists the datasets of a file, including those in groups.

use std::{fs::File, io::Read, path::Path};

use hdf5_reader::{
    Dataset, Hdf5File,
    error::{Error, Result},
};

/// Largest depth of groups, and largest numbers of groups and datasets.
pub(super) const DEEPEST: usize = 16;
const MOST_GROUPS: usize = 1000;
pub(super) const MOST_DATASETS: usize = 20_000;

/// Whether MATLAB wrote a file; it starts with that text.
pub(super) fn is_matlab(path: &Path) -> bool {
    let mut beginning = [0; 6];
    let read = File::open(path).and_then(|mut input| input.read_exact(&mut beginning));
    read.is_ok() && beginning == *b"MATLAB"
}

/// The error of too many datasets.
pub(super) fn too_many() -> Error {
    Error::InvalidData(format!("it has more than {MOST_DATASETS} datasets"))
}

/// All datasets with their paths, joined by points.
///
/// # Errors
/// A description of the defect.
pub(super) fn datasets(file: &Hdf5File) -> Result<Vec<(String, Dataset)>> {
    let mut found = Vec::new();
    let mut seen = Vec::new();
    let mut groups = vec![(file.root_group()?, String::new(), 0)];
    while let Some((group, path, depth)) = groups.pop() {
        // A group may be a member of itself.
        if seen.contains(&group.address()) || depth > DEEPEST {
            continue;
        }
        seen.push(group.address());
        if seen.len() > MOST_GROUPS {
            return Err(Error::InvalidData(format!(
                "it has more than {MOST_GROUPS} groups"
            )));
        }
        let (inner, datasets) = group.members()?;
        for dataset in datasets {
            if found.len() >= MOST_DATASETS {
                return Err(too_many());
            }
            found.push((format!("{path}{}", dataset.name()), dataset));
        }
        // MATLAB's internal groups: contents of cells, classes.
        let inner = inner.into_iter().filter(|own| !own.name().starts_with('#'));
        groups.extend(inner.map(|own| {
            let path = format!("{path}{}.", own.name());
            (own, path, depth + 1)
        }));
    }
    found.sort_by(|a, b| a.0.cmp(&b.0));
    Ok(found)
}
