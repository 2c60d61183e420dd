//! HDF5 files, including MATLAB's `.mat` files of version 7.3.
//!
//! Vectors and columns of matrices are named by the path of their dataset. They are read block by
//! block, so large files stay on disk. MATLAB orders the dimensions of a matrix differently from
//! HDF5; columns are named as MATLAB shows them.

mod list;
mod number;
mod references;
mod rows;
mod series;

use overact::Code;
use std::path::Path;

use hdf5_reader::{FileStorage, Hdf5File, OpenOptions};

use self::{
    references::Expanded,
    rows::{Rows, Wanted},
    series::{Series, broken},
};
use crate::{
    error::{Error, Problem},
    formats::arrays::ambiguous,
    formats::table_file::{RowReader, TableFile},
    problems::{Existing, shown, unreadable},
};

/// Largest sizes of a dataset's chunk, of one read, and of the chunk cache.
const LARGEST_CHUNK: usize = 64 << 20;
const LARGEST_READ: usize = 64 << 20;
const KEPT: usize = 64 << 20;

/// Largest size of the header of a dataset or group.
const LARGEST_DESCRIPTION: usize = 1 << 20;

/// A file and its datasets.
#[derive(Debug)]
pub(crate) struct Hdf5 {
    /// The file as the caller named it.
    file: String,
    series: Vec<Series>,
    /// Texts that name a dataset, with its path.
    labels: Vec<(String, String)>,
    /// Number of all vectors and matrix columns.
    columns: usize,
    /// Scalars.
    variables: Vec<(String, [f64; 1])>,
    bytes: u64,
}

impl Hdf5 {
    /// Opens a file and lists its datasets.
    ///
    /// # Errors
    /// A file that cannot be read, is truncated or broken.
    pub(crate) fn open(file: String, path: &Path) -> Result<Self, Error> {
        let bytes = std::fs::metadata(path)
            .map_err(|error| unreadable(&file, &error))?
            .len();
        let input = std::fs::File::open(path).map_err(|error| unreadable(&file, &error))?;
        let broken = |error: hdf5_reader::error::Error| broken(&file, &error.to_string());
        let options = OpenOptions {
            chunk_cache_bytes: KEPT,
            max_chunk_bytes: LARGEST_CHUNK,
            max_read_bytes: LARGEST_READ,
            max_object_header_bytes: LARGEST_DESCRIPTION,
            ..OpenOptions::default()
        };
        let storage = FileStorage::from_file(input).map_err(broken)?;
        let opened = Hdf5File::from_storage_with_options(std::sync::Arc::new(storage), options);
        let opened = opened.map_err(broken)?;
        let is_matlab = list::is_matlab(path);
        let datasets = list::datasets(&opened).map_err(broken)?;
        let expanded = if is_matlab {
            references::expand(&opened, datasets).map_err(broken)?
        } else {
            Expanded {
                datasets,
                ..Expanded::default()
            }
        };
        let mut series: Vec<Series> = { expanded.datasets.into_iter() }
            .map(|(name, dataset)| Series::new(name, dataset, is_matlab))
            .collect();
        let mut columns = 0_usize;
        for own in &mut series {
            own.first = columns;
            columns = columns.saturating_add(own.count);
        }
        let mut variables = Vec::new();
        for own in series
            .iter()
            .filter(|own| own.samples == 1 && own.count == 1 && own.unfit.is_none())
        {
            let value = rows::single(&own.dataset).map_err(broken)?;
            variables.extend(value.map(|value| (own.name.clone(), [value])));
        }
        Ok(Self {
            file,
            series,
            labels: expanded.labels,
            columns,
            variables,
            bytes,
        })
    }

    /// Dataset of a column, and index of the column in it.
    fn series(&self, place: usize) -> Option<(usize, usize)> {
        let series = self
            .series
            .iter()
            .position(|own| place >= own.first && place - own.first < own.count)?;
        Some((series, place - self.series[series].first))
    }

