//! Converts the `[experiment]` table of a description to a virtual experiment.

pub(crate) mod errors;
pub(crate) mod fleet;

use crate::{
    configuration::prior::{is_of_payload, of_load},
    error::{Error, Problem},
    robot::Robot,
};
use overact::{Info, Model, Parameter};
use overact_codegen::diagnostic::Code;
use overact_codegen::{description, diagnostic::did_you_mean};
use overact_identification::{carried_payloads, is_carried, load_of};
use overact_simulation::{Drives, Experiment, Record, Run, Term, Trajectory, simulate};
use std::collections::BTreeMap;

/// Virtual experiment of a robot: the simulated counterpart of recordings in a laboratory.
#[derive(Debug, Clone)]
pub struct VirtualExperiment<'a> {
    robot: &'a Robot,
    plan: Experiment,
    /// Parameters of each named payload, by their names in the model.
    loads: BTreeMap<String, BTreeMap<&'static str, f64>>,
    without_effect: Vec<String>,
}

impl Robot {
    /// Virtual experiment of the description.
    ///
    /// # Errors
    /// A description without an experiment, or without a run.
    pub fn experiment(&self) -> Result<VirtualExperiment<'_>, Error> {
        let missing = |message: &str| {
            let help = "describe it in the tables [experiment] and [[experiment.run]], or let `overact excite` find runs; to identify, give measured logs with --data";
            Problem::new(Code::NO_EXPERIMENT, message)
                .file(self.file())
                .help(help)
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
        let has = |parameter: &Parameter, name: &String| {
            let loads = self.payloads().into_iter();
            let mut loads = loads.filter(|_| is_of_payload(parameter));
            parameter.name == name || loads.any(|load| of_load(parameter.name, load) == *name)
        };
        without_effect.retain(|name| !all().any(|parameter| has(parameter, name)));
        let value = |name: &str, kept: f64| truth.get(name).copied().unwrap_or(kept);
        Ok(VirtualExperiment {
            robot: self,
            plan: plan(table, &info),
            loads: loads(self, &value, &BTreeMap::new()),
            without_effect,
        })
    }

    /// Names of the description's validation runs.
    #[must_use]
    pub fn held_out(&self) -> Vec<String> {
        let table = self.description().experiment.as_ref();
        let runs = table.iter().flat_map(|table| &table.runs);
        let held = runs.filter(|run| run.validation);
        held.map(|run| run.name.value.clone()).collect()
    }

    /// Names of the payloads, if there are several.
    #[must_use]
    pub fn payloads(&self) -> Vec<&str> {
        let names = self.description().payloads.iter();
        names.map(|name| name.value.as_str()).collect()
    }

    /// Name of the payload that a run of the virtual experiment carries, if there are several;
    /// `A+B` if it carries two.
    pub(crate) fn payload_of(&self, run: &str) -> Option<&str> {
        let table = self.description().experiment.as_ref()?;
        let run = table.runs.iter().find(|one| one.name.value == run)?;
        run.payload_name.as_deref()
    }

    /// True values of all parameters of the virtual robot; omitted ones are zero.
    ///
    /// `None` without a virtual experiment.
    #[must_use]
    pub fn true_values(&self) -> Option<BTreeMap<String, f64>> {
        let table = self.description().experiment.as_ref()?;
        let info = self.model().info();
        let all = info.parameters.iter().chain(info.payload_parameters);
        let names = |one: &Parameter| {
            let is_load = is_of_payload(one) && load_of(one).is_none();
            let loads = self.payloads().into_iter().filter(|_| is_load);
            let loads = loads.map(|load| of_load(one.name, load));
            loads.chain([one.name.to_owned()]).collect::<Vec<_>>()
        };
        let mut truth: BTreeMap<String, f64> =
            { all.flat_map(names) }.map(|name| (name, 0.0)).collect();
        truth.extend(true_values(table));
        Some(truth)
    }
}

