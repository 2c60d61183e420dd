//! `overact identify`: identifies parameters from logs or from the virtual experiment.
//!
//! The identification uses positions and torques of the actuators only. True values of a virtual
//! experiment are only reported for comparison.

use crate::{
    failure::{Failure, Problem},
    input,
    measurements::{factors, runs},
    note, output,
    progress::Progress,
    report as files,
    stopwatch::Stopwatch,
};
use clap::ValueEnum;
use overact::Model;
use overact_codegen::diagnostic::Code;
use overact_identification::{
    CalibrationScope, CheckScope, ForgettingRule, Grade, Identification, OnlineSettings,
    Progress as Doing,
};
use overact_report::Extent;
use overact_robot::{Identifier, tracking};
use std::path::PathBuf;

/// Message if `--tracking` has no runs to follow.
const NOTHING_TO_FOLLOW: &str = "--tracking has no run: it uses the validation runs of [experiment], also with logs, and the description has none (`validation = true` of a run)";

/// Arguments of the command.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Description
    #[arg(value_name = "TOML")]
    pub(super) file: PathBuf,
    #[command(flatten)]
    runs: runs::Arguments,
    /// Factor files (`overact factor`) instead of logs
    #[arg(long, value_name = "PARQUET", num_args = 1.., conflicts_with_all = ["tracking", "calibrate", "gains", "gravity_direction", "gear_friction", "stribeck_velocity", "online", "parameters", "strict", "all", "tables", "timings", "reports", "published"])]
    factors: Vec<PathBuf>,
    /// Skip unusable parts of factor files, and report them
    #[arg(long, requires = "factors")]
    skip_bad: bool,
    /// Kept actuators of the actuator projection [default: those of the description]
    #[arg(long, value_delimiter = ',', value_name = "ACTUATORS")]
    kept: Option<Vec<String>>,
    /// Simulate tracking of the validation runs with a PD controller and with computed torques
    /// [default: if the runs are virtual and published results are in the folder of the description]
    #[arg(long)]
    tracking: bool,
    /// Checks to run: all, or only those of the raw samples and residuals, which take less time
    #[arg(long, value_enum, value_name = "SCOPE", default_value_t)]
    checks: Checks,
    /// Exit with code 3 if the verdict is "do not use it"
    #[arg(long)]
    strict: bool,
    /// List all parameters; without it the summary has about 50 lines
    #[arg(long)]
    all: bool,
    /// Print all tables below the whole summary
    #[arg(long)]
    tables: bool,
    /// Also report the time of each stage and of each check
    #[arg(long)]
    timings: bool,
    /// Write the text (with --json the document) to a file instead of stdout
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// First estimate encoder offsets and lengths from the closure of redundant loops, and use them:
    /// the fewest that explain the data, all offsets, or all offsets and lengths that the data determine
    #[arg(
        long,
        value_enum,
        value_name = "WHICH",
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = "smallest"
    )]
    calibrate: Option<Scope>,
    /// First identify the gains of the drives, relative to [identification.known], and multiply the
    /// torques by them [default: that of the description]
    #[arg(long)]
    gains: bool,
    /// Identify the direction of gravity together with the parameters, for a tilted base
    /// [default: that of the description]
    #[arg(long, conflicts_with = "gains")]
    gravity_direction: bool,
    /// First identify the friction of the gears that is proportional to the transmitted torque
    /// [default: that of the description]
    #[arg(long, conflicts_with_all = ["gains", "gravity_direction"])]
    gear_friction: bool,
    /// First identify the Stribeck velocities of joints with the key `stribeck`
    /// [default: that of the description]
    #[arg(long, conflicts_with_all = ["gains", "gravity_direction", "gear_friction"])]
    stribeck_velocity: bool,
    /// Replay the runs through the online filter: parameters with standard deviations over time,
    /// and detected changes
    #[arg(long)]
    online: bool,
    /// How old data lose weight in the replay: `none`, `exponential:FACTOR` or `directional:FACTOR`
    /// per decimated sample, with a factor from 0 to 1
    #[arg(long, value_name = "RULE", requires = "online", value_parser = forgetting)]
    forgetting: Option<ForgettingRule>,
    /// Write the description with the calibrated offsets and lengths
    #[arg(long, value_name = "TOML", requires = "calibrate")]
    calibrated_robot: Option<PathBuf>,
    /// Write the physically consistent standard parameters, for `simulate` and `evaluate`
    #[arg(long, value_name = "TOML")]
    parameters: Option<PathBuf>,
    #[command(flatten)]
    reports: files::Arguments,
}

