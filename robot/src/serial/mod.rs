//! The skeleton of a robot as a serial robot, with the inertia of its loops lumped into its bodies.
//!
//! Simulators and controllers for serial robots cannot handle loops. A serial model has the same
//! coordinates and frames, and bodies that fit the inertia matrix and the torque of gravity of the
//! whole robot over its workspace. The report gives the errors that remain, at other states than
//! those of the fit.
//!
//! - `tree`: the skeleton, and its dynamics as columns of inertial parameters;
//! - `pseudo_inertia`: ten parameters as a matrix, and in another frame;
//! - `states`: states of the workspace with the robot's dynamics;
//! - `lumping`: the fit of physically consistent bodies.

mod lumping;
mod pseudo_inertia;
mod states;
mod tree;

pub use states::RangeOrigin;

use crate::{
    error::{Error, Problem},
    interpreted::InterpretedRobot,
    robot::Robot,
};
use lumping::{Lumping, Scales};
use nalgebra::{DMatrix, DVector, Vector3};
use overact::{Columns, Function, Model, StandardParameter};
use overact_codegen::{
    Effort, Request, derivation::MotionInput, diagnostic::Code, mechanism::Mechanism,
};
use overact_interchange::{Format, SerialBody, SerialTree, write_serial};
use pseudo_inertia::moved;
use serde::Serialize;
use states::{Plant, State};
use std::collections::BTreeMap;
use tree::{INERTIAL, Tree};

/// Gravity that programs assume for URDF, m/s².
const STANDARD_GRAVITY: f64 = 9.81;

/// Reason why a robot has no serial model.
#[derive(Debug)]
struct Refusal {
    message: String,
    help: String,
}

/// Settings of a serial model.
#[derive(Debug, Clone, PartialEq)]
pub struct SerialSettings {
    /// MJCF or URDF.
    pub format: Format,
    /// Values of the standard parameters by name; those of the virtual experiment if absent.
    pub parameters: Option<BTreeMap<String, f64>>,
    /// Number of states of the fit.
    pub fitted_states: usize,
    /// Number of states at which the errors are computed.
    pub states: usize,
    /// Seed of the states of the errors; those of the fit have the next one.
    pub seed: u64,
}

impl SerialSettings {
    /// Default settings for a format.
    #[must_use]
    pub const fn new(format: Format) -> Self {
        Self {
            format,
            parameters: None,
            fitted_states: 400,
            states: 1000,
            seed: 1,
        }
    }
}

/// Error of a quantity over the states, relative to its root mean square.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct RelativeError {
    /// Root mean square.
    pub rms: f64,
    /// Largest error.
    pub largest: f64,
}

/// A serial model with its errors.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SerialModel {
    /// Name of the robot.
    pub robot: String,
    /// The file.
    #[serde(skip)]
    pub text: String,
    /// Names of the coordinates.
    pub coordinates: Vec<String>,
    /// Centres of their ranges, rad or m.
    pub home: Vec<f64>,
    /// Half ranges of the states, rad or m.
    pub half_ranges: Vec<f64>,
    /// Origin of the ranges.
    pub origin: RangeOrigin,
    /// Pose and twist of each state of the errors.
    #[serde(skip)]
    pub states: Vec<(Vec<f64>, Vec<f64>)>,
    /// Number of states.
    pub state_count: usize,
    /// Number of other states of the ranges that are outside the workspace.
    pub rejected_states: usize,
    /// Number of states that a singularity of the motors separates from home.
    ///
    /// There, the positions of the motors do not determine those of the joints.
    pub ambiguous_states: usize,
    /// Error of the inertia matrix.
    pub inertia_matrix: RelativeError,
    /// Error of the torque of gravity; `None` without gravity.
    pub gravity: Option<RelativeError>,
    /// Error of centrifugal and Coriolis torques; `None` if there are none.
    pub velocity_torques: Option<RelativeError>,
    /// Parts of the robot that the file does not have, as sentences.
    pub notes: Vec<String>,
}

/// Functions that a serial model needs.
fn needs(mechanism: &Mechanism, function: Function, from: MotionInput) -> bool {
    matches!(function, Function::Bias(Columns::Standard))
        || InterpretedRobot::serves(mechanism, function, from)
}

