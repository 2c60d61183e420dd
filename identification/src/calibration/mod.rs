//! Calibration from redundancy: encoder offsets and lengths from the closure of the loops.
//!
//! A robot with n sensors for r < n coordinates measures its pose more often than needed. Where the
//! described geometry and the encoders are right, the n positions of each sample agree with one pose but
//! for noise; where they are not, they contradict it, and the contradictions of many poses tell what is
//! wrong, without any instrument beside the robot (self-calibration: Wampler, Hollerbach and Arai, *An
//! implicit loop method for kinematic calibration and its application to closed-chain mechanisms*, IEEE
//! Trans. Robotics and Automation 11, 1995; Hollerbach and Wampler, *The calibration index and taxonomy
//! for robot kinematic calibration methods*, Int. J. Robotics Research 15, 1996).
//!
//! With x_t the pose of sample t, o the offsets of the encoders and p the changes of lengths, the sensors
//! show y_t = q(x_t, p) + o + noise. The sum of squares over all samples, each sensor in units of its
//! noise, is minimised over o, p and all x_t. The poses are eliminated sample by sample (`elimination`),
//! as in separable least squares (Golub and Pereyra, *SIAM J. Numerical Analysis* 10, 1973) and bundle
//! adjustment: n - r equations in o and p are left of each sample.
//!
//! What they determine is told by the rank of these equations. A rigid motion of the base frame or of the
//! platform frame changes no angle, and if all sensors are angles, neither does a common factor of all
//! lengths: lengths are relative to those that are held as described.
//!
//! - `geometry`: the robot as seen from here;
//! - `samples`: samples of the runs, and the noise of the sensors;
//! - `elimination`, `fit`: the equations without poses, and their solution;
//! - `correlation`, `deviations`: how the noise hangs together over time, and how sure the solution is;
//! - `selection`: which parameters are changed;
//! - `result`: what is told.

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

use crate::{
    data::Log,
    error::{Error, Problem},
};
use elimination::Normal;
use fit::{Fit, inverted, restricted};
use report::Report;
use samples::Samples;
use selection::{Choice, independent_part};

/// Estimates encoder offsets and lengths from the closure of the loops in runs. A robot whose loops tell
/// nothing is no error: then nothing is estimated, and the remarks say why.
///
/// # Errors
/// No run, runs that do not fit the robot, that can't be read or that leave its workspace.
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
        Problem::new(
            Code::CALIBRATION,
            format!("the calibration finds no robot: {error}"),
        )
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

/// Of the first `count` parameters those that the equations determine together, in the order in which they
/// are rather changed than held: with deviations below [`DETERMINED`] under the noise of the sensors.
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

/// Deviation, relative to the robot's largest length or in radians, above which a parameter counts as not
/// determined when all are estimated together.
const DETERMINED: f64 = 0.01;
