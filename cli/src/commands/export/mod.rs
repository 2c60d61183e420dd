//! `overact export`: writes identified parameters into the file that a description was imported
//! from, or a description's skeleton as a serial robot.

mod serial;

use super::import::Choices;
use crate::{
    failure::{Failure, Problem},
    note::is_quiet,
    output::{self, check, print},
};
use overact_codegen::diagnostic::Code;
use overact_interchange::{Exported, export};
use overact_robot::errors_of_files;
use std::{
    io::{self, Write},
    path::{Path, PathBuf},
};

/// Arguments of the command.
#[derive(Debug, clap::Args)]
#[command(group(clap::ArgGroup::new("original").required(true).args(["mjcf", "urdf", "serial"])))]
pub(crate) struct Arguments {
    /// The MJCF from which the description was imported
    #[arg(long, value_name = "FILE")]
    mjcf: Option<PathBuf>,
    /// The URDF from which the description was imported
    #[arg(long, value_name = "FILE")]
    urdf: Option<PathBuf>,
    /// Write the skeleton of a description as a serial robot, with the inertia of its loops lumped
    /// into the bodies, and report the errors over the workspace
    #[arg(long, value_name = "FORMAT", value_enum, requires = "file")]
    serial: Option<SerialFormat>,
    /// Description, for `--serial`
    #[arg(value_name = "TOML", requires = "serial")]
    file: Option<PathBuf>,
    /// Standard parameters, written by `overact identify --parameters`; with `--serial` those of
    /// `[experiment.parameters]` by default
    #[arg(long, value_name = "TOML", required_unless_present = "serial")]
    parameters: Option<PathBuf>,
    /// With `--serial`: also write the states of the report as a table for `overact evaluate`
    #[arg(long, value_name = "CSV", requires = "serial")]
    states: Option<PathBuf>,
    /// The file to write instead of stdout; changed included files are written next to it
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Options with which the description was imported
    #[command(flatten)]
    choices: Choices,
}

/// Format of a serial robot.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum SerialFormat {
    /// MuJoCo's format
    Mjcf,
    /// The format of ROS
    Urdf,
}

impl Arguments {
    /// File of the robot.
    pub(super) fn file(&self) -> &Path {
        let all = [&self.mjcf, &self.urdf, &self.file].into_iter();
        let mut given = all.filter_map(Option::as_deref);
        given.next().unwrap_or(Path::new("-"))
    }
}

/// Runs the command.
///
/// # Errors
/// Errors of one of the files, or an output that cannot be written.
pub(super) fn run(arguments: &Arguments, as_json: bool) -> Result<(), Failure> {
    let file = arguments.file();
    if let Some(format) = arguments.serial {
        return serial::run(arguments, file, format, as_json);
    }
    // Required by the parser of arguments.
    let parameters = arguments.parameters.as_deref().unwrap_or(Path::new("-"));
    let output = output::file(arguments.output.as_ref());
    let outputs: Vec<&Path> = output.into_iter().collect();
    check(&[file, parameters], &outputs)?;
    let options = arguments.choices.options();
    let exported = export(file, parameters, &options).map_err(errors_of_files)?;
    let is_mjcf = exported.format == overact_interchange::Format::Mjcf;
    if is_mjcf != arguments.mjcf.is_some() {
        let (is, key) = if is_mjcf {
            ("MJCF", "--mjcf")
        } else {
            ("URDF", "--urdf")
        };
        let message = format!("the file is {is}: write `{key}`");
        return Err(Failure::Usage(message));
    }
    let others = included_files(file, output, &exported)?;
    let all: Vec<&Path> = outputs
        .iter()
        .copied()
        .chain(others.iter().map(|(path, _)| path.as_path()))
        .collect();
    let inputs: Vec<&Path> = exported.inputs.iter().map(PathBuf::as_path).collect();
    check(&inputs, &all)?;
    tell(&exported);
    match output {
        Some(output) => {
            let mut files = vec![(output.to_owned(), exported.text.into_bytes())];
            files.extend(others);
            output::write(files)
        }
        None => print(&exported.text),
    }
}

/// Changed included files, with paths relative to the output as theirs to the main file.
fn included_files(
    file: &Path,
    output: Option<&Path>,
    exported: &Exported,
) -> Result<Vec<(PathBuf, Vec<u8>)>, Failure> {
    let folder = file.parent().unwrap_or(Path::new(""));
    let place = |(path, text): &(PathBuf, String)| {
        let inside = path
            .strip_prefix(folder)
            .ok()
            .filter(|p| p.components().all(|c| c.as_os_str() != ".."));
        match (inside, output) {
            (Some(inside), Some(output)) => {
                let to = output.parent().unwrap_or(Path::new("")).join(inside);
                Ok((to, text.clone().into_bytes()))
            }
            _ => {
                let message = "this included file contains parameters and changes, too";
                let help = "write to a file in another folder, `-o NEW/robot.xml`; first move files that are included from outside the robot's folder into it";
                let problem = Problem::new(Code::OUTPUT, message).file(path.display().to_string());
                Err(problem.help(help).into())
            }
        }
    };
    exported.included.iter().map(place).collect()
}

/// Prints the changes, and parameters that the file cannot express.
fn tell(exported: &Exported) {
    if is_quiet() {
        return;
    }
    let mut lines = vec![if exported.changed.is_empty() {
        "the file is unchanged".to_owned()
    } else {
        format!("changed: {}", exported.changed.join(", "))
    }];
    lines.extend(exported.notes.iter().cloned());
    for line in lines {
        // A closed stderr is ignored.
        let _ = writeln!(io::stderr(), "note: {line}");
    }
}
