//! Parameters as the functions of a model take them.

use serde::Serialize;

use super::regrouping::Regrouping;

/// What a base parameter is that the functions of the robot's model take.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FunctionParameter {
    /// Its name in the table of the functions' base parameters. Where an estimated base parameter of that name is
    /// another sum, the suffix is `F` in the place of `R`.
    pub name: String,
    /// Name of the kept parameter.
    pub parameter: String,
    /// What is added to the kept parameter.
    pub regrouping: Vec<Regrouping>,
    /// Its value that the base estimate gives, SI.
    pub value: f64,
}
