//! Parameters as the functions of a model take them.

use serde::Serialize;

/// What a base parameter is that the functions of the robot's model take.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FunctionParameter {
    /// Its name in the table of the functions' base parameters.
    pub name: String,
    /// Its value that the base estimate gives, SI.
    pub value: f64,
}
