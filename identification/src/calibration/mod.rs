//! Calibration: encoder offsets and lengths from the closure of the loops.
//!
//! A robot with n sensors for r < n coordinates measures its pose redundantly. With the right
//! geometry and encoders, the n positions of each sample agree with one pose up to noise. Otherwise
//! the contradictions of many poses determine the errors, without external instruments
//! (self-calibration: Wampler, Hollerbach and Arai, *An implicit loop method for kinematic
//! calibration and its application to closed-chain mechanisms*, IEEE Trans. Robotics and Automation
//! 11, 1995; Hollerbach and Wampler, *The calibration index and taxonomy for robot kinematic
//! calibration methods*, Int. J. Robotics Research 15, 1996).
//!
//! With the pose x_t of sample t, encoder offsets o and changes p of lengths, the sensors show
//! y_t = q(x_t, p) + o + noise. The sum of squares over all samples, in units of the sensors'
//! noise, is minimised over o, p and all x_t. The poses are eliminated sample by sample
//! (`elimination`), as in separable least squares (Golub and Pereyra, *SIAM J. Numerical Analysis*
//! 10, 1973) and bundle adjustment. Each sample keeps n - r equations in o and p.
//!
//! The rank of these equations shows which parameters are determined. A rigid motion of the base
//! frame or of the platform frame changes no angle. If all sensors measure angles, a common factor
//! of all lengths changes no angle, either. Lengths are relative to those that are held as
//! described.
//!
//! - `geometry`: interface to the robot;
//! - `samples`: samples of the runs, and the noise of the sensors;
//! - `elimination`, `fit`: the equations without poses, and their solution;
//! - `correlation`, `deviations`: autocorrelation of the noise, standard deviations of the
//!   solution;
//! - `selection`: choice of the changed parameters;
//! - `report`: assembly of the result;
//! - `result`: the result.

mod correlation;
mod deviations;
mod elimination;
mod fit;
mod geometry;
mod report;
mod result;
mod samples;
mod selection;

pub use geometry::{
    ChangedGeometry, DescribedGeometry, Geometry, GeometryParameter, ParameterKind, Reached,
};
pub use result::{CalibratedParameter, Calibration, CalibrationScope, HeldParameter, SensorNoise};

use overact::Code;
use overact::Model;

use elimination::Normal;
use fit::{Fit, inverted, restricted};
use overact_logs::{Error, Log, Problem};
use report::Report;
use samples::Samples;
use selection::{Choice, independent_part};

/// Estimates encoder offsets and lengths from the loop closure in runs.
///
/// A robot without redundant sensors is no error: nothing is estimated, and the remarks say why.
///
/// # Errors
/// No run, or runs that do not fit the robot, cannot be read or leave its workspace.
pub fn calibrate(
    model: &dyn Model,
    geometry: &dyn Geometry,
    runs: &[Log],
    scope: CalibrationScope,
) -> Result<Calibration, Error> {
    check(model, runs)?;
    let info = model.info();
    let (n, r) = (info.sizes.actuators, info.sizes.dof);
    let parameters = n + geometry.parameters().len();
    if n <= r {
        return Ok(report::without_redundancy(&info, geometry, scope));
    }
    let samples = Samples::new(model, runs)?;
    let problem = elimination::Problem {
        model,
        geometry,
        samples: &samples,
    };
    let unreached = |error: overact::Error| -> Error {
        Problem::new(Code::CALIBRATION, format!("the calibration fails: {error}"))
            .help("check the described lengths and the units of the positions")
            .into()
    };
    let mut start = problem.start().map_err(unreached)?;
    let described = problem.eliminated(&mut start).map_err(unreached)?;
    let described = Normal::new(&described, parameters);
    let all: Vec<usize> = (0..parameters).collect();
    let choice = Choice {
        problem: &problem,
        candidates: &all,
        redundancy: n - r,
    };
    let fit = match scope {
        CalibrationScope::Smallest => choice.smallest(start),
        CalibrationScope::Offsets => {
            let selected = determined(&described, &problem, n);
            Fit::new(&problem, start, selected)
        }
        CalibrationScope::All => {
            let selected = determined(&described, &problem, parameters);
            Fit::new(&problem, start, selected)
        }
    };
    let report = Report {
        scope,
        choice: &choice,
        fit: &fit.map_err(unreached)?,
        described: &described,
    };
    Ok(report.calibration())
}

/// Checks that there are runs, and that they have the robot's sensors.
fn check(model: &dyn Model, runs: &[Log]) -> Result<(), Error> {
    let info = model.info();
    let mut problems = Vec::new();
    if runs.is_empty() {
        problems.push(
            Problem::new(
                Code::NOTHING_DETERMINED,
                "there is no run to calibrate from",
            )
            .help("give at least one log"),
        );
    }
    for log in runs
        .iter()
        .filter(|log| log.actuators() != info.sizes.actuators)
    {
        let message = format!(
            "the run has {} positions, the robot `{}` has {} actuators",
            log.actuators(),
            info.name,
            info.sizes.actuators
        );
        let problem = Problem::new(Code::LOG_ACTUATORS, message).file(log.name());
        problems.push(problem.help("map one position and one torque column to each actuator"));
    }
    Error::check(problems)
}

/// Those of the first `count` parameters that the equations determine together.
///
/// They are ordered by preference for change. Their standard deviations for the sensors' noise are
/// below [`DETERMINED`].
fn determined(normal: &Normal, problem: &elimination::Problem<'_>, count: usize) -> Vec<usize> {
    let n = problem.samples.sensors;
    let lengths = problem.geometry.parameters();
    let size = lengths.iter().map(|one| one.described.abs());
    let size = size.fold(0.0, f64::max);
    let info = problem.model.info();
    let limit = |place: usize| match info.actuator_is_revolute.get(place) {
        Some(true) => DETERMINED,
        _ => DETERMINED * size,
    };
    let kind = |place: usize| match place.checked_sub(n) {
        Some(own) => lengths[own].kind,
        None => ParameterKind::EncoderOffset,
    };
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by_key(|&place| kind(place));
    let mut selected = Vec::new();
    for place in order {
        if independent_part(normal, &selected, place).is_none() {
            continue;
        }
        selected.push(place);
        let inverse = inverted(&restricted(&normal.matrix, &selected));
        let known = inverse.is_some_and(|inverse| {
            let variances = inverse.diagonal();
            let mut each = selected.iter().zip(variances.iter());
            each.all(|(&own, variance)| variance.sqrt() < limit(own))
        });
        if !known {
            selected.pop();
        }
    }
    selected
}

/// Largest standard deviation of a determined parameter when all are estimated together.
///
/// In radians, or relative to the robot's largest length.
const DETERMINED: f64 = 0.01;
