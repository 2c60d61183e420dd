//! A description as a Python object.

use crate::{
    arrays::{Rows, common_samples, output},
    errors,
    function::{Function, names},
    function_form::{Form, Owner, follow},
    identification::{self, Identified},
    operations,
    simulation::{self, Made, Wishes},
};
use overact::{Model, Parameter, SampleError};
use overact_codegen::{
    Choice, Effort, Request,
    derivation::{FunctionForm, MotionInput, name_in_robot},
    diagnostic::did_you_mean,
    mechanism::Mechanism,
};
use overact_identification::Time;
use overact_robot::{CompiledFile, Error, InterpretedRobot, Robot};
use pyo3::{
    exceptions::{PyAttributeError, PyValueError},
    prelude::*,
    types::{PyDict, PyTuple},
};
use std::{
    collections::{BTreeMap, HashMap},
    path::PathBuf,
    sync::{Arc, Mutex, PoisonError},
};

/// A robot compiled from its description; the base of `overact.Robot`.
#[pyclass(module = "overact._overact", frozen)]
pub(crate) struct Handle {
    robot: Arc<Robot>,
    forms: Mutex<HashMap<String, Arc<Form>>>,
}

impl Handle {
    fn new(py: Python<'_>, robot: Result<Robot, Error>) -> PyResult<Self> {
        let robot = robot.map_err(|error| errors::of_robot(py, &error))?;
        Ok(Self {
            robot: Arc::new(robot),
            forms: Mutex::default(),
        })
    }

    /// Form by name; compiled now if the robot was compiled without it.
    fn form(&self, py: Python<'_>, name: &str) -> PyResult<Arc<Form>> {
        let forms = || self.forms.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(form) = forms().get(name) {
            return Ok(Arc::clone(form));
        }
        let own = self.robot.model().model();
        let known = names(own);
        if !known.iter().any(|one| one == name) {
            let known = known.iter().map(String::as_str);
            let help = did_you_mean(name, known)
                .unwrap_or_else(|| "`Robot.functions` lists them".to_owned());
            let robot = &own.mechanism.name;
            let message = format!("the robot {robot} has no function `{name}`; {help}");
            return Err(PyAttributeError::new_err(message));
        }
        let owner = if own.functions.iter().any(|one| one.name == name) {
            Owner::Robot(Arc::clone(&self.robot))
        } else {
            Owner::Own(Box::new(
                py.detach(|| self.compiled_alone(name))
                    .map_err(|error| errors::of_robot(py, &error))?,
            ))
        };
        let form = Form::new(owner, name);
        let form = form.ok_or_else(|| {
            PyAttributeError::new_err(format!("the function `{name}` can't be derived"))
        })?;
        let form = Arc::new(form);
        forms().insert(name.to_owned(), Arc::clone(&form));
        Ok(form)
    }

    /// Model of one function only, with the functions that compute its pose.
    fn compiled_alone(&self, name: &str) -> Result<InterpretedRobot, Error> {
        let wanted = |mechanism: &Mechanism, function, from: MotionInput| {
            InterpretedRobot::finds_pose(mechanism, function, from)
                || name_in_robot(mechanism, FunctionForm::new(function, from)) == name
        };
        let request = Request {
            wanted: &wanted,
            side_by_side: false,
            ..Request::with_effort(Effort::None)
        };
        let compiled = CompiledFile::new(self.robot.source().clone(), &request)?;
        Ok(InterpretedRobot::new(compiled.model))
    }

    /// Compiles the description with an effort.
    fn compiled(
        &self,
        py: Python<'_>,
        functions: Option<Vec<String>>,
        effort: &str,
    ) -> PyResult<CompiledFile> {
        let effort = Effort::named(effort).ok_or_else(|| {
            let known = Effort::ALL.map(Effort::name).join(", ");
            PyValueError::new_err(format!("effort=\"{effort}\" is none of {known}"))
        })?;
        let choice = functions.map(|names| Choice::new(names.iter().map(String::as_str)));
        let choice = choice.transpose().map_err(|unknown| {
            let told = unknown.iter().map(|one| format!("{one}; {}", one.help));
            PyValueError::new_err(told.collect::<Vec<_>>().join("\n"))
        })?;
        let request = Request {
            functions: choice.as_ref(),
            ..Request::with_effort(effort)
        };
        py.detach(|| CompiledFile::new(self.robot.source().clone(), &request))
            .map_err(|error| errors::of_robot(py, &error))
    }
}

