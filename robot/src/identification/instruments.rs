//! Instruments from simulation: the motion of the estimated robot under its controller.
//!
//! Instruments must be independent of the measured run's errors but need not be exact. Parameters
//! by least squares are therefore sufficient, although they may be biased. A good controller keeps
//! any such robot near its reference.

use crate::{configuration::prior::of_load, error::Error, robot::Robot};
use overact::{Info, Model};
use overact_codegen::diagnostic::Code;
use overact_identification::{
    Estimate, Instruments, Load, Log, PreparedSystem, Projection, Settings, carried_payloads,
    estimate_projection, is_carried, load_of, prepare,
};
use overact_simulation::{
    Cascade, Drives, Experiment, Record, Recorded, follow_recorded, simulate,
};

/// Adds simulated instruments to the runs of a virtual experiment.
///
/// The simulation has the parameters by least squares, the experiment's controller and ideal
/// sensors.
///
/// # Errors
/// Data that determine no parameter, or estimates that cannot be simulated.
pub fn beside_simulated(
    model: &dyn Model,
    plan: &Experiment,
    runs: Vec<Log>,
    settings: &Settings,
) -> Result<Vec<Log>, Error> {
    let parameters = estimated(model, &runs, settings)?;
    let mut plan = Experiment {
        encoder_resolution: Vec::new(),
        torque_noise: Vec::new(),
        drives: Drives::default(),
        nominal_parameters: Some(
            plan.nominal_parameters
                .as_ref()
                .unwrap_or(&plan.parameters)
                .clone(),
        ),
        parameters: parameters(None),
        ..plan.clone()
    };
    plan.runs
        .retain(|run| runs.iter().any(|log| log.name() == run.name));
    let mut records = Vec::new();
    if runs.iter().all(|log| log.payload_name().is_none()) {
        records = simulate(model, &plan, &|_, _| ()).map_err(failed)?;
    } else {
        for run in &plan.runs {
            let own = runs.iter().find(|log| log.name() == run.name);
            let plan = Experiment {
                parameters: parameters(own.and_then(Log::payload_name)),
                runs: vec![run.clone()],
                ..plan.clone()
            };
            records.extend(simulate(model, &plan, &|_, _| ()).map_err(failed)?);
        }
    }
    let mut instrumented = Vec::new();
    for log in runs {
        let own = records.iter().find(|record| record.name == log.name());
        instrumented.push(match own {
            Some(record) => log.with_instruments(as_log(record)?),
            None => log,
        });
    }
    Ok(instrumented)
}

impl Robot {
    /// Adds simulated instruments to runs.
    ///
    /// The simulation follows the recorded references if the runs have these, else the virtual
    /// experiment.
    pub(crate) fn simulated(&self, runs: &[Log], settings: &Settings) -> Result<Vec<Log>, Error> {
        let model = self.model();
        match &self.description().controller {
            Some(controller) if runs.iter().all(|log| log.instruments().is_some()) => {
                let cascade = Cascade {
                    position_gain: controller.position_gain.clone(),
                    velocity_gain: controller.velocity_gain.clone(),
                    drive_gain: controller.drive_gain.clone(),
                    limit: controller.limit.clone(),
                };
                along_references(model, &cascade, runs, settings)
            }
            _ if self.description().experiment.is_some() => {
                let experiment = self.experiment()?;
                beside_simulated(model, experiment.plan(), runs.to_vec(), settings)
            }
            // The reason is reported where the instruments are needed.
            _ => Ok(runs.to_vec()),
        }
    }
}

/// Replaces the references of runs by the motion of the simulated robot that follows them.
fn along_references(
    model: &dyn Model,
    cascade: &Cascade,
    runs: &[Log],
    settings: &Settings,
) -> Result<Vec<Log>, Error> {
    let whole = estimated(model, runs, settings)?;
    let robot = model.info().sizes.parameters;
    let loaded = runs.iter().any(Log::payload);
    let mut instrumented = Vec::new();
    for log in runs {
        let reference = log.instruments().map(Log::load).transpose()?;
        let (positions, _) = reference.unwrap_or_default();
        let mut parameters = whole(log.payload_name());
        if !log.payload() {
            parameters[robot..].fill(0.0);
            // Without payload, the body that carries it in a serial robot has zero parameters.
            let own = model.info().parameters.iter().zip(&mut parameters);
            own.filter(|(parameter, _)| loaded && is_carried(parameter))
                .for_each(|(_, value)| *value = 0.0);
        }
        let recorded = Recorded {
            run: log.name(),
            payload: log.payload(),
            sampling_hz: log.sampling_frequency(),
            positions: &positions,
        };
        let record = follow_recorded(model, cascade, &parameters, recorded).map_err(failed)?;
        instrumented.push(log.clone().with_instruments(as_log(&record)?));
    }
    Ok(instrumented)
}

/// Standard parameters equivalent to the base estimate by least squares, the payload's last.
///
/// With several payloads, those of the requested ones.
fn estimated<'a>(
    model: &'a dyn Model,
    runs: &[Log],
    settings: &Settings,
) -> Result<impl Fn(Option<&str>) -> Vec<f64> + 'a, Error> {
    let sizes = model.info().sizes;
    let projection = if sizes.actuators > sizes.dof {
        Projection::Platform
    } else {
        Projection::Joints
    };
    let settings = Settings {
        instruments: Instruments::None,
        r_sigma: f64::INFINITY,
        ..settings.clone()
    };
    let prepared = prepare(model, runs, &[projection], &settings, &|_| {})?;
    let outcome = estimate_projection(&prepared, 0, &settings, None)?;
    let held = settings.prior.held;
    Ok(move |load: Option<&str>| {
        let info = model.info();
        let mut all = standard(&info, &prepared, &outcome.base, load);
        for (one, value) in info.parameters.iter().zip(&mut all) {
            *value = held.get(one.name).copied().unwrap_or(*value);
        }
        all
    })
}

/// Assigns each base parameter's value to its kept parameter; regrouped ones are zero.
fn standard(
    info: &Info<'_>,
    prepared: &PreparedSystem,
    estimate: &Estimate,
    load: Option<&str>,
) -> Vec<f64> {
    let columns = prepared.columns.as_slice();
    let value = |name: &str| {
        let own = estimate.parameters.iter().find(|one| {
            let kept = prepared.base.columns.get(one.column);
            let column = kept.and_then(|&column| columns.get(column));
            column.is_some_and(|column| column.standard == name)
        });
        own.map_or(0.0, |one| one.value)
    };
    let all = info.parameters.iter().chain(info.payload_parameters);
    all.map(|parameter| {
        let Some(label) = load else {
            return value(parameter.name);
        };
        let carried = carried_payloads(label);
        let own: f64 = carried
            .map(|one| value(&of_load(parameter.name, one)))
            .sum();
        let of_other = load_of(parameter).is_some_and(|own| !Load::Named(label).contains(own));
        if own != 0.0 || of_other {
            own
        } else {
            value(parameter.name)
        }
    })
    .collect()
}

/// Converts a record to a run for instruments.
fn as_log(record: &Record) -> Result<Log, overact_identification::Error> {
    Log::new(
        format!("{}, simulated", record.name),
        record.sampling_hz,
        record.actuators.len(),
        record.positions.clone(),
        record.torques.clone(),
        record.payload,
    )
}

/// Error of a failed simulation.
fn failed(error: overact_simulation::Error) -> Error {
    let help = "the robot of the estimated parameters can't be simulated: set `instruments` to \"periods\" or \"none\"";
    crate::error::Problem::new(Code::ESTIMATED_ROBOT, error.to_string())
        .help(help)
        .into()
}
