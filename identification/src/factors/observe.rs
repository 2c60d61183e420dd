//! Computes factors from logs.

use std::sync::{Arc, Mutex, PoisonError};

use overact::Model;

use super::{
    content::{content, hash},
    run::{ModelFactors, RunFactors},
};
use crate::{
    assessment::{self, check::Check},
    estimation::base::{PayloadUse, base_parameters, check_payloads, names_of_loads},
    identify::Progress,
    kinematics,
    prior::Prior,
    regression::{
        columns::ColumnSet,
        observation::{MeasuredRun, RunObservation},
        observer::Observer,
        projection::Projection,
        sink::LARGEST_STRETCHES,
        system::RunEquations,
    },
    result::RunSummary,
    settings::{Instruments, Normalisation, Settings},
};
use overact_logs::{Error, Log};

/// Metadata of runs.
#[derive(Debug, Clone, Default)]
pub struct Origin {
    /// Serial number of the robot; empty if unknown.
    pub serial: String,
    /// Start of each run, µs since 1970 (UTC).
    pub times_us: Vec<Option<i64>>,
}

/// Hash of the description and of the settings that affect the equations.
///
/// Line ends do not count, comments do.
#[must_use]
pub fn settings_hash(description: &str, settings: &Settings) -> String {
    let settings = Settings {
        r_sigma: 0.0,
        keep_significant: false,
        normalisation: Normalisation::Unbiased,
        weighted: true,
        validation_samples: None,
        instruments: Instruments::None,
        period_s: None,
        prior: Prior::default(),
        known: std::collections::BTreeMap::new(),
        ..settings.clone()
    };
    let lines: Vec<&str> = description.lines().collect();
    hash(format!("{}\n{settings:?}", lines.join("\n")).as_bytes())
}

/// Computes factors of runs one by one.
pub struct Factory<'a> {
    model: &'a dyn Model,
    settings: &'a Settings,
    settings_hash: String,
    /// Columns for each payload.
    known: Mutex<Vec<(Load, Arc<Columns>)>>,
}

/// Payload of a run: none, an unnamed one, or a named one.
type Load = Option<Option<String>>;

impl<'a> Factory<'a> {
    /// A factory for runs of a robot with this `description`.
    ///
    /// # Errors
    /// Settings that do not fit the model.
    pub fn new(
        model: &'a dyn Model,
        description: &str,
        settings: &'a Settings,
    ) -> Result<Self, Error> {
        settings.check(&model.info())?;
        Ok(Self {
            model,
            settings,
            settings_hash: settings_hash(description, settings),
            known: Mutex::new(Vec::new()),
        })
    }

    /// Factors of a run of the robot with this serial number; `time_us` is its start (UTC, from
    /// 1970).
    ///
    /// # Errors
    /// A log that does not fit, or is unusable.
    pub fn run(&self, log: &Log, serial: &str, time_us: Option<i64>) -> Result<RunFactors, Error> {
        kinematics::check(self.model, log, self.settings)?;
        self.factors(log, serial, time_us, None, &|_| ())
    }

