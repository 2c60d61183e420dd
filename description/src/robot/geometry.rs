//! Points, orientations and placements.

use crate::expressions::dimension::Dimension;
use crate::robot::model::Placement;
use crate::toml_text::reader::Item;
use crate::toml_text::scope::Scope;
use overact_exact::{Angle, Number};

impl Item<'_, '_> {
    /// Three numbers of one dimension.
    pub(crate) fn vector(&self, dimension: Dimension, scope: &Scope) -> Option<[Number; 3]> {
        // All three are evaluated before the first failure returns.
        let [x, y, z] = self.triple()?.map(|item| item.number(dimension, scope));
        Some([x?.value, y?.value, z?.value])
    }

    /// The angles rx, ry, rz.
    pub(crate) fn angles(&self, scope: &Scope) -> Option<[Angle; 3]> {
        let [x, y, z] = self.triple()?.map(|item| item.angle(scope));
        Some([x?.value, y?.value, z?.value])
    }
}

/// A placement with optional position and orientation.
pub(crate) fn placement(
    at: Option<&Item<'_, '_>>,
    rotation: Option<&Item<'_, '_>>,
    scope: &Scope,
) -> Placement {
    let at = at.and_then(|item| item.vector(Dimension::LENGTH, scope));
    let rotation = rotation.and_then(|item| item.angles(scope));
    Placement {
        at: at.unwrap_or([Number::ZERO; 3]),
        rotation: rotation.unwrap_or([Angle::ZERO; 3]),
    }
}
