//! Which of the estimates are shown as the answer, and what they are called.

use overact_identification::{Estimate, Identification, ModelKind, Stage};

/// The answer of each model: its recommended parameters; all base parameters where nothing is
/// recommended.
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

/// The first estimate of a model at a stage.
pub(crate) fn of(
    identification: &Identification,
    model: ModelKind,
    stage: Stage,
) -> Option<&Estimate> {
    let mut all = identification.by_least_squares();
    all.find(|one| one.model == model && one.stage == stage)
}

/// The estimates of a stage, one of each model.
pub(crate) fn of_stage(identification: &Identification, stage: Stage) -> Vec<&Estimate> {
    let models = answers(identification).into_iter().map(|one| one.model);
    models
        .filter_map(|model| of(identification, model, stage))
        .collect()
}

/// Whether what is made with an estimate of a model and stage is made with the answer.
pub(crate) fn is_answer(identification: &Identification, model: ModelKind, stage: Stage) -> bool {
    answers(identification)
        .iter()
        .any(|one| one.model == model && one.stage == stage)
}

/// The case at the beginning of a sentence.
pub(crate) const fn case_heading(model: ModelKind) -> &'static str {
    match model {
        ModelKind::Platform => "Case 1",
        ModelKind::Actuators => "Case 2",
        ModelKind::Joints => "Joint model",
    }
}

/// What the parameters of a stage are called.
pub(crate) const fn stage_name(stage: Stage) -> &'static str {
    match stage {
        Stage::Base => "all base parameters",
        Stage::Recommended => "recommended parameters",
        Stage::Essential => "parameters by the r_σ rule",
        Stage::Consistent => "physically consistent parameters",
    }
}

/// What a model does with the inputs.
pub(crate) fn projection(estimate: &Estimate) -> String {
    match estimate.model {
        ModelKind::Platform => String::from("torques projected on the platform"),
        ModelKind::Actuators => {
            format!(
                "torques projected on {}",
                estimate.kept_actuators.join(", ")
            )
        }
        ModelKind::Joints => String::from("torques of all joints"),
    }
}
