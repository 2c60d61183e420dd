//! Inputs of a pass over the start of a run.

use overact::Model;

use super::{products::live_columns::AllColumns, sections::Frame};
use crate::{
    regression::{columns::ColumnSet, projection::ModelKind},
    settings::Settings,
};
use overact_logs::Variant;

/// Inputs of a pass.
pub(super) struct Pass<'a> {
    pub(super) model: &'a dyn Model,
    pub(super) variants: &'a [Variant<'a>],
    pub(super) columns: &'a ColumnSet,
    pub(super) base: &'a [usize],
    /// Indices of the dry friction columns among the base parameters.
    pub(super) friction: &'a [usize],
    pub(super) kind: ModelKind,
    pub(super) frame: Frame<'a>,
    /// Decimation factor.
    pub(super) decimation: usize,
    pub(super) settings: &'a Settings,
}

impl Pass<'_> {
    /// Columns of a row: base parameters, Y, one-column hypotheses, payload.
    pub(super) fn width(&self) -> usize {
        self.frame.layout.decimated + 1
    }

    /// All columns of the lines.
    pub(super) fn all_columns(&self) -> AllColumns<'_> {
        AllColumns {
            columns: self.columns,
            base: self.base,
            friction: self.friction,
            hypotheses: self.frame.hypotheses,
            layout: self.frame.layout,
        }
    }
}
