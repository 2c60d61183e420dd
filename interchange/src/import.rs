//! Import of a robot file as a description.

use crate::{
    account::Account,
    assembly::{
        fitting::{pins, translating::translating},
        free_bodies, home, idle,
        layout::{self, Layout},
        misfit,
        network::Network,
        parasitic, simple, undriven,
    },
    bounds, choices,
    experiment::{self, Experiment},
    files::{Errors, Files, Place},
    format::Format,
    mjcf,
    model::Model,
    options::Options,
    origins::Origins,
    par,
    plan::Plan,
    sdf, unsupported, urdf,
    writing::{self, WrittenDescription},
    xml,
};
use overact_description::diagnostic::Diagnostics;
use std::path::{Path, PathBuf};

/// A description generated from a file.
#[derive(Debug, Clone, PartialEq)]
pub struct Imported {
    /// TOML text.
    pub text: String,
    /// Paths of all files read.
    pub inputs: Vec<PathBuf>,
    /// Source locations of the parts of the text.
    origins: Origins,
    /// Name of the robot, from the options or else the file.
    pub name: String,
    /// Summary of what was used of the files and what was not.
    pub account: Account,
    /// Changes of closures and axes that close the loops.
    pub misfits: Vec<ClosureMisfit>,
    /// Rods between two ball joints, whose rotation about their own line is held.
    pub spins: Vec<String>,
}

/// Change of a closure's frame or of a joint's axis that closes a loop.
#[derive(Debug, Clone, PartialEq)]
pub struct ClosureMisfit {
    /// Path of the file.
    pub file: String,
    /// Line, counted from 1.
    pub line: usize,
    /// Name of the closure or joint.
    pub name: String,
    /// Displacement, m.
    pub length: f64,
    /// Rotation, rad.
    pub angle: f64,
}

impl std::fmt::Display for ClosureMisfit {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let amount = misfit::amount(self.length, self.angle);
        write!(
            f,
            "`{}` is changed by {amount} to close the loops",
            self.name
        )
    }
}

impl Imported {
    /// Maps errors of the description to the source file.
    ///
    /// Each error is reported at its joint, or for the file as a whole, with the import option that
    /// helps.
    #[must_use]
    pub fn located(&self, errors: &Diagnostics) -> Errors {
        self.origins.located(errors)
    }
}

/// Generates a description from a robot file.
///
/// The description is not yet validated; `overact_robot::import` also does that.
///
/// # Errors
/// All errors of the file, each with its line, and contents that a description cannot express.
pub fn import(path: &Path, options: &Options) -> Result<Imported, Errors> {
    let files = Files::default();
    let described = described(&files, path, options);
    match described.filter(|_| files.is_clean()) {
        Some(Described {
            name,
            text,
            origins,
            misfits,
            spins,
        }) => Ok(Imported {
            text,
            inputs: files.paths(),
            origins,
            name,
            account: files.account(),
            misfits,
            spins,
        }),
        None => Err(files.into_errors()),
    }
}

/// A generated description with its origins.
struct Described {
    name: String,
    text: String,
    origins: Origins,
    misfits: Vec<ClosureMisfit>,
    spins: Vec<String>,
}

fn described(files: &Files, path: &Path, options: &Options) -> Option<Described> {
    let (model, _) = model(files, path, options)?;
    let robot = Robot::new(files, &model, options)?;
    let designed = if robot.plan.motors.is_empty() {
        experiment::design(&robot.network, &robot.layout, &robot.plan)
    } else {
        Err(String::from("its motors turn several joints"))
    };
    let name = options.name.clone().unwrap_or_else(|| model.name.clone());
    let WrittenDescription { text, joints } = robot.toml(files, &designed, path, options);
    Some(Described {
        name,
        text,
        origins: Origins::new(files, robot.network.model, joints),
        misfits: misfits(files, robot.network.model),
        spins: spins(&robot.network),
    })
}

fn spins(network: &Network<'_>) -> Vec<String> {
    network.spins().into_iter().map(str::to_owned).collect()
}

fn misfits(files: &Files, model: &Model) -> Vec<ClosureMisfit> {
    let each = model.misfits.iter().map(|own| ClosureMisfit {
        file: files.name(own.place.file),
        line: files.line(&own.place),
        name: own.name.clone(),
        length: own.length,
        angle: own.angle,
    });
    each.collect()
}

