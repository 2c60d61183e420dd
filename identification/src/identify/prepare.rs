//! Equations of all projections from one pass over the runs.

use nalgebra::DMatrix;
use overact::Model;

use super::{instruments::InstrumentRuns, progress::Progress};
use crate::{
    assessment,
    consistent::{ConsistencySearch, Consistent},
    estimation::{
        base::{BaseParameters, PayloadUse, base_parameters, payload_names},
        column_noise::ColumnNoise,
    },
    gravity::GravityDirection,
    kinematics,
    prior::Prior,
    regression::{
        columns::ColumnSet,
        factor::Factor,
        observation::{MeasuredRun, RunObservation},
        observer::Observer,
        projection::Projection,
        sink::LARGEST_STRETCHES,
        system::{RunEquations, System},
        torque_uncertainty::TorqueCorrection,
        uncertainty_propagation::PropagatedUncertainty,
    },
    result::{Estimate, RunSummary},
    settings::{Settings, check_partition},
};
use overact_logs::{
    Error, Log, carried_payloads,
    periods::{PeriodicMotion, periodic_motions},
};

/// Prepared data: systems of the projections, columns and base parameters.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct PreparedSystem {
    /// Columns of the model.
    pub columns: ColumnSet,
    /// The base parameters.
    pub base: BaseParameters,
    /// Treatment of the payload columns.
    pub payload: PayloadUse,
    /// The projections.
    pub projections: Vec<Projection>,
    /// For each projection its system in the base parameters, or the error.
    pub systems: Vec<Result<System, Error>>,
    /// The runs.
    pub runs: Vec<RunSummary>,
    /// Other results of the pass over each run.
    pub(super) observations: Vec<RunObservation>,
    /// For each run and projection, the equations of each line at the plotted points.
    pub(super) points: Vec<Vec<Vec<DMatrix<f64>>>>,
    /// Instruments.
    pub(super) instrument_runs: InstrumentRuns,
    /// Periodic motion of each run, if it has one.
    pub(super) periodic_motions: Vec<Option<PeriodicMotion>>,
    /// Effect of the uncertainty of previous identifications.
    pub(super) propagated_uncertainty: Option<PropagatedUncertainty>,
}

impl PreparedSystem {
    /// Systems of the projections, without runs.
    pub(crate) fn new(
        columns: ColumnSet,
        base: BaseParameters,
        payload: PayloadUse,
        projections: Vec<Projection>,
        systems: Vec<Result<System, Error>>,
    ) -> Self {
        Self {
            columns,
            base,
            payload,
            projections,
            systems,
            runs: Vec::new(),
            observations: Vec::new(),
            points: Vec::new(),
            instrument_runs: InstrumentRuns::default(),
            periodic_motions: Vec::new(),
            propagated_uncertainty: None,
        }
    }

    /// Adds the uncertainty of a correction of the runs' torques.
    pub(super) fn with_correction(
        mut self,
        model: &dyn Model,
        runs: &[Log],
        correction: &TorqueCorrection<'_>,
        settings: &Settings,
    ) -> Result<Self, Error> {
        let observer = Observer {
            model,
            columns: &self.columns,
            base: &self.base.columns,
            projections: &self.projections,
            settings,
        };
        self.propagated_uncertainty = Some(correction.propagated(&observer, runs)?);
        Ok(self)
    }

    /// Covariance of an estimate of the columns `selected` from previous identifications.
    ///
    /// `None` without them, or for dependent columns. `weights` are those of the lines.
    pub(super) fn covariance_before(
        &self,
        projection: usize,
        selected: &[usize],
        weights: &[f64],
    ) -> Option<DMatrix<f64>> {
        let propagated_uncertainty = self.propagated_uncertainty.as_ref()?;
        propagated_uncertainty.covariance(projection, selected, weights)
    }

    /// Effect of position noise on the columns of each projection.
    ///
    /// # Errors
    /// A log cannot be read any more.
    pub(super) fn column_noise(
        &self,
        model: &dyn Model,
        runs: &[Log],
        settings: &Settings,
    ) -> Result<Vec<Option<ColumnNoise>>, Error> {
        let observer = Observer {
            model,
            columns: &self.columns,
            base: &self.base.columns,
            projections: &self.projections,
            settings,
        };
        ColumnNoise::all(&observer, runs)
    }

