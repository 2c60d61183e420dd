//! What is believed of the standard parameters before the data speak.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// What is believed of the standard parameters before the data speak: it fills in what these leave open.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Prior {
    /// Values by name (SI units), from CAD for instance. A body that is named needs its mass; second moments
    /// that are missing are those of `uniform`, scaled to the mass.
    pub values: BTreeMap<String, f64>,
    /// Inertial parameters by name of bodies that are filled uniformly, all of one density, which is found
    /// from the data; a body that is missing here is a small ball at the origin of its frame.
    pub uniform: BTreeMap<String, f64>,
    /// Smallest and largest value by name (SI units), of masses and of coefficients of friction and rotors.
    pub bounds: BTreeMap<String, [f64; 2]>,
}
