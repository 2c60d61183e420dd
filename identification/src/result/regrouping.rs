//! Terms of base parameters.

use serde::Serialize;

/// One term of a base parameter.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Regrouping {
    /// Name of the regrouped parameter.
    pub parameter: String,
    /// Coefficient.
    pub coefficient: f64,
}