    /// Pose coordinates with their ranges in the runs (m, rad); empty with free rotation.
    pub(super) fn ranges(&self, model: &dyn Model) -> Vec<(String, f64)> {
        let sizes = model.info().sizes;
        if sizes.pose != sizes.dof {
            return Vec::new();
        }
        let runs = || {
            self.observations
                .iter()
                .map(|observation| &observation.figures)
        };
        let names = runs()
            .next()
            .map_or(Vec::new(), |run| run.coordinates.clone());
        let range = |(place, name): (usize, String)| {
            let all = runs().filter_map(|run| run.pose.get(place));
            let bounds = all
                .flatten()
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
                    (f64::min(low, *value), f64::max(high, *value))
                });
            (name, bounds.1 - bounds.0)
        };
        names.into_iter().enumerate().map(range).collect()
    }

    /// Adds the uncertainty of the model's direction of gravity.
    pub(super) fn with_gravity(mut self, direction: &GravityDirection) -> Self {
        let all = self.columns.as_slice();
        let columns = self.base.columns.iter();
        let names: Vec<&str> = columns.map(|&index| all[index].name.as_str()).collect();
        self.propagated_uncertainty = Some(direction.propagated_uncertainty(&names));
        self
    }

    /// Names of the standard parameters that have no effect on the model.
    #[must_use]
    pub fn without_effect(&self) -> Vec<String> {
        let columns = self.columns.as_slice();
        let named = self
            .base
            .without_effect
            .iter()
            .filter_map(|&index| columns.get(index));
        named.map(|column| column.name.clone()).collect()
    }

    /// Number of equations of all runs that were excluded at standstill.
    pub(super) fn left_out(&self) -> usize {
        let runs = self.runs.iter();
        runs.flat_map(|run| &run.standstill_equations).sum()
    }

    /// Physically consistent parameters with the best fit, for one of the projections.
    ///
    /// `base` is the estimate of its base parameters. `None` if the search does not converge.
    #[must_use]
    pub fn consistent(
        &self,
        projection: usize,
        base: &Estimate,
        prior: &Prior,
    ) -> Option<Consistent> {
        let system = self.systems.get(projection)?.as_ref().ok()?;
        let search = ConsistencySearch {
            columns: &self.columns,
            base: &self.base,
            system,
            estimate: base,
        };
        search.run(prior)
    }
}

/// Finds the base parameters and reads the runs, once for all projections.
///
/// # Errors
/// Invalid settings, no run, runs that do not fit the robot or leave its workspace (the problems of
/// all runs together), invalid projections. Kept actuators that are singular at a sample are an
/// error of their system only.
pub fn prepare(
    model: &dyn Model,
    runs: &[Log],
    projections: &[Projection],
    settings: &Settings,
    progress: &dyn Fn(Progress<'_>),
) -> Result<PreparedSystem, Error> {
    let info = model.info();
    settings.check(&info)?;
    check_projections(projections, model)?;
    let payload = PayloadUse::of(&info, runs)?;
    check_runs(model, runs, settings)?;
    progress(Progress::Base);
    let columns = ColumnSet::new(
        model,
        payload != PayloadUse::Absent,
        settings.asymmetric_friction,
        settings.seed,
    )?
    .with_payloads(&payload_names(runs))
    .holding(&settings.prior);
    Error::check(settings.prior.problems(&columns.named()))?;
    let base = base_parameters(model, &columns, payload, settings.seed)?;
    // Column relations belong to the model, reversals to the data.
    let columns = columns.with_friction_signs(model, settings)?;
    let observer = Observer {
        model,
        columns: &columns,
        base: &base.columns,
        projections,
        settings,
    };
    let sessions = session_numbers(runs.iter().map(Log::session));
    let new = |projection: &Projection| {
        let system = System::new(projection.clone(), &info, base.columns.len());
        Ok(System {
            sessions: sessions.clone(),
            ..system
        })
    };
    let mut systems: Vec<Result<System, Error>> = projections.iter().map(new).collect();
    let (mut observations, mut points, mut problems) = (Vec::new(), Vec::new(), Vec::new());
    let mut instrument_runs = InstrumentRuns::new(runs, settings);
    if !instrument_runs.logs.is_empty() {
        let with = |system: Result<System, Error>| system.map(System::with_instruments);
        systems = systems.into_iter().map(with).collect();
    }
    let periodic_motions = periodic_motions(runs, settings.period_s);
    for (number, log) in runs.iter().enumerate() {
        let run = log.name();
        let report = |done, samples| progress(Progress::Run { run, done, samples });
        let budget = LARGEST_STRETCHES / runs.len();
        let measured = MeasuredRun {
            number,
            log,
            instruments: instrument_runs.of(number),
            budget,
            periodic_motion: periodic_motions[number],
        };
        match observer.run(&measured, &report) {
            Ok((equations, run_observation)) => {
                instrument_runs.missing = instrument_runs
                    .missing
                    .or_else(|| run_observation.unusable.clone());
                observations.push(run_observation);
                points.push(add(&mut systems, equations));
            }
            Err(error) => problems.extend(assessment::explained(model, log, error).problems),
        }
    }
    Error::check(problems)?;
    let runs = runs.iter().zip(&observations);
    Ok(PreparedSystem {
        runs: runs
            .map(|(log, observation)| RunSummary::new(log, observation))
            .collect(),
        observations,
        points,
        instrument_runs,
        periodic_motions,
        ..PreparedSystem::new(columns, base, payload, projections.to_vec(), systems)
    })
}

/// Number of each run's recording session, that of its first run; empty for one session.
pub(crate) fn session_numbers<'a>(sessions: impl Iterator<Item = Option<&'a str>>) -> Vec<usize> {
    let names: Vec<Option<&str>> = sessions.collect();
    let first_of = |name| names.iter().position(|one| one == name);
    let numbers: Vec<usize> = names.iter().filter_map(first_of).collect();
    if numbers.iter().any(|number| *number != 0) {
        numbers
    } else {
        Vec::new()
    }
}

