//! Payloads of logs on the command line: `NAME=LOG` if a description has several, `A+B=LOG` for a
//! run with two of them.

use crate::failure::{Failure, Problem};
use overact_codegen::diagnostic::Code;
use overact_codegen::diagnostic::did_you_mean;
use overact_identification::{Log, carried_payloads};
use overact_robot::Robot;
use std::path::{Path, PathBuf};

/// Named payloads of a description; empty if there is only one, or none.
pub(crate) struct Payloads<'a> {
    names: Vec<&'a str>,
}

/// Log as given on the command line.
#[derive(Debug, Clone)]
pub(crate) struct GivenLog {
    pub(crate) path: PathBuf,
    pub(crate) loaded: bool,
    /// Name before the equals sign, if payloads have names.
    name: Option<String>,
    /// Path as given, if it was read from standard input or a pipe.
    pub(crate) given: Option<String>,
}

impl GivenLog {
    /// Adds the name of the payload to the log.
    pub(crate) fn label(&self, log: Log) -> Log {
        let log = match &self.given {
            Some(name) => log.with_name(name.as_str()),
            None => log,
        };
        match &self.name {
            Some(name) => log.with_payload_name(name),
            None => log,
        }
    }
}

impl<'a> Payloads<'a> {
    pub(crate) fn new(robot: &'a Robot) -> Self {
        Self {
            names: robot.payloads(),
        }
    }

    /// Logs of runs without payload.
    pub(crate) fn without(&self, paths: &[PathBuf]) -> Vec<GivenLog> {
        let given = |path: &PathBuf| GivenLog {
            path: path.clone(),
            loaded: false,
            name: None,
            given: None,
        };
        paths.iter().map(given).collect()
    }

    /// Logs of runs with a payload.
    pub(crate) fn with(&self, paths: &[PathBuf]) -> Vec<GivenLog> {
        let given = |path: &PathBuf| {
            let name = split(path).map(|(name, _)| name.to_owned());
            GivenLog {
                path: file(path).to_path_buf(),
                loaded: true,
                name,
                given: None,
            }
        };
        paths.iter().map(given).collect()
    }

    /// Checks the names of all logs.
    ///
    /// # Errors
    /// Logs without a name although payloads have names, and unknown names.
    pub(crate) fn check<'g>(
        &self,
        given: impl Iterator<Item = &'g GivenLog>,
    ) -> Result<(), Failure> {
        let problem = |one: &GivenLog| {
            let file = one.path.display().to_string();
            let list = self.names.join(", ");
            let mut carried = one.name.as_deref().into_iter().flat_map(carried_payloads);
            let unknown = carried.find(|name| !self.names.contains(name));
            match (&one.name, unknown) {
                (Some(label), None) => twice(label).map(|name| {
                    let message = format!("the payload `{name}` is named twice");
                    Problem::new(Code::LOG_PAYLOAD, message)
                        .file(file)
                        .help("a run carries each payload at most once")
                }),
                (_, Some(name)) => {
                    let help = did_you_mean(name, self.names.iter().copied());
                    let help = help.unwrap_or_else(|| {
                        if self.names.is_empty() {
                            String::from(
                                "leave out the name, or name the payloads in the description, payloads = [\"A\", \"B\"]",
                            )
                        } else {
                            format!("its payloads are {list}")
                        }
                    });
                    let message = format!("there is no payload `{name}`");
                    Some(
                        Problem::new(Code::LOG_PAYLOAD, message)
                            .file(file)
                            .help(help),
                    )
                }
                (None, None) if one.loaded && !self.names.is_empty() => {
                    let message =
                        "the robot's payloads have names, and this run does not name its payload";
                    let help = format!(
                        "write NAME=LOG, the name being one of {list}, or A+B=LOG for a run with two of them"
                    );
                    Some(
                        Problem::new(Code::LOG_PAYLOAD, message)
                            .file(file)
                            .help(help),
                    )
                }
                (None, None) => None,
            }
        };
        let problems: Vec<Problem> = given.filter_map(problem).collect();
        if problems.is_empty() {
            Ok(())
        } else {
            Err(problems.into())
        }
    }
}

/// The first name that a label contains twice.
fn twice(label: &str) -> Option<&str> {
    let names: Vec<&str> = carried_payloads(label).collect();
    let mut all = names.iter().enumerate();
    all.find_map(|(at, name)| names[..at].contains(name).then_some(*name))
}

/// Name and file around an equals sign; `None` if the whole is the name of an existing file.
fn split(path: &Path) -> Option<(&str, &str)> {
    let (name, file) = path.to_str()?.split_once('=')?;
    let is_label = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '+';
    let word = !name.is_empty() && name.chars().all(is_label);
    (word && !path.exists()).then_some((name, file))
}

/// File of a log as given on the command line.
pub(crate) fn file(path: &Path) -> &Path {
    split(path).map_or(path, |(_, file)| Path::new(file))
}
