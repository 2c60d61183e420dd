//! Terms of base parameters.

use serde::Serialize;

/// One term of a base parameter.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Regrouping {
    /// Name of the parameter that is regrouped.
    pub parameter: String,
    /// Its coefficient.
    pub coefficient: f64,
}
