//! `overact generate`: generates Rust, C or C++, one module per robot.

mod module;

use crate::{
    effort,
    failure::Failure,
    functions,
    note::{print_description_note, print_note, print_warnings},
    output::{self, json, print, write},
    progress::Progress,
};
use clap::builder::PossibleValuesParser;
use module::Module;
use overact::{online, transmission};
use overact_codegen::{Choice, Float, Progress as Step, Request, Runtime, mechanism::Mechanism};
use overact_robot::CompiledFile;
use std::path::{Path, PathBuf};

/// Number of joints above which generation takes minutes.
const LARGE: usize = 60;

/// Arguments of the command.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Descriptions
    #[arg(required = true, value_name = "TOML")]
    pub(super) files: Vec<PathBuf>,
    /// A file for one robot, or a folder for `<description>.rs` of each; for C a folder for
    /// `<robot>.h` and `<robot>.c` of each, for C++ also `<robot>.hpp`; `-` is standard output
    #[arg(short, long, value_name = "FILE|FOLDER")]
    output: Option<PathBuf>,
    /// The language: Rust, C99 that needs only `math.h`, or C99 with a header for C++
    #[arg(long, value_enum, default_value_t = Language::Rust)]
    lang: Language,
    /// Also write the C files of online estimation: overact_online.h and its sources
    #[arg(long)]
    online: bool,
    /// Also write the C files of transmissions: overact_transmission.h, its source, and a header for
    /// C++
    #[arg(long)]
    transmission: bool,
    /// Write nothing; fail if a file differs from what would be written
    #[arg(long, requires = "output")]
    check: bool,
    /// Values of all standard parameters, written by `identify --parameters`: generates the dynamics
    /// of one description with these constants, without identification models
    #[arg(long, value_name = "TOML")]
    parameters: Option<PathBuf>,
    /// Number type of the code
    #[arg(long, value_parser = PossibleValuesParser::new(Float::ALL.map(Float::name)), default_value = "f64")]
    float: String,
    /// Path of the crate `overact` in the generated Rust [default: ::overact]
    #[arg(long = "crate", value_name = "PATH", value_parser = Runtime::new)]
    runtime: Option<Runtime>,
    #[command(flatten)]
    functions: functions::Arguments,
    #[command(flatten)]
    effort: effort::Arguments,
}

/// A language that robots are written in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Language {
    /// One module
    Rust,
    /// A header and a source file of C99
    C,
    /// The same, and a header for C++17 with arrays of checked lengths
    Cpp,
}

impl Language {
    /// Whether the output has C files.
    const fn has_c(self) -> bool {
        matches!(self, Self::C | Self::Cpp)
    }

    /// The value of `--lang`.
    const fn name(self) -> &'static str {
        match self {
            Self::Rust => "rust",
            Self::C => "c",
            Self::Cpp => "cpp",
        }
    }
}

impl Arguments {
    /// Output file or folder; `None` for standard output.
    fn output(&self) -> Option<&Path> {
        let output = self.output.as_deref();
        output.filter(|output| *output != Path::new("-"))
    }

    /// Whether the output is a folder: an existing one, a path with a trailing separator, or
    /// several files.
    fn is_folder(&self, output: &Path) -> bool {
        let written = output.as_os_str().to_string_lossy();
        output.is_dir()
            || self.files.len() > 1
            || written.ends_with(std::path::is_separator)
            || self.lang.has_c()
    }

    /// Number type; the argument parser accepts known names only.
    fn float(&self) -> Float {
        Float::named(&self.float).unwrap_or_default()
    }

    /// Options that determine the output, as on the command line.
    fn options(&self) -> String {
        let language = match self.lang {
            Language::Rust => String::new(),
            other => format!(" --lang {}", other.name()),
        };
        let path = self.runtime.as_ref().map(Runtime::path);
        let path = path.map_or_else(String::new, |path| format!(" --crate {path}"));
        let float = match self.float() {
            Float::F64 => "",
            Float::F32 => " --float f32",
        };
        format!("{language}{float}{path}{}", self.functions.words())
    }

