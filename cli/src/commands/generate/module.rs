//! Generated files of a robot in one language, and their names.

use super::{Arguments, Language};
use crate::failure::{Failure, Problem};
use overact::online::CFile;
use overact_codegen::diagnostic::Code;
use overact_codegen::{backends::c, backends::rust};
use overact_robot::CompiledFile;
use serde_json::{Value, json};
use std::{
    collections::BTreeMap,
    fs,
    path::{Component, Path, PathBuf},
};

/// Module of a robot.
#[derive(Debug)]
pub(super) struct Module {
    robot: String,
    description: String,
    /// Arguments of `overact generate`.
    arguments: String,
    language: Language,
    pub(super) parts: Vec<ModulePart>,
}

/// A file of a module.
#[derive(Debug)]
pub(super) struct ModulePart {
    /// Name in the output folder.
    name: String,
    /// Path, if it is written to a file.
    pub(super) file: Option<PathBuf>,
    pub(super) code: String,
}

impl Module {
    /// Module of a robot whose description is at `path`.
    pub(super) fn new(robot: &CompiledFile, path: &Path, arguments: &Arguments) -> Self {
        let mut own = robot.file.clone();
        let mut labels = label(path);
        if let Some(parameters) = &arguments.parameters {
            own += &format!(" --parameters {}", parameters.display());
            labels += &format!(" --parameters {}", label(parameters));
        }
        let own_options = arguments.options();
        own += &own_options;
        labels += &own_options;
        let parts = match arguments.lang {
            Language::Rust => vec![ModulePart {
                name: format!("{}.rs", module_name(path)),
                file: rust_file(path, arguments),
                code: rust::file(&robot.model, &labels),
            }],
            Language::C | Language::Cpp => {
                let files = c::files(&robot.model, &labels);
                let part = |extension: &str, code: String| {
                    let name = format!("{}.{extension}", files.stem);
                    ModulePart {
                        file: arguments.output().map(|folder| folder.join(&name)),
                        name,
                        code,
                    }
                };
                let mut parts = vec![
                    part("h", files.header.clone()),
                    part("c", files.source.clone()),
                ];
                if arguments.lang == Language::Cpp {
                    parts.push(part("hpp", c::cpp_header(&robot.model, &labels)));
                }
                parts
            }
        };
        Self {
            robot: robot.model.mechanism.name.clone(),
            description: robot.file.clone(),
            arguments: own,
            language: arguments.lang,
            parts,
        }
    }

    /// Adds C files of the runtime, which are the same for all robots.
    pub(super) fn add_files(&mut self, files: &[CFile], arguments: &Arguments) {
        let parts = files.iter().map(|file| ModulePart {
            name: file.name.to_owned(),
            file: arguments.output().map(|folder| folder.join(file.name)),
            code: file.text.to_owned(),
        });
        self.parts.extend(parts);
    }

    /// Module as a JSON document, with its text if it is not written to a file.
    pub(super) fn document(&self) -> Value {
        let mut document = json!({ "robot": self.robot, "description": self.description });
        let texts = |part: &ModulePart| {
            let mut text = json!({ "file": part.file });
            if part.file.is_none() {
                text["source"] = json!(part.code);
            }
            text
        };
        match (self.language, &self.parts[..]) {
            (Language::Rust, [part]) => {
                let Value::Object(texts) = texts(part) else {
                    return document;
                };
                texts
                    .into_iter()
                    .for_each(|(key, value)| document[key] = value);
            }
            (_, parts) => {
                let named = |part: &ModulePart| {
                    let mut text = texts(part);
                    text["name"] = json!(part.name);
                    text
                };
                document["files"] = parts.iter().map(named).collect();
            }
        }
        document
    }

    /// Text of all files in sequence.
    pub(super) fn text(&self) -> String {
        self.parts.iter().map(|part| part.code.as_str()).collect()
    }
}

/// Path of a description's Rust module, if it is written to a file.
pub(super) fn rust_file(description: &Path, arguments: &Arguments) -> Option<PathBuf> {
    let output = arguments.output()?;
    Some(if arguments.is_folder(output) {
        output.join(format!("{}.rs", module_name(description)))
    } else {
        output.to_owned()
    })
}

/// Module name of a description: `DualV.toml` becomes `dual_v`.
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
        if c.is_alphanumeric() {
            name.extend(c.to_lowercase())
        } else {
            name.push('_')
        }
        before = c;
    }
    name
}

/// Path of the description in generated code: relative, and independent of the working folder.
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

/// Checks that robot names and output files are distinct.
pub(super) fn distinct(modules: &[Module]) -> Result<(), Failure> {
    let mut problems = Vec::new();
    let mut robots: BTreeMap<&str, &Module> = BTreeMap::new();
    let mut files: BTreeMap<&Path, &Module> = BTreeMap::new();
    for module in modules {
        let problem = |message: String| {
            Problem::new(Code::MODULES_COLLIDE, message).file(module.description.as_str())
        };
        let twin = robots.insert(&module.robot, module);
        if let Some(other) = twin {
            let message = format!(
                "the robot is named `{}`, like that of {}",
                module.robot, other.description
            );
            problems.push(problem(message).help("give each robot a `name` of its own"));
        }
        let shared = module.parts.iter().filter_map(|part| {
            let file = part.file.as_deref()?;
            Some((file, files.insert(file, module)?))
        });
        // Robots of one name share their C files; that was already reported.
        let shared: Vec<(&Path, &Module)> = shared.collect();
        if let (Some((file, other)), true) = (
            shared.first(),
            twin.is_none() || module.language == Language::Rust,
        ) {
            let message = format!(
                "its module is {}, like that of {}",
                file.display(),
                other.description
            );
            let help = match module.language {
                Language::Rust => "give each description a file name of its own",
                Language::C | Language::Cpp => {
                    "give each robot a `name` that differs not only in capitals"
                }
            };
            problems.push(problem(message).help(help));
        }
    }
    if problems.is_empty() {
        Ok(())
    } else {
        Err(problems.into())
    }
}

/// Fails if a file differs from what would be written.
pub(super) fn compare(modules: &[Module]) -> Result<(), Failure> {
    let mut problems = Vec::new();
    for module in modules {
        for part in &module.parts {
            let Some(file) = &part.file else { continue };
            let message = match fs::read_to_string(file) {
                Ok(text) if text == part.code => continue,
                Ok(_) => "the file differs from what its description generates".to_owned(),
                Err(error) => format!("the file can't be read: {error}"),
            };
            let (arguments, path) = (&module.arguments, file.display());
            let output = match (module.language, file.parent()) {
                (language, Some(folder)) if language.has_c() => folder.display(),
                _ => path,
            };
            let help = format!("renew it with `overact generate {arguments} -o {output}`");
            let path = file.display().to_string();
            problems.push(Problem::new(Code::NOT_FRESH, message).file(path).help(help));
        }
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
    fn module_names_and_description_labels_follow_from_paths() {
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