impl Robot {
    /// Compilation request for [`serial`](Self::serial).
    #[must_use]
    pub fn serial_request() -> Request<'static> {
        Request {
            wanted: &needs,
            side_by_side: false,
            ..Request::with_effort(Effort::None)
        }
    }

    /// Serial model of the robot's skeleton, or of the whole robot if it has no loops.
    ///
    /// The robot must be compiled for [`serial_request`](Self::serial_request).
    ///
    /// # Errors
    /// A robot without a skeleton, without values of its parameters, or with too small a workspace.
    pub fn serial(&self, settings: &SerialSettings) -> Result<SerialModel, Error> {
        let refused = |refusal: Refusal| -> Error {
            let problem = Problem::new(Code::STRUCTURE, refusal.message);
            problem.file(self.file()).help(refusal.help).into()
        };
        let at_home = |error: overact::Error| -> Error {
            let message = format!("the robot has no dynamics at home: {error}");
            Problem::new(Code::SINGULAR, message)
                .file(self.file())
                .into()
        };
        let mechanism = &self.model().model().mechanism;
        let tree = Tree::new(mechanism).map_err(refused)?;
        let values = match settings.parameters.clone().or_else(|| self.true_values()) {
            Some(values) => values,
            None => {
                let message = "the description has no values of the parameters";
                let help = "give a file of `overact identify --parameters` by `--parameters`, or write the table [experiment.parameters]";
                let problem = Problem::new(Code::NO_EXPERIMENT, message);
                return Err(problem.file(self.file()).help(help).into());
            }
        };
        let value = |name: &str| values.get(name).copied().unwrap_or(0.0);
        let plant = Plant::new(self, &value).map_err(at_home)?;
        let mut armature = plant.rotors_at_home().map_err(at_home)?;
        if settings.format == Format::Urdf {
            armature.clear();
        }
        let next = settings.seed.wrapping_add(1);
        let fitted = plant.drawn(settings.fitted_states, next).map_err(refused)?;
        let states = plant
            .drawn(settings.states, settings.seed)
            .map_err(refused)?;
        let gravity = Vector3::from(mechanism.gravity.map(|number| number.value()));
        let own = own_inertia(mechanism, &tree, &value);
        let lumping = Lumping {
            tree: &tree,
            states: &fitted.all,
            gravity,
            armature: &armature,
            length: mechanism.length_scale(),
            own: &own,
        };
        let mut bodies = lumping.fitted();
        armature = bodies.split_off(own.len());
        armature.resize(mechanism.dof(), 0.0);
        let errors = Errors {
            tree: &tree,
            bodies: DVector::from_column_slice(&bodies),
            armature: &armature,
            gravity,
        };
        let [inertia_matrix, gravity_error, velocity_torques] = errors.over(&states.all);
        let info = self.model().info();
        let mut model = SerialModel {
            robot: info.name.to_owned(),
            text: String::new(),
            coordinates: mechanism.coordinates(),
            home: info.home_pose.to_vec(),
            half_ranges: plant.ranges.clone(),
            origin: plant.origin,
            state_count: states.all.len(),
            rejected_states: states.rejected,
            ambiguous_states: states.all.iter().filter(|state| state.is_beyond).count(),
            states: { states.all.iter() }
                .map(|state| (state.pose.clone(), state.twist.clone()))
                .collect(),
            inertia_matrix: inertia_matrix.unwrap_or(RelativeError {
                rms: 0.0,
                largest: 0.0,
            }),
            gravity: gravity_error,
            velocity_torques,
            notes: notes(mechanism, settings.format, &value, self),
        };
        let written = written(&model, &tree, &armature, &bodies, gravity);
        model.text = write_serial(&written, settings.format);
        Ok(model)
    }
}

/// Inertial parameters of the skeleton's moving bodies, with those of bodies fixed on them.
fn own_inertia(mechanism: &Mechanism, tree: &Tree, value: &dyn Fn(&str) -> f64) -> Vec<f64> {
    use overact_codegen::mechanism::StandardParameter;
    let mut all = vec![0.0; INERTIAL * tree.bodies.len()];
    let Some(leg) = mechanism.legs.first() else {
        return all;
    };
    for index in 0..leg.joints.len() {
        let Some((body, place)) = tree.carrier(leg, index) else {
            continue;
        };
        let name = |symbol| mechanism.parameter_name(symbol, 0, index);
        let inertia = StandardParameter::INERTIA.map(|symbol| value(&name(symbol)));
        let moved = moved(&inertia, &place);
        let own = all.iter_mut().skip(INERTIAL * body).zip(moved);
        own.for_each(|(sum, part)| *sum += part);
    }
    all
}

/// Sentences on parts of the robot that the file does not have.
fn notes(
    mechanism: &Mechanism,
    format: Format,
    value: &dyn Fn(&str) -> f64,
    robot: &Robot,
) -> Vec<String> {
    let info = robot.model().info();
    let has = |is_kind: &dyn Fn(StandardParameter) -> bool| {
        let mut own = info.parameters.iter();
        own.any(|one| is_kind(one.symbol) && value(one.name) != 0.0)
    };
    let mut notes = Vec::new();
    if has(&|symbol| symbol.is_friction() || symbol == StandardParameter::Off) {
        notes.push("friction and offsets are left out".to_owned());
    }
    let is_known = |leg: &overact_codegen::mechanism::Leg| {
        leg.joints.iter().any(|joint| joint.known.is_some())
    };
    if has(&|symbol| symbol == StandardParameter::K)
        || !mechanism.springs.is_empty()
        || mechanism.legs.iter().any(is_known)
    {
        notes.push("springs, dampers and known torques are left out".to_owned());
    }
    if !info.payload_parameters.is_empty() {
        notes.push("the payload is left out".to_owned());
    }
    let gravity = Vector3::from(mechanism.gravity.map(|number| number.value())).norm();
    if format == Format::Urdf && (gravity - STANDARD_GRAVITY).abs() > 1e-9 {
        notes.push(format!(
            "URDF has no gravity: set it to {gravity} m/s² along -z in the simulator"
        ));
    }
    if format == Format::Urdf && has(&|symbol| symbol == StandardParameter::Ia) {
        notes.push(
            "URDF has no rotor inertia: it is in the inertia of the bodies, as far as it fits there"
                .to_owned(),
        );
    }
    notes
}

