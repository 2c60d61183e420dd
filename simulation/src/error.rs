//! Errors of a virtual experiment, with location and advice.

use std::fmt;

/// Error of a virtual experiment.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Error {
    /// All invalid values of the experiment or the search for this robot.
    Experiment(Vec<Problem>),
    /// Runs that failed, in the order of the experiment.
    Runs(Vec<RunError>),
    /// The search for exciting trajectories found none.
    NoTrajectory {
        /// Number of candidates tried.
        candidates: usize,
        /// Number of candidates that the robot can follow completely.
        reachable: usize,
    },
    /// The model has no value at the home pose, so nothing can be scaled there.
    Home(overact::Error),
}

/// An invalid value, with advice.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Problem {
    /// Path of the value, such as `runs[1].trajectory.terms[0].coordinate`.
    pub field: String,
    /// Problem and advice.
    pub message: String,
}

/// A run that failed.
#[derive(Debug, Clone, PartialEq)]
pub struct RunError {
    /// Name of the run.
    pub run: String,
    /// Time in the run, s.
    pub time_s: f64,
    /// Stage of the loop.
    pub stage: Stage,
    /// Cause.
    pub cause: Cause,
}

/// Stage of the control loop.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// The desired motion.
    Trajectory,
    /// The controller.
    Controller,
    /// The robot.
    Plant,
}

/// Cause of a failed run.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Cause {
    /// The model has no value there.
    Model(overact::Error),
    /// The mass matrix is not positive definite.
    MassMatrix,
    /// An actuator left its trajectory.
    Lost {
        /// Name of the actuator.
        actuator: String,
        /// Tracking error, m or rad.
        error: f64,
    },
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}`: {}", self.field, self.message)
    }
}

impl fmt::Display for RunError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let place = match self.stage {
            Stage::Trajectory => "the desired trajectory",
            Stage::Controller => "the controller",
            Stage::Plant => "the robot",
        };
        write!(
            f,
            "run `{}`, {place} at t = {:.4} s: ",
            self.run, self.time_s
        )?;
        match &self.cause {
            Cause::Model(error) => {
                write!(f, "{error}")?;
                match error {
                    overact::Error::NotOffered { .. } => Ok(()),
                    _ => write!(f, "; lower the amplitudes or move the trajectory"),
                }
            }
            Cause::MassMatrix => write!(
                f,
                "the mass matrix is not positive definite; check the masses and inertias in `parameters`"
            ),
            Cause::Lost { actuator, error } => write!(
                f,
                "actuator `{actuator}` is off by {error:.2e} (rad or m); raise the torque limit, or lower the accelerations of the trajectory or the bandwidth of the controller"
            ),
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Experiment(problems) => lines(f, problems),
            Self::Runs(runs) => lines(f, runs),
            Self::NoTrajectory {
                candidates,
                reachable,
            } => write!(
                f,
                "none of {candidates} candidates is both reachable ({reachable} are) and well conditioned in every partition; lower `amplitude_limits` or raise `condition_bound` or `candidates`"
            ),
            Self::Home(error) => write!(f, "the home pose of the robot: {error}"),
        }
    }
}

/// Writes one item per line.
fn lines(f: &mut fmt::Formatter<'_>, items: &[impl fmt::Display]) -> fmt::Result {
    for (i, item) in items.iter().enumerate() {
        if i > 0 {
            writeln!(f)?;
        }
        write!(f, "{item}")?;
    }
    Ok(())
}

impl std::error::Error for Problem {}
impl std::error::Error for RunError {}
impl std::error::Error for Error {}
