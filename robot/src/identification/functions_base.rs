//! Identified parameters as inputs of the generated base-parameter functions.

use overact_codegen::RobotModel;
use overact_identification::{
    BaseParameter, Estimate, Estimator, FunctionParameter, Identification, Regrouping, Stage,
};
use std::collections::BTreeMap;

/// Base estimate of the first model, expressed in the base parameters of the functions.
///
/// The payload's parameters follow the robot's. Both parameter sets are sums of standard parameters
/// that give the same torques. The standard parameters kept in the estimate's sums get the
/// estimated values; all others are zero. These values give the functions' sums. The result is
/// empty if the estimate has parameters that the functions do not have, such as friction by
/// direction.
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
    let kept = kept.filter_map(|one| Some((one.parameter.clone(), value(&one.name)?)));
    let held = found.settings.prior.held.iter();
    let held = held.map(|(name, value)| (name.clone(), *value));
    let kept: BTreeMap<String, f64> = kept.chain(held).collect();
    let selection = &model.selection;
    let known: Vec<String> = (selection.standard.iter().chain(&selection.payload))
        .map(|&parameter| model.parameter_name(parameter))
        .collect();
    if !kept.keys().all(|name| known.contains(name)) {
        return Vec::new();
    }
    let named = |(parameter, value)| {
        let base = model.base.iter().find(|base| base.parameter == parameter);
        let terms = base.map_or(&[][..], |base| base.regrouped.as_slice());
        let regrouping = terms.iter().map(|&(other, coefficient)| Regrouping {
            parameter: model.parameter_name(other),
            coefficient,
        });
        let own = FunctionParameter {
            name: match base {
                Some(base) => model.base_name(base),
                None => model.parameter_name(parameter),
            },
            parameter: model.parameter_name(parameter),
            regrouping: regrouping.collect(),
            value,
        };
        distinct(own, &found.base_parameters)
    };
    model.regrouped(&kept).into_iter().map(named).collect()
}

/// Suffix of a base parameter whose name belongs to another sum in the estimate.
const OTHER_SUM: char = 'F';

/// Tolerance for equal coefficients.
const EQUAL: f64 = 1e-6;

/// Renames a parameter if an estimated parameter of another sum has its name.
fn distinct(mut own: FunctionParameter, estimated: &[BaseParameter]) -> FunctionParameter {
    let alike = estimated.iter().find(|one| one.name == own.name);
    if alike.is_some_and(|one| !is_same_sum(&own, one)) {
        own.name = format!("{}{OTHER_SUM}", own.parameter);
    }
    own
}

/// Whether two base parameters are the same sum of standard parameters.
fn is_same_sum(own: &FunctionParameter, other: &BaseParameter) -> bool {
    let coefficient = |terms: &[Regrouping], name: &str| {
        let own = terms.iter().filter(|term| term.parameter == name);
        own.map(|term| term.coefficient).sum::<f64>()
    };
    let all = own.regrouping.iter().chain(&other.regrouping);
    own.parameter == other.parameter
        && all.into_iter().all(|term| {
            let [a, b] = [&own.regrouping, &other.regrouping]
                .map(|terms| coefficient(terms, &term.parameter));
            (a - b).abs() <= EQUAL * a.abs().max(b.abs()).max(1.0)
        })
}
