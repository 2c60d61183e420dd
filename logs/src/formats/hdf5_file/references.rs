//! Arrays of structures and cell arrays of MATLAB 7.3, which store references to their items.
//!
//! The items are in the group `#refs#`. A field of an array of structures is a dataset of
//! references, one per structure. Its items are named as in files of older versions:
//! `out.signals(2).values`, and `runs{2}.q` in a cell array.

use std::collections::HashMap;

use hdf5_reader::{Dataset, Datatype, Hdf5File, error::Result, group::Group, reference};

use super::list::{DEEPEST, MOST_DATASETS, too_many};

/// Fields with the name of a signal, and with its values.
const LABELS: [&str; 2] = ["name", "label"];
const VALUES: [&str; 2] = ["data", "values"];

/// Longest text that names a signal.
const LONGEST_LABEL: u64 = 4096;

/// Datasets of a file with their paths, and texts that name some of them.
#[derive(Default)]
pub(super) struct Expanded {
    pub(super) datasets: Vec<(String, Dataset)>,
    /// Text and path.
    pub(super) labels: Vec<(String, String)>,
}

/// Replaces datasets of references by the datasets to which they refer.
///
/// # Errors
/// A description of the defect.
pub(super) fn expand(file: &Hdf5File, listed: Vec<(String, Dataset)>) -> Result<Expanded> {
    let is_reference =
        |(_, dataset): &(String, Dataset)| matches!(dataset.dtype(), Datatype::Reference { .. });
    let mut expanded = Expanded::default();
    if !listed.iter().any(is_reference) {
        expanded.datasets = listed;
        return Ok(expanded);
    }
    let items = Items::of(file)?;
    let mut labels = Vec::new();
    for (path, dataset) in listed {
        items.add(path, dataset, 0, &mut expanded, &mut labels)?;
    }
    for (owner, text) in labels {
        let is_own = |path: &&str| {
            let field = path.strip_prefix(owner.as_str());
            field.is_some_and(|field| VALUES.iter().any(|own| field.eq_ignore_ascii_case(own)))
        };
        let paths = expanded.datasets.iter().map(|(path, _)| path.as_str());
        let own = paths
            .filter(is_own)
            .map(|path| (text.clone(), path.to_owned()));
        let own: Vec<_> = own.collect();
        expanded.labels.extend(own);
    }
    Ok(expanded)
}

/// Items to which references of a file refer, by address.
#[derive(Default)]
struct Items {
    datasets: HashMap<u64, Dataset>,
    groups: HashMap<u64, Group>,
}

impl Items {
    fn of(file: &Hdf5File) -> Result<Self> {
        let root = file.root_group()?;
        let mut groups = root.groups()?.into_iter();
        let Some(items) = groups.find(|own| own.name() == "#refs#") else {
            return Ok(Self::default());
        };
        let (groups, datasets) = items.members()?;
        let datasets = datasets.into_iter().map(|own| (own.address(), own));
        let groups = groups.into_iter().map(|own| (own.address(), own));
        Ok(Self {
            datasets: datasets.collect(),
            groups: groups.collect(),
        })
    }

    /// Adds a dataset, or the items to which it refers.
    ///
    /// A label is added with the path of its structure, which ends with a point.
    fn add(
        &self,
        path: String,
        dataset: Dataset,
        depth: usize,
        expanded: &mut Expanded,
        labels: &mut Vec<(String, String)>,
    ) -> Result<()> {
        if expanded.datasets.len() >= MOST_DATASETS {
            return Err(too_many());
        }
        let fields = path.rsplit_once('.');
        if let Some((owner, field)) = fields
            && LABELS.iter().any(|own| field.eq_ignore_ascii_case(own))
            && let Some(text) = text(&dataset)
        {
            labels.push((format!("{owner}."), text));
        }
        let Datatype::Reference { size, .. } = dataset.dtype() else {
            expanded.datasets.push((path, dataset));
            return Ok(());
        };
        let count = dataset.num_elements()?;
        if count > MOST_DATASETS as u64 {
            return Err(too_many());
        }
        let places = reference::read_object_references(&dataset.read_raw_bytes()?, *size)?;
        let is_cell = class(&dataset).as_deref() == Some("cell");
        let mut has_any = false;
        for (place, address) in (1..).zip(&places) {
            let own = match fields {
                _ if is_cell => format!("{path}{{{place}}}"),
                Some((owner, field)) => format!("{owner}({place}).{field}"),
                None => format!("{path}({place})"),
            };
            if let Some(item) = self.datasets.get(address) {
                has_any = true;
                if depth < DEEPEST {
                    self.add(own, item.clone(), depth + 1, expanded, labels)?;
                }
            } else if let Some(group) = self.groups.get(address) {
                has_any = true;
                self.fields(&format!("{own}."), group, depth + 1, expanded, labels)?;
            }
        }
        if !has_any {
            // References of other programs than MATLAB: reported if the dataset is requested.
            expanded.datasets.push((path, dataset));
        }
        Ok(())
    }

    /// Adds the fields of a structure.
    fn fields(
        &self,
        path: &str,
        group: &Group,
        depth: usize,
        expanded: &mut Expanded,
        labels: &mut Vec<(String, String)>,
    ) -> Result<()> {
        if depth >= DEEPEST {
            return Ok(());
        }
        let (inner, datasets) = group.members()?;
        for dataset in datasets {
            let own = format!("{path}{}", dataset.name());
            self.add(own, dataset, depth + 1, expanded, labels)?;
        }
        for group in inner {
            let own = format!("{path}{}.", group.name());
            self.fields(&own, &group, depth + 1, expanded, labels)?;
        }
        Ok(())
    }
}

/// MATLAB's class of a dataset.
fn class(dataset: &Dataset) -> Option<String> {
    dataset.attribute("MATLAB_class").ok()?.read_string().ok()
}

/// A text of one line; `None` if it is empty or no text.
fn text(dataset: &Dataset) -> Option<String> {
    let is_text = class(dataset).as_deref() == Some("char");
    let is_empty = dataset.attribute("MATLAB_empty").is_ok();
    let is_wide = matches!(dataset.dtype(), Datatype::FixedPoint { size: 2, .. });
    let is_line = matches!(*dataset.shape(), [length, 1] if length <= LONGEST_LABEL);
    if !is_text || is_empty || !is_wide || !is_line {
        return None;
    }
    let bytes = dataset.read_native_bytes().ok()?;
    let (units, _) = bytes.as_chunks::<2>();
    let units: Vec<u16> = units.iter().map(|own| u16::from_ne_bytes(*own)).collect();
    let text = String::from_utf16_lossy(&units);
    let text = text.trim();
    (!text.is_empty()).then(|| text.to_owned())
}
