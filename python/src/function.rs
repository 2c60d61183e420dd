//! Function of a robot as a Python callable on arrays.

use crate::{
    arrays::{Rows, common_samples, output},
    errors,
    function_form::{Argument, Form},
};
use overact::{Extent, Model, SampleError};
use overact_codegen::{
    Choice,
    derivation::{MotionInput, function_name, inventory, name_in_robot},
};
use pyo3::{
    exceptions::{PyTypeError, PyValueError},
    prelude::*,
    types::{PyDict, PyTuple},
};
use std::sync::Arc;

/// Number of samples between checks for signals, such as Ctrl-C.
const STRETCH: usize = 1 << 15;

/// Number of samples that are evaluated individually if one of them has no value.
const TRIED: usize = 64;

/// A function of a robot, callable with arrays of one or many samples.
#[pyclass(module = "overact", frozen)]
pub(crate) struct Function {
    form: Arc<Form>,
}

impl Function {
    pub(crate) const fn new(form: Arc<Form>) -> Self {
        Self { form }
    }
}

#[pymethods]
impl Function {
    /// Evaluates the function.
    ///
    /// The last axis of each input has the numbers of a sample; all axes before are samples. An
    /// input of one axis is used for all samples. Contiguous float64 is read in place.
    #[pyo3(signature = (*arguments, out=None, start=None, invalid="raise", **named))]
    fn __call__<'py>(
        &self,
        py: Python<'py>,
        arguments: &Bound<'py, PyTuple>,
        out: Option<Bound<'py, PyAny>>,
        start: Option<Bound<'py, PyAny>>,
        invalid: &str,
        named: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let fills = match invalid {
            "raise" => false,
            "nan" => true,
            _ => {
                return Err(PyValueError::new_err(format!(
                    "invalid=\"{invalid}\" is neither \"raise\" nor \"nan\""
                )));
            }
        };
        let inputs = self.inputs_of(arguments, named)?;
        let leading = common_samples(&inputs)?;
        let mut start = self.start(start.as_ref())?;
        let shape = [leading.as_slice(), self.form.shape()].concat();
        let mut result = output(py, out.as_ref(), &shape)?;
        let samples = leading.iter().product();
        let slices = inputs.iter().map(Rows::values);
        let slices = slices.collect::<PyResult<Vec<_>>>()?;
        let shared: Vec<bool> = inputs.iter().map(Rows::is_shared).collect();
        let widths: Vec<usize> = inputs.iter().map(Rows::width).collect();
        let width: usize = self.form.shape().iter().product();
        let written = result.as_slice_mut()?;
        let mut first = 0;
        while first < samples {
            let count = STRETCH.min(samples - first);
            let part: Vec<&[f64]> = slices
                .iter()
                .zip(&shared)
                .zip(&widths)
                .map(|((values, shared), width)| {
                    if *shared {
                        values
                    } else {
                        &values[first * width..(first + count) * width]
                    }
                })
                .collect();
            let place = &mut written[first * width..(first + count) * width];
            let call = Call {
                form: &self.form,
                shared: &shared,
            };
            let done = py.detach(|| call.stretch(&part, count, &mut start, place, fills));
            done.map_err(|error| {
                let sample = first + error.sample;
                errors::of_sample(py, &self.name(), &SampleError { sample, ..error })
            })?;
            first += count;
            if first < samples {
                py.check_signals()?;
            }
        }
        let array = (**result).clone().into_any();
        drop(result);
        Ok(array)
    }

    /// Name of the function, as in generated code.
    #[getter]
    fn name(&self) -> String {
        self.form.function().name.clone()
    }

    /// Result of the function, with its equation.
    #[getter]
    fn summary(&self) -> &'static str {
        self.form.function().computes.summary()
    }

    /// Inputs in order, with their length in a sample.
    #[getter]
    fn inputs<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let inputs = PyDict::new(py);
        for one in &self.form.arguments {
            inputs.set_item(&one.name, one.length)?;
        }
        Ok(inputs)
    }

    /// Shape of the output at a sample.
    #[getter]
    fn shape<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, self.form.shape())
    }

    /// Names of the parameters of its columns; empty if it is not a regressor.
    #[getter]
    fn columns(&self) -> Vec<String> {
        let model = self.form.model().model();
        let function = self.form.function().computes;
        let is_model = !function.is_vector();
        let base = function.is_of_base_parameters() && is_model && function.columns().is_some();
        if base {
            model.base.iter().map(|one| model.base_name(one)).collect()
        } else {
            let columns = model.columns_of(function).iter();
            columns.map(|&one| model.parameter_name(one)).collect()
        }
    }

    /// Signature: the function with its inputs and shapes.
    #[getter]
    fn signature(&self) -> String {
        let argument = |one: &Argument| format!("{}: ({},)", one.name, one.length);
        let inputs: Vec<String> = self.form.arguments.iter().map(argument).collect();
        let shape = crate::arrays::shown(self.form.shape());
        format!("{}({}) -> {shape}", self.name(), inputs.join(", "))
    }

    fn __repr__(&self) -> String {
        let robot = self.form.model().info().name;
        format!("<{} of {robot}>", self.signature())
    }
}

