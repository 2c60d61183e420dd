//! What a pass over the beginning of a run needs.

use overact::Model;

use super::sections::Frame;
use crate::{
    data::Variant,
    regression::{columns::ColumnSet, projection::ModelKind},
    settings::Settings,
};

/// What a pass needs.
pub(super) struct Pass<'a> {
    pub(super) model: &'a dyn Model,
    pub(super) variants: &'a [Variant<'a>],
    pub(super) columns: &'a ColumnSet,
    pub(super) base: &'a [usize],
    /// Places of the columns of dry friction among the base parameters.
    pub(super) friction: &'a [usize],
    pub(super) kind: ModelKind,
    pub(super) frame: Frame<'a>,
    /// One sample in so many is kept.
    pub(super) decimation: usize,
    pub(super) settings: &'a Settings,
}

impl Pass<'_> {
    /// Columns of a row: the base parameters', Y, the suspects' of one column each, the payload's.
    pub(super) fn width(&self) -> usize {
        self.frame.layout.decimated + 1
    }
}
