//! Tables of the contents that import uses for each format, and the record of an import.

mod ledger;
mod mjcf;
mod par;
mod sdf;
mod table;
#[cfg(test)]
pub(crate) mod trace;
mod urdf;
mod yaml;

pub use ledger::{Account, Entry};
pub(crate) use ledger::{Ledger, Use};
pub(crate) use table::{Index, Rule, Table, Treatment, is_neutral};

pub(crate) use mjcf::TABLE as MJCF;
pub(crate) use par::TABLE as PAR;
pub(crate) use sdf::TABLE as SDF;
pub(crate) use urdf::TABLE as URDF;
pub(crate) use yaml::TABLE as YAML;
