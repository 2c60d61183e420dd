//! Compares all functions of a description with the reference.

use super::conversion::reference;
use super::expected::Expected;
use super::library::workspace;
use super::sample::samples;
use super::{Comparison, Evaluated, Failure, model_with};
use overact::Function;
use overact_codegen::{Choice, Effort, Request, Source};

/// Differences of all functions of a description from the reference that exceed the tolerances.
///
/// The first tolerance is for functions of base parameters, whose regroupings are computed
/// numerically, the second for all others.
///
/// # Errors
///
/// An invalid description, or one without regular states.
pub fn against_reference(
    source: Source,
    states: usize,
    tolerances: [f64; 2],
) -> Result<Vec<String>, Failure> {
    of_functions(source, states, tolerances, None)
}

/// The same for selected functions.
///
/// # Errors
///
/// An invalid description, or one without regular states.
pub fn of_functions(
    source: Source,
    states: usize,
    [of_base, of_others]: [f64; 2],
    functions: Option<&Choice>,
) -> Result<Vec<String>, Failure> {
    let request = Request {
        functions,
        ..Request::with_effort(Effort::None)
    };
    let model = model_with(&source, &request)?;
    let mechanism = reference(&model.mechanism, workspace(&model));
    let mut expected = Expected::by_position(&model, mechanism);
    expected.tolerance_of_derivatives = of_others;
    let parameters = expected.parameters();
    let all = samples(&expected.mechanism, &parameters, states, 7, false)?;
    let truths = all.iter().map(|sample| expected.at(sample));
    let truths = truths.collect::<Result<Vec<_>, Failure>>()?;
    let mut comparisons = [of_base, of_others].map(Comparison::new);
    for function in &model.functions {
        // The closure error only has to vanish; rows of blocked directions are unique up to
        // multiples.
        let is_compared = !matches!(
            function.computes,
            Function::ClosureError | Function::BlockedJacobian | Function::PoseErrorJacobian
        );
        if is_compared {
            let at = usize::from(!function.name.contains("_base"));
            comparisons[at].function(function, &Evaluated(&model), &all, &truths)?;
        }
    }
    let [mut all, others] = comparisons;
    let least = if functions.is_some() { 5 } else { 20 };
    if all.lines.len() + others.lines.len() <= least {
        return Err("hardly a function was compared".into());
    }
    all.failures.extend(others.failures);
    Ok(all.failures)
}