impl Function {
    /// Inputs of a call in order, by position or name.
    fn inputs_of<'py>(
        &self,
        arguments: &Bound<'py, PyTuple>,
        named: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Vec<Rows<'py>>> {
        let wanted = &self.form.arguments;
        if arguments.len() > wanted.len() {
            return Err(self.misused(&format!(
                "takes {} inputs, but {} were given",
                wanted.len(),
                arguments.len()
            )));
        }
        if let Some(named) = named {
            for key in named.keys() {
                let key: String = key.extract()?;
                match wanted.iter().position(|one| one.name == key) {
                    None => return Err(self.misused(&format!("has no input `{key}`"))),
                    Some(at) if at < arguments.len() => {
                        return Err(self.misused(&format!("was given `{key}` twice")));
                    }
                    Some(_) => {}
                }
            }
        }
        let mut inputs = Vec::with_capacity(wanted.len());
        for (at, one) in wanted.iter().enumerate() {
            let value = match arguments.get_item(at) {
                Ok(value) => Some(value),
                Err(_) => match named {
                    Some(named) => named.get_item(&one.name)?,
                    None => None,
                },
            };
            let Some(value) = value else {
                return Err(self.misused(&format!("needs `{}`", one.name)));
            };
            let what = self.what(one);
            inputs.push(Rows::new(&value, &one.name, one.length, &what)?);
        }
        Ok(inputs)
    }

    /// Description of an input's numbers.
    fn what(&self, one: &Argument) -> String {
        let model = self.form.model();
        let info = model.info();
        let names: Vec<String> = match one.name.as_str() {
            "pose" => model.model().mechanism.pose_coordinates(),
            "twist" | "acceleration" => info.coordinates.iter().map(ToString::to_string).collect(),
            "actuators" | "torques" | "actuator_velocities" | "actuator_accelerations" => {
                info.actuators.iter().map(ToString::to_string).collect()
            }
            _ => return String::new(),
        };
        format!(" ({})", names.join(", "))
    }

    fn misused(&self, what: &str) -> PyErr {
        PyTypeError::new_err(format!("{} {what}: {}", self.name(), self.signature()))
    }

    /// Start pose of forward kinematics.
    fn start(&self, given: Option<&Bound<'_, PyAny>>) -> PyResult<Vec<f64>> {
        let info = self.form.model().info();
        let Some(given) = given else {
            return Ok(info.home_pose.to_vec());
        };
        if !self.form.follows() {
            return Err(self.misused("takes no `start`, since it does not compute a pose"));
        }
        let rows = Rows::new(given, "start", info.sizes.pose, "")?;
        if rows.is_shared() {
            Ok(rows.values()?.to_vec())
        } else {
            Err(PyValueError::new_err("`start` is one pose, not several"))
        }
    }
}

/// Form with information on its inputs.
struct Call<'a> {
    form: &'a Form,
    shared: &'a [bool],
}

