//! Other people's descriptions of robots, made into descriptions of overact.
//!
//! | stage | from | to |
//! |---|---|---|
//! | `mjcf`, `urdf` | a file, with those that it includes | bodies, joints and closures (`model`) |
//! | `assembly` | the model | a closed configuration, a skeleton and chains |
//! | `frames` | axes in space | modified Denavit-Hartenberg constants |
//! | `writing` | all of it | TOML with a comment at each choice |

mod assembly;
mod files;
mod frames;
mod geometry;
mod import;
mod mjcf;
mod model;
mod options;
mod plan;
mod urdf;
mod writing;
mod xml;

pub use files::Errors;
pub use import::{Imported, import};
pub use options::Options;
