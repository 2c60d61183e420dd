//! Functions called by name, for other languages and the browser.

use crate::error::Problem;
use overact::{FrameQuantity, Function, Input, Model};
use overact_codegen::diagnostic::{Code, did_you_mean};

/// Name of a function in the table of functions; `_base` marks functions of base parameters.
#[must_use]
pub fn function_of_model(function: Function) -> String {
    if function.is_of_base_parameters() {
        format!("{}_base", function.name())
    } else {
        function.name().to_owned()
    }
}

/// The function of a name, of the table or of a frame.
fn found(model: &dyn Model, name: &str) -> Option<Function> {
    let mut all = Function::ALL.into_iter();
    let of_frame = || {
        let (frame, quantity) = FrameQuantity::in_name(name)?;
        let frame = model.frames().iter().position(|own| *own == frame)?;
        Some(Function::of_frame(frame, quantity))
    };
    all.find(|one| function_of_model(*one) == name)
        .or_else(of_frame)
}

/// Evaluates a function at samples, by its name ([`function_of_model`]) or that of a frame's
/// function, such as `tool_pose`.
///
/// `inputs` contains all inputs in order, each sample by sample; parameters occur once. The output
/// is sample by sample, each row-major.
///
/// ```
/// use overact_robot::{Robot, values};
///
/// # fn main() -> Result<(), overact_robot::Error> {
/// # let emps = concat!(env!("CARGO_MANIFEST_DIR"), "/../robots/emps.toml");
/// let robot = Robot::from_toml(emps)?; // "robots/emps.toml"
/// assert_eq!(values(robot.model(), "joints", 2, &[0.1, 0.2])?, [0.1, 0.2]);
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// An unknown function, a wrong number of inputs, or a sample without a value.
pub fn values(
    model: &dyn Model,
    function: &str,
    samples: usize,
    inputs: &[f64],
) -> Result<Vec<f64>, Problem> {
    let misused = |message: String| Problem::new(Code::USAGE, message);
    let found = found(model, function).ok_or_else(|| {
        let mut names: Vec<String> = Function::ALL.into_iter().map(function_of_model).collect();
        for frame in model.frames() {
            let of_frame = FrameQuantity::ALL.into_iter();
            names.extend(of_frame.map(|quantity| format!("{frame}_{}", quantity.name())));
        }
        let problem = misused(format!("there is no function `{function}`"));
        match did_you_mean(function, names.iter().map(String::as_str)) {
            Some(help) => problem.help(help),
            None => problem,
        }
    })?;
    let sizes = model.info().sizes;
    let (mut rows, mut rest) = (Vec::new(), inputs);
    for input in found.inputs() {
        let count = match input {
            Input::Parameters | Input::BaseParameters => 1,
            _ => samples,
        };
        let parts = rest.split_at_checked(sizes.of(*input) * count);
        let (own, others) = parts
            .ok_or_else(|| misused(format!("there are too few numbers for `{}`", input.name())))?;
        rows.push(own);
        rest = others;
    }
    if !rest.is_empty() {
        return Err(misused(format!(
            "there are {} numbers too many",
            rest.len()
        )));
    }
    let (height, width) = found.shape(&sizes);
    let mut output = vec![0.0; samples * height * width];
    let done = model.evaluate(found, &rows, &mut output);
    done.map_err(|error| misused(format!("sample {}: {}", error.sample, error.error)))?;
    Ok(output)
}
