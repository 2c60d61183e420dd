//! Prior values of the standard parameters.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// Prior values of the standard parameters, for directions that the data leave open.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Prior {
    /// Values by name (SI units), for instance from CAD.
    ///
    /// A named body needs its mass. Missing second moments are those of `uniform`, scaled to the
    /// mass.
    pub values: BTreeMap<String, f64>,
    /// Inertial parameters by name of uniform bodies with a common density, which is estimated.
    ///
    /// A missing body is a small ball at the origin of its frame.
    pub uniform: BTreeMap<String, f64>,
    /// Smallest and largest value by name (SI units), of masses, friction and rotor inertias.
    pub bounds: BTreeMap<String, [f64; 2]>,
    /// Parameters that are held at these values (SI units), by name.
    ///
    /// Their torque is subtracted from the measured one, and they are not estimated.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub held: BTreeMap<String, f64>,
}
