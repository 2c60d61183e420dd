//! Chooses the estimates that are presented as the result, and names them.

use overact_identification::{Estimate, Identification, ModelKind, Stage};

/// Result of each model: the recommended parameters, else all base parameters.
pub(crate) fn answers(identification: &Identification) -> Vec<&Estimate> {
    let mut models: Vec<ModelKind> = Vec::new();
    for estimate in identification.by_least_squares() {
        if !models.contains(&estimate.model) {
            models.push(estimate.model);
        }
    }
    let stages = [Stage::Recommended, Stage::Base, Stage::Essential];
    models
        .into_iter()
        .filter_map(|model| {
            stages
                .into_iter()
                .find_map(|stage| of(identification, model, stage))
        })
        .collect()
}

/// First estimate of a model at a stage.
pub(crate) fn of(
    identification: &Identification,
    model: ModelKind,
    stage: Stage,
) -> Option<&Estimate> {
    let mut all = identification.by_least_squares();
    all.find(|one| one.model == model && one.stage == stage)
}

/// Estimates of a stage, one for each model.
pub(crate) fn of_stage(identification: &Identification, stage: Stage) -> Vec<&Estimate> {
    let models = answers(identification).into_iter().map(|one| one.model);
    models
        .filter_map(|model| of(identification, model, stage))
        .collect()
}

/// Whether an estimate of a model and stage is the presented result.
pub(crate) fn is_answer(identification: &Identification, model: ModelKind, stage: Stage) -> bool {
    answers(identification)
        .iter()
        .any(|one| one.model == model && one.stage == stage)
}

/// Name of the projection at the beginning of a sentence.
pub(crate) const fn case_heading(model: ModelKind) -> &'static str {
    match model {
        ModelKind::Platform => "Platform projection",
        ModelKind::Actuators => "Actuator projection",
        ModelKind::Joints => "Joint model",
    }
}

/// Name of the parameters of a stage.
pub(crate) const fn stage_name(stage: Stage) -> &'static str {
    match stage {
        Stage::Base => "all base parameters",
        Stage::Recommended => "recommended parameters",
        Stage::Essential => "parameters by the r_σ rule",
        Stage::Consistent => "physically consistent parameters",
    }
}

/// Description of the model's projection.
pub(crate) fn projection(estimate: &Estimate) -> String {
    match estimate.model {
        ModelKind::Platform => String::from("torques of all actuators"),
        ModelKind::Actuators => {
            format!(
                "torques projected on {}",
                estimate.kept_actuators.join(", ")
            )
        }
        ModelKind::Joints => String::from("torques of all joints"),
    }
}
