//! From logs to factors.

use std::sync::{Arc, Mutex, PoisonError};

use overact::Model;

use super::{
    content::{content, hash},
    run::{ModelFactors, RunFactors},
};
use crate::{
    assessment::{self, check::Check},
    data::Log,
    error::Error,
    estimation::base::{PayloadUse, base_parameters},
    identify::{LARGEST_STRETCHES, Progress},
    kinematics,
    prior::Prior,
    regression::{
        columns::ColumnSet,
        observation::{Observer, Seen},
        projection::Projection,
        system::Observed,
    },
    result::RunSummary,
    settings::{Instruments, Normalisation, Settings},
};

/// What is known of runs beside their logs.
#[derive(Debug, Clone, Default)]
pub struct Origin {
    /// Serial number of the robot; empty where it is not known.
    pub serial: String,
    /// For each run, when it began, µs since 1970 (UTC).
    pub times_us: Vec<Option<i64>>,
}

/// A hash of what equations are like: the text of the description, and those settings that make the equations
/// and not what is done with them. Ends of lines do not count, comments do.
#[must_use]
pub fn likeness(description: &str, settings: &Settings) -> String {
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

/// Makes factors of runs one by one.
pub struct Factory<'a> {
    model: &'a dyn Model,
    settings: &'a Settings,
    like: String,
    /// Columns by what a run carries.
    known: Mutex<Vec<(Load, Arc<Columns>)>>,
    /// Values of successive equations that a run may keep; none where none are to be kept.
    budget: Option<usize>,
}

/// What a run carries: nothing, something without a name, or something with one.
type Load = Option<Option<String>>;

impl<'a> Factory<'a> {
    /// One for runs of a robot with this `description`.
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
            like: likeness(description, settings),
            known: Mutex::new(Vec::new()),
            budget: None,
        })
    }

    /// The factors of a run of the robot with this serial number that began at this time, µs since 1970 (UTC).
    ///
    /// # Errors
    /// A log that does not fit, or can't be used.
    pub fn run(&self, log: &Log, serial: &str, time_us: Option<i64>) -> Result<RunFactors, Error> {
        kinematics::check(self.model, log, self.settings)?;
        self.factors(log, (serial, time_us), &|_| ())
    }

    fn factors(
        &self,
        log: &Log,
        origin: (&str, Option<i64>),
        progress: &dyn Fn(Progress<'_>),
    ) -> Result<RunFactors, Error> {
        let columns = self.columns(log, progress)?;
        let about = About {
            like: &self.like,
            origin,
            budget: self.budget,
        };
        let made = columns.factors((self.model, log), self.settings, &about, progress);
        made.map_err(|error| assessment::explained(self.model, log, error))
    }

    /// The columns of a run, told once for all runs that carry the same.
    fn columns(&self, log: &Log, progress: &dyn Fn(Progress<'_>)) -> Result<Arc<Columns>, Error> {
        let load: Load = log.payload().then(|| log.payload_name().map(str::to_owned));
        // A thread that panicked left whole entries behind.
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

/// The factors of runs; with `equations` the successive equations, too, where these are few.
///
/// # Errors
/// As [`prepare`](crate::prepare); the problems of all runs together.
pub fn factor_runs(
    model: &dyn Model,
    (logs, description, origin): (&[Log], &str, &Origin),
    settings: &Settings,
    equations: bool,
    progress: &dyn Fn(Progress<'_>),
) -> Result<Vec<RunFactors>, Error> {
    let mut factory = Factory::new(model, description, settings)?;
    factory.budget = equations.then(|| LARGEST_STRETCHES / logs.len().max(1));
    PayloadUse::of(&model.info(), logs)?;
    let checks = logs
        .iter()
        .filter_map(|log| kinematics::check(model, log, settings).err());
    Error::check(checks.flat_map(|error| error.problems).collect())?;
    let (mut runs, mut problems) = (Vec::new(), Vec::new());
    for (number, log) in logs.iter().enumerate() {
        let time = origin.times_us.get(number).copied().flatten();
        match factory.factors(log, (&origin.serial, time), progress) {
            Ok(run) => runs.push(run),
            Err(error) => problems.extend(error.problems),
        }
    }
    Error::check(problems)?;
    Ok(runs)
}

/// What a run is told beside its log.
struct About<'a> {
    like: &'a str,
    /// Serial number and time.
    origin: (&'a str, Option<i64>),
    budget: Option<usize>,
}

/// The columns of runs that carry the same.
#[derive(Debug)]
struct Columns {
    all: ColumnSet,
    /// Those that may be columns of base parameters, whatever other runs carry.
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
        let names: Vec<String> = load.flatten().map(str::to_owned).into_iter().collect();
        let all = new(load.is_some())?.with_payloads(&names);
        let mut chosen = match load {
            Some(_) => base_parameters(model, &all, PayloadUse::Separate, seed)?.columns,
            None => base_parameters(model, &all, PayloadUse::Absent, seed)?.columns,
        };
        // Beside runs with a payload, bodies that are always there may be told by other columns.
        if load.is_none() && crate::regression::columns::has_payload(&model.info()) {
            let beside = new(true)?;
            let base = base_parameters(model, &beside, PayloadUse::Separate, seed)?;
            for column in base.columns {
                let own = beside
                    .as_slice()
                    .get(column)
                    .filter(|own| !own.is_of_payload());
                let same = |name: &str| all.as_slice().iter().position(|one| one.name == name);
                let place = own.and_then(|own| same(&own.name));
                chosen.extend(place.filter(|place| !chosen.contains(place)));
            }
        }
        let all = all.with_reversals(model, settings)?;
        Ok(Self { all, chosen })
    }

    fn factors(
        &self,
        (model, log): (&dyn Model, &Log),
        settings: &Settings,
        about: &About<'_>,
        progress: &dyn Fn(Progress<'_>),
    ) -> Result<RunFactors, Error> {
        let info = model.info();
        let projections = Projection::usual(&info, &settings.kept_actuators);
        let observer = Observer {
            model,
            columns: &self.all,
            base: &self.chosen,
            projections: &projections,
            settings,
        };
        let run = log.name();
        let report = |done, samples| progress(Progress::Run { run, done, samples });
        let (systems, seen) =
            observer.run(0, (log, None), (about.budget.unwrap_or(0), None), &report)?;
        let models = projections.iter().zip(systems);
        let models = models.map(|(projection, observed)| {
            let lines = projection.line_names(&info);
            kept((projection, lines), observed, about.budget.is_some())
        });
        let names = self
            .chosen
            .iter()
            .filter_map(|&at| self.all.as_slice().get(at));
        let mut run = RunFactors {
            robot: info.name.to_owned(),
            serial: about.origin.0.to_owned(),
            time_us: about.origin.1,
            like: about.like.to_owned(),
            content: String::new(),
            summary: RunSummary::new(log, &seen),
            flags: flags((model, log), seen),
            columns: names.map(|column| column.name.clone()).collect(),
            models: models.collect(),
        };
        run.content = content(&run);
        Ok(run)
    }
}

/// What is kept of the equations of a projection.
fn kept(
    (projection, lines): (&Projection, Vec<String>),
    observed: Result<Observed, Error>,
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

/// What the raw numbers of a run are suspected of.
fn flags((model, log): (&dyn Model, &Log), seen: Seen) -> Vec<String> {
    let checks = assessment::suspicious(model, log.name(), seen.monitor);
    let failed = checks.iter().filter(|check| !check.passed);
    failed.map(Check::located).collect()
}
