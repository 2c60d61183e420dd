//! What was identified, as the functions of the robot's model take it.

use overact_codegen::RobotModel;
use overact_identification::{Estimate, Estimator, FunctionParameter, Identification, Stage};
use std::collections::BTreeMap;

/// The base estimate of the first model in the base parameters of the functions, the payload's behind them.
///
/// Both are sums of standard parameters that give the same torques. So the standard parameters that are kept in
/// the estimate's sums, with the estimate's values and all others zero, give the functions' sums. Nothing is told
/// where the estimate has parameters that the functions do not know, as friction by direction.
pub(crate) fn functions_base(model: &RobotModel, found: &Identification) -> Vec<FunctionParameter> {
    let base =
        |one: &&Estimate| one.stage == Stage::Base && one.estimator == Estimator::LeastSquares;
    let Some(estimate) = found.estimates.iter().find(base) else {
        return Vec::new();
    };
    let value = |name: &str| {
        let own = estimate.parameters.iter().find(|one| one.name == name);
        own.map(|one| one.value)
    };
    let kept = found.base_parameters.iter();
    let kept: BTreeMap<String, f64> = kept
        .filter_map(|one| Some((one.parameter.clone(), value(&one.name)?)))
        .collect();
    let selection = &model.selection;
    let known: Vec<String> = (selection.standard.iter().chain(&selection.payload))
        .map(|&parameter| model.parameter_name(parameter))
        .collect();
    if !kept.keys().all(|name| known.contains(name)) {
        return Vec::new();
    }
    let named = |(parameter, value)| {
        let base = model.base.iter().find(|base| base.parameter == parameter);
        let name = match base {
            Some(base) => model.base_name(base),
            None => model.parameter_name(parameter),
        };
        FunctionParameter { name, value }
    };
    model.regrouped(&kept).into_iter().map(named).collect()
}