/// Reads a model and applies the user's choices; `None` after an error.
pub(crate) fn model(files: &Files, path: &Path, options: &Options) -> Option<(Model, Format)> {
    let file = files.read(path, None)?;
    let (mut model, format) = read(files, file, options)?;
    choices::check(files, format, options)?;
    bounds::check(files, &model)?;
    choices::apply(files, &mut model, options)?;
    simple::drop_closures_on_one_body(files, &mut model);
    files.is_clean().then_some(())?;
    free_bodies::check(files, &model)?;
    let tolerance = options.closure_tolerance.unwrap_or(misfit::TOLERANCE);
    if !model.closures.is_empty() && options.home.is_empty() {
        home::choose(&mut model);
    }
    if !model.closures.is_empty() {
        simple::join_balls(&mut model);
    }
    if !model.closures.is_empty() {
        pins::join_points(&mut model, tolerance);
        model = misfit::fitted(files, model, tolerance)?;
        pins::planar(&mut model);
    }
    if !model.closures.is_empty() {
        let network = Network::new(files, &model)?;
        idle::check_rods(files, &network)?;
        model = idle::without_idle_pins(&network).unwrap_or(model);
        model = translating(&model, tolerance).unwrap_or(model);
    }
    no_balls_in_trees(files, &model)?;
    unsupported::leave_out(files, format, &mut model);
    Some((model, format))
}

/// Skeleton and chains of a robot, and its legs in the description.
pub(crate) struct Robot<'m> {
    pub(crate) network: Network<'m>,
    pub(crate) layout: Layout,
    pub(crate) plan: Plan,
}

impl<'m> Robot<'m> {
    /// Computes skeleton, chains and legs; `None` after an error.
    pub(crate) fn new(files: &Files, model: &'m Model, options: &Options) -> Option<Self> {
        let mut network = Network::new(files, model)?;
        undriven::check(files, &network)?;
        let platform = parasitic::find(&network).filter(|_| options.coordinates.is_none());
        if let Some(platform) = platform.filter(|_| !layout::exists(&mut network)) {
            let plan = Plan::on_platform(files, &network, &platform)?;
            return Some(Self {
                network,
                layout: Layout::default(),
                plan,
            });
        }
        let layout = layout::find(files, &mut network, options)?;
        let plan = Plan::new(files, &network, &layout)?;
        Some(Self {
            network,
            layout,
            plan,
        })
    }

    /// Writes the description.
    pub(crate) fn toml(
        &self,
        files: &Files,
        designed: &Result<Experiment, String>,
        path: &Path,
        options: &Options,
    ) -> WrittenDescription {
        let source = path
            .file_name()
            .map(|name| name.to_string_lossy().into_owned());
        let source = source.unwrap_or_default();
        let account = files.account();
        writing::toml(
            &self.network,
            &self.plan,
            designed,
            &account,
            &source,
            options,
        )
    }
}

fn read(files: &Files, file: usize, options: &Options) -> Option<(Model, Format)> {
    let text = files.text(file);
    let start = text.trim_start_matches(['\u{feff}', ' ', '\t', '\r', '\n']);
    if !start.starts_with('<') {
        if is_table(&text) {
            return par::read(files, file, options).map(|model| (model, Format::Par));
        }
        refuse_text(files, file, start);
        return None;
    }
    let root = xml::parse(files, file)?;
    match root.name.as_str() {
        "mujoco" => mjcf::read(files, file, options).map(|model| (model, Format::Mjcf)),
        "robot" => urdf::read(files, file, options).map(|model| (model, Format::Urdf)),
        "sdf" | "gazebo" => sdf::read(files, file, options).map(|model| (model, Format::Sdf)),
        other => {
            let message =
                format!("a file with the root <{other}> is neither MJCF nor URDF nor SDFormat");
            files.report(
                &root.place,
                message,
                "MJCF begins with <mujoco>, URDF with <robot>, SDFormat with <sdf>",
            );
            None
        }
    }
}

/// Reports a file that is neither XML nor a table.
fn refuse_text(files: &Files, file: usize, text: &str) {
    let message = if text.is_empty() {
        "the file is empty"
    } else {
        "the file is neither XML nor a .par table"
    };
    let help = "give a robot as MJCF (<mujoco>), URDF (<robot>), SDFormat (<sdf>) or .par (NJ = …)";
    let span = 0..0;
    files.report(&Place { file, span }, message, help);
}

/// Whether a text is in the .par format.
fn is_table(text: &str) -> bool {
    let mut lines = text.lines();
    lines.any(|line| {
        let start = line.trim_start().get(..2);
        start.is_some_and(|start| start.eq_ignore_ascii_case("NJ")) && line.contains('=')
    })
}

/// Rejects ball joints in serial robots: every joint of those has a motor in a description.
fn no_balls_in_trees(files: &Files, model: &Model) -> Option<()> {
    if !model.closures.is_empty() {
        return Some(());
    }
    let mut balls = model.joints.iter();
    let ball = balls.find(|joint| joint.kind == crate::model::JointType::Ball);
    let Some(ball) = ball else {
        return Some(());
    };
    let message = format!(
        "the ball joint `{}` has no motor, which is not supported without loops",
        ball.name
    );
    let help = "write it as three revolute joints";
    files.report(&ball.place, message, help);
    None
}
