//! The table `[experiment]`: a virtual experiment.

use crate::diagnostic::{Code, Diagnostic, Span, did_you_mean};
use crate::experiments::drives::{self, Drives};
use crate::experiments::payloads;
use crate::experiments::per_actuator::{effort, per_actuator};
use crate::expressions::dimension::Dimension;
use crate::robot::inventory::{Body, Inventory};
use crate::robot::leg::joint;
use crate::robot::model::{JointKind, Spanned};
use crate::toml_text::reader::{Item, Table};
use crate::toml_text::scope::Scope;
use overact_core::StandardParameter;

/// A virtual experiment.
#[derive(Debug, Clone, PartialEq)]
pub struct Experiment {
    /// Sampling frequency, Hz.
    pub sampling: f64,
    /// Duration of runs without their own, s.
    pub duration: f64,
    /// Natural frequency of the controlled robot, Hz.
    pub bandwidth: f64,
    /// Damping factor.
    pub damping: f64,
    /// Cutoff of the low-pass filter on the controller's derivative, Hz.
    pub derivative_cutoff: f64,
    /// Whether the controller adds the inverse dynamics of the desired motion.
    pub feed_forward: bool,
    /// Whether internal torques are removed from the controller's output, eq. (50).
    pub project_internal: bool,
    /// Encoder resolution of each actuator, rad or m; 0 is ideal.
    pub encoder: Vec<f64>,
    /// Delay of the position sensors, s.
    pub encoder_delay: f64,
    /// Standard deviation of each actuator's torque measurement, N m or N.
    pub torque_noise: Vec<f64>,
    /// Largest absolute torque of each actuator, N m or N.
    pub torque_limit: Option<Vec<f64>>,
    /// Deviations of the drives from the controller's torques.
    pub drives: Drives,
    /// Seed of all noise.
    pub seed: u64,
    /// True values of the parameters; those not listed are 0.
    pub parameters: Vec<TrueParameter>,
    /// The runs in order.
    pub runs: Vec<Run>,
    /// Location of the table.
    pub span: Span,
}

/// The true value of a standard parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct TrueParameter {
    /// Full name, such as `zz_1_leg1`.
    pub name: Spanned<String>,
    /// Body or joint of the parameter.
    pub body: Body,
    /// The parameter of the body.
    pub symbol: StandardParameter,
    /// Value in SI units.
    pub value: f64,
}

/// One run.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// Unique name.
    pub name: Spanned<String>,
    /// Whether the payload is on the platform.
    pub payload: bool,
    /// Name of the payload, if there are several; `A+B` if the run carries two.
    pub payload_name: Option<String>,
    /// Whether the run is validation data: it is only predicted, and not used for estimation.
    pub validation: bool,
    /// Duration, s; that of the experiment if absent.
    pub duration: Option<f64>,
    /// Frequency of the first harmonic, Hz.
    pub fundamental: f64,
    /// The terms of the desired motion about home.
    pub terms: Vec<Term>,
}

/// A term amplitude sin(2π harmonic fundamental t + phase) of one coordinate.
#[derive(Debug, Clone, PartialEq)]
pub struct Term {
    /// Name of the coordinate: of the platform, or a joint of a robot without a platform.
    pub coordinate: Spanned<String>,
    /// Its index among the r coordinates.
    pub index: usize,
    /// Multiple of the fundamental frequency, at least 1.
    pub harmonic: u32,
    /// Amplitude, m or rad.
    pub amplitude: f64,
    /// Phase, rad.
    pub phase: f64,
}

/// Reads the table. Its defaults are those of section 5.1 of the paper.
pub(crate) fn read(item: &Item<'_, '_>, robot: &Inventory<'_>) -> Option<Experiment> {
    let table = item.table("the table `[experiment]`")?;
    let scope = robot.scope;
    let positive = |key: &str, dimension, default: f64| {
        table
            .get(key)
            .and_then(|i| i.positive(dimension, scope))
            .unwrap_or(default)
    };
    let switch = |key: &str| table.get(key).and_then(|i| i.boolean()).unwrap_or(true);
    let kinds = robot.actuator_kinds();
    let list = |key: &str, dimension: fn(JointKind) -> Dimension| {
        table
            .get(key)
            .and_then(|item| per_actuator(&item, &kinds, dimension, scope))
    };
    let ideal = || vec![0.0; kinds.len()];
    let parameters = table
        .get("parameters")
        .map(|item| parameters(&item, robot))
        .unwrap_or_default();
    let runs = table
        .get("run")
        .map(|item| runs(&item, robot))
        .unwrap_or_default();
    let experiment = Experiment {
        sampling: positive("sampling", Dimension::FREQUENCY, 5000.0),
        duration: positive("duration", Dimension::TIME, 10.0),
        bandwidth: positive("bandwidth", Dimension::FREQUENCY, 70.0),
        damping: positive("damping", Dimension::NONE, 0.7),
        derivative_cutoff: positive("derivative_cutoff", Dimension::FREQUENCY, 70.0),
        feed_forward: switch("feed_forward"),
        project_internal: switch("project_internal"),
        encoder: list("encoder", position).unwrap_or_else(ideal),
        encoder_delay: table
            .get("encoder_delay")
            .and_then(|i| i.not_negative(Dimension::TIME, scope))
            .unwrap_or(0.0),
        torque_noise: list("torque_noise", effort).unwrap_or_else(ideal),
        torque_limit: list("torque_limit", effort),
        drives: table
            .get("drives")
            .and_then(|item| drives::read(&item, robot))
            .unwrap_or_default(),
        seed: table.get("seed").and_then(|i| i.integer(0)).unwrap_or(1),
        parameters,
        runs,
        span: table.span.clone(),
    };
    table.finish();
    Some(experiment)
}

