//! `overact generate`: Rust source, one module per robot.

use crate::{
    effort,
    failure::{Failure, Problem},
    note::{tell, tell_doubts, tell_note},
    output::{self, json, print, write},
    progress::Progress,
};
use overact_codegen::{Progress as Step, Request, emission, mechanism::Mechanism};
use overact_robot::CompiledFile;
use serde::Serialize;
use std::{
    collections::BTreeMap,
    fs,
    path::{Component, Path, PathBuf},
};

/// More joints than these and generation is a matter of minutes.
const LARGE: usize = 60;

/// Arguments of the command.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Descriptions
    #[arg(required = true, value_name = "TOML")]
    pub(super) files: Vec<PathBuf>,
    /// A file for one robot, or a folder for `<description>.rs` of each
    #[arg(short, long, value_name = "FILE|FOLDER")]
    output: Option<PathBuf>,
    /// Write nothing; fail if a file differs from what would be written
    #[arg(long, requires = "output")]
    check: bool,
    /// Values of all standard parameters, as `identify --parameters` writes them: the dynamics of one
    /// description with these as constants, without the identification models
    #[arg(long, value_name = "TOML")]
    parameters: Option<PathBuf>,
    #[command(flatten)]
    effort: effort::Arguments,
}

/// A robot's module.
#[derive(Debug, Serialize)]
struct Module {
    robot: String,
    description: String,
    file: Option<PathBuf>,
    #[serde(skip_serializing_if = "Option::is_none")]
    source: Option<String>,
    /// What stands behind `overact generate`.
    #[serde(skip)]
    arguments: String,
    #[serde(skip)]
    code: String,
}

/// Runs the command.
///
/// # Errors
/// Descriptions with errors, two robots that would have one name, or files that differ with
/// `--check`.
pub(super) fn run(arguments: &Arguments, as_json: bool) -> Result<(), Failure> {
    if arguments.output.is_none() && arguments.files.len() > 1 && !as_json {
        let message = "several descriptions need a folder to write to: add `-o FOLDER`";
        return Err(Failure::Usage(message.to_owned()));
    }
    if arguments.parameters.is_some() && arguments.files.len() > 1 {
        let message = "parameters are those of one description: generate one at a time";
        return Err(Failure::Usage(message.to_owned()));
    }
    let inputs = arguments.files.iter().chain(&arguments.parameters);
    let inputs: Vec<&Path> = inputs.map(PathBuf::as_path).collect();
    if !arguments.check {
        let mut outputs = inputs
            .iter()
            .filter_map(|file| module_file(file, arguments));
        outputs.try_for_each(|output| output::check_distinct(&inputs, &[&output]))?;
    }
    let robots = load_all(arguments, as_json)?;
    let mut modules: Vec<Module> = robots
        .iter()
        .zip(&arguments.files)
        .map(|(robot, path)| module(robot, path, arguments))
        .collect();
    distinct(&modules)?;
    if arguments.check {
        compare(&modules)?;
    }
    let Some(_) = &arguments.output else {
        if as_json {
            modules
                .iter_mut()
                .for_each(|m| m.source = Some(m.code.clone()));
            return print(&json(&serde_json::json!({ "robots": modules }))?);
        }
        let code: Vec<&str> = modules.iter().map(|m| m.code.as_str()).collect();
        return print(&code.concat());
    };
    if !arguments.check {
        let file = |m: &Module| Some((m.file.clone()?, m.code.clone().into_bytes()));
        let outputs: Vec<&Path> = modules.iter().filter_map(|m| m.file.as_deref()).collect();
        output::check_distinct(&inputs, &outputs)?;
        make_folder(arguments)?;
        write(modules.iter().filter_map(file).collect())?;
    }
    if as_json {
        return print(&json(&serde_json::json!({ "robots": modules }))?);
    }
    let what = if arguments.check {
        "up to date"
    } else {
        "written"
    };
    let line = |m: &Module| Some(format!("{}: {what}", m.file.as_ref()?.display()));
    print(
        &modules
            .iter()
            .filter_map(line)
            .collect::<Vec<_>>()
            .join("\n"),
    )
}

fn load_all(arguments: &Arguments, as_json: bool) -> Result<Vec<CompiledFile>, Failure> {
    let (mut good, mut bad) = (Vec::new(), Vec::new());
    let count = arguments.files.len();
    let bar = Progress::new("generating", as_json);
    for (at, file) in arguments.files.iter().enumerate() {
        let name = file.display().to_string();
        let watch = |progress: Step<'_>| {
            let whole = progress.functions.max(1) as f64;
            let done = at as f64 + progress.done as f64 / whole;
            bar.at(done / count as f64, &format!("{name}: {}", progress.work));
            if progress.functions == 0 {
                tell(&name, large(progress.mechanism).as_deref(), as_json);
            }
        };
        let request = Request {
            progress: &watch,
            ..arguments.effort.request()
        };
        let compiled = match &arguments.parameters {
            Some(parameters) => CompiledFile::with_parameters(file, parameters, &request),
            None => CompiledFile::read(file, &request),
        };
        match compiled {
            Ok(robot) => {
                tell_note(&robot, as_json);
                tell_doubts(&robot.doubts, as_json);
                good.push(robot);
            }
            Err(failure) => bad.push(failure),
        }
    }
    if bad.is_empty() {
        Ok(good)
    } else {
        Err(bad.into())
    }
}

