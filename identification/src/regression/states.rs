//! Random states of a model without noise, on which linear relations between columns are exact.
//!
//! Poses are around the home pose. An unreachable pose is replaced by one of half the spread,
//! repeatedly, so that robots of any size have states.

use overact::Code;
use overact::{Columns, Function, Model};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

use crate::{blocks::slice, kinematics::Motion};
use overact_logs::{Error, Load, Problem};

/// Initial spread of the poses around home (m, rad).
const SPREAD: f64 = 1.0;
/// Largest number of halvings before the model counts as impossible to evaluate.
const HALVINGS: usize = 40;
/// Largest random twist coordinate (m/s, rad/s).
const LARGEST_TWIST: f64 = 3.0;
/// Largest random acceleration coordinate (m/s², rad/s²).
const LARGEST_ACCELERATION: f64 = 10.0;

/// States of a robot, sample after sample.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct States {
    /// Number of states.
    pub(crate) samples: usize,
    /// Poses, samples × pose coordinates (m, rad).
    pub(crate) pose: Vec<f64>,
    /// Twist coordinates, samples × r (m/s, rad/s).
    pub(crate) twist: Vec<f64>,
    /// Accelerations, samples × r (m/s², rad/s²).
    pub(crate) acceleration: Vec<f64>,
}

impl States {
    /// The states as unrelated samples, with any payload.
    pub(crate) fn sampled(&self) -> SampledStates<'_> {
        SampledStates {
            samples: self.samples,
            interval: 0.0,
            pose: &self.pose,
            twist: &self.twist,
            acceleration: &self.acceleration,
            carried: Load::Any,
        }
    }
}

/// Successive states of a robot.
#[derive(Debug, Clone, Copy)]
pub struct SampledStates<'a> {
    /// Number of samples.
    pub samples: usize,
    /// Sampling interval, s; zero for unrelated states.
    pub interval: f64,
    /// Poses, samples × pose coordinates (m, rad).
    pub pose: &'a [f64],
    /// Twist coordinates, samples × r (m/s, rad/s).
    pub twist: &'a [f64],
    /// Accelerations, samples × r (m/s², rad/s²).
    pub acceleration: &'a [f64],
    /// The payload that the platform carries.
    pub carried: Load<'a>,
}

impl<'a> SampledStates<'a> {
    /// States of `count` samples from number `first` of a motion on.
    pub(crate) fn of_motion(motion: &'a Motion, first: usize, count: usize) -> Self {
        let rows = |values: &'a [f64]| slice(values, values.len() / motion.samples, first, count);
        Self {
            samples: count,
            interval: 1.0 / motion.sampling_frequency,
            pose: rows(&motion.pose),
            twist: rows(&motion.twist),
            acceleration: rows(&motion.acceleration),
            carried: motion.carried(),
        }
    }
}

/// Draws `count` random states at which the model has a value, reproducibly for a `seed`.
///
/// # Errors
/// A model without a value even next to its home pose.
pub(crate) fn random_states(model: &dyn Model, count: usize, seed: u64) -> Result<States, Error> {
    let info = model.info();
    let dof = info.sizes.dof;
    let mut generator = Pcg64::seed_from_u64(seed);
    let mut draw = |largest: f64| -> Vec<f64> {
        (0..dof)
            .map(|_| generator.random_range(-largest..largest))
            .collect()
    };
    let mut states = States {
        samples: count,
        pose: Vec::new(),
        twist: Vec::new(),
        acceleration: Vec::new(),
    };
    for _ in 0..count {
        let twist = draw(LARGEST_TWIST);
        let acceleration = draw(LARGEST_ACCELERATION);
        let mut spread = SPREAD;
        let mut reason = None;
        let mut found = None;
        for _ in 0..HALVINGS {
            let mut pose = info.home_pose.to_vec();
            model.displace(&mut pose, &draw(spread));
            match try_state(model, &pose, &twist, &acceleration) {
                Ok(()) => {
                    found = Some(pose);
                    break;
                }
                Err(error) => reason = Some(error),
            }
            spread /= 2.0;
        }
        let Some(pose) = found else {
            let why = reason.map_or_else(String::new, |error| format!(": {error}"));
            return Err(Problem::new(
                Code::NO_EFFECT,
                format!(
                    "the model of `{}` has no value even next to its home pose{why}",
                    info.name
                ),
            )
            .help("check the geometry and the home pose of the description")
            .into());
        };
        states.pose.extend(pose);
        states.twist.extend(twist);
        states.acceleration.extend(acceleration);
    }
    Ok(states)
}

/// Whether the model can be evaluated at a state, with finite results.
fn try_state(
    model: &dyn Model,
    pose: &[f64],
    twist: &[f64],
    acceleration: &[f64],
) -> Result<(), overact::Error> {
    let sizes = model.info().sizes;
    let functions = [
        (Function::InverseJacobian, true),
        (Function::JointVelocities, true),
        (Function::IdmRedPlatform(Columns::Standard), true),
        (Function::IdmRedPayload, sizes.payload_parameters > 0),
    ];
    for (function, wanted) in functions {
        let (rows, columns) = function.shape(&sizes);
        if !wanted || rows * columns == 0 {
            continue;
        }
        let inputs: &[&[f64]] = &[pose, twist, acceleration];
        let inputs = &inputs[..function.inputs().len()];
        let mut output = vec![0.0; rows * columns];
        model
            .evaluate(function, inputs, &mut output)
            .map_err(|error| error.error)?;
        if output.iter().any(|value| !value.is_finite()) {
            return Err(overact::Error::Overflow);
        }
    }
    Ok(())
}