    /// Message on incompatible arguments.
    fn contradiction(&self, as_json: bool) -> Option<String> {
        let is_printed = self.output.is_none() && !as_json;
        if is_printed && self.lang.has_c() {
            let message = "C is a header and a source file: add `-o FOLDER`";
            return Some(message.to_owned());
        }
        let of_c = [(self.online, "online"), (self.transmission, "transmission")];
        if let Some((_, name)) = of_c.iter().find(|(given, _)| *given && !self.lang.has_c()) {
            return Some(format!(
                "`--{name}` writes C files: add `--lang c`; Rust has the module `overact::{name}`"
            ));
        }
        if self.runtime.is_some() && self.lang.has_c() {
            let message = "C uses no crate: leave out `--crate`, or generate Rust";
            return Some(message.to_owned());
        }
        if is_printed && self.files.len() > 1 {
            let message = "several descriptions need a folder to write to: add `-o FOLDER`";
            return Some(message.to_owned());
        }
        if self.parameters.is_some() && self.files.len() > 1 {
            let message = "parameters are those of one description: generate one at a time";
            return Some(message.to_owned());
        }
        if self.check && self.output().is_none() {
            let message = "--check compares with files: give the file or folder, `-o FILE|FOLDER`";
            return Some(message.to_owned());
        }
        let extension = self.output().and_then(Path::extension);
        let is_file =
            extension.is_some_and(|e| ["c", "h", "hpp"].iter().any(|c| e.eq_ignore_ascii_case(c)));
        if self.lang.has_c() && is_file {
            let message =
                "C is a header and a source file: give a folder instead of a file, `-o FOLDER`";
            return Some(message.to_owned());
        }
        None
    }
}

/// Runs the command.
///
/// # Errors
/// Descriptions with errors, two robots with one name, or files that differ with `--check`.
pub(super) fn run(arguments: &Arguments, as_json: bool) -> Result<(), Failure> {
    if let Some(message) = arguments.contradiction(as_json) {
        return Err(Failure::Usage(message));
    }
    let inputs = arguments.files.iter().chain(&arguments.parameters);
    let inputs: Vec<&Path> = inputs.map(PathBuf::as_path).collect();
    // C files are named after the robots, which are not supported yet.
    if !arguments.check && arguments.lang == Language::Rust {
        let mut outputs = inputs
            .iter()
            .filter_map(|file| module::rust_file(file, arguments));
        outputs.try_for_each(|output| output::check_distinct(&inputs, &[&output]))?;
    }
    let choice = arguments.functions.choice()?;
    let robots = load_all(arguments, choice.as_ref(), as_json)?;
    let mut modules: Vec<Module> = robots
        .iter()
        .zip(&arguments.files)
        .map(|(robot, path)| Module::new(robot, path, arguments))
        .collect();
    module::distinct(&modules)?;
    if let Some(first) = modules.first_mut() {
        if arguments.online {
            first.add_files(&online::C_FILES, arguments);
        }
        if arguments.transmission {
            first.add_files(&transmission::C_FILES, arguments);
        }
    }
    if arguments.check {
        module::compare(&modules)?;
    } else if arguments.output().is_some() {
        write_all(&modules, &inputs, arguments)?;
    }
    if as_json {
        let documents: Vec<_> = modules.iter().map(Module::document).collect();
        return print(&json(&serde_json::json!({ "robots": documents }))?);
    }
    if arguments.output().is_none() {
        return print(&modules.iter().map(Module::text).collect::<String>());
    }
    let what = if arguments.check {
        "up to date"
    } else {
        "written"
    };
    let files = modules.iter().flat_map(|m| &m.parts);
    let files = files.filter_map(|part| part.file.as_ref());
    let lines: Vec<String> = files
        .map(|file| format!("{}: {what}", file.display()))
        .collect();
    print(&lines.join("\n"))
}

/// Writes all files, or none.
fn write_all(modules: &[Module], inputs: &[&Path], arguments: &Arguments) -> Result<(), Failure> {
    let parts = || modules.iter().flat_map(|m| &m.parts);
    let outputs: Vec<&Path> = parts().filter_map(|part| part.file.as_deref()).collect();
    output::check_distinct(inputs, &outputs)?;
    if let Some(folder) = arguments
        .output()
        .filter(|output| arguments.is_folder(output))
    {
        output::make_folder(folder)?;
    }
    let contents =
        parts().filter_map(|part| Some((part.file.clone()?, part.code.clone().into_bytes())));
    write(contents.collect())
}

fn load_all(
    arguments: &Arguments,
    choice: Option<&Choice>,
    as_json: bool,
) -> Result<Vec<CompiledFile>, Failure> {
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
                print_note(&name, large(progress.mechanism).as_deref(), as_json);
            }
        };
        let request = Request {
            functions: choice,
            float: arguments.float(),
            runtime: arguments.runtime.as_ref(),
            progress: &watch,
            ..arguments.effort.request()
        };
        let compiled = match &arguments.parameters {
            Some(parameters) => CompiledFile::with_parameters(file, parameters, &request),
            None => CompiledFile::read(file, &request),
        };
        match compiled {
            Ok(robot) => {
                print_description_note(&robot, as_json);
                print_warnings(&robot.warnings, as_json);
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

/// Note for a robot whose generation takes minutes.
fn large(mechanism: &Mechanism) -> Option<String> {
    let joints = mechanism.joints().len();
    (joints > LARGE).then(|| {
        format!(
            "with {joints} joints this takes minutes; `--effort none` is quickest, `--effort quick` saves most of what a thorough search does"
        )
    })
}
