//! What an identification is told as: a [`summary()`] and tables for a [`terminal`], a page for a browser
//! ([`page()`]), and a flat table of all numbers ([`numbers()`]).
//!
//! The page is one file that needs nothing from elsewhere: plots are SVG within it, its style follows
//! the reader's choice of light or dark, and there is no script. Its sections are in files of their
//! own in [`page()`]; the plots' axes and lines are in the module `plot`.

pub mod beside;
mod choice;
mod intervals;
mod judgement;
pub mod layout;
pub mod numbers;
pub mod page;
mod parameters_file;
mod plot;
pub mod published;
mod sheet;
pub mod summary;
pub mod terminal;
mod text;
pub mod units;
mod whole;

pub use beside::beside;
pub use numbers::numbers;
pub use page::{Attachment, Contents, page};
pub use parameters_file::parameters_file;
pub use published::Published;
pub use sheet::{Plot, sheet};
pub use summary::{Extent, summary};
pub use terminal::{base_parameters, coefficient, cross_validation, estimate, tables};
pub use units::Units;
pub use whole::{About, document, document_with_figures, whole_page};
