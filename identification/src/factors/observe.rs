//! From logs to factors.

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
    let info = model.info();
    settings.check(&info)?;
    PayloadUse::of(&info, logs)?;
    let checks = logs
        .iter()
        .filter_map(|log| kinematics::check(model, log, settings).err());
    Error::check(checks.flat_map(|error| error.problems).collect())?;
    let like = likeness(description, settings);
    let budget = match equations {
        true => LARGEST_STRETCHES / logs.len().max(1),
        false => 0,
    };
    let (mut runs, mut problems) = (Vec::new(), Vec::new());
    let mut known: Vec<(Option<Option<&str>>, Columns)> = Vec::new();
    for (number, log) in logs.iter().enumerate() {
        let load = log.payload().then(|| log.payload_name());
        if !known.iter().any(|(own, _)| *own == load) {
            progress(Progress::Base);
            known.push((load, Columns::new(model, load, settings)?));
        }
        let Some((_, columns)) = known.iter().find(|(own, _)| *own == load) else {
            continue;
        };
        let about = About {
            like: &like,
            origin,
            number,
            budget,
            equations,
        };
        match columns.factors((model, log), settings, &about, progress) {
            Ok(run) => runs.push(run),
            Err(error) => problems.extend(assessment::explained(model, log, error).problems),
        }
    }
    Error::check(problems)?;
    Ok(runs)
}

/// What a run is told beside its log.
struct About<'a> {
    like: &'a str,
    origin: &'a Origin,
    number: usize,
    budget: usize,
    equations: bool,
}

/// The columns of runs that carry the same.
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
        let (systems, seen) = observer.run(0, (log, None), about.budget, &report)?;
        let models = projections.iter().zip(systems);
        let models = models.map(|(projection, observed)| {
            let lines = projection.line_names(&info);
            kept((projection, lines), observed, about.equations)
        });
        let names = self
            .chosen
            .iter()
            .filter_map(|&at| self.all.as_slice().get(at));
        let mut run = RunFactors {
            robot: info.name.to_owned(),
            serial: about.origin.serial.clone(),
            time_us: about.origin.times_us.get(about.number).copied().flatten(),
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
