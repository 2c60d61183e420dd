//! Wording of verdicts and checks for page and terminal.

use overact_identification::{
    Check, CheckKind, Grade, Identification, ModelKind, Stage, significant, titled,
};

/// Grade as an advice.
pub(crate) const fn grade_words(grade: Grade) -> &'static str {
    match grade {
        Grade::Use => "use it",
        Grade::UseListed => "use it for what is listed",
        Grade::DoNotUse => "do not use it",
    }
}

/// Number of passed checks of an estimate.
pub(crate) fn passed(identification: &Identification, model: ModelKind, stage: Stage) -> usize {
    let checks = identification.checks.iter();
    checks
        .filter(|check| check.passed && check.concerns(model, stage))
        .count()
}

/// Warnings that belong to no failed check, each once.
#[must_use]
pub fn other_warnings(identification: &Identification) -> Vec<&String> {
    let failed = identification.checks.iter().filter(|check| !check.passed);
    let failed: Vec<&str> = failed.map(|check| check.words.as_str()).collect();
    let mut all: Vec<&String> = Vec::new();
    for warning in &identification.warnings {
        let is_of_check = failed.iter().any(|words| warning.contains(words));
        if !is_of_check && !all.contains(&warning) {
            all.push(warning);
        }
    }
    all
}

/// Heading of a check.
pub(crate) const fn title(kind: CheckKind) -> &'static str {
    match kind {
        CheckKind::Degrees => "unit of the positions",
        CheckKind::Unit => "units of time, positions and torques",
        CheckKind::Closure => "closure of the loops",
        CheckKind::WrongSign => "signs",
        CheckKind::WrongGain => "gains of the drives",
        CheckKind::PayloadLabel => "label of the payload",
        CheckKind::Delay => "delay between torques and motion",
        CheckKind::MissingParameter => "terms missing from the model",
        CheckKind::Partition => "kept actuators",
        CheckKind::Consistency => "physical consistency",
        CheckKind::RelativeError => "residual beyond noise",
        CheckKind::ResidualCorrelation => "residuals correlated between drives",
        CheckKind::HeldOut => "validation runs",
        CheckKind::RegressorErrors => "position noise in the regressor",
        other => other.name(),
    }
}

/// Scope of a check: models, stages, run and actuator.
pub(crate) fn place(check: &Check) -> String {
    let models = check.models.iter().map(|model| model.label().to_owned());
    let stages = check
        .stages
        .iter()
        .map(|stage| crate::choice::stage_name(*stage).to_owned());
    let actuator = check.actuator.iter().map(|name| titled(name));
    let rest = check.run.iter().cloned().chain(actuator);
    let parts: Vec<String> = models.chain(stages).chain(rest).collect();
    parts.join(", ")
}

/// Measured statistic with its unit, if there is one.
pub(crate) fn statistic(check: &Check) -> Option<String> {
    quantity(check.statistic, check.unit)
}

/// Threshold with its unit, if there is one.
pub(crate) fn threshold(check: &Check) -> Option<String> {
    quantity(check.threshold, check.unit)
}

fn quantity(value: f64, unit: &str) -> Option<String> {
    if value.is_nan() {
        return None;
    }
    let text = if value.is_infinite() {
        String::from("infinite")
    } else {
        significant(value, 3)
    };
    Some(if unit.is_empty() {
        text
    } else {
        format!("{text} {unit}")
    })
}

#[cfg(test)]
mod tests {
    use super::quantity;

    #[test]
    fn quantities_have_units_and_nan_is_omitted() {
        assert_eq!(quantity(0.001_234_5, "rad").as_deref(), Some("0.00123 rad"));
        assert_eq!(quantity(2.0, "").as_deref(), Some("2"));
        assert_eq!(quantity(f64::INFINITY, "").as_deref(), Some("infinite"));
        assert_eq!(quantity(f64::NAN, "%"), None);
    }
}
