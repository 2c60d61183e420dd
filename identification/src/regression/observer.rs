//! Options of the observation of runs.

use overact::Model;

use super::{columns::ColumnSet, projection::Projection};
use crate::settings::Settings;

/// Options of the observation, the same for all runs.
pub(crate) struct Observer<'a> {
    pub(crate) model: &'a dyn Model,
    pub(crate) columns: &'a ColumnSet,
    /// Columns of the base parameters.
    pub(crate) base: &'a [usize],
    pub(crate) projections: &'a [Projection],
    pub(crate) settings: &'a Settings,
}

/// Conditioning of the kept actuators.
#[derive(Clone, Copy)]
pub(super) struct Conditioning<'a> {
    /// Scales of the platform's coordinates.
    pub(super) scales: &'a [f64],
    /// Whether chunks contain the conditions.
    pub(super) is_recorded: bool,
}
