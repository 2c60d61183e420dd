//! Cost of functions, and their programs step by step.

use overact_codegen::{
    RobotModel,
    lowering::{Condition, Operand, Operation, Program},
};
use pyo3::{prelude::*, types::PyDict};

/// Cost of all functions of a model by name, as JSON: single operations, iteration steps and
/// totals.
pub(crate) fn costs(model: &RobotModel) -> serde_json::Value {
    let cost = |function| {
        let whole = model.cost(function);
        serde_json::json!({ "operations": whole.once.operations(), "cost": whole })
    };
    let all = model.functions.iter();
    all.map(|one| (one.name.clone(), cost(one)))
        .collect::<serde_json::Map<_, _>>()
        .into()
}

/// Constant, input element or result of a step: kind, position or array, value or index.
type Term = (&'static str, usize, f64);

fn term(operand: Operand) -> Term {
    match operand {
        Operand::Constant(value) => ("constant", 0, value),
        Operand::Input { array, index } => ("input", array, index as f64),
        Operand::Step(at) => ("step", at, 0.0),
    }
}

const fn operation(operation: &Operation) -> &'static str {
    match operation {
        Operation::Add(..) => "add",
        Operation::Sub(..) => "sub",
        Operation::Mul(..) => "mul",
        Operation::Div(..) => "div",
        Operation::Neg(_) => "neg",
        Operation::Sqrt(_) => "sqrt",
        Operation::Sine(_) => "sin",
        Operation::Cosine(_) => "cos",
        Operation::Sign(_) => "sign",
        Operation::Signed(..) => "signed",
        Operation::Atan2(..) => "atan2",
    }
}

fn condition(condition: &Condition) -> String {
    match condition {
        Condition::Reach { leg, .. } => {
            format!("the pose is in reach of leg {leg}: not negative, nor near zero")
        }
        Condition::Leg { leg, .. } => format!("leg {leg} is regular: not zero"),
        Condition::Platform { actuators, .. } => {
            format!("the {actuators} determine the platform's motion: not zero")
        }
        Condition::Closed { leg, .. } => format!("leg {leg} allows the pose: near zero"),
        Condition::Coordinates { .. } => {
            "the independent coordinates determine the others: not zero".to_owned()
        }
        Condition::Mass => "the mass matrix is positive definite: positive".to_owned(),
        Condition::Size { most } => format!("nothing overflows: a magnitude of at most {most:.1e}"),
    }
}

/// Program as lists: `inputs`, `steps`, `entries`, `guards`, `shape`.
pub(crate) fn steps<'py>(py: Python<'py>, program: &Program) -> PyResult<Bound<'py, PyDict>> {
    let listing = PyDict::new(py);
    let inputs = program.inputs.iter();
    let inputs: Vec<_> = inputs.map(|one| (&one.name, one.len())).collect();
    listing.set_item("inputs", inputs)?;
    let steps = program.steps.iter().map(|step| {
        let operands = step.operation.operands().into_iter();
        let operands: Vec<Term> = operands.map(term).collect();
        (operation(&step.operation), operands, step.name.clone())
    });
    listing.set_item("steps", steps.collect::<Vec<_>>())?;
    let entries = program.entries.iter();
    let entries = entries.map(|entry| (term(entry.operand), entry.negative));
    listing.set_item("entries", entries.collect::<Vec<_>>())?;
    let guards = program.guards.iter();
    let guards = guards.map(|guard| (term(guard.operand), condition(&guard.condition)));
    listing.set_item("guards", guards.collect::<Vec<_>>())?;
    listing.set_item("shape", program.output.shape.clone())?;
    Ok(listing)
}