impl VirtualExperiment<'_> {
    /// Plan of the experiment.
    #[must_use]
    pub const fn plan(&self) -> &Experiment {
        &self.plan
    }

    /// Mutable plan of the experiment.
    pub const fn plan_mut(&mut self) -> &mut Experiment {
        &mut self.plan
    }

    /// The robot.
    #[must_use]
    pub const fn robot(&self) -> &Robot {
        self.robot
    }

    /// Sets standard parameters of the virtual robot by name.
    ///
    /// The payload keeps its own values if `values` has none for it.
    pub fn set_parameters(&mut self, values: &BTreeMap<String, f64>) {
        let info = self.robot.model().info();
        let all = info.parameters.iter().chain(info.payload_parameters);
        for (parameter, own) in all.zip(&mut self.plan.parameters) {
            *own = values.get(parameter.name).copied().unwrap_or(*own);
        }
        let value = |name: &str, kept: f64| values.get(name).copied().unwrap_or(kept);
        self.loads = loads(self.robot, &value, &self.loads);
    }

    /// Names of true parameters that have no effect on the model.
    #[must_use]
    pub fn without_effect(&self) -> &[String] {
        &self.without_effect
    }

    /// Checks that runs exist.
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
            Problem::new(
                Code::NO_EXPERIMENT,
                format!("the experiment has no run `{name}`"),
            )
            .file(self.robot.file())
            .help(help)
        };
        let problems: Vec<Problem> = unknown.map(problem).collect();
        if problems.is_empty() {
            Ok(())
        } else {
            Err(Error::Problems(problems))
        }
    }

    /// Checks that training runs remain apart from those `held_out`.
    pub(crate) fn check_some_left(&self, held_out: &[String]) -> Result<(), Error> {
        let mut runs = self.plan.runs.iter();
        if runs.any(|run| !held_out.contains(&run.name)) {
            return Ok(());
        }
        let problem = Problem::new(
            Code::NO_EXPERIMENT,
            "all runs of the experiment are validation runs, so there are no training data",
        );
        let help = "use fewer of them for validation";
        Err(Error::Problems(vec![
            problem.file(self.robot.file()).help(help),
        ]))
    }

    /// Simulates all runs.
    ///
    /// `progress` is called with the completed fraction, from 0 to 1, and the name of a run.
    ///
    /// # Errors
    /// An invalid experiment, with all its problems, or runs that failed.
    pub fn records(&self, progress: &dyn Fn(f64, &str)) -> Result<Vec<Record>, Error> {
        let info = self.robot.model().info();
        if info.parameters.iter().any(is_carried) || !self.loads.is_empty() {
            return self.records_by_load(progress);
        }
        simulate(self.robot.model(), &self.plan, progress)
            .map_err(|error| located(self.robot, &error))
    }

    /// Simulates all runs one by one, each with its payload.
    ///
    /// This is needed for several payloads, and for serial robots, where the payload is a body of
    /// its own.
    fn records_by_load(&self, progress: &dyn Fn(f64, &str)) -> Result<Vec<Record>, Error> {
        let info = self.robot.model().info();
        let of_robot = info.parameters.iter().any(is_carried);
        let mut records = Vec::new();
        for run in &self.plan.runs {
            let mut plan = self.plan.clone();
            plan.runs = vec![Run {
                payload: run.payload && !of_robot,
                ..run.clone()
            }];
            let label = self.robot.payload_of(&run.name);
            let carried = label.into_iter().flat_map(carried_payloads);
            let loads: Vec<_> = carried.filter_map(|name| self.loads.get(name)).collect();
            let both = [Some(&mut plan.parameters), plan.nominal_parameters.as_mut()];
            for values in both.into_iter().flatten() {
                let all = info.parameters.iter().chain(info.payload_parameters);
                for (parameter, value) in all.zip(values).filter(|(one, _)| is_of_payload(one)) {
                    if !run.payload {
                        *value = 0.0;
                    } else if !loads.is_empty() {
                        let own = loads.iter().filter_map(|load| load.get(parameter.name));
                        *value = own.sum();
                    }
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

/// Parameters of each named payload, by their names in the model.
///
/// `value` returns a parameter by its own name, or its default.
fn loads(
    robot: &Robot,
    value: &dyn Fn(&str, f64) -> f64,
    before: &BTreeMap<String, BTreeMap<&'static str, f64>>,
) -> BTreeMap<String, BTreeMap<&'static str, f64>> {
    let info = robot.model().info();
    let all = info.parameters.iter().chain(info.payload_parameters);
    let own: Vec<&Parameter> = all.filter(|one| is_of_payload(one)).collect();
    let of = |load: &str| {
        let known = before.get(load);
        let each = own.iter().map(|one| {
            let kept = known.and_then(|known| known.get(one.name)).copied();
            let value = value(&of_load(one.name, load), kept.unwrap_or(0.0));
            (one.name, value)
        });
        each.collect()
    };
    let names = robot.payloads().into_iter();
    names.map(|name| (name.to_owned(), of(name))).collect()
}

/// Converts the table to a plan.
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

/// Converts the drives; omitted values are ideal.
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

/// True parameter values by name, as given in the description; others are zero.
fn true_values(table: &description::Experiment) -> BTreeMap<String, f64> {
    table
        .parameters
        .iter()
        .map(|p| (p.name.value.clone(), p.value))
        .collect()
}

fn converted(run: &description::Run, info: &Info<'_>) -> Run {
    let term = |term: &description::Term| Term {
        // The index was checked; the name in the file may differ from the model's.
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

/// Locates the simulation's errors in the description.
fn located(robot: &Robot, error: &overact_simulation::Error) -> Error {
    let source = robot.source().clone();
    let diagnostics = errors::diagnostics(&source, robot.description(), error);
    Error::Description {
        source,
        diagnostics,
    }
}
