//! Tracking of validation runs by the virtual robot (B Table 4).
//!
//! It compares a PD controller alone with feedforward torques of the identified parameters.

use crate::{error::Error, robot::Robot};
use overact::Model;
use overact_identification::{Estimate, Identification, ModelKind, Stage, TrackingError};
use overact_simulation::Experiment;

/// Simulates every controller on the validation runs.
///
/// Empty without validation runs or without a virtual robot.
///
/// # Errors
/// An invalid virtual experiment.
pub fn tracking(
    robot: &Robot,
    result: &Identification,
    progress: &dyn Fn(f64, &str),
) -> Result<Vec<TrackingError>, Error> {
    if robot.description().experiment.is_none() {
        return Ok(Vec::new());
    }
    let mut names: Vec<String> = Vec::new();
    for one in &result.cross_validation {
        if !names.contains(&one.run) {
            names.push(one.run.clone());
        }
    }
    // Measured runs have file names; then use the validation runs of the description.
    let mut experiment = robot.experiment()?;
    let mut plain = experiment.plan().clone();
    if !plain.runs.iter().any(|run| names.contains(&run.name)) {
        names = robot.held_out();
    }
    plain.runs.retain(|run| names.contains(&run.name));
    if plain.runs.is_empty() {
        return Ok(Vec::new());
    }
    plain.feed_forward = false;
    let mut controllers = vec![(String::from("pd"), plain.clone())];
    for estimate in answers(result) {
        let name = match estimate.model {
            ModelKind::Platform => "computed torque, platform projection",
            ModelKind::Actuators => "computed torque, actuator projection",
            ModelKind::Joints => "computed torque",
        };
        let computed = Experiment {
            feed_forward: true,
            nominal_parameters: Some(standard(robot, result, estimate)),
            ..plain.clone()
        };
        controllers.push((name.to_owned(), computed));
    }
    let mut all = Vec::new();
    for (controller, plan) in controllers {
        *experiment.plan_mut() = plan;
        for record in experiment.records(progress)? {
            all.push(TrackingError {
                run: record.name,
                controller: controller.clone(),
                actuators: record.actuators,
                largest: record.tracking_error,
            });
        }
    }
    // Sort by run, as in the table.
    all.sort_by_key(|one| names.iter().position(|name| *name == one.run));
    Ok(all)
}

/// Recommended parameters of each model; all base parameters if there are none.
fn answers(result: &Identification) -> Vec<&Estimate> {
    let mut answers: Vec<&Estimate> = Vec::new();
    for estimate in result.by_least_squares() {
        let known = answers.iter_mut().find(|one| one.model == estimate.model);
        match known {
            Some(known) if estimate.stage == Stage::Recommended => *known = estimate,
            Some(_) => {}
            None => answers.push(estimate),
        }
    }
    answers
}

/// Standard parameters equivalent to an estimate.
///
/// Each base parameter's value is assigned to its kept parameter; regrouped ones are zero.
fn standard(robot: &Robot, result: &Identification, estimate: &Estimate) -> Vec<f64> {
    let info = robot.model().info();
    let all = info.parameters.iter().chain(info.payload_parameters);
    let value = |name: &str| -> f64 {
        let mut parameters = estimate.parameters.iter();
        let own = parameters.find(|one| {
            let base = result.base_parameters.get(one.column);
            base.is_some_and(|base| base.parameter == name)
        });
        own.map_or(0.0, |one| one.value)
    };
    all.map(|parameter| value(parameter.name)).collect()
}
