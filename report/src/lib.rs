//! Reports of an identification for terminal, browser and other programs.
//!
//! There are a [`summary()`] and tables for a [`terminal`], an HTML page ([`page()`]) and a flat
//! table of all numbers ([`numbers()`]).
//!
//! ```
//! use overact_identification::{Error, Identification};
//! use overact_report::{About, Extent, document, summary, whole_page};
//!
//! /// Prints the summary of a result, and returns its page and its numbers as JSON.
//! fn report(result: &Identification, about: &About<'_>) -> Result<(String, String), Error> {
//!     println!("{}", summary(result, None, Extent::Short));
//!     Ok((whole_page(result, about, "robot")?, document(result)?))
//! }
//! ```
//!
//! The page is one self-contained file: plots are embedded SVG, the style follows the reader's
//! choice of light or dark, and there is no script. Each section has a file in [`page()`]; axes and
//! lines of plots are in the module `plot`.

mod chart_sheet;
mod choice;
mod intervals;
mod judgement;
pub mod layout;
mod line_errors;
pub mod numbers;
mod online;
pub mod page;
mod parameters_file;
mod plot;
pub mod published;
pub mod published_comparison;
mod report_bundle;
pub mod summary;
pub mod terminal;
mod text;
pub mod units;

pub use chart_sheet::{Plot, chart_sheet};
pub use judgement::other_warnings;
pub use numbers::numbers;
pub use page::{Attachment, Contents, page};
pub use parameters_file::parameters_file;
pub use published::Published;
pub use published_comparison::compare_with_published;
pub use report_bundle::{About, document, document_with_figures, whole_page};
pub use summary::{Extent, summary};
pub use terminal::{base_parameters, coefficient, cross_validation, estimate, tables, timings};
pub use units::Units;
