//! Parameters of a model's functions.

use serde::Serialize;

use super::regrouping::Regrouping;

/// A base parameter of the functions of the robot's model.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FunctionParameter {
    /// Name in the table of the functions' base parameters.
    ///
    /// If an estimated base parameter of this name is another combination, the suffix is `F`
    /// instead of `R`.
    pub name: String,
    /// Name of the kept parameter.
    pub parameter: String,
    /// Terms added to the kept parameter.
    pub regrouping: Vec<Regrouping>,
    /// Value from the base estimate (SI units).
    pub value: f64,
}