impl Call<'_> {
    /// Evaluates samples; those without a value become NaN if requested.
    fn stretch(
        &self,
        inputs: &[&[f64]],
        samples: usize,
        start: &mut [f64],
        output: &mut [f64],
        fills: bool,
    ) -> Result<(), SampleError> {
        let begin = start.to_vec();
        let done = self.form.evaluate(inputs, samples, start, output);
        match done {
            Err(error) if !fills => Err(error),
            Ok(()) => Ok(()),
            Err(_) => {
                start.copy_from_slice(&begin);
                self.in_parts(inputs, samples, start, output);
                Ok(())
            }
        }
    }

    /// Evaluates samples in small blocks, and individually where one has no value.
    fn in_parts(&self, inputs: &[&[f64]], samples: usize, start: &mut [f64], output: &mut [f64]) {
        let width = output.len() / samples.max(1);
        for first in (0..samples).step_by(TRIED) {
            let count = TRIED.min(samples - first);
            let begin = start.to_vec();
            let place = &mut output[first * width..(first + count) * width];
            let part = self.rows(inputs, samples, first, count);
            if self.form.evaluate(&part, count, start, place).is_ok() {
                continue;
            }
            start.copy_from_slice(&begin);
            for (at, place) in place.chunks_mut(width.max(1)).enumerate() {
                let row = self.rows(inputs, samples, first + at, 1);
                if self.form.evaluate(&row, 1, start, place).is_err() {
                    place.fill(f64::NAN);
                }
            }
        }
    }

    /// Some rows of the inputs.
    fn rows<'v>(
        &self,
        inputs: &[&'v [f64]],
        samples: usize,
        first: usize,
        count: usize,
    ) -> Vec<&'v [f64]> {
        let rows = |(values, shared): (&&'v [f64], &bool)| {
            let values: &'v [f64] = values;
            let width = values.len() / samples.max(1);
            if *shared {
                values
            } else {
                &values[first * width..(first + count) * width]
            }
        };
        inputs.iter().zip(self.shared).map(rows).collect()
    }
}

/// Names of a robot's functions, in the order of the table of functions.
pub(crate) fn names(model: &overact_codegen::RobotModel) -> Vec<String> {
    let all = inventory(&model.mechanism, &model.selection);
    all.iter()
        .map(|form| name_in_robot(&model.mechanism, *form))
        .collect()
}

/// Function for documentation: full name, source, inputs, meaning of rows and columns, summary.
type Known = (
    String,
    &'static str,
    Vec<&'static str>,
    (&'static str, Option<&'static str>),
    &'static str,
);

/// All functions of robots with a platform, in all forms.
#[pyfunction]
pub(crate) fn known_functions() -> Vec<Known> {
    let sources = [
        MotionInput::Pose,
        MotionInput::Joints,
        MotionInput::Actuators,
    ];
    let mut known: Vec<Known> = Vec::new();
    for function in overact::Function::ALL {
        for from in sources {
            let name = function_name(function, from, false);
            let is_new = known.iter().all(|one| one.0 != name);
            if is_new && Choice::new([name.as_str()]).is_ok_and(|_| is_form(function, from)) {
                let inputs = function.inputs().iter().map(|input| input.name());
                let (rows, columns) = function.extents();
                let extents = (counted(rows), columns.map(counted));
                known.push((
                    name,
                    from.name(),
                    inputs.collect(),
                    extents,
                    function.summary(),
                ));
            }
        }
    }
    known
}

/// Whether some robot with a platform has this form of a function.
fn is_form(function: overact::Function, from: MotionInput) -> bool {
    let plain = match function {
        overact::Function::PoseInClosedForm => MotionInput::Actuators,
        _ if function.inputs().contains(&overact::Input::Joints) => MotionInput::Joints,
        _ => MotionInput::Pose,
    };
    // The selection of functions already excludes forms with other names.
    from == plain
        || from != MotionInput::Pose
            && function_name(function, from, false) != function_name(function, plain, false)
}

/// Meaning of the number of rows or columns.
const fn counted(extent: Extent) -> &'static str {
    match extent {
        Extent::Pose => "pose",
        Extent::Dof => "r",
        Extent::Actuators => "n",
        Extent::Joints => "n_t",
        Extent::Redundancy => "n - r",
        Extent::Parameters => "n_st",
        Extent::BaseParameters => "n_b",
        Extent::PayloadParameters => "n_l",
        Extent::Free => "6",
        Extent::Blocked => "6 - r",
        Extent::Dependent => "pose - r",
        Extent::Fixed(1) => "1",
        Extent::Fixed(3) => "3",
        Extent::Fixed(6) => "6",
        Extent::Fixed(7) => "7",
        _ => "?",
    }
}
