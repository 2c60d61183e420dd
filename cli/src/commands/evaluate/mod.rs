//! `overact evaluate`: evaluates a function of a robot for given states.

mod gather;
mod resolve;

use crate::{
    failure::{Failure, Problem},
    function_options::{ColumnsOf, Source},
    input,
    note::print_warnings,
    output,
    states::States,
};
use overact::Model;
use overact::{Columns, Function};
use overact_codegen::diagnostic::Code;
use overact_codegen::{
    Effort, Request, RobotModel,
    derivation::{FunctionForm, MotionInput, name_in_robot},
    interpreter::Rows,
    lowering::Program,
    mechanism::Mechanism,
    model_with,
};
use overact_robot::{CompiledFile, InterpretedRobot, read_parameters};
use serde::Serialize;
use std::{collections::BTreeMap, path::PathBuf};

/// Arguments of the command.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Description
    #[arg(value_name = "TOML")]
    pub(super) file: PathBuf,
    /// A function, such as `idm_red_platform`, or the full name of a Rust function
    function: String,
    /// States: a JSON array of objects keyed by input name, or CSV with a header such as
    /// `pose[0],pose[1]`; `-` is stdin
    #[arg(long, value_name = "FILE")]
    states: PathBuf,
    /// Inputs to evaluate from [default: those of the states]
    #[arg(long, value_enum)]
    from: Option<Source>,
    /// Columns of an identification model, or parameters of dynamics [default: standard]
    #[arg(long, value_enum)]
    columns: Option<ColumnsOf>,
    /// Kept actuators of the actuator projection [default: those of the description]
    #[arg(long, value_delimiter = ',', value_name = "ACTUATORS")]
    kept: Option<Vec<String>>,
    /// Standard parameters, for functions that take `parameters` or `base_parameters` [default: those of
    /// each state]
    #[arg(long, value_name = "TOML")]
    parameters: Option<PathBuf>,
    /// Write to a file instead of stdout
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// JSON document.
#[derive(Debug, Serialize)]
struct Document {
    function: String,
    parameters: Vec<String>,
    shapes: BTreeMap<String, Vec<usize>>,
    results: Vec<BTreeMap<String, Vec<f64>>>,
}

/// Quantities that states may contain: inputs of all functions, and the start of forward
/// kinematics.
const QUANTITIES: [&str; 15] = [
    "pose",
    "twist",
    "acceleration",
    "joints",
    "joint_velocities",
    "joint_accelerations",
    "actuators",
    "actuator_velocities",
    "actuator_accelerations",
    "torques",
    "parameters",
    "base_parameters",
    "preload",
    "wrench",
    "start",
];

/// Runs the command.
///
/// # Errors
/// A function that the robot does not have, states without the required inputs, or a state for
/// which the function has no value.
pub(super) fn run(arguments: &Arguments, as_json: bool) -> Result<(), Failure> {
    let mut inputs = vec![arguments.file.as_path(), arguments.states.as_path()];
    inputs.extend(arguments.parameters.as_deref());
    output::check(&inputs, output::file(arguments.output.as_ref()).as_slice())?;
    let name = arguments.function.as_str();
    let wanted = |mechanism: &Mechanism, function: Function, from: MotionInput| {
        let full = || name_in_robot(mechanism, FunctionForm::new(function, from));
        let is_of_frame = matches!(function, Function::Frame(_));
        InterpretedRobot::finds_pose(mechanism, function, from)
            || (function.name() == name && !is_of_frame)
            || full() == name
    };
    let request = Request {
        wanted: &wanted,
        side_by_side: false,
        ..Request::with_effort(Effort::None)
    };
    let CompiledFile {
        mut model,
        description,
        ..
    } = input::compiled(&arguments.file, &request, as_json)?;
    let states = States::read(&arguments.states)?;
    let unknown = states.unknown(&QUANTITIES);
    print_warnings(unknown.as_slice(), as_json);
    if let Some(names) = &arguments.kept {
        model = with_kept(model, names, &request)?;
    }
    let function = resolve::function(&model, arguments, &states)?;
    let program = function.program.clone();
    let (function, from, name) = (function.computes, function.from, function.name.clone());
    let robot = InterpretedRobot::new(model);
    let given = match &arguments.parameters {
        Some(path) => {
            let given = read_parameters(path, &description, &robot.info())?;
            print_warnings(&given.warnings, as_json);
            GivenParameters::new(&given.values, &robot)
        }
        None => GivenParameters::default(),
    };
    let values = evaluate(&robot, &program, from, given, &states)?;
    let width = program.output.len();
    let rows = (0..states.len()).map(|at| &values[at * width..(at + 1) * width]);
    let shape = program.output.shape.clone();
    let label = robot.model().function_name(function);
    let text = if as_json {
        output::json(&Document {
            function: name,
            parameters: parameters(robot.model(), function),
            shapes: BTreeMap::from([(label.clone(), shape)]),
            results: rows
                .map(|row| BTreeMap::from([(label.clone(), row.to_vec())]))
                .collect(),
        })?
    } else {
        csv(&label, &shape, rows)
    };
    output::emit(&text, output::file(arguments.output.as_ref()))
}