/// What is said of a robot whose functions take minutes, before they do.
fn large(mechanism: &Mechanism) -> Option<String> {
    let joints = mechanism.joints().len();
    (joints > LARGE).then(|| {
        format!(
            "with {joints} joints this takes minutes; `--effort none` is quickest, `--effort quick` \
             finds most of what a thorough search does"
        )
    })
}

/// The file of a description's module, where there is one.
fn module_file(description: &Path, arguments: &Arguments) -> Option<PathBuf> {
    let output = arguments.output.as_ref()?;
    Some(match is_folder(output, arguments) {
        true => output.join(format!("{}.rs", module_name(description))),
        false => output.clone(),
    })
}

fn module(robot: &CompiledFile, path: &Path, arguments: &Arguments) -> Module {
    let mut own = robot.file.clone();
    let mut labels = label(path);
    if let Some(parameters) = &arguments.parameters {
        own += &format!(" --parameters {}", parameters.display());
        labels += &format!(" --parameters {}", label(parameters));
    }
    Module {
        robot: robot.model.mechanism.name.clone(),
        description: robot.file.clone(),
        file: module_file(path, arguments),
        source: None,
        code: emission::file(&robot.model, &labels),
        arguments: own,
    }
}

/// Whether the output is a folder: it is one already, is written like one, or must hold several
/// files.
fn is_folder(output: &Path, arguments: &Arguments) -> bool {
    let written = output.as_os_str().to_string_lossy();
    output.is_dir() || arguments.files.len() > 1 || written.ends_with(std::path::is_separator)
}

fn make_folder(arguments: &Arguments) -> Result<(), Failure> {
    match &arguments.output {
        Some(output) if is_folder(output, arguments) => {
            fs::create_dir_all(output).map_err(|error| {
                let problem = Problem::new(format!("the folder can't be made: {error}"));
                problem.file(output.display().to_string()).into()
            })
        }
        _ => Ok(()),
    }
}

/// The description's name as a module: `DualV.toml` is `dual_v`.
fn module_name(path: &Path) -> String {
    let stem = path
        .file_stem()
        .map(|stem| stem.to_string_lossy().into_owned())
        .unwrap_or_default();
    let mut name = String::new();
    let mut before = '_';
    for c in stem.chars() {
        if c.is_uppercase() && (before.is_lowercase() || before.is_ascii_digit()) {
            name.push('_');
        }
        match c.is_alphanumeric() {
            true => name.extend(c.to_lowercase()),
            false => name.push('_'),
        }
        before = c;
    }
    name
}

/// How generated code calls its description: never by an absolute path, and alike from whichever
/// folder the program is run.
fn label(path: &Path) -> String {
    let here = std::env::current_dir().unwrap_or_default();
    let relative = match path.strip_prefix(&here) {
        Ok(relative) => relative,
        Err(_) if path.is_absolute() => path.file_name().map_or(path, Path::new),
        Err(_) => path,
    };
    let parts = relative.components().filter_map(|part| match part {
        Component::Normal(part) => Some(part.to_string_lossy().into_owned()),
        _ => None,
    });
    parts.collect::<Vec<_>>().join("/")
}

/// Two robots of one name, or two modules in one file, can't stand side by side.
fn distinct(modules: &[Module]) -> Result<(), Failure> {
    let mut problems = Vec::new();
    let mut robots: BTreeMap<&str, &Module> = BTreeMap::new();
    let mut files: BTreeMap<&Path, &Module> = BTreeMap::new();
    for module in modules {
        let problem = |message: String| Problem::new(message).file(module.description.as_str());
        if let Some(other) = robots.insert(&module.robot, module) {
            let message = format!(
                "the robot is named `{}`, like that of {}",
                module.robot, other.description
            );
            problems.push(problem(message).help("give each robot a `name` of its own"));
        }
        if let Some(file) = &module.file
            && let Some(other) = files.insert(file, module)
        {
            let message = format!(
                "its module is {}, like that of {}",
                file.display(),
                other.description
            );
            problems.push(problem(message).help("give each description a file name of its own"));
        }
    }
    if problems.is_empty() {
        Ok(())
    } else {
        Err(problems.into())
    }
}

/// Fails if a file is not what would be written.
fn compare(modules: &[Module]) -> Result<(), Failure> {
    let mut problems = Vec::new();
    for module in modules {
        let Some(file) = &module.file else { continue };
        let message = match fs::read_to_string(file) {
            Ok(text) if text == module.code => continue,
            Ok(_) => "the file differs from what its description generates".to_owned(),
            Err(error) => format!("the file can't be read: {error}"),
        };
        let (arguments, path) = (&module.arguments, file.display());
        let help = format!("renew it with `overact generate {arguments} -o {path}`");
        problems.push(Problem::new(message).file(path.to_string()).help(help));
    }
    if problems.is_empty() {
        Ok(())
    } else {
        Err(problems.into())
    }
}

#[cfg(test)]
mod tests {
    use super::{label, module_name};
    use std::path::Path;

    #[test]
    fn names_of_modules_and_descriptions() {
        assert_eq!(module_name(Path::new("a/DualV.toml")), "dual_v");
        assert_eq!(module_name(Path::new("planar-4rrr.toml")), "planar_4rrr");
        assert_eq!(
            label(Path::new("../robots/dualv.toml")),
            "robots/dualv.toml"
        );
        assert_eq!(label(Path::new("./dualv.toml")), "dualv.toml");
        assert_eq!(label(Path::new("/nowhere/dualv.toml")), "dualv.toml");
    }
}
