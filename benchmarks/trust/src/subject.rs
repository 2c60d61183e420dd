//! A robot for virtual experiments.

use crate::Failure;
use overact::{Info, Model};
use overact_identification::{Projection, Scales, Settings};
use overact_robot::{Robot, Variants};
use overact_simulation::Experiment;
use std::{collections::BTreeMap, ffi::OsStr, fs, path::Path};

/// A robot with its virtual experiment and the settings of its identification.
pub struct Subject {
    robot: Robot,
    /// The robot as compiled Rust, ten times as fast as interpreted, if it is in the library.
    compiled: Option<&'static dyn Model>,
    /// Its experiment without validation runs.
    pub experiment: Experiment,
    /// The true values by name.
    pub truth: BTreeMap<String, f64>,
    /// Robots with changed lengths, if only torques contain information on these.
    pub variants: Variants,
    /// Sizes and limits of the description, to check units.
    pub scales: Scales,
    /// Settings of the identification.
    pub settings: Settings,
}

impl Subject {
    /// Reads a robot's description.
    ///
    /// # Errors
    /// An invalid description, or one without a virtual experiment.
    pub fn load(path: &Path) -> Result<Self, Failure> {
        let robot = Robot::from_toml(path).map_err(said)?;
        Self::new(robot, compiled(path))
    }

    /// Reads a robot's description with replacements in its text.
    ///
    /// # Errors
    /// A replacement without effect, an invalid description, or one without a virtual experiment.
    pub fn altered(path: &Path, replacements: &[(String, String)]) -> Result<Self, Failure> {
        let mut text = fs::read_to_string(path)?;
        for (from, to) in replacements {
            if !text.contains(from) {
                return Err(format!("{}: no `{from}`", path.display()).into());
            }
            text = text.replacen(from, to, 1);
        }
        let robot = Robot::from_text(&path.to_string_lossy(), &text).map_err(said)?;
        Self::new(robot, None)
    }

    fn new(robot: Robot, compiled: Option<&'static dyn Model>) -> Result<Self, Failure> {
        let mut experiment = robot.experiment().map_err(said)?.plan().clone();
        let held = robot.held_out();
        experiment.runs.retain(|run| !held.contains(&run.name));
        Ok(Self {
            settings: robot.settings(experiment.sampling_hz),
            truth: robot.true_values().unwrap_or_default(),
            variants: robot.variants(),
            scales: robot.scales(),
            experiment,
            compiled,
            robot,
        })
    }

    /// The robot in another gravity, m/s² in the base frame.
    ///
    /// # Errors
    /// A robot without a model in this gravity.
    pub fn in_gravity(&self, gravity: [f64; 3]) -> Result<Robot, Failure> {
        Ok(self.robot.in_gravity(gravity).map_err(said)?)
    }

    /// The model.
    #[must_use]
    pub fn model(&self) -> &dyn Model {
        self.compiled.unwrap_or_else(|| self.robot.model())
    }

    /// Information on the robot.
    #[must_use]
    pub fn info(&self) -> Info<'_> {
        self.model().info()
    }

    /// Settings for another sampling frequency (Hz), as on the command line.
    #[must_use]
    pub fn settings_at(&self, frequency: f64) -> Settings {
        self.robot.settings(frequency)
    }

    /// Shortens all runs to a fraction of their duration.
    pub fn shorten(&mut self, part: f64) {
        self.experiment.duration_s *= part;
        for duration in self
            .experiment
            .runs
            .iter_mut()
            .flat_map(|run| &mut run.duration_s)
        {
            *duration *= part;
        }
    }

    /// Both projections, or the joint model of a robot without redundancy.
    #[must_use]
    pub fn projections(&self) -> Vec<Projection> {
        let sizes = self.info().sizes;
        if sizes.actuators > sizes.dof {
            let kept = self.settings.kept_actuators.clone();
            vec![Projection::Platform, Projection::Actuators(kept)]
        } else {
            vec![Projection::Joints]
        }
    }
}

/// Text of an error as on the command line.
fn said(error: overact_robot::Error) -> String {
    error.render(false)
}

/// Compiled robot of a library file.
fn compiled(path: &Path) -> Option<&'static dyn Model> {
    let library = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../robots"));
    let folder = path.canonicalize().ok()?.parent()?.to_owned();
    if library.canonicalize().ok()? != folder {
        return None;
    }
    overact_compiled::by_stem(path.file_stem().and_then(OsStr::to_str)?)
}