/// Model with other kept actuators than the description's.
fn with_kept(
    model: RobotModel,
    names: &[String],
    request: &Request<'_>,
) -> Result<RobotModel, Failure> {
    let kept = overact_robot::kept_actuators(&model, names)?;
    let mut mechanism = model.mechanism;
    mechanism.kept_actuators = kept;
    model_with(mechanism, request).map_err(|_| {
        let message = "these kept actuators never determine the platform's motion";
        let help = "choose other ones; `overact inspect` lists how well each choice does";
        Problem::new(Code::KEPT_ACTUATORS, message)
            .help(help)
            .into()
    })
}

/// Names of the columns.
fn parameters(model: &RobotModel, function: Function) -> Vec<String> {
    match function {
        Function::IdmRedPlatform(Columns::Base) | Function::IdmRedActuators(Columns::Base) => model
            .base
            .iter()
            .map(|base| model.base_name(base))
            .collect(),
        _ => model
            .columns_of(function)
            .iter()
            .map(|&p| model.parameter_name(p))
            .collect(),
    }
}

/// Parameters of all states, in the order of the functions' inputs.
#[derive(Debug, Default)]
struct GivenParameters {
    standard: Option<Vec<f64>>,
    base: Option<Vec<f64>>,
}

impl GivenParameters {
    /// Parameters of a file; without values for the payload there is none.
    fn new(values: &BTreeMap<String, f64>, robot: &InterpretedRobot) -> Self {
        let info = robot.info();
        let all = info.parameters.iter().chain(info.payload_parameters);
        let standard = all.map(|one| values.get(one.name).copied().unwrap_or_default());
        let base = robot.model().regrouped(values);
        Self {
            standard: Some(standard.collect()),
            base: Some(base.into_iter().map(|(_, value)| value).collect()),
        }
    }

    /// Parameters for an input.
    fn input(&self, name: &str) -> Option<&Vec<f64>> {
        match name {
            "parameters" => self.standard.as_ref(),
            "base_parameters" => self.base.as_ref(),
            _ => None,
        }
    }
}

/// Values for all states, row after row.
fn evaluate(
    robot: &InterpretedRobot,
    program: &Program,
    from: MotionInput,
    parameters: GivenParameters,
    states: &States,
) -> Result<Vec<f64>, Failure> {
    let inputs = gather::inputs(robot, program, from, parameters, states)?;
    let rows: Vec<Rows<'_>> = inputs
        .iter()
        .map(|values| Rows {
            values,
            shared: false,
        })
        .collect();
    let mut values = vec![0.0; states.len() * program.entries.len()];
    let done = program.evaluate(states.len(), &rows, &mut values);
    done.map_err(|failed| {
        let error = robot.error(program, &failed);
        states.problem(error.sample, &error.error.to_string())
    })?;
    // Guards keep denominators away from zero, but squares of inputs such as 1e200 overflow.
    match values.iter().position(|value| !value.is_finite()) {
        None => Ok(values),
        Some(at) => {
            let width = program.entries.len();
            let message = format!(
                "number {} of the result is too large for a number",
                at % width
            );
            let help = "check the units: positions in m and rad, velocities in m/s and rad/s";
            Err(states.problem(at / width, &message).help(help).into())
        }
    }
}

/// CSV with one row per state and indexed column names.
fn csv<'a>(name: &str, shape: &[usize], rows: impl Iterator<Item = &'a [f64]>) -> String {
    let mut header: Vec<String> = vec![name.to_owned()];
    for &length in shape {
        header = header
            .iter()
            .flat_map(|h| (0..length).map(move |i| format!("{h}[{i}]")))
            .collect();
    }
    let mut text = header.join(",") + "\n";
    for row in rows {
        let cells: Vec<String> = row.iter().map(|value| format!("{value:?}")).collect();
        text += &(cells.join(",") + "\n");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::csv;

    #[test]
    fn csv_columns_are_named_in_row_major_order() {
        let rows = [&[1.0, 2.0, 3.0, 4e-30][..]].into_iter();
        let expected = "j[0][0],j[0][1],j[1][0],j[1][1]\n1.0,2.0,3.0,4e-30\n";
        assert_eq!(csv("j", &[2, 2], rows), expected);
    }
}