/// Equations of a run for each projection, or the error.
type Equations = Vec<Result<RunEquations, Error>>;

/// Adds the equations of a run to the systems, and returns those at the plotted points.
fn add(systems: &mut [Result<System, Error>], observed: Equations) -> Vec<Vec<DMatrix<f64>>> {
    let mut points = Vec::new();
    for (system, observed) in systems.iter_mut().zip(observed) {
        match (system.as_mut(), observed) {
            (Ok(own), Ok(mut observed)) => {
                points.push(std::mem::take(&mut observed.points));
                own.extend(observed);
            }
            (Ok(_), Err(error)) => {
                points.push(Vec::new());
                *system = Err(error);
            }
            (Err(_), _) => points.push(Vec::new()),
        }
    }
    points
}

/// Checks the kept actuators of all projections.
fn check_projections(projections: &[Projection], model: &dyn Model) -> Result<(), Error> {
    let problem = |projection: &Projection| match projection {
        Projection::Actuators(kept) => check_partition(kept, &model.info()),
        _ => None,
    };
    Error::check(projections.iter().filter_map(problem).collect())
}

/// Checks whether runs fit the robot and the settings, before the long computation.
pub(super) fn check_runs(
    model: &dyn Model,
    runs: &[Log],
    settings: &Settings,
) -> Result<(), Error> {
    let check = |log: &Log| kinematics::check(model, log, settings).err();
    let errors = runs.iter().filter_map(check);
    Error::check(errors.flat_map(|error| error.problems).collect())
}

/// Warnings before any estimate.
pub(super) fn prepared_warnings(prepared: &PreparedSystem, others: &[Log]) -> Vec<String> {
    let mut warnings = Vec::new();
    if prepared.payload == PayloadUse::Regrouped {
        warnings.push(String::from(
            match prepared.columns.loads().len() {
                0 | 1 => "the payload's parameters are not identifiable without unloaded runs: they are regrouped into the platform's",
                _ => "no run is without payload: the parameters of one payload are regrouped into the robot's, and those of the others are differences from it",
            },
        ));
    }
    warnings.extend(mostly_still(prepared));
    for other in others {
        let label = other
            .payload_name()
            .filter(|_| prepared.payload != PayloadUse::Absent);
        let mut carried = label.into_iter().flat_map(carried_payloads);
        if let Some(name) = carried.find(|name| !prepared.columns.has_load(name)) {
            warnings.push(format!(
                "{}: no training run carries the payload `{name}` of this validation run: it is predicted without",
                other.name()
            ));
            continue;
        }
        let known = match prepared.payload {
            PayloadUse::Absent => !other.payload(),
            PayloadUse::Regrouped => other.payload(),
            PayloadUse::Separate => true,
        };
        if !known {
            warnings.push(format!(
                "{}: the validation run {} the payload, unlike the training runs",
                other.name(),
                if other.payload() {
                    "carries"
                } else {
                    "does not carry"
                }
            ));
        }
    }
    warnings
}

/// Warning if standstill excludes most data, as positions in a wrong unit would.
fn mostly_still(prepared: &PreparedSystem) -> Option<String> {
    let still = prepared.left_out();
    let system = prepared.systems.iter().find_map(|one| one.as_ref().ok())?;
    let left: usize = system.lines.iter().map(Factor::equations).sum();
    (still > left).then(|| {
        format!(
            "{still} of {} equations are skipped at standstill: check the unit of the positions, `position_scale` of [data], and `standstill_velocity` of [identification]",
            still + left
        )
    })
}
