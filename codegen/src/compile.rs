//! The stages of the generator, in order.

use crate::choice::{Chosen, Missing};
use crate::derivation::{DerivationError, FunctionForm, Selection, inventory, name_in_robot};
use crate::float::Float;
use crate::mechanism::{self, Mechanism};
use crate::model::{CompiledFunction, RobotModel};
use crate::parallel;
use crate::request::{Progress, Request};
use crate::selection::{self, Assembler, Forms, Search};
use overact_description::diagnostic::{Diagnostics, Source};
use overact_description::{Description, Effort};
use std::sync::atomic::{AtomicUsize, Ordering};

/// A description and the model made from it.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Compiled {
    /// The parsed text.
    pub description: Description,
    /// The robot's model.
    pub model: RobotModel,
}

/// Compiles a description's text to a robot's model with all its functions.
///
/// # Errors
/// All errors of the description, each at its location.
pub fn compile(source: &Source) -> Result<Compiled, Diagnostics> {
    compile_with(source, &Request::default())
}

/// Compiles a description's text to the requested parts of a robot's model.
///
/// # Errors
/// All errors of the description, each at its location.
pub fn compile_with(source: &Source, request: &Request<'_>) -> Result<Compiled, Diagnostics> {
    let description = overact_description::parse(source)?;
    let mechanism = mechanism::check(&description)?;
    let effort = request.effort_for(description.effort);
    let model = derived(mechanism, effort, request);
    let model = model.map_err(|error| error.locate(&description))?;
    Ok(Compiled { description, model })
}

/// The model of a checked mechanism.
///
/// # Errors
/// See [`DerivationError`].
pub fn model_with(
    mechanism: Mechanism,
    request: &Request<'_>,
) -> Result<RobotModel, DerivationError> {
    derived(mechanism, request.effort_for(None), request)
}

/// The error for requested functions that are not available.
fn not_offered(missing: Vec<Missing>) -> DerivationError {
    let sentences = missing.into_iter().map(|one| (one.sentence, one.help));
    DerivationError::NotOffered(sentences.collect())
}

/// Checks that the floating-point type can represent the constants of all functions.
fn representable(functions: &[CompiledFunction], float: Float) -> Result<(), DerivationError> {
    for function in functions {
        let mut constants = function.program.constants();
        if let Some(value) = constants.find(|value| !float.holds(*value)) {
            return Err(DerivationError::Unrepresentable {
                function: function.name.clone(),
                value: value.to_string(),
                float: float.name(),
            });
        }
    }
    Ok(())
}

/// The requested functions that the robot has, and the choice.
fn chosen(
    mechanism: &Mechanism,
    selection: &Selection,
    request: &Request<'_>,
) -> Result<(Vec<FunctionForm>, Chosen), DerivationError> {
    let mut offered = inventory(mechanism, selection);
    offered.retain(|form| {
        let function = form.function;
        let has_parameters = function.columns().is_some() || function.is_of_base_parameters();
        selection.values.is_none() || !has_parameters
    });
    let chosen = match request.functions {
        Some(choice) if selection.values.is_some() && choice.columns().is_some() => {
            return Err(not_offered(vec![Missing::of_known_parameters()]));
        }
        Some(choice) => choice
            .of_robot(mechanism, selection.joints, &offered)
            .map_err(not_offered)?,
        None => Chosen::all(&offered),
    };
    offered.retain(|form| {
        let is_wanted = || (request.wanted)(mechanism, form.function, form.from);
        chosen.functions.contains(form) && (request.functions.is_some() || is_wanted())
    });
    Ok((offered, chosen))
}

/// Derives and lowers one function.
fn compiled(
    assembler: &Assembler<'_>,
    request: &Request<'_>,
    form: FunctionForm,
) -> Result<CompiledFunction, DerivationError> {
    let FunctionForm { function, from } = form;
    let program = Forms::new(*assembler, function, from).cheapest()?;
    let lanes = if request.side_by_side && request.float == Float::F64 {
        selection::lane_program(assembler, function, from, &program)
    } else {
        None
    };
    let mechanism = assembler.mechanism;
    let mut compiled = CompiledFunction::new(mechanism, function, from, program, lanes);
    compiled.guard_sizes(mechanism, request.float);
    Ok(compiled)
}

/// Selects form and columns, then derives and lowers one function after the other.
fn derived(
    mechanism: Mechanism,
    effort: Effort,
    request: &Request<'_>,
) -> Result<RobotModel, DerivationError> {
    let tell = |done: usize, functions: usize, work: &str| {
        (request.progress)(Progress {
            mechanism: &mechanism,
            done,
            functions,
            work,
        });
    };
    tell(0, 0, "form and columns of the model");
    let (mut selection, base) = selection::select(&mechanism)?;
    let values = |given| selection::regrouped(&mechanism, &selection, &base, given);
    selection.values = request.parameters.map(values);
    let assembler = Assembler {
        mechanism: &mechanism,
        selection: &selection,
        search: &Search::with(effort, &mechanism),
    };
    let (offered, chosen) = chosen(&mechanism, &selection, request)?;
    let done = AtomicUsize::new(0);
    let functions = parallel::map(&offered, |&form| {
        let name = name_in_robot(&mechanism, form);
        tell(done.load(Ordering::Relaxed), offered.len(), &name);
        let compiled = compiled(&assembler, request, form)?;
        done.fetch_add(1, Ordering::Relaxed);
        Ok(compiled)
    });
    let functions = functions
        .into_iter()
        .collect::<Result<Vec<_>, DerivationError>>()?;
    representable(&functions, request.float)?;
    Ok(RobotModel {
        functions,
        mechanism,
        selection,
        base,
        forward_kinematics: chosen.forward,
        is_model: chosen.is_model,
        float: request.float,
        runtime: request.runtime.cloned().unwrap_or_default(),
    })
}
