//! A description's table `[experiment]` as a virtual experiment of the simulation.

pub(crate) mod errors;

use crate::{
    error::{Error, Problem},
    robot::Robot,
};
use overact::{Info, Model};
use overact_codegen::{description, diagnostic::did_you_mean};
use overact_identification::is_carried;
use overact_simulation::{Drives, Experiment, Record, Run, Term, Trajectory, simulate};
use std::collections::BTreeMap;

/// The virtual experiment of a robot: what would be recorded in a laboratory.
#[derive(Debug, Clone)]
pub struct VirtualExperiment<'a> {
    robot: &'a Robot,
    plan: Experiment,
    without_effect: Vec<String>,
}

impl Robot {
    /// The virtual experiment of the description.
    ///
    /// # Errors
    /// A description without an experiment, or without a run.
    pub fn experiment(&self) -> Result<VirtualExperiment<'_>, Error> {
        let missing = |message: &str| {
            let help = "describe it in the tables [experiment] and [[experiment.run]], or give measured logs with --data";
            Problem::new(message).file(self.file()).help(help)
        };
        let Some(table) = &self.description().experiment else {
            return Err(missing("the description has no virtual experiment").into());
        };
        if table.runs.is_empty() {
            return Err(missing("the virtual experiment has no run").into());
        }
        let info = self.model().info();
        let truth = true_values(table);
        let mut without_effect: Vec<String> = truth.keys().cloned().collect();
        let all = || info.parameters.iter().chain(info.payload_parameters);
        without_effect.retain(|name| all().all(|parameter| parameter.name != *name));
        Ok(VirtualExperiment {
            robot: self,
            plan: plan(table, &info),
            without_effect,
        })
    }

    /// Names of the runs that the description holds out, to validate with.
    #[must_use]
    pub fn held_out(&self) -> Vec<String> {
        let table = self.description().experiment.as_ref();
        let runs = table.iter().flat_map(|table| &table.runs);
        let held = runs.filter(|run| run.validation);
        held.map(|run| run.name.value.clone()).collect()
    }

    /// True values of all parameters of the virtual robot: one that the description leaves out is zero.
    /// None without a virtual experiment.
    #[must_use]
    pub fn true_values(&self) -> Option<BTreeMap<String, f64>> {
        let table = self.description().experiment.as_ref()?;
        let info = self.model().info();
        let all = info.parameters.iter().chain(info.payload_parameters);
        let mut truth: BTreeMap<String, f64> = all.map(|p| (p.name.to_owned(), 0.0)).collect();
        truth.extend(true_values(table));
        Some(truth)
    }
}

impl VirtualExperiment<'_> {
    /// What will be done.
    #[must_use]
    pub const fn plan(&self) -> &Experiment {
        &self.plan
    }

    /// The plan, to be changed.
    pub const fn plan_mut(&mut self) -> &mut Experiment {
        &mut self.plan
    }

    /// The robot.
    #[must_use]
    pub const fn robot(&self) -> &Robot {
        self.robot
    }

    /// Gives the virtual robot other standard parameters than the description's, by name; the payload keeps its
    /// own where there are none for it.
    pub fn set_parameters(&mut self, values: &BTreeMap<String, f64>) {
        let info = self.robot.model().info();
        let all = info.parameters.iter().chain(info.payload_parameters);
        for (parameter, own) in all.zip(&mut self.plan.parameters) {
            *own = values.get(parameter.name).copied().unwrap_or(*own);
        }
    }

    /// Names of true parameters that have no effect on the model.
    #[must_use]
    pub fn without_effect(&self) -> &[String] {
        &self.without_effect
    }

    /// Checks names of runs.
    ///
    /// # Errors
    /// All names that no run has.
    pub fn check_runs(&self, names: &[String]) -> Result<(), Error> {
        let runs = &self.plan.runs;
        let known: Vec<&str> = runs.iter().map(|run| run.name.as_str()).collect();
        let unknown = names.iter().filter(|name| !known.contains(&name.as_str()));
        let problem = |name: &String| {
            let help = did_you_mean(name, known.iter().copied());
            let help = help.unwrap_or_else(|| format!("the runs are {}", known.join(", ")));
            Problem::new(format!("the experiment has no run `{name}`"))
                .file(self.robot.file())
                .help(help)
        };
        let problems: Vec<Problem> = unknown.map(problem).collect();
        match problems.is_empty() {
            true => Ok(()),
            false => Err(Error::Problems(problems)),
        }
    }

    /// Makes all runs. `progress` hears the part that is done, from 0 to 1, and the name of a run.
    ///
    /// # Errors
    /// An experiment that can't be made, all that is wrong at once, or runs that could not be finished.
    pub fn records(&self, progress: &dyn Fn(f64, &str)) -> Result<Vec<Record>, Error> {
        let info = self.robot.model().info();
        if info.parameters.iter().any(is_carried) {
            return self.records_with_carried(progress);
        }
        simulate(self.robot.model(), &self.plan, progress)
            .map_err(|error| located(self.robot, &error))
    }

    /// Makes all runs of a robot without platform one by one: its payload is a body that is there in runs
    /// with payload alone.
    fn records_with_carried(&self, progress: &dyn Fn(f64, &str)) -> Result<Vec<Record>, Error> {
        let info = self.robot.model().info();
        let mut records = Vec::new();
        for run in &self.plan.runs {
            let mut plan = self.plan.clone();
            plan.runs = vec![Run {
                payload: false,
                ..run.clone()
            }];
            if !run.payload {
                let both = [Some(&mut plan.parameters), plan.nominal_parameters.as_mut()];
                for values in both.into_iter().flatten() {
                    let own = info.parameters.iter().zip(values);
                    own.filter(|(parameter, _)| is_carried(parameter))
                        .for_each(|(_, value)| *value = 0.0);
                }
            }
            let made = simulate(self.robot.model(), &plan, progress)
                .map_err(|error| located(self.robot, &error))?;
            let made = made.into_iter();
            records.extend(made.map(|record| Record {
                payload: run.payload,
                ..record
            }));
        }
        Ok(records)
    }
}

/// The plan of an experiment.
pub(crate) fn plan(table: &description::Experiment, info: &Info<'_>) -> Experiment {
    let truth = true_values(table);
    let all = info.parameters.iter().chain(info.payload_parameters);
    let value = |name: &str| truth.get(name).copied().unwrap_or(0.0);
    Experiment {
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
        parameters: all.map(|parameter| value(parameter.name)).collect(),
        runs: table.runs.iter().map(|run| converted(run, info)).collect(),
        ..Experiment::default()
    }
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
fn true_values(table: &description::Experiment) -> BTreeMap<String, f64> {
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

/// The simulation's errors, each at its place in the description.
fn located(robot: &Robot, error: &overact_simulation::Error) -> Error {
    let source = robot.source().clone();
    let diagnostics = errors::diagnostics(&source, robot.description(), error);
    Error::Description {
        source,
        diagnostics,
    }
}