/// Dimension of an actuator's position.
pub(crate) fn position(kind: JointKind) -> Dimension {
    joint::dimension(kind).unwrap_or(Dimension::NONE)
}

/// Reads a table of parameters by name.
pub(crate) fn parameters(item: &Item<'_, '_>, robot: &Inventory<'_>) -> Vec<TrueParameter> {
    let Some(table) = item.table("a table of parameters") else {
        return Vec::new();
    };
    let known = robot.parameters();
    let mut all = Vec::new();
    for item in table.items() {
        let name = item.key.clone();
        let Some((_, body, symbol, dimension)) = known.iter().find(|(n, ..)| *n == name.value)
        else {
            let help = did_you_mean(&name.value, known.iter().map(|(n, ..)| n.as_str()));
            let message = format!("the robot has no parameter `{}`", name.value);
            let help = help.unwrap_or_else(|| pattern(robot).to_owned());
            item.context
                .report(Diagnostic::new(Code::UNKNOWN_NAME, message, name.span).help(help));
            continue;
        };
        let Some(value) = item.float(*dimension, robot.scope) else {
            continue;
        };
        all.push(TrueParameter {
            name,
            body: *body,
            symbol: *symbol,
            value,
        });
    }
    all
}

fn pattern(robot: &Inventory<'_>) -> &'static str {
    match robot.platform {
        None => {
            "names are SYMBOL_JOINT, for instance `zz_1`; only those listed for the joint exist"
        }
        Some(_) => {
            "names are SYMBOL_JOINT_LEG, SYMBOL_platform and SYMBOL_payload; only those \
             listed for the body exist"
        }
    }
}

fn runs(item: &Item<'_, '_>, robot: &Inventory<'_>) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    for table in item.tables("a run") {
        let run = run(&table, robot);
        table.finish();
        let Some(run) = run else { continue };
        if runs.iter().any(|other| other.name.value == run.name.value) {
            let message = format!("there are two runs \"{}\"", run.name.value);
            table.context.report(Diagnostic::new(
                Code::SAME_NAME,
                message,
                run.name.span.clone(),
            ));
        }
        runs.push(run);
    }
    runs
}

/// Largest number of characters of a run's name, which occurs in file names.
const NAME: usize = 60;

fn run(table: &Table<'_, '_>, robot: &Inventory<'_>) -> Option<Run> {
    let scope = robot.scope;
    let name = table
        .require("name", "for instance name = \"unloaded 1\"")
        .and_then(|i| {
            let name = i.string()?;
            let length = name.value.chars().count();
            if length > NAME {
                let message =
                    format!("the name of the run has {length} characters, more than {NAME}");
                let help = "its logs are named after it: choose a short one";
                table
                    .context
                    .report(i.error(Code::BAD_NAME, message).help(help));
            }
            Some(name)
        });
    let payload = table.get("payload");
    let payload = payload.map(|item| payloads::of_run(&item, robot));
    let (payload, payload_name) = payload.unwrap_or_default();
    let validation = table
        .get("validation")
        .and_then(|i| i.boolean())
        .unwrap_or(false);
    let duration = table
        .get("duration")
        .and_then(|i| i.positive(Dimension::TIME, scope));
    let help = "fundamental = \"0.1 Hz\", the frequency of the first harmonic";
    let fundamental = table
        .require("fundamental", help)
        .and_then(|i| i.positive(Dimension::FREQUENCY, scope));
    let help = "terms = [ { coordinate = \"x\", harmonic = 1, amplitude = \"0.05 m\" }, ... ]";
    let terms = table
        .require("terms", help)
        .and_then(|i| i.list())
        .unwrap_or_default();
    let coordinates = robot.coordinates();
    let terms = terms
        .iter()
        .filter_map(|item| term(item, &coordinates, scope))
        .collect();
    Some(Run {
        name: name?,
        payload,
        payload_name,
        validation,
        duration,
        fundamental: fundamental?,
        terms,
    })
}

fn term(item: &Item<'_, '_>, coordinates: &[(String, Dimension)], scope: &Scope) -> Option<Term> {
    let table = item.table("a term")?;
    let help = "coordinate = \"NAME\" of a platform coordinate, or of a joint without platform";
    let coordinate = table.require("coordinate", help);
    let harmonic = table
        .require("harmonic", "harmonic = 1 is the fundamental")
        .and_then(|i| i.integer(1));
    let amplitude = table.require("amplitude", "for instance amplitude = \"0.05 m\"");
    let phase = table
        .get("phase")
        .and_then(|i| i.float(Dimension::ANGLE, scope))
        .unwrap_or(0.0);
    table.finish();
    let coordinate = coordinate?;
    let text = coordinate.string()?;
    let names = || coordinates.iter().map(|(name, _)| name.as_str());
    let Some(index) = names().position(|name| name == text.value) else {
        let list = || {
            format!(
                "its coordinates are {}",
                names().collect::<Vec<_>>().join(", ")
            )
        };
        let help = did_you_mean(&text.value, names()).unwrap_or_else(list);
        let message = format!("the robot has no coordinate `{}`", text.value);
        item.context
            .report(coordinate.error(Code::UNKNOWN_NAME, message).help(help));
        return None;
    };
    let (_, dimension) = coordinates.get(index)?;
    let amplitude = amplitude?.float(*dimension, scope)?;
    let harmonic = u32::try_from(harmonic?).unwrap_or(u32::MAX);
    Some(Term {
        coordinate: text,
        index,
        harmonic,
        amplitude,
        phase,
    })
}
