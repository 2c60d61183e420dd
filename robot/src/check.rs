//! Complete check of a description without its model.
//!
//! It also reports what simulation and identification of the virtual experiment would reject,
//! without simulating.

use crate::{
    compiled_file::{note, read},
    configuration::{
        prior::{NamedParameter, prior},
        settings::settings,
    },
    error::Error,
    experiment,
    parameters::body::body,
    robot::Robot,
};
use overact::{Info, Sizes};
use overact_codegen::diagnostic::Code;
use overact_codegen::{
    Checked,
    derivation::BodyParameter,
    description::{self, Description},
    diagnostic::{Diagnostic, Diagnostics, Source},
    mechanism::Mechanism,
};
use overact_identification::filters::butterworth;
use overact_simulation::Experiment;
use std::path::Path;

/// A description without errors.
#[derive(Debug)]
#[non_exhaustive]
pub struct CheckedFile {
    /// The path as the user gave it.
    pub file: String,
    /// The mechanism with its home configuration.
    pub mechanism: Mechanism,
    /// Contents that may be unintended.
    pub note: Option<String>,
}

/// Reads and checks a description.
///
/// # Errors
/// A file that cannot be read, or all errors of the description.
pub fn check(path: &Path) -> Result<CheckedFile, Error> {
    check_text(read(path)?)
}

/// Checks a description in memory.
///
/// ```
/// use overact_codegen::Source;
///
/// let error = overact_robot::check_text(Source::new("empty.toml", "")).unwrap_err();
/// assert!(error.problems().iter().all(|problem| problem.help.is_some()));
/// ```
///
/// # Errors
/// All errors of the description.
pub fn check_text(source: Source) -> Result<CheckedFile, Error> {
    match checked(&source) {
        Ok(checked) => Ok(CheckedFile {
            note: note(&source, &checked.description, &checked.mechanism),
            file: source.name,
            mechanism: checked.mechanism,
        }),
        Err(diagnostics) => Err(Error::Description {
            source,
            diagnostics,
        }),
    }
}

impl Robot {
    /// Rejects a `[prior]` table with bodies that are not physically consistent.
    pub(crate) fn check_prior(&self) -> Result<(), Error> {
        let mut errors = Diagnostics::new();
        let mechanism = &self.model().model().mechanism;
        check_prior(self.source(), self.description(), mechanism, &mut errors);
        errors
            .into_result(())
            .map_err(|diagnostics| Error::Description {
                source: self.source().clone(),
                diagnostics,
            })
    }
}

fn checked(source: &Source) -> Result<Checked, Diagnostics> {
    let checked = overact_codegen::check(source)?;
    let mut errors = Diagnostics::new();
    check_prior(
        source,
        &checked.description,
        &checked.mechanism,
        &mut errors,
    );
    with_info(&checked.mechanism, |info| {
        check_experiment(source, &checked.description, info, &mut errors);
    });
    errors.into_result(checked)
}

/// Reports bodies of the `[prior]` table that are not physically consistent.
fn check_prior(
    source: &Source,
    description: &Description,
    mechanism: &Mechanism,
    errors: &mut Diagnostics,
) {
    let all = BodyParameter::all(mechanism).into_iter();
    let all = all.chain(BodyParameter::of_payload(mechanism));
    let names: Vec<_> = all.map(|one| (one.name(mechanism), one)).collect();
    let named: Vec<NamedParameter<'_>> = names
        .iter()
        .map(|(name, one)| (name.as_str(), one.symbol(), body(mechanism, *one)))
        .collect();
    let symbols: Vec<_> = named.iter().map(|(name, of, _)| (*name, *of)).collect();
    let prior = prior(description, &named, &mechanism.home.joints);
    for problem in prior.problems(&symbols) {
        let name = problem.column_name().unwrap_or_default();
        let at = description::place(source, &format!("prior.values.{name}"));
        let help = problem.help.unwrap_or_default();
        errors.push(
            Diagnostic::global(Code::KNOWN, problem.message)
                .help(help)
                .at(at),
        );
    }
}