    /// Factors of runs; with `equations` also successive equations, if they are few.
    ///
    /// # Errors
    /// As [`prepare`](crate::prepare); the problems of all runs together.
    pub fn runs(
        &self,
        logs: &[Log],
        origin: &Origin,
        equations: bool,
        progress: &dyn Fn(Progress<'_>),
    ) -> Result<Vec<RunFactors>, Error> {
        let budget = equations.then(|| LARGEST_STRETCHES / logs.len().max(1));
        check_payloads(&self.model.info(), logs)?;
        let checks = logs
            .iter()
            .filter_map(|log| kinematics::check(self.model, log, self.settings).err());
        Error::check(checks.flat_map(|error| error.problems).collect())?;
        let (mut runs, mut problems) = (Vec::new(), Vec::new());
        for (number, log) in logs.iter().enumerate() {
            let time = origin.times_us.get(number).copied().flatten();
            match self.factors(log, &origin.serial, time, budget, progress) {
                Ok(run) => runs.push(run),
                Err(error) => problems.extend(error.problems),
            }
        }
        Error::check(problems)?;
        Ok(runs)
    }

    /// Factors of a run that fits.
    ///
    /// `budget` is the number of values of successive equations to keep; `None` to keep none.
    fn factors(
        &self,
        log: &Log,
        serial: &str,
        time_us: Option<i64>,
        budget: Option<usize>,
        progress: &dyn Fn(Progress<'_>),
    ) -> Result<RunFactors, Error> {
        let columns = self.columns(log, progress)?;
        let info = self.model.info();
        let projections = Projection::usual(&info, &self.settings.kept_actuators);
        let observer = Observer {
            model: self.model,
            columns: &columns.all,
            base: &columns.chosen,
            projections: &projections,
            settings: self.settings,
        };
        let run = log.name();
        let report = |done, samples| progress(Progress::Run { run, done, samples });
        let measured = MeasuredRun {
            number: 0,
            log,
            instruments: None,
            budget: budget.unwrap_or(0),
            periodic_motion: None,
        };
        let (systems, observation) = observer
            .run(&measured, &report)
            .map_err(|error| assessment::explained(self.model, log, error))?;
        let models = projections
            .iter()
            .zip(systems)
            .map(|(projection, observed)| {
                let lines = projection.line_names(&info);
                kept(projection, lines, observed, budget.is_some())
            });
        let names = columns
            .chosen
            .iter()
            .filter_map(|&at| columns.all.as_slice().get(at));
        let mut run = RunFactors {
            robot: info.name.to_owned(),
            serial: serial.to_owned(),
            time_us,
            settings_hash: self.settings_hash.clone(),
            content: String::new(),
            summary: RunSummary::new(log, &observation),
            flags: flags(self.model, log, observation),
            columns: names.map(|column| column.name.clone()).collect(),
            models: models.collect(),
        };
        run.content = content(&run);
        Ok(run)
    }

    /// Columns of a run, computed once for each payload.
    fn columns(&self, log: &Log, progress: &dyn Fn(Progress<'_>)) -> Result<Arc<Columns>, Error> {
        let load: Load = log.payload().then(|| log.payload_name().map(str::to_owned));
        // Entries are complete even if a thread panicked.
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, columns)) = known.iter().find(|(own, _)| *own == load) {
            return Ok(Arc::clone(columns));
        }
        progress(Progress::Base);
        let name = load.as_ref().map(Option::as_deref);
        let columns = Arc::new(Columns::new(self.model, name, self.settings)?);
        known.push((load, Arc::clone(&columns)));
        Ok(columns)
    }
}

/// Columns of runs with the same payload.
#[derive(Debug)]
struct Columns {
    all: ColumnSet,
    /// Columns that may be base parameters for any payloads of other runs.
    chosen: Vec<usize>,
}

impl Columns {
    fn new(
        model: &dyn Model,
        load: Option<Option<&str>>,
        settings: &Settings,
    ) -> Result<Self, Error> {
        let seed = settings.seed;
        let new = |payload| ColumnSet::new(model, payload, settings.asymmetric_friction, seed);
        let names = names_of_loads(load.flatten().map(overact_logs::Load::Named).into_iter());
        let all = new(load.is_some())?.with_payloads(&names);
        let mut chosen = match load {
            Some(_) => base_parameters(model, &all, PayloadUse::Separate, seed)?.columns,
            None => base_parameters(model, &all, PayloadUse::Absent, seed)?.columns,
        };
        // With loaded runs, permanent bodies may have other columns.
        if load.is_none() && crate::regression::columns::has_payload(&model.info()) {
            let with_payload = new(true)?;
            let base = base_parameters(model, &with_payload, PayloadUse::Separate, seed)?;
            for column in base.columns {
                let own = with_payload
                    .as_slice()
                    .get(column)
                    .filter(|own| !own.is_of_payload());
                let same = |name: &str| all.as_slice().iter().position(|one| one.name == name);
                let place = own.and_then(|own| same(&own.name));
                chosen.extend(place.filter(|place| !chosen.contains(place)));
            }
        }
        let all = all.with_friction_signs(model, settings)?;
        Ok(Self { all, chosen })
    }
}

/// Stored equations of a projection.
fn kept(
    projection: &Projection,
    lines: Vec<String>,
    observed: Result<RunEquations, Error>,
    equations: bool,
) -> ModelFactors {
    let model = projection.model();
    match observed {
        Ok(observed) => ModelFactors {
            model,
            lines,
            stretches: if equations {
                observed.stretches
            } else {
                Vec::new()
            },
            parts: Ok(observed.parts),
            partition: observed.partition,
        },
        Err(error) => ModelFactors {
            model,
            lines,
            parts: Err(error.to_string()),
            stretches: Vec::new(),
            partition: None,
        },
    }
}

/// Suspicions about the raw numbers of a run.
fn flags(model: &dyn Model, log: &Log, observation: RunObservation) -> Vec<String> {
    let checks = assessment::suspicious(model, log.name(), observation.monitor);
    let failed = checks.iter().filter(|check| !check.passed);
    failed.map(Check::located).collect()
}
