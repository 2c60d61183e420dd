//! What was chosen for a robot before its functions are derived: columns, actuators, forms, search.

use super::regressor::BodyParameter;
use super::robot::Formulation;
use crate::cas::Number;
use crate::lowering::Reach;
use crate::mechanism::states::State;

/// What the derivation of a function needs beside the mechanism.
#[derive(Debug, Clone, Default)]
pub struct Selection {
    /// The standard parameters whose columns are not identically zero.
    pub standard: Vec<BodyParameter>,
    /// The independent ones among them.
    pub base: Vec<BodyParameter>,
    /// The payload's parameters whose columns are not identically zero.
    pub payload: Vec<BodyParameter>,
    /// Kept actuators of case 2.
    pub kept_actuators: Vec<usize>,
    /// How the robot is written.
    pub formulation: Formulation,
    /// Dependent columns that are had more cheaply from others than from their definition.
    pub combined: Vec<Combination>,
    /// How far cheaper ways to write a function are searched.
    pub reach: Reach,
    /// Groups of states at which the search compares the digits of forms.
    pub states: Vec<Vec<State>>,
}

/// A column as a linear combination of other columns.
#[derive(Debug, Clone)]
pub struct Combination {
    /// The parameter whose column it is.
    pub parameter: BodyParameter,
    /// The other columns with their coefficients.
    pub of: Vec<(BodyParameter, Number)>,
}

/// How the joints follow from the pose.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum JointsBy {
    /// In closed form, as part of the function.
    Rule,
    /// By Newton's method, before the function is evaluated: joints are an input of the program.
    Newton,
}