#[pymethods]
impl Handle {
    /// The robot of a description in a file.
    #[staticmethod]
    fn from_file(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let robot = py.detach(|| Robot::from_toml(path));
        Self::new(py, robot)
    }

    /// Robot of a description in memory; `name` is its name in errors.
    #[staticmethod]
    fn from_text(py: Python<'_>, text: &str, name: &str) -> PyResult<Self> {
        let robot = py.detach(|| Robot::from_text(name, text));
        Self::new(py, robot)
    }

    /// The text of the description.
    #[getter]
    fn text(&self) -> &str {
        &self.robot.source().text
    }

    /// Path or name of the description in errors.
    #[getter]
    fn file(&self) -> &str {
        self.robot.file()
    }

    /// Names, sizes and parameters as JSON.
    fn info(&self) -> String {
        info(&self.robot).to_string()
    }

    /// Names of all functions.
    fn function_names(&self) -> Vec<String> {
        names(self.robot.model().model())
    }

    /// A function by its name.
    fn function(&self, py: Python<'_>, name: &str) -> PyResult<Function> {
        self.form(py, name).map(Function::new)
    }

    /// Cost of functions as JSON.
    #[pyo3(signature = (functions=None, effort="quick"))]
    fn costs(
        &self,
        py: Python<'_>,
        functions: Option<Vec<String>>,
        effort: &str,
    ) -> PyResult<String> {
        let compiled = self.compiled(py, functions, effort)?;
        Ok(operations::costs(&compiled.model).to_string())
    }

    /// The program of a function, step by step.
    #[pyo3(signature = (name, effort="quick"))]
    fn program<'py>(
        &self,
        py: Python<'py>,
        name: &str,
        effort: &str,
    ) -> PyResult<Bound<'py, PyDict>> {
        // Unknown names are reported with similar ones.
        self.form(py, name)?;
        let compiled = self.compiled(py, Some(vec![name.to_owned()]), effort)?;
        let function = compiled.model.functions.iter().find(|one| one.name == name);
        let function = function.ok_or_else(|| {
            PyAttributeError::new_err(format!("the function `{name}` can't be derived"))
        })?;
        operations::steps(py, &function.program)
    }

    /// Forward kinematics: poses from the positions of all actuators, sample by sample.
    #[pyo3(signature = (actuators, start=None, out=None))]
    fn pose_from_actuators<'py>(
        &self,
        py: Python<'py>,
        actuators: &Bound<'py, PyAny>,
        start: Option<&Bound<'py, PyAny>>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let info = self.robot.model().info();
        let names = format!(" ({})", info.actuators.join(", "));
        let rows = Rows::new(actuators, "actuators", info.sizes.actuators, &names)?;
        let rows = [rows];
        let leading = common_samples(&rows)?;
        let mut pose = match start {
            None => info.home_pose.to_vec(),
            Some(start) => {
                let start = Rows::new(start, "start", info.sizes.pose, "")?;
                start.values()?[..info.sizes.pose].to_vec()
            }
        };
        let shape = [leading.as_slice(), &[info.sizes.pose]].concat();
        let mut result = output(py, out, &shape)?;
        let values = rows[0].values()?;
        let written = result.as_slice_mut()?;
        let model = self.robot.model();
        let done = py.detach(|| {
            let samples = values.chunks(info.sizes.actuators.max(1));
            let places = written.chunks_mut(info.sizes.pose.max(1));
            for (sample, (row, place)) in samples.zip(places).enumerate() {
                follow(model, row, &mut pose).map_err(|error| SampleError { sample, error })?;
                place.copy_from_slice(&pose);
            }
            Ok(())
        });
        done.map_err(|error| errors::of_sample(py, "pose_from_actuators", &error))?;
        let array = (**result).clone().into_any();
        drop(result);
        Ok(array)
    }

    /// Values of the base parameters, the payload's last, from standard parameters by name.
    fn regrouped(&self, values: BTreeMap<String, f64>) -> Vec<f64> {
        let base = self.robot.model().model().regrouped(&values).into_iter();
        base.map(|(_, value)| value).collect()
    }

    /// A drawing of the robot at its home configuration, SVG.
    fn drawing(&self) -> String {
        overact_robot::drawing::svg(&self.robot.model().model().mechanism)
    }

    /// Simulates the virtual experiment.
    #[pyo3(signature = (runs, seed=None, parameters=None, progress=None))]
    fn simulate<'py>(
        &self,
        py: Python<'py>,
        runs: Vec<String>,
        seed: Option<u64>,
        parameters: Option<BTreeMap<String, f64>>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Made<'py>> {
        let wishes = Wishes {
            runs,
            seed,
            parameters,
        };
        simulation::simulate(py, &self.robot, &wishes, progress)
    }

    /// Identifies the robot.
    fn identify(
        &self,
        py: Python<'_>,
        runs: Vec<Bound<'_, PyTuple>>,
        validation: Vec<Bound<'_, PyTuple>>,
        options: &Bound<'_, PyDict>,
    ) -> PyResult<Identified> {
        identification::identify(py, &self.robot, &runs, &validation, options)
    }
}

