//! Identification from runs, and its result in all output formats.

use crate::{
    errors,
    logs::{Given, given, logs},
    progress::Teller,
};
use overact::Model;
use overact_cli::report;
use overact_identification::{CalibrationScope, CheckScope, Grade, Identification, Progress};
use overact_report::{Extent, Published};
use overact_robot::{Error, Identifier, Robot, Runs, kept_actuators, tracking};
use pyo3::{
    conversion::FromPyObjectOwned,
    exceptions::PyValueError,
    prelude::*,
    types::{PyDict, PyTuple},
};
use std::{path::PathBuf, sync::Arc};

/// Options of an identification.
struct Wishes {
    runs: Vec<(Given, bool)>,
    validation: Vec<(Given, bool)>,
    /// Names of the virtual experiment's validation runs.
    held_out: Vec<String>,
    seed: Option<u64>,
    kept: Option<Vec<String>>,
    asymmetric: Option<bool>,
    calibrate: Option<CalibrationScope>,
    gains: Option<bool>,
    checks: CheckScope,
    tracking: bool,
}

/// Result of an identification.
#[pyclass(module = "overact._overact", frozen)]
pub(crate) struct Identified {
    robot: Arc<Robot>,
    result: Identification,
    published: Option<Published>,
}

/// Identifies a robot.
pub(crate) fn identify(
    py: Python<'_>,
    robot: &Arc<Robot>,
    runs: &[Bound<'_, PyTuple>],
    validation: &[Bound<'_, PyTuple>],
    options: &Bound<'_, PyDict>,
) -> PyResult<Identified> {
    let all = |items: &[Bound<'_, PyTuple>]| items.iter().map(given).collect::<PyResult<Vec<_>>>();
    let published = option::<PathBuf>(options, "published")?;
    let published = published.as_deref().map(report::published).transpose();
    let published = published.map_err(|failure| errors::of_command(py, &failure))?;
    let friction = option::<String>(options, "friction")?;
    let calibrate = option::<String>(options, "calibrate")?;
    let checks = option::<String>(options, "checks")?;
    let is_virtual = runs.is_empty();
    let tracked = option(options, "tracking")?;
    let wishes = Wishes {
        runs: all(runs)?,
        validation: all(validation)?,
        held_out: option(options, "held_out")?.unwrap_or_default(),
        seed: option(options, "seed")?,
        kept: option(options, "kept")?,
        asymmetric: friction.as_deref().map(is_asymmetric).transpose()?,
        calibrate: calibrate.as_deref().map(scope).transpose()?,
        gains: option(options, "gains")?,
        checks: checks.as_deref().map_or(Ok(CheckScope::All), check_scope)?,
        tracking: tracked.unwrap_or(is_virtual && published.is_some()),
    };
    let teller = Teller::new(option(options, "progress")?);
    let result = py.detach(|| identified(robot, &wishes, &teller));
    teller.end()?;
    Ok(Identified {
        robot: Arc::clone(robot),
        result: result.map_err(|error| errors::of_robot(py, &error))?,
        published,
    })
}

fn option<'py, T>(options: &Bound<'py, PyDict>, name: &str) -> PyResult<Option<T>>
where
    T: FromPyObjectOwned<'py>,
{
    match options.get_item(name)? {
        Some(value) if !value.is_none() => value.extract().map(Some).map_err(Into::into),
        _ => Ok(None),
    }
}

fn is_asymmetric(friction: &str) -> PyResult<bool> {
    match friction {
        "symmetric" => Ok(false),
        "asymmetric" => Ok(true),
        other => Err(unknown(
            "friction",
            other,
            "\"symmetric\" or \"asymmetric\"",
        )),
    }
}

fn scope(calibrate: &str) -> PyResult<CalibrationScope> {
    match calibrate {
        "smallest" => Ok(CalibrationScope::Smallest),
        "offsets" => Ok(CalibrationScope::Offsets),
        "all" => Ok(CalibrationScope::All),
        other => Err(unknown(
            "calibrate",
            other,
            "\"smallest\", \"offsets\" or \"all\"",
        )),
    }
}

fn check_scope(checks: &str) -> PyResult<CheckScope> {
    match checks {
        "all" => Ok(CheckScope::All),
        "basic" => Ok(CheckScope::Basic),
        other => Err(unknown("checks", other, "\"all\" or \"basic\"")),
    }
}

fn unknown(name: &str, found: &str, wanted: &str) -> PyErr {
    PyValueError::new_err(format!("{name}=\"{found}\" is none of {wanted}"))
}

/// Runs the identification as the command line does.
fn identified(robot: &Robot, wishes: &Wishes, teller: &Teller) -> Result<Identification, Error> {
    let kept = wishes.kept.as_deref();
    let kept = kept.map(|names| kept_actuators(robot.model().model(), names));
    let kept = kept.transpose()?;
    let runs = runs(robot, wishes, teller)?;
    let mut settings = robot.settings(runs.sampling_frequency());
    settings.asymmetric_friction = wishes.asymmetric.unwrap_or(settings.asymmetric_friction);
    settings.kept_actuators = kept.unwrap_or(settings.kept_actuators);
    settings.checks = wishes.checks;
    let tell = |doing: Progress<'_>| tell(teller, doing);
    let mut identifier = Identifier::new(robot)
        .data(&runs)
        .settings(settings)
        .progress(&tell);
    if let Some(gains) = wishes.gains {
        identifier = identifier.gains(gains);
    }
    if let Some(scope) = wishes.calibrate {
        identifier = identifier.calibrate(scope);
    }
    let mut result = identifier.run()?;
    if wishes.tracking {
        result.tracking = tracking(robot, &result, &|part, run| teller.tell(part, run))?;
    }
    Ok(result)
}

/// Logs, or the virtual experiment if there are none.
fn runs(robot: &Robot, wishes: &Wishes, teller: &Teller) -> Result<Runs, Error> {
    if wishes.runs.is_empty() {
        let mut experiment = robot.experiment()?;
        if let Some(seed) = wishes.seed {
            experiment.plan_mut().seed = seed;
        }
        let own = robot.held_out();
        let held = if wishes.held_out.is_empty() {
            &own
        } else {
            &wishes.held_out
        };
        return experiment.runs(held, &|part, run| teller.tell(part, run));
    }
    let hears = |part: f64| teller.tell(part, "reading");
    Ok(Runs {
        identified: logs(robot, &wishes.runs, &hears)?,
        validation: logs(robot, &wishes.validation, &hears)?,
        true_values: None,
    })
}

fn tell(teller: &Teller, doing: Progress<'_>) {
    let part = |done: usize, samples: usize| done as f64 / samples.max(1) as f64;
    match doing {
        Progress::Base => teller.tell(0.0, "base parameters"),
        Progress::Run { run, done, samples } => teller.tell(part(done, samples), run),
        Progress::Estimation { model } => teller.tell(1.0, &format!("{model}: estimation")),
        Progress::Validation { run, done, samples } => {
            teller.tell(part(done, samples), &format!("cross-validation on {run}"));
        }
        _ => {}
    }
}

#[pymethods]
impl Identified {
    /// All numbers as JSON, as in `overact identify --json`.
    fn json(&self) -> PyResult<String> {
        serde_json::to_string_pretty(&self.result)
            .map_err(|error| PyValueError::new_err(error.to_string()))
    }

    /// All numbers and figures as JSON.
    fn json_with_figures(&self, py: Python<'_>) -> PyResult<String> {
        report::document(&self.result).map_err(|failure| errors::of_command(py, &failure))
    }

    /// Report as an HTML page.
    fn html(&self, py: Python<'_>) -> PyResult<String> {
        let made = py.detach(|| {
            let info = self.robot.model().info();
            report::html(&self.robot, &info, &self.result, self.published.as_ref())
        });
        made.map_err(|failure| errors::of_command(py, &failure))
    }

    /// All numbers as one flat table, CSV.
    fn csv(&self) -> PyResult<String> {
        overact_report::numbers(&self.result)
            .map_err(|error| PyValueError::new_err(error.to_string()))
    }

    /// Output of `overact identify --all`.
    fn summary(&self) -> String {
        overact_report::summary(&self.result, None, Extent::Whole)
    }

    /// Tables that `overact identify --tables` prints below the summary.
    fn tables(&self) -> String {
        let mut text = overact_report::tables(&self.result);
        text.push_str(&overact_report::compare_with_published(
            &self.result,
            self.published.as_ref(),
        ));
        text
    }

    /// Physically consistent standard parameters as TOML; None if there are none.
    fn parameters_toml(&self) -> Option<String> {
        overact_report::parameters_file(&self.result)
    }

    /// Description with the calibration; None if nothing was calibrated.
    fn calibrated_description(&self, py: Python<'_>) -> PyResult<Option<String>> {
        let calibration = self.result.calibration.as_ref();
        let text = calibration.map(|calibration| self.robot.calibrated_text(calibration));
        text.transpose()
            .map_err(|error| errors::of_robot(py, &error))
    }

    /// Whether the verdict on the first model is to use the result.
    fn trusted(&self) -> bool {
        self.result.grade() == Grade::Use
    }
}
