//! A description's table `[experiment]` as a virtual experiment of the simulation.

use crate::{
    error::{Error, Problem},
    load::Robot,
};
use overact::Info;
use overact_codegen::description;
use overact_simulation::{Drives, Experiment, Run, Term, Trajectory};
use std::collections::BTreeMap;

/// The virtual experiment of a robot, and true parameters that have no effect on its model.
///
/// # Errors
/// A description without an experiment, or without a run.
pub fn experiment(robot: &Robot, info: &Info<'_>) -> Result<(Experiment, Vec<String>), Error> {
    let missing = |message: &str| {
        let help = "describe it in the tables [experiment] and [[experiment.run]], or give measured logs with --data";
        Problem::new(message).file(robot.file.as_str()).help(help)
    };
    let Some(table) = &robot.description.experiment else {
        return Err(missing("the description has no virtual experiment").into());
    };
    if table.runs.is_empty() {
        return Err(missing("the virtual experiment has no run").into());
    }
    let truth = true_values(table);
    let all = || info.parameters.iter().chain(info.payload_parameters);
    let value = |name: &str| truth.get(name).copied().unwrap_or(0.0);
    let without_effect = truth.keys().filter(|name| all().all(|p| p.name != **name));
    let without_effect = without_effect.cloned().collect();
    let experiment = Experiment {
        sampling_hz: table.sampling,
        duration_s: table.duration,
        bandwidth_hz: table.bandwidth,
        damping: table.damping,
        derivative_cutoff_hz: table.derivative_cutoff,
        feed_forward: table.feed_forward,
        project_internal: table.project_internal,
        encoder_resolution: table.encoder.clone(),
        encoder_delay_s: table.encoder_delay,
        torque_noise: table.torque_noise.clone(),
        torque_limit: table.torque_limit.clone(),
        drives: drives(&table.drives),
        seed: table.seed,
        parameters: all().map(|parameter| value(parameter.name)).collect(),
        runs: table.runs.iter().map(|run| converted(run, info)).collect(),
        ..Experiment::default()
    };
    Ok((experiment, without_effect))
}

/// The drives; what the description leaves out is ideal.
fn drives(table: &description::Drives) -> Drives {
    let list = |values: &Option<Vec<f64>>| values.clone().unwrap_or_default();
    Drives {
        gain: list(&table.gain),
        delay_s: table.delay,
        current_bandwidth_hz: list(&table.current_bandwidth),
        cogging: list(&table.cogging),
        cogging_periods: list(&table.cogging_periods),
        flexible_hz: list(&table.flexible_frequency),
        flexible_damping: table.flexible_damping,
        flexible_stiffness: list(&table.flexible_stiffness),
    }
}

/// True values of the parameters by name, as the description gives them; the others are zero.
#[must_use]
pub fn true_values(table: &description::Experiment) -> BTreeMap<String, f64> {
    table
        .parameters
        .iter()
        .map(|p| (p.name.value.clone(), p.value))
        .collect()
}

fn converted(run: &description::Run, info: &Info<'_>) -> Run {
    let term = |term: &description::Term| Term {
        // The index is checked; the name is that of the file, which the model may write otherwise.
        coordinate: info
            .coordinates
            .get(term.index)
            .map_or_else(|| term.coordinate.value.clone(), |name| (*name).to_owned()),
        harmonic: term.harmonic,
        amplitude: term.amplitude,
        phase_rad: term.phase,
    };
    Run {
        name: run.name.value.clone(),
        payload: run.payload,
        duration_s: run.duration,
        trajectory: Trajectory::Periodic {
            fundamental_hz: run.fundamental,
            terms: run.terms.iter().map(term).collect(),
        },
    }
}

/// The simulation's errors, each at the description.
#[must_use]
pub fn located(robot: &Robot, error: &overact_simulation::Error) -> Error {
    use overact_simulation::Error as Simulation;
    let problem = |message: String| Problem::new(message).file(robot.file.as_str());
    Error::Problems(match error {
        Simulation::Experiment(all) => all.iter().map(|p| problem(p.to_string())).collect(),
        Simulation::Runs(all) => all.iter().map(|p| problem(p.to_string())).collect(),
        other => vec![problem(other.to_string())],
    })
}