/// Names, sizes and parameters.
fn info(robot: &Robot) -> serde_json::Value {
    let (info, model) = (robot.model().info(), robot.model().model());
    let mechanism = &model.mechanism;
    let description = robot.description();
    let parameter = |one: &Parameter| serde_json::json!({ "name": one.name, "symbol": one.symbol.name(), "unit": one.unit });
    let parameters = |all: &[Parameter]| all.iter().map(parameter).collect::<Vec<_>>();
    let base = model.base.iter().map(|base| {
        let regrouped = base.regrouped.iter();
        let regrouped = regrouped.map(|&(one, factor)| (model.parameter_name(one), factor));
        serde_json::json!({
            "name": model.base_name(base),
            "parameter": model.parameter_name(base.parameter),
            "unit": model.parameter_unit(base.parameter),
            "regrouped": regrouped.collect::<Vec<_>>(),
        })
    });
    let joints = mechanism.joints();
    let joints: Vec<String> = joints.iter().map(|&at| mechanism.joint_name(at)).collect();
    let experiment = description.experiment.as_ref();
    let runs = experiment.iter().flat_map(|table| &table.runs);
    let runs: Vec<&str> = runs.map(|run| run.name.value.as_str()).collect();
    serde_json::json!({
        "name": info.name,
        "summary": description.summary,
        "source": description.source,
        "r": info.sizes.dof,
        "n": info.sizes.actuators,
        "joints": joints,
        "legs": info.legs,
        "actuators": info.actuators,
        "actuator_is_revolute": info.actuator_is_revolute,
        "actuator_joints": actuator_joints(robot),
        "coordinates": info.coordinates,
        "pose_coordinates": if model.is_tree() { mechanism.coordinates() } else { mechanism.pose_coordinates() },
        "home_pose": info.home_pose,
        "home_joints": info.home_joints,
        "kept_actuators": info.kept_actuators,
        "parameters": parameters(info.parameters),
        "payload_parameters": parameters(info.payload_parameters),
        "base_parameters": base.collect::<Vec<_>>(),
        "runs": runs,
        "columns": columns(robot),
        "held_out": robot.held_out(),
        "true_values": robot.true_values(),
    })
}

/// Joints that each actuator drives, with factors.
fn actuator_joints(robot: &Robot) -> Vec<Vec<(usize, f64)>> {
    let model = robot.model();
    let joints = model.info().actuated_joints.iter().enumerate();
    joints
        .map(|(actuator, &joint)| match model.actuator_terms(actuator) {
            [] => vec![(joint, 1.0)],
            terms => terms.to_vec(),
        })
        .collect()
}

/// Columns of a log, including columns in expressions.
fn columns(robot: &Robot) -> Vec<String> {
    let mapping = robot.mapping();
    let time = match mapping.time {
        Time::Column(name) => Some(name),
        Time::Frequency(_) => None,
    };
    let signals = [mapping.positions, mapping.torques, mapping.velocities];
    time.into_iter().chain(signals.concat()).collect()
}
