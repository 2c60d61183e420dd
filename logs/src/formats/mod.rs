//! Readers of file formats. Each reads a file as a table of columns.
//!
//! - `format`: table of all formats, and recognition from the first bytes;
//! - `table`: a file of any format;
//! - `text`, `json_lines`, `mat_file`, `numpy`, `parquet_file`, `hdf5_file`, `mcap_file`: one format
//!   each;
//! - `instant`: dates and times of day as texts;
//! - `table_file`: interface of a format;
//! - `row_range`: some rows of a table;
//! - `arrays`: formats that are read as a whole.

mod archive;
pub(crate) mod arrays;
pub(crate) mod format;
#[cfg(feature = "hdf5")]
mod hdf5_file;
mod instant;
mod json_lines;
mod mat_file;
#[cfg(feature = "mcap")]
mod mcap_file;
mod numpy;
pub(crate) mod parquet_file;
pub(crate) mod row_range;
mod structures;
pub(crate) mod table;
pub(crate) mod table_file;
mod text;