/// Checks that are run.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
enum Checks {
    /// All checks
    #[default]
    All,
    /// Raw samples and residuals
    Basic,
}

impl From<Checks> for CheckScope {
    fn from(checks: Checks) -> Self {
        match checks {
            Checks::All => Self::All,
            Checks::Basic => Self::Basic,
        }
    }
}

/// What is calibrated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Scope {
    /// The fewest offsets and lengths that explain the data
    Smallest,
    /// All encoder offsets that the data determine
    Offsets,
    /// All encoder offsets and lengths that the data determine
    All,
}

impl From<Scope> for CalibrationScope {
    fn from(scope: Scope) -> Self {
        match scope {
            Scope::Smallest => Self::Smallest,
            Scope::Offsets => Self::Offsets,
            Scope::All => Self::All,
        }
    }
}

/// Rule of forgetting from its text.
fn forgetting(text: &str) -> Result<ForgettingRule, String> {
    let (rule, factor) = text.split_once(':').unwrap_or((text, ""));
    let factor = || match factor.parse::<f64>() {
        Ok(factor) if factor > 0.0 && factor <= 1.0 => Ok(factor),
        _ => Err(format!(
            "`{rule}` needs a factor above 0 and at most 1, as in `{rule}:0.999`"
        )),
    };
    match rule {
        "none" if text == rule => Ok(ForgettingRule::None),
        "exponential" => factor().map(ForgettingRule::Exponential),
        "directional" => factor().map(ForgettingRule::Directional),
        _ => Err(String::from(
            "the rules are `none`, `exponential:FACTOR` and `directional:FACTOR`",
        )),
    }
}

/// Runs the command.
///
/// # Errors
/// Logs that cannot be used, an invalid virtual experiment, or data that determine no parameter.
/// With `--strict`, also a result with the verdict not to use it, which has then been written.
pub(super) fn run(arguments: &Arguments, as_json: bool) -> Result<(), Failure> {
    if !arguments.factors.is_empty() {
        return from_factors(arguments, as_json);
    }
    let reports = arguments.reports.check(&arguments.file)?;
    let inputs = [arguments.runs.inputs(&arguments.file), reports.inputs()].concat();
    let output = output::file(arguments.output.as_ref());
    let outputs = output
        .into_iter()
        .chain(arguments.calibrated_robot.as_deref())
        .chain(arguments.parameters.as_deref());
    output::check(&inputs, &[reports.outputs(), outputs.collect()].concat())?;
    let stopwatch = Stopwatch::default();
    stopwatch.begin("description");
    let robot = input::robot(&arguments.file, as_json)?;
    let reports = reports.read()?;
    let kept = match &arguments.kept {
        Some(names) => Some(overact_robot::kept_actuators(robot.model().model(), names)?),
        None => None,
    };
    stopwatch.begin("logs");
    let runs = arguments.runs.runs(&robot, as_json)?;
    let mut settings = arguments.runs.settings(&robot, &runs);
    settings.kept_actuators = kept.unwrap_or(settings.kept_actuators);
    settings.checks = arguments.checks.into();
    settings.online = arguments.online.then(|| OnlineSettings {
        forgetting: arguments.forgetting.unwrap_or_default(),
        ..OnlineSettings::default()
    });
    let scope = arguments.calibrate.map(CalibrationScope::from);
    let identifier = Identifier::new(&robot).data(&runs).settings(settings);
    let identifier = if arguments.gains {
        identifier.gains(true)
    } else {
        identifier
    };
    let identifier = if arguments.gravity_direction {
        identifier.gravity_direction(true)
    } else {
        identifier
    };
    let identifier = if arguments.gear_friction {
        identifier.gear_friction(true)
    } else {
        identifier
    };
    let identifier = if arguments.stribeck_velocity {
        identifier.stribeck_velocity(true)
    } else {
        identifier
    };
    stopwatch.begin("preparation");
    let mut result = identified(identifier, scope, &stopwatch, as_json)?;
    let timings = stopwatch.finish();
    if arguments.timings {
        result.timings = timings;
    }
    let published = reports.published().filter(|_| arguments.runs.are_virtual());
    if arguments.tracking || published.is_some() {
        let bar = Progress::new("simulating", as_json);
        result.tracking = tracking(&robot, &result, &|part, run| bar.at(part, run))?;
    }
    if arguments.tracking && result.tracking.is_empty() {
        result.warnings.push(String::from(NOTHING_TO_FOLLOW));
    }
    let text = if as_json {
        output::json(&result)?
    } else {
        let page = reports.page().map(|path| path.display().to_string());
        let extent = if arguments.all || arguments.tables {
            Extent::Whole
        } else {
            Extent::Short
        };
        let mut text = overact_report::summary(&result, page.as_deref(), extent);
        if arguments.tables {
            text.push_str(&overact_report::tables(&result));
            text.push_str(&overact_report::compare_with_published(
                &result,
                reports.published(),
            ));
        }
        text.push_str(&overact_report::timings(&result));
        text
    };
    let mut written = reports.written(&robot, &robot.model().info(), &result)?;
    if let (Some(path), Some(calibration)) = (&arguments.calibrated_robot, &result.calibration) {
        let text = robot.calibrated_text(calibration)?;
        written.push((path.clone(), text.into_bytes()));
    }
    if let Some(path) = &arguments.parameters {
        let text = overact_report::parameters_file(&result).ok_or_else(no_parameters)?;
        written.push((path.clone(), text.into_bytes()));
    }
    note::print_result_warnings(&warnings(&result), output.is_some(), as_json);
    output::emit_with(&text, output, written)?;
    match result.grade() {
        Grade::DoNotUse if arguments.strict => Err(refused(&result)),
        _ => Ok(()),
    }
}