/// A model's errors.
struct Errors<'a> {
    tree: &'a Tree,
    bodies: DVector<f64>,
    armature: &'a [f64],
    gravity: Vector3<f64>,
}

impl Errors<'_> {
    /// Errors of inertia matrix, gravity and velocity torques; `None` for one that is zero.
    fn over(&self, states: &[State]) -> [Option<RelativeError>; 3] {
        let scales = Scales::new(states);
        let sizes = [scales.inertia, scales.gravity, scales.velocity];
        let (mut squares, mut largest) = ([0.0_f64; 3], [0.0_f64; 3]);
        for state in states {
            let own = self.at(state);
            let errors = [
                scales.matrix(&(own.0 - &state.inertia)),
                scales.vector(&(own.1 - &state.gravity)),
                scales.vector(&(own.2 - &state.velocity)),
            ];
            for (at, error) in errors.into_iter().enumerate() {
                let error = error / sizes[at];
                squares[at] += error * error;
                largest[at] = largest[at].max(error);
            }
        }
        let count = states.len().max(1) as f64;
        // Torques of nothing but rounding have no relative error.
        let least = 1e-12 * scales.inertia;
        std::array::from_fn(|at| {
            (sizes[at] > least).then(|| RelativeError {
                rms: (squares[at] / count).sqrt(),
                largest: largest[at],
            })
        })
    }

    /// Inertia matrix, gravity and velocity torques of the serial model.
    fn at(&self, state: &State) -> (DMatrix<f64>, DVector<f64>, DVector<f64>) {
        let r = state.twist.len();
        let (still, none) = (vec![0.0; r], Vector3::zeros());
        let torques = |velocity: &[f64], acceleration: &[f64], gravity: &Vector3<f64>| {
            let columns = self
                .tree
                .columns(&state.pose, velocity, acceleration, gravity);
            columns * &self.bodies
        };
        let mut inertia = DMatrix::zeros(r, r);
        for axis in 0..r {
            let mut unit = still.clone();
            unit[axis] = 1.0;
            inertia.set_column(axis, &torques(&still, &unit, &none));
            inertia[(axis, axis)] += self.armature[axis];
        }
        (
            inertia,
            torques(&still, &still, &self.gravity),
            torques(&state.twist, &still, &none),
        )
    }
}

/// The tree of the file.
fn written(
    model: &SerialModel,
    tree: &Tree,
    armature: &[f64],
    bodies: &[f64],
    gravity: Vector3<f64>,
) -> SerialTree {
    let percent = |error: Option<RelativeError>| {
        error.map_or_else(
            || "none".to_owned(),
            |error| format!("{:.2e} (largest {:.2e})", error.rms, error.largest),
        )
    };
    let comment = vec![
        format!("Serial model of {}, written by `overact export --serial`.", model.robot),
        "The inertia of loops is lumped into the bodies of the skeleton. Errors relative to the root mean".to_owned(),
        format!("square of each quantity, at {} states:", model.state_count),
        format!("inertia matrix {};", percent(Some(model.inertia_matrix))),
        format!("torque of gravity {};", percent(model.gravity)),
        format!("centrifugal and Coriolis torques {}.", percent(model.velocity_torques)),
    ];
    // The body of an independent joint, by its coordinate.
    let leader = |coordinate: usize| {
        let mut all = tree.bodies.iter();
        all.position(|body| body.terms == [(coordinate, 1.0)])
    };
    let own = tree.bodies.iter().enumerate().map(|(at, body)| {
        let (coordinate, factor) = body.terms.first().copied().unwrap_or((0, 1.0));
        let first = leader(coordinate).unwrap_or(at);
        let [home, range] = [&model.home, &model.half_ranges].map(|all| factor * all[coordinate]);
        SerialBody {
            name: body.name.clone(),
            parent: body.parent,
            placement: body.placement,
            is_revolute: body.is_revolute,
            follows: (first != at).then_some((first, factor)),
            range: [home - range.abs(), home + range.abs()],
            armature: if first == at {
                armature[coordinate]
            } else {
                0.0
            },
            inertia: std::array::from_fn(|entry| bodies[INERTIAL * at + entry]),
        }
    });
    SerialTree {
        name: model.robot.clone(),
        comment,
        gravity,
        bodies: own.collect(),
    }
}
