//! A robot whose virtual experiments are drawn.

use crate::Failure;
use overact::{Info, Model};
use overact_identification::{Projection, Scales, Settings};
use overact_robot::{Robot, Variants};
use overact_simulation::Experiment;
use std::{collections::BTreeMap, ffi::OsStr, fs, path::Path};

/// A robot with its virtual experiment and the settings of its identification.
pub struct Subject {
    robot: Robot,
    /// The robot as compiled Rust, ten times as fast as the interpreted one, if it is one of the library.
    compiled: Option<&'static dyn Model>,
    /// Its experiment, without the runs that are held out.
    pub experiment: Experiment,
    /// The true values by name.
    pub truth: BTreeMap<String, f64>,
    /// The robot with other lengths, where nothing but the torques tells of them.
    pub variants: Variants,
    /// Sizes and limits of the description, by which units are judged.
    pub scales: Scales,
    /// How it is identified.
    pub settings: Settings,
}

impl Subject {
    /// Reads the description of a robot.
    ///
    /// # Errors
    /// A description that is wrong or has no virtual experiment.
    pub fn load(path: &Path) -> Result<Self, Failure> {
        let robot = Robot::from_toml(path).map_err(said)?;
        Self::new(robot, compiled(path))
    }

    /// Reads the description of a robot with replacements in its text.
    ///
    /// # Errors
    /// A replacement that replaces nothing, a description that is wrong or has no virtual experiment.
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

    /// The model.
    #[must_use]
    pub fn model(&self) -> &dyn Model {
        self.compiled.unwrap_or_else(|| self.robot.model())
    }

    /// What is known of the robot.
    #[must_use]
    pub fn info(&self) -> Info<'_> {
        self.model().info()
    }

    /// The settings of runs sampled at another frequency (Hz), as the command line chooses them.
    #[must_use]
    pub fn settings_at(&self, frequency: f64) -> Settings {
        self.robot.settings(frequency)
    }

    /// Shortens all runs to a part of their duration.
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

    /// Case 1 and case 2, or the joint model of a robot without redundancy.
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

/// An error as the command line tells it.
fn said(error: overact_robot::Error) -> String {
    error.render(false)
}

/// The compiled robot of a file of the library.
fn compiled(path: &Path) -> Option<&'static dyn Model> {
    let library = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../robots"));
    let folder = path.canonicalize().ok()?.parent()?.to_owned();
    if library.canonicalize().ok()? != folder {
        return None;
    }
    overact_compiled::by_stem(path.file_stem().and_then(OsStr::to_str)?)
}