/// Reports what simulation and identification of the virtual experiment would reject.
fn check_experiment(
    source: &Source,
    description: &Description,
    info: &Info<'_>,
    errors: &mut Diagnostics,
) {
    let Some(table) = description
        .experiment
        .as_ref()
        .filter(|t| !t.runs.is_empty())
    else {
        return;
    };
    let experiment = experiment::plan(table, info);
    let problems = experiment.problems(info);
    if problems.is_empty() {
        check_filters(source, description, &experiment, info, errors);
    } else {
        let refused = overact_simulation::Error::Experiment(problems);
        errors.append(experiment::errors::diagnostics(
            source,
            description,
            &refused,
        ));
    }
}

/// Reports runs of the virtual experiment that are too short or sampled too slowly for the filters.
fn check_filters(
    source: &Source,
    description: &Description,
    experiment: &Experiment,
    info: &Info<'_>,
    errors: &mut Diagnostics,
) {
    let frequency = experiment.sampling_hz;
    let settings = settings(description, info, frequency);
    let at = |path: &str, message: String, help: &str| {
        let place = description::place(source, path);
        Diagnostic::global(Code::KNOWN, message)
            .help(help)
            .at(place)
    };
    let (cutoff, nyquist) = (settings.filter_cutoff_hz, frequency / 2.0);
    if cutoff >= nyquist {
        let message = format!(
            "the cutoff frequency of {cutoff} Hz is not below half the sampling frequency of the virtual experiment, {nyquist} Hz"
        );
        let help =
            "give `filter_cutoff` of [identification] about ten times the bandwidth of the motion";
        errors.push(at("identification.filter_cutoff", message, help));
    } else if let Err(refused) = butterworth(settings.filter_order, cutoff / nyquist) {
        for problem in refused.problems {
            let help = problem.help.unwrap_or_default();
            errors.push(at("identification.filter_order", problem.message, &help));
        }
    }
    let longest = experiment.runs.iter().map(|run| experiment.samples(run));
    let longest = longest.max().unwrap_or(0) as f64 / frequency;
    if cutoff * longest < 1.0 {
        let message = format!(
            "the cutoff frequency of {cutoff} Hz is below one period in the longest run, of {longest} s: the filter would remove the whole motion"
        );
        let help =
            "give `filter_cutoff` of [identification] about ten times the bandwidth of the motion";
        errors.push(at("identification.filter_cutoff", message, help));
    }
    let needed = settings.samples_needed();
    for (index, run) in experiment.runs.iter().enumerate() {
        let samples = experiment.samples(run);
        if samples < needed {
            let message = format!(
                "the run `{}` has {samples} samples; the filters, the decimation and the skipped samples of the identification need at least {needed}",
                run.name
            );
            let help = "extend the run, or skip fewer samples";
            errors.push(at(
                &format!("experiment.run[{index}].duration"),
                message,
                help,
            ));
        }
    }
}

/// Calls a function with the information that an experiment is checked against.
///
/// Parameters are omitted: their number follows from the model.
fn with_info<T>(mechanism: &Mechanism, then: impl FnOnce(&Info<'_>) -> T) -> T {
    let joints = mechanism.joints();
    let actuated_joints = mechanism.first_joints();
    let actuator_is_revolute = mechanism.actuator_is_revolute();
    let actuators = mechanism.actuator_names();
    let actuators: Vec<&str> = actuators.iter().map(String::as_str).collect();
    let coordinates = mechanism.coordinates();
    let coordinates: Vec<&str> = coordinates.iter().map(String::as_str).collect();
    then(&Info {
        name: &mechanism.name,
        sizes: Sizes {
            pose: mechanism.pose_len(),
            dof: mechanism.dof(),
            actuators: actuators.len(),
            joints: joints.len(),
            parameters: 0,
            base_parameters: 0,
            payload_parameters: 0,
        },
        legs: &[],
        actuators: &actuators,
        actuated_joints: &actuated_joints,
        actuator_is_revolute: &actuator_is_revolute,
        coordinates: &coordinates,
        parameters: &[],
        payload_parameters: &[],
        home_pose: &mechanism.home.pose,
        home_joints: &mechanism.home.joints,
        kept_actuators: &mechanism.kept_actuators,
    })
}