    /// Index of a vector, or of a column of a matrix.
    fn named(&self, name: &str) -> Result<Option<usize>, Problem> {
        let bare: String = name.chars().filter(|c| !c.is_whitespace()).collect();
        let bare = bare.trim_start_matches('/');
        let (path, part) = match bare.rfind('(').filter(|_| bare.ends_with(')')) {
            Some(start) => bare.split_at(start),
            None => (bare, ""),
        };
        let path = path.replace('/', ".");
        // A structure `s` is `s(1)` as well.
        let single = path.replace("(1).", ".");
        let is = |own: &&Series, path: &str| own.name == path;
        let path = if self.series.iter().any(|own| is(&own, &path)) {
            path
        } else {
            single
        };
        let mut named = self.series.iter().filter(|own| is(own, &path));
        let Some(first) = named.next() else {
            return Ok(None);
        };
        if named.next().is_some() {
            let message = format!(
                "the file has several datasets that are called `{}` with points between names",
                shown(&path)
            );
            return Err(Problem::new(Code::SAME_COLUMN, message)
                .file(self.file.as_str())
                .column(name));
        }
        Ok(first.part(part).map(|part| first.first + part))
    }
}

impl TableFile for Hdf5 {
    fn file(&self) -> &str {
        &self.file
    }

    fn what(&self) -> &'static str {
        "an HDF5 file"
    }

    fn columns(&self) -> usize {
        self.columns
    }

    fn find(&self, name: &str) -> Result<Option<usize>, Problem> {
        if let Some(place) = self.named(name)? {
            return Ok(Some(place));
        }
        let index = name.rfind('(').filter(|_| name.ends_with(')'));
        let (label, column) = name.split_at(index.unwrap_or(name.len()));
        for (label, column) in [(name, ""), (label.trim(), column)] {
            let own = self.labels.iter().filter(|(own, _)| own == label);
            let paths: Vec<&str> = own.map(|(_, path)| path.as_str()).collect();
            match paths[..] {
                [] => {}
                [path] => return self.named(&format!("{path}{column}")),
                [first, second, ..] => {
                    return Err(ambiguous(&self.file, name, label, [first, second]));
                }
            }
        }
        Ok(None)
    }

    fn check(&self, place: usize) -> Result<(), Problem> {
        let series = self.series(place).map(|(series, _)| &self.series[series]);
        let Some((series, what)) = series.and_then(|own| Some((own, own.unfit?))) else {
            return Ok(());
        };
        let message = format!("`{}` {what}", shown(&series.name));
        let problem = Problem::new(Code::LOG_FORMAT, message)
            .file(self.file.as_str())
            .column(series.name.as_str());
        Err(problem.help("store vectors of numbers, or a matrix with a column for each actuator"))
    }

    fn variable(&self, name: &str) -> Option<&[f64]> {
        let path = name.trim_start_matches('/').replace('/', ".");
        let mut variables = self.variables.iter();
        let found = variables.find(|(own, _)| *own == path);
        found.map(|(_, value)| value.as_slice())
    }

    fn has_variables(&self) -> bool {
        true
    }

    fn first_column(&self, name: &str) -> Option<&str> {
        let mut labels = self.labels.iter();
        let labelled = labels.find_map(|(own, path)| (own == name).then_some(path));
        let path = match labelled {
            Some(path) => path.clone(),
            None => name.trim_start_matches('/').replace('/', "."),
        };
        let series = self.series.iter().find(|own| own.name == path);
        series.and_then(|own| own.first_column.as_deref())
    }

    fn existing(&self) -> Existing<'_> {
        Existing {
            names: { self.series.iter().map(|own| own.name.as_str()) }
                .chain(self.labels.iter().map(|(label, _)| label.as_str()))
                .collect(),
            columns: self.columns,
            what: "dataset",
        }
    }

    fn rows<'a>(&'a self, wanted: &[(usize, &'a str)]) -> Result<Box<dyn RowReader + 'a>, Error> {
        let wanted = wanted.iter().filter_map(|&(place, name)| {
            let (series, part) = self.series(place)?;
            Some(Wanted { series, part, name })
        });
        let wanted: Vec<Wanted<'_>> = wanted.collect();
        let mut problems = Vec::new();
        if let Some((first, others)) = wanted.split_first() {
            let count = self.series[first.series].samples;
            for own in others
                .iter()
                .filter(|own| self.series[own.series].samples != count)
            {
                let message = format!(
                    "`{}` has {} samples, but `{}` has {count}",
                    shown(own.name),
                    self.series[own.series].samples,
                    shown(first.name)
                );
                problems.push(
                    Problem::new(Code::LOG_SHAPE, message)
                        .file(self.file.as_str())
                        .column(own.name),
                );
            }
        }
        Error::check(problems)?;
        let rows = Rows::new(&self.file, self.bytes, &self.series, wanted);
        Ok(Box::new(rows))
    }
}
