//! Import of robots from MJCF, URDF, SDFormat and .par, and export of identified parameters.
//!
//! ```
//! use overact_interchange::{Options, import};
//!
//! let file = std::env::temp_dir().join("overact-interchange-pendulum.xml");
//! std::fs::write(&file, r#"
//! <mujoco model="pendulum">
//!   <worldbody>
//!     <body name="arm">
//!       <joint name="swing" axis="0 1 0"/>
//!       <inertial pos="0 0 -0.2" mass="1.5" diaginertia="0.02 0.02 0.001"/>
//!     </body>
//!   </worldbody>
//!   <actuator><motor joint="swing"/></actuator>
//! </mujoco>"#)?;
//! let imported = import(&file, &Options::default()).expect("a readable file");
//! assert!(imported.text.contains("actuated = true")); // a description in TOML
//! assert!(imported.account.reported.is_empty()); // nothing was left out
//! # Ok::<(), std::io::Error>(())
//! ```
//!
//! Call [`import()`] first; [`export()`] writes identified parameters back into the file.
//!
//! | stage | from | to |
//! |---|---|---|
//! | `mjcf`, `urdf`, `sdf`, `par` | a file, with those that it includes | bodies, joints and closures (`model`) |
//! | `account` | elements and attributes | what is honoured, ignored, reported or rejected |
//! | `bounds` | the model | the model, if its numbers are plausible |
//! | `assembly` | the model | a closed configuration, a skeleton and chains |
//! | `frames` | axes in space | modified Denavit-Hartenberg constants |
//! | `experiment` | the closed robot | motions within its joint limits |
//! | `writing` | the results of the other stages | TOML with a comment at each choice |
//! | `origins` | errors of the description | errors of the file |
//! | `export` | the file and parameters | the file with these parameters |
//! | `serial` | a tree of bodies | MJCF or URDF |

mod account;
#[cfg(test)]
mod agreement;
mod assembly;
mod bounds;
mod choices;
mod couplings;
mod experiment;
mod export;
mod files;
mod format;
mod frames;
mod geometry;
mod import;
mod listing;
mod mjcf;
mod model;
mod motors;
mod options;
mod origins;
mod par;
mod plan;
mod prune;
mod sdf;
mod serial;
mod unsupported;
mod urdf;
mod writing;
mod xml;

pub use account::{Account, Entry};
pub use export::{Exported, export};
pub use files::Errors;
pub use format::Format;
pub use import::{ClosureMisfit, Imported, import};
pub use options::Options;
pub use serial::{SerialBody, SerialTree, write_serial};