/// Reasons of the verdicts and other warnings, each once; a reason names the models that have it.
fn warnings(result: &Identification) -> Vec<String> {
    let mut reasons: Vec<(&str, Vec<&str>)> = Vec::new();
    for verdict in result.verdicts.iter().filter(|one| !one.trusted) {
        for reason in &verdict.reasons {
            match reasons.iter_mut().find(|(own, _)| own == reason) {
                Some((_, subjects)) => subjects.push(&verdict.subject),
                None => reasons.push((reason, vec![&verdict.subject])),
            }
        }
    }
    let reasons = reasons.iter();
    let mut all: Vec<String> = reasons
        .map(|(reason, subjects)| format!("{}: {reason}", subjects.join(", ")))
        .collect();
    for warning in overact_report::other_warnings(result) {
        if !all.contains(warning) {
            all.push(warning.clone());
        }
    }
    all
}

/// Identifies parameters from factor files.
fn from_factors(arguments: &Arguments, as_json: bool) -> Result<(), Failure> {
    if arguments.runs.names_logs() {
        let message = "`--factors` replaces logs: leave out one of the two";
        return Err(Failure::Usage(message.to_owned()));
    }
    factors::run(&factors::Request {
        description: &arguments.file,
        files: &arguments.factors,
        skip_bad: arguments.skip_bad,
        kept: arguments.kept.as_deref(),
        output: output::file(arguments.output.as_ref()),
        as_json,
    })
}

fn no_parameters() -> Failure {
    let problem = Problem::new(
        Code::NOT_CONSISTENT,
        "no physically consistent parameters: the search did not converge",
    );
    problem
        .help("widen or remove the bounds of `[prior.bounds]`: they may contradict the data or each other")
        .into()
}

/// Failure for a result with the verdict not to use it.
fn refused(result: &Identification) -> Failure {
    let first = result.verdicts.first();
    let reasons = first.map_or(&[][..], |verdict| verdict.reasons.as_slice());
    Failure::Refused(format!(
        "the result is not to be used: {}",
        reasons
            .first()
            .map_or("there is no estimate", String::as_str)
    ))
}

/// Runs the identification with a progress bar.
fn identified(
    identifier: Identifier<'_>,
    calibrated: Option<CalibrationScope>,
    stopwatch: &Stopwatch,
    as_json: bool,
) -> Result<Identification, Failure> {
    let bar = Progress::new("identifying", as_json);
    let tell = |doing: Doing<'_>| {
        stopwatch.hear(&doing);
        runs::tell(&bar, doing);
    };
    let identifier = match calibrated {
        Some(scope) => identifier.calibrate(scope),
        None => identifier,
    };
    Ok(identifier.progress(&tell).run()?)
}
